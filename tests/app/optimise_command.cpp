// `lagroid optimize`: problems, data, methods, endings, files.
#include "command_line.hpp"

#include <H5Cpp.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace app_optimise_command_tests {
namespace {

class Optimise : public CommandLine {
 protected:
  static std::string scene(const std::string& name) { return "optimize " + example("optimisation/" + name); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  /// A scene that is not stopped by a gap.
  std::string endless() const {
    return file("endless.toml",
                "problem = \"rayleigh\"\n[data]\nA = {random = \"symmetric\", rows = 300, seed = 1}\n"
                "[stop]\nrelative_gradient = 1e-30\npatience = 0\niterations = 1000000000\n");
  }
  nlohmann::json summary(const std::string& arguments) const {
    const Outcome r = run(arguments + " --json");
    EXPECT_EQ(r.code, 0) << arguments << r.err << r.out;
    return nlohmann::json::parse(r.out);
  }
};

TEST_F(Optimise, EveryExampleFindsItsMinimum) {
  int examples = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(LAGROID_EXAMPLES) / "optimisation")) {
    if (entry.path().extension() != ".toml") continue;
    ++examples;
    const std::string name = entry.path().stem();
    const auto found = summary(scene(name));
    EXPECT_EQ(found.at("status"), "converged");
    // Of the means of many points nobody knows the minimum; their Hessians are at least one.
    if (found.contains("gap"))
      EXPECT_LT(found.at("gap").get<double>(), 2e-10) << name;
    else
      EXPECT_LT(found.at("gradient").get<double>(), 1e-9) << name;
    EXPECT_LT(found.at("constraints").get<double>(), 1e-14) << name;
  }
  EXPECT_GE(examples, 5);
}

TEST_F(Optimise, EveryMethodFindsTheMinimum) {
  const std::vector<std::string> methods{"robust",
                                         "robust --set method.look_ahead=true --set method.restart=true",
                                         "robust --set method.constraint=projection",
                                         "adaptive",
                                         "direct",
                                         "euler-lagrange",
                                         "euler-lagrange --set method.version=2",
                                         "gradient-descent --set method.c=1",
                                         "gradient-descent --set method.retraction=cayley",
                                         "conjugate-gradients --set method.retraction=polar",
                                         "trust-region"};
  for (const std::string& method : methods) {
    const auto found =
        summary(scene("rayleigh") + " --set stop.gap=1e-7 --set stop.iterations=20000 --set method.name=" + method);
    EXPECT_LT(found.at("gap").get<double>(), 1e-7) << method;
  }
}

TEST_F(Optimise, EveryMethodFindsTheMeanOfTwoPoints) {
  const std::string points = file("two.toml",
                                  "problem = \"hyperbolic-mean\"\nreference = true\n[data]\npoints = \"two.csv\"\n"
                                  "[start]\nfile = \"start.csv\"\nnearest = true\n[stop]\ngradient = 1e-7\n");
  file("two.csv", "1, 0\n0, 2\n");
  file("start.csv", "1\n-1\n0.5\n");
  const std::string tensors = file("tensors.toml",
                                   "problem = \"positive-definite-mean\"\nreference = true\n[data]\n"
                                   "matrices = \"matrices.csv\"\n[stop]\ngradient = 1e-7\n");
  file("matrices.csv", "2, 1\n1, 3\n1, 0\n0, 0.5\n");
  for (const std::string& problem : {points, tensors})
    for (const std::string method :
         {"robust --set method.constraint=geodesics", "adaptive --set method.constraint=geodesics --set method.h=0.02",
          "direct --set method.constraint=geodesics --set method.h=0.02 --set method.lambda=2",
          "euler-lagrange --set method.h=0.02", "gradient-descent", "conjugate-gradients", "trust-region"}) {
      const std::string domain =
          method.starts_with("adaptive") || method.starts_with("euler") ? " --set method.diameter=4" : "";
      const auto found = summary("optimize " + problem + " --set method.name=" + method + domain);
      EXPECT_LT(std::abs(found.at("gap").get<double>()), 1e-13) << method;
    }
}

TEST_F(Optimise, FindsMeansFarOutAndWhereTheyBegin) {
  const std::string far = file("far.toml",
                               "problem = \"hyperbolic-mean\"\n[data]\npoints = \"far.csv\"\n"
                               "[method]\nname = \"trust-region\"\n[stop]\ngradient = 1e-9\n");
  file("far.csv", "1e8, 0\n-1e8, 0\n");
  EXPECT_LT(summary("optimize " + far).at("gradient").get<double>(), 1e-9);
  const std::string equal =
      file("equal.toml", "problem = \"positive-definite-mean\"\n[data]\nmatrices = \"equal.csv\"\n");
  file("equal.csv", "2, 1\n1, 3\n2, 1\n1, 3\n");
  EXPECT_EQ(summary("optimize " + equal).at("status"), "converged");
}

TEST_F(Optimise, APenaltyComesNear) {
  const auto found = summary("optimize " + endless() +
                             " --set method.name=robust --set method.constraint=penalty --set method.penalty=1e6"
                             " --set stop.relative_gradient=1e-9 --set stop.iterations=100000");
  EXPECT_LT(found.at("off_manifold").get<double>(), 1e-3);
  EXPECT_GT(found.at("off_manifold").get<double>(), 1e-7);
  EXPECT_LT(found.at("constraints").get<double>(), 1e-14);
  EXPECT_NEAR(found.at("value").get<double>(),
              summary("optimize " + endless() + " --set method.name=robust --set stop.relative_gradient=1e-9")
                  .at("value")
                  .get<double>(),
              1e-8);
  // A weak one is no minimum of the problem.
  const Outcome weak = run("optimize " + endless() +
                           " --set method.constraint=penalty --set method.penalty=1e-3"
                           " --set stop.relative_gradient=1e-6 --set stop.iterations=100000");
  EXPECT_EQ(weak.code, 3);
  EXPECT_NE(weak.err.find("raise its weight"), std::string::npos) << weak.err;
}

TEST_F(Optimise, ReadsEveryKindOfFile) {
  const std::string problem = file("scene.toml", "problem = \"rayleigh\"\nreference = true\n[data]\nA = \"\"\n");
  file("a.csv", "# three by three\n2, -1, 0\n-1, 2, -1\n0, -1, 2\n");
  file("sparse.mtx", "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n1 1 2\n2 2 2\n3 3 2\n2 1 -1\n3 2 -1\n");
  file("dense.mtx", "%%MatrixMarket matrix array real general\n3 3\n2\n-1\n0\n-1\n2\n-1\n0\n-1\n2\n");
  {
    const double a[9] = {2, -1, 0, -1, 2, -1, 0, -1, 2};
    const hsize_t size[2] = {3, 3};
    const H5::H5File out((folder_ / "a.h5").string(), H5F_ACC_TRUNC);
    out.createDataSet("A", H5::PredType::NATIVE_DOUBLE, H5::DataSpace(2, size)).write(a, H5::PredType::NATIVE_DOUBLE);
  }
  for (const std::string data : {"a.csv", "sparse.mtx", "dense.mtx", "a.h5:/A"})
    EXPECT_NEAR(summary("optimize " + problem + " --set data.A=\\\"" + data + "\\\"").at("value").get<double>(),
                -2 - std::sqrt(2.0), 1e-13)
        << data;
}

TEST_F(Optimise, WritesFilesAndGoesOnFromThem) {
  const std::string out = (folder_ / "out").string();
  const Outcome r =
      run(scene("membrane") + " --set stop.iterations=100 --set stop.relative_gradient=1e-12 --out " + out);
  EXPECT_EQ(r.code, 3);
  EXPECT_NE(r.err.find("100 iterations did not suffice"), std::string::npos) << r.err;
  for (const char* name :
       {"history.csv", "result.h5", "summary.json", "summary.txt", "plot.gp", "plot.svg", "plot.png"})
    EXPECT_TRUE(fs::exists(out + "/" + name)) << name;
  std::ifstream history(out + "/history.csv");
  EXPECT_EQ(std::count(std::istreambuf_iterator<char>(history), {}, '\n'), 102);
  const auto before = nlohmann::json::parse(std::ifstream(out + "/summary.json"));
  const auto after = summary(scene("membrane") + " --set start.file=\\\"" + out + "/result.h5:/x\\\"");
  EXPECT_LT(after.at("gap").get<double>(), 1e-12);
  EXPECT_GT(before.at("gap").get<double>(), 1e-6);
}

TEST_F(Optimise, AnInterruptLeavesTheBestPoint) {
  const std::string out = (folder_ / "out").string();
  const Outcome r =
      run("optimize " + endless() + " --set method.name=direct --out " + out, "timeout --preserve-status -s INT 2 ");
  EXPECT_EQ(r.code, 4) << r.err;
  const auto found = nlohmann::json::parse(std::ifstream(out + "/summary.json"));
  EXPECT_EQ(found.at("status"), "interrupted");
  std::ifstream history(out + "/history.csv");
  std::string line;
  std::getline(history, line);
  ASSERT_EQ(line.substr(0, line.find(',', line.find(',') + 1)), "iteration,value");
  double least = HUGE_VAL;
  long rows = 0;
  for (; std::getline(history, line); ++rows) least = std::min(least, std::stod(line.substr(line.find(',') + 1)));
  EXPECT_GT(rows, 100);
  EXPECT_EQ(found.at("value").get<double>(), least);
  EXPECT_TRUE(fs::exists(out + "/result.h5"));
}

TEST_F(Optimise, BadInputIsOneLineThatNamesTheRemedy) {
  file("nan.csv", "1, 0\n0, nan\n");
  file("word.csv", "1, 0\n0, one\n");
  file("ragged.csv", "1, 0\n0\n");
  file("skew.csv", "1, 1\n-1, 1\n");
  file("wide.csv", "1, 1, 2\n-1, 1, 2\n");
  file("no.mtx", "1 2 3\n");
  file("pattern.mtx", "%%MatrixMarket matrix coordinate pattern symmetric\n2 2 1\n2 1\n");
  file("upper.mtx", "%%MatrixMarket MATRIX COORDINATE PATTERN SYMMETRIC\n2 2 1\n2 1\n");
  file("more.mtx", "%%MatrixMarket matrix coordinate real general\n2 2 1\n1 1 3\n2 2 7\n");
  file("fewer.mtx", "%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 3\n");
  file("zero.mtx", "%%MatrixMarket matrix coordinate real general\n2 2 1\n0 0 3\n");
  file("off.csv", "1\n1\n");
  file("two.csv", "1, 0\n0, 2\n");
  file("indefinite.csv", "1, 0\n0, 1\n1, 2\n2, 1\n");
  file("crooked.csv", "1, 0\n0, 1\n2, 1\n0.5, 2\n");
  file("three.csv", "1, 0\n0, 1\n1, 2\n");
  file("a.bin", "");
  file("b.h5", "no HDF5");
  const std::string path = folder_.string() + "/";
  const auto data = [&](const char* name) { return scene("rayleigh") + " --set data.A=\\\"" + path + name + "\\\""; };
  const std::vector<std::pair<std::string, std::string>> cases{
      {data("missing.csv"), "no such file"},
      {data("nan.csv"), "entry (2, 2) is nan"},
      {data("word.csv"), "line 2, column 2: \"one\" is no number"},
      {data("ragged.csv"), "line 2 has 1 numbers"},
      {data("skew.csv"), "(A + A^T) / 2"},
      {data("wide.csv"), "2 x 3; give a symmetric one"},
      {data("no.mtx"), "MatrixMarket"},
      {data("pattern.mtx"), "give a real matrix"},
      {data("upper.mtx"), "give a real matrix"},
      {data("more.mtx"), "line 4: more than the 1 entries"},
      {data("fewer.mtx"), "1 entries where 2 were announced"},
      {data("zero.mtx"), "indices begin at 1"},
      {data("a.bin"), ".csv, .mtx (MatrixMarket) and .h5"},
      {data("b.h5:/A"), "h5ls"},
      {data("b.h5"), "say which data set"},
      {scene("rayleigh") + " --set data.A.rows=1", "one eigenvalue"},
      {scene("membrane") + " --set parameters.weights=[3,2,1]", "0 <= mu_1"},
      {scene("membrane") + " --set parameters.weights=[]", "weights"},
      {scene("membrane") + " --set start.file=\\\"data/markers.csv\\\"", "12 x 3 numbers, points of the Stiefel"},
      {scene("membrane") + " --set start.component=1", "only O(n)"},
      {scene("markers") + " --set data.B=\\\"data/membrane.mtx\\\"", "they need the same number"},
      {scene("rayleigh") + " --set method.name=newton", "robust"},
      {scene("rayleigh") + " --set method.name=robust --set method.c=4", "between 0 and 4"},
      {scene("rayleigh") + " --set method.stpe=1", "unknown key"},
      {scene("rayleigh") + " --set method.penalty=3", "goes with constraint"},
      {scene("rayleigh") + " --set problem=max-cut", "rayleigh"},
      {scene("rayleigh") + " --set stop.gap=-1", "positive"},
      {data("two.csv") + " --set start.file=\\\"" + path + "off.csv\\\"", "start.nearest = true"},
      {scene("rayleigh") + " --set method.constraint=penalty", "stop by the gradient"},
      {scene("rayleigh") + " --set method.name=trust-region --set method.constraint=penalty", "unknown key"},
      {scene("rayleigh") + " --set method.capped=false --set method.cap=2", "goes with capped"},
      {scene("rayleigh") + " --set stop.relative_gradient=2", "below 1"},
      {scene("tensors") + " --set method.name=robust", "take the constraint geodesics"},
      {scene("tensors") + " --set method.retraction=qr", "take one of: exponential"},
      {scene("tensors") + " --set method.name=euler-lagrange", "or lambda"},
      {scene("tensors") + " --set start.seed=2", "first point"},
      {scene("tensors") + " --set data.matrices=\\\"" + path + "indefinite.csv\\\"",
       "matrix 2 is not positive definite, its smallest eigenvalue is -1.0e+00; leave it out"},
      {scene("tensors") + " --set data.matrices=\\\"" + path + "crooked.csv\\\"", "give (A + A^T) / 2"},
      {scene("tensors") + " --set data.matrices=\\\"" + path + "three.csv\\\"", "one below the other"},
      {scene("tensors") + " --set data.matrices=\\\"" + path + "missing.csv\\\"", "no such file"},
      {scene("hyperbolic_mean") + " --set method.diameter=-1", "positive"},
      {"optimize", "name a scene"},
      {"optimize nowhere.toml", "nowhere.toml"}};
  for (const auto& [arguments, words] : cases) {
    const Outcome r = expect_refused(arguments, words);
    EXPECT_EQ(nlohmann::json::parse(run(arguments + " --json").out).at("message").get<std::string>() + "\n",
              r.err.substr(std::string("lagroid: ").size()));
  }
  // The unbalanced problem has no minimum that is known.
  const Outcome r =
      run(scene("markers") + " --set data.B=\\\"" +
          file("one.csv", std::string("1\n1\n1\n1\n1\n1\n") + "1\n1\n1\n1\n1\n1\n") + "\\\" --set start={}");
  EXPECT_EQ(r.code, 2) << r.out;
  EXPECT_NE(r.err.find("nobody knows"), std::string::npos) << r.err;
}

TEST_F(Optimise, AGapThatWasAskedForIsNotForgotten) {
  // From a subspace without the minimum, which rounding may leave: nothing that stays there is called converged.
  const std::string problem = file("saddle.toml",
                                   "problem = \"rayleigh\"\n[data]\nA = \"a.csv\"\n[start]\nfile = \"x.csv\"\n"
                                   "[stop]\ngap = 1e-9\n");
  file("a.csv", "1,0,0,0\n0,2,0,0\n0,0,3,0\n0,0,0,9\n");
  file("x.csv", "0.6\n0.8\n0\n0\n");
  for (const std::string method : {"robust", "conjugate-gradients", "adaptive"}) {
    const Outcome r = run("optimize " + problem + " --json --set method.name=" + method);
    const double gap = nlohmann::json::parse(r.out).at("gap").get<double>();
    EXPECT_EQ(r.code, gap < 2e-9 ? 0 : 3) << method << r.err;
    EXPECT_TRUE(gap < 2e-9 || std::abs(gap - 7) < 1e-6) << method << gap;
  }
}

TEST_F(Optimise, ListsProblemsAndMethods) {
  const Outcome r = run("optimize --list");
  EXPECT_EQ(r.code, 0);
  for (const char* name :
       {"rayleigh", "brockett", "procrustes", "hyperbolic-mean", "positive-definite-mean", "robust", "adaptive",
        "direct", "euler-lagrange", "gradient-descent", "conjugate-gradients", "trust-region"})
    EXPECT_NE(r.out.find("  " + std::string(name) + " "), std::string::npos) << name;
}

TEST_F(Optimise, FigureOneIsReproduced) {
  const std::string out = (folder_ / "figure").string();
  const auto found =
      summary("reproduce accelerated-optimization --instances 1 --iterations 3000 --out " + out).at("iterations");
  for (const char* problem : {"Rayleigh", "Brockett", "unbalanced Procrustes", "balanced Procrustes"}) {
    const auto to_8 = [&](const char* method) { return found.at(problem).at(method).at("1e-8").get<double>(); };
    EXPECT_GT(to_8("Algorithm 1 adaptive"), 0) << problem;
    EXPECT_EQ(to_8("Algorithm 1 direct"), -1) << problem;
    EXPECT_EQ(to_8("Algorithm 2 I"), -1) << problem;
    EXPECT_LT(3 * to_8("robust"), to_8("Algorithm 1 adaptive")) << problem;
  }
  for (const char* name :
       {"report.md", "runs.csv", "curves.csv", "costs.csv", "figures.gp", "figure_1.svg", "tuned.svg", "costs.svg"})
    EXPECT_TRUE(fs::exists(out + "/" + name)) << name;
}

TEST_F(Optimise, OrdersOfConstrainedMapsAreReproduced) {
  const std::string out = (folder_ / "maps").string();
  const auto found = summary("reproduce constrained-maps --refinements 3 --out " + out).at("orders");
  const auto order = [&](const char* problem, const char* method, const char* of) {
    return found.at(problem).at(method).at(of).get<double>();
  };
  for (const auto& [method, expected] : {std::pair("type II r = 0", 1),
                                         {"type III r = 0", 1},
                                         {"type I trapezoid (RATTLE)", 2},
                                         {"type II r = 1 trapezoid", 2},
                                         {"type II r = 2 Gauss", 2},
                                         {"type II r = 3 Gauss", 2},
                                         {"RATTLE triple jump", 4},
                                         {"RATTLE Suzuki", 4}}) {
    EXPECT_NEAR(order("spherical pendulum", method, "q"), expected, 0.2) << method;
    EXPECT_NEAR(order("spherical pendulum", method, "tangent"), expected, 0.2) << method;
    EXPECT_NEAR(order("spherical pendulum", method, "p"), 1, 0.2) << method;
  }
  for (int r = 0; r <= 4; ++r)
    EXPECT_NEAR(order("planar pendulum", ("type II r = " + std::to_string(r)).c_str(), "q"), r + 1, 0.3) << r;
  for (const char* name : {"report.md", "errors.csv", "figures.gp", "errors.svg"})
    EXPECT_TRUE(fs::exists(out + "/" + name)) << name;
}

}  // namespace
}  // namespace app_optimise_command_tests
