// `lagroid learn` and `lagroid trajectories` on spheres: data, models, endings, files, and what is refused.
#include "learn.hpp"

#include <H5Cpp.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace learn_command_spheres_tests {
namespace {

/// A trajectory of two points, with so many columns of times, and q_1x of the last one.
std::string hdf5(const std::string& file, hsize_t columns, double last) {
  const H5::H5File out(file, H5F_ACC_TRUNC);
  const auto add = [&](const char* set, hsize_t width, std::vector<double> numbers) {
    const hsize_t size[2] = {2, width};
    out.createDataSet(set, H5::PredType::NATIVE_DOUBLE, H5::DataSpace(2, size))
        .write(numbers.data(), H5::PredType::NATIVE_DOUBLE);
  };
  add("trajectory", 1, {1, 1});
  add("t", columns, columns == 1 ? std::vector<double>{0, 0.1} : std::vector<double>(2 * columns));
  add("z", 6, {0, 0, 1, 1, 0, 0, last, 0, 1, 1, 0, 0});
  return file;
}

TEST_F(Learn, RecoversWhatWasDrawn) {
  const std::string data = drawn("data.csv", "--chain 2 --masses 1,0.5 --lengths 1,0.7 --gravity 3");
  const std::string test =
      drawn("test.h5", "--chain 2 --masses 1,0.5 --lengths 1,0.7 --gravity 3 --points 21 --duration 2 --seed 5");
  const auto found = summary("learn " + data + " --model polynomial:1 --test " + test);
  EXPECT_EQ(found.at("status"), "converged");
  EXPECT_LT(found.at("held_out").at("mse").get<double>(), 1e-12);
  EXPECT_LT(found.at("held_out").at("energy_variation_largest").get<double>(), 1e-5);
  EXPECT_LT(found.at("held_out").at("momentum_change_data").get<double>(), 1e-11);
  EXPECT_NEAR(found.at("mass_matrix")[0][0].get<double>(), 1.5, 1e-7);
  EXPECT_NEAR(found.at("mass_matrix")[0][1].get<double>(), 0.35, 1e-7);
  EXPECT_NEAR(found.at("mass_matrix")[1][1].get<double>(), 0.245, 1e-7);
}

TEST_F(Learn, ReadsEveryKindOfFile) {
  const std::string csv = drawn("data.csv");
  const std::string hdf5 = drawn("data.h5");
  const auto by = [&](const std::string& data) {
    return summary("learn " + data + " --model polynomial:1").at("training_mse").get<double>();
  };
  EXPECT_EQ(by(csv), by(hdf5));
  // Columns in another order, comments, and weights.
  std::ifstream in(csv);
  std::string line;
  std::getline(in, line);
  std::string other = "# a comment\nweight," + line + "\n";
  for (bool first = true; std::getline(in, line); first = false) other += (first ? "2, +" : " 1,") + line + "\n";
  EXPECT_LT(by(file("other.csv", other)), 1e-20);
  EXPECT_EQ(by(file("marked.csv", "\xEF\xBB\xBF" + read(csv))), by(csv));
}

TEST_F(Learn, WritesFilesAndReadsTheModel) {
  const std::string data = drawn("data.csv");
  const std::string test = drawn("test.csv", "--points 5 --duration 1 --seed 9");
  const std::string out = path("out");
  const Outcome r = run("learn " + data + " --model network:4 --iterations 5 --test " + test + " --out " + out);
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("iteration_limit"), std::string::npos);
  EXPECT_NE(r.out.find("allow more"), std::string::npos);
  for (const char* name :
       {"model.json", "history.csv", "errors.csv", "summary.json", "summary.txt", "plot.gp", "plot.svg", "plot.png"})
    EXPECT_TRUE(fs::exists(out + "/" + name)) << name;
  const auto model = nlohmann::json::parse(read(out + "/model.json"));
  EXPECT_EQ(model.at("kind"), "learned_hamiltonian");
  EXPECT_EQ(model.at("model"), "network:4");
  EXPECT_EQ(model.at("parameters").size(), 21U);
  // Read again it is the same, and training goes on from it.
  const auto before = nlohmann::json::parse(read(out + "/summary.json"));
  const auto same = summary("learn " + data + " --model " + out + "/model.json --iterations 0 --test " + test);
  for (const char* key : {"training_mse", "mass_matrix", "model"}) EXPECT_EQ(same.at(key), before.at(key)) << key;
  EXPECT_EQ(same.at("held_out").at("mse"), before.at("held_out").at("mse"));
  const auto further = summary("learn " + data + " --model " + out + "/model.json --iterations 20");
  EXPECT_LT(further.at("training_mse"), same.at("training_mse"));
  EXPECT_LE(further.at("iterations"), 20);
  // Without held-out data their file goes.
  EXPECT_EQ(run("learn " + data + " --model network:4 --iterations 5 --out " + out).code, 0);
  EXPECT_FALSE(fs::exists(out + "/errors.csv"));
}

TEST_F(Learn, GivesTheSameBits) {
  const std::string data = drawn("data.csv", "--noise 0.01");
  EXPECT_EQ(read(data), read(drawn("again.csv", "--noise 0.01")));
  const std::string command = "learn " + data + " --noise 0.01 --model network:4 --iterations 10 --out ";
  EXPECT_EQ(run(command + path("a")).code, 0);
  EXPECT_EQ(run(command + path("b")).code, 0);
  EXPECT_EQ(read(path("a/model.json")), read(path("b/model.json")));
}

TEST_F(Learn, AModelRunsAsAScene) {
  const std::string out = path("out");
  ASSERT_EQ(run("learn " + drawn("data.csv", "--chain 2") + " --model polynomial:1 --out " + out).code, 0);
  const std::string start = "[initial]\ntheta = [2.0, 2.4]\nphi = [0.1, 1.2]\n";
  const std::string time = "[time]\nstep = 0.01\nsteps = 200\nmethod = \"munthe-kaas-54\"\nform = \"momenta\"\n";
  const auto learned =
      summary("run " + file("learned.toml", "system = \"learned_hamiltonian\"\n[parameters]\nmodel = \"" + out +
                                                "/model.json\"\n" + start + time));
  const auto truth = summary("run " + file("chain.toml",
                                           "system = \"pendulum_chain\"\n[parameters]\nlinks = 2\nmasses = 1.0\n"
                                           "lengths = 1.0\ngravity = 1.0\n" +
                                               start + time));
  for (const char* key : {"position", "momentum"})
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(learned.at("final").at(key)[i].get<double>(), truth.at("final").at(key)[i].get<double>(), 1e-7);
  const Outcome r = run("run " + file("none.toml",
                                      "system = \"learned_hamiltonian\"\n[parameters]\nmodel = "
                                      "\"none.json\"\n" +
                                          start + time));
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("none.json: there is no such file"), std::string::npos) << r.err;
}

TEST_F(Learn, FindsAFrictionOnSpheres) {
  // None in the data: R is found to be zero, and the rest as without.
  const auto found = summary("learn " + drawn("data.csv") + " --model polynomial:1 --dissipation");
  EXPECT_LT(found.at("dissipation")[0][0].get<double>(), 1e-6);
  EXPECT_NEAR(found.at("mass_matrix")[0][0].get<double>(), 1, 1e-5);
}

TEST_F(Learn, AnInterruptLeavesTheBestModel) {
  const std::string data = drawn("data.csv", "--chain 2 --count 3000");
  const std::string out = path("out");
  // A busy machine may not have begun after three seconds, and a program that has not is ended.
  Outcome r;
  for (const char* after : {"3", "20", "100"}) {
    r = run("learn " + data + " --model network:12 --starts 1 --iterations 1000000 --out " + out,
            std::string("timeout --preserve-status -s INT ") + after + " ");
    if (fs::exists(out + "/summary.json")) break;
  }
  EXPECT_EQ(r.code, 4) << r.err;
  EXPECT_EQ(nlohmann::json::parse(read(out + "/summary.json")).at("status"), "interrupted");
  EXPECT_TRUE(fs::exists(out + "/model.json"));
}

TEST_F(Learn, AModelThatCannotBeFollowedIsNamed) {
  const std::string model =
      file("wild.json",
           "{\"kind\": \"learned_hamiltonian\", \"bodies\": 1, \"model\": \"polynomial:1\", \"parameters\": "
           "[0, 1e300, 1e300, 1e300]}");
  const Outcome r = run("learn " + drawn("data.csv") + " --model " + model);
  EXPECT_EQ(r.code, 3);
  EXPECT_NE(r.err.find("wild.json: the parameters to go on from have no finite error"), std::string::npos) << r.err;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
}

TEST_F(Learn, SaysWhatShareOfTheMotionIsExplained) {
  const auto motion = summary("learn " + drawn("data.csv") + " --model polynomial:1");
  EXPECT_GT(motion.at("explained").get<double>(), 0.999);
  EXPECT_FALSE(motion.contains("notes"));
  // Ends that have nothing to do with their starts: every training converges on them.
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::string rows = "trajectory,t,q1x,q1y,q1z,p1x,p1y,p1z\n";
  for (int i = 0; i < 120; ++i) {
    double q[3];
    for (double& x : q) x = normal(random);
    const double length = std::hypot(q[0], q[1], q[2]);
    rows += std::to_string(i / 2) + (i % 2 == 0 ? ",0" : ",0.1");
    for (const double x : q) rows += "," + std::to_string(x / length);
    rows += ",0,0,0\n";
  }
  const auto noise = summary("learn " + file("noise.csv", rows) + " --noise 1e-5 --validation 0 --model polynomial:1");
  EXPECT_EQ(noise.at("status"), "converged");
  EXPECT_LT(noise.at("explained").get<double>(), 0.8);
  EXPECT_NE(noise.at("notes").dump().find("of the motion in the data: they are noise"), std::string::npos) << noise;
}

TEST_F(Learn, SaysThatDataAtRestDetermineNoMass) {
  std::string rows = "trajectory,t,q1x,q1y,q1z,p1x,p1y,p1z\n";
  for (const char* n : {"1", "2", "3"}) rows += std::string(n) + ",0,0,0,-1,0,0,0\n" + n + ",0.1,0,0,-1,0,0,0\n";
  const auto found = summary("learn " + file("rest.csv", rows) + " --model polynomial:1");
  EXPECT_EQ(found.at("status"), "converged");
  EXPECT_NE(found.at("notes")[0].get<std::string>().find("do not determine the mass matrix"), std::string::npos);
}

TEST_F(Learn, AnInterruptLeavesTheMeasuresOut) {
  const std::string data = drawn("data.csv");
  const std::string test = drawn("test.csv", "--count 20000 --points 10 --duration 4");
  const std::string out = path("out");
  Outcome r;
  for (const char* after : {"1.5", "3", "6", "12", "24"}) {
    r = run("learn " + data + " --model polynomial:1 --test " + test + " --out " + out,
            std::string("timeout --preserve-status -s INT ") + after + " ");
    if (fs::exists(out + "/model.json")) break;
  }
  EXPECT_EQ(r.code, 4) << r.err;
  EXPECT_TRUE(fs::exists(out + "/model.json"));
  EXPECT_FALSE(fs::exists(out + "/errors.csv"));
  EXPECT_NE(read(out + "/summary.txt").find("nothing was measured"), std::string::npos);
}

TEST_F(Learn, BadInputIsOneLineThatNamesTheRemedy) {
  const std::string data = drawn("data.csv");
  const std::string two = drawn("two.csv", "--chain 2");
  const std::string noisy = drawn("noisy.csv", "--noise 0.01");
  const std::string header = "trajectory,t,q1x,q1y,q1z,p1x,p1y,p1z\n";
  const auto rows = [&](const char* name, const std::string& text) { return file(name, header + text); };
  const std::string good = "1,0,0,0,1,1,0,0\n1,0.1,0,0,1,1,0,0\n";
  file("broken.h5", "no HDF5");
  const auto model = [&](const char* name, const std::string& text) {
    return "learn " + data + " --model " + file(name, text);
  };
  const std::string kind = "{\"kind\": \"learned_hamiltonian\"";
  { const H5::H5File out(path("empty.h5"), H5F_ACC_TRUNC); }
  fs::create_directory(path("held"));
  file("held/trajectory.csv", "");
  std::string network = "network:10000";
  for (int layer = 0; layer < 22; ++layer) network += ",10000";
  const std::string wide = hdf5(path("wide.h5"), 2, 0);
  const std::string unknown = hdf5(path("unknown.h5"), 1, std::nan(""));
  const std::vector<std::pair<std::string, std::string>> cases{
      {"learn", "data is required"},
      {"learn nowhere.csv", "nowhere.csv: there is no such file"},
      {"learn " + file("a.txt", ""), ".csv and .h5"},
      {"learn " + file("void.csv", ""), "no header"},
      {"learn " + file("head.csv", header), "no rows"},
      {"learn " + file("columns.csv", "trajectory,t,q1x,q1y,q1z,p1x,p1y\n"), "no column p1z"},
      {"learn " + file("more.csv", "trajectory,t,q1x,q1y,q1z,p1x,p1y,p1z,mass\n"), "nobody knows the column mass"},
      {"learn " + file("uneven.csv", "trajectory,t,q1,q2,p1\n"), "no column p2"},
      {"learn " + file("gap.csv", "trajectory,t,q1,q3,p1,p3\n"), "no column q2"},
      {"learn " + file("mixed.csv", "trajectory,t,q1,p1,q1x\n"), "nobody knows the column q1x"},
      {"learn " + data + " --points 9", "fewer than a piece of 9"},
      {"learn " + file("twice.csv", "trajectory,t,t,q1x,q1y,q1z,p1x,p1y,p1z\n"), "two columns t"},
      {"learn " + rows("nan.csv", good + "2,0,0,0,nan,1,0,0\n"), "row 4 (trajectory 2, t = 0): q_1 is nan"},
      {"learn " + rows("off.csv", good + "2,0,0,0,1.1,1,0,0\n"), "row 4 (trajectory 2, t = 0): q_1 is off the unit"},
      {"learn " + rows("along.csv", good + "2,0,0,0,1,1,0,1\n"), "p_1 has a part"},
      {"learn " + rows("word.csv", good + "2,0,0,0,one,1,0,0\n"), "row 4: \"one\" is no number"},
      {"learn " + rows("ragged.csv", good + "2,0,0,0,1,1,0\n"), "row 4: 7 numbers, the header has 8"},
      {"learn " + rows("unequal.csv", good + "2,0,0,0,1,1,0,0\n"), "this trajectory has 1 points, the first one 2"},
      {"learn " + rows("one.csv", "1,0,0,0,1,1,0,0\n"), "a trajectory of one point"},
      {"learn " + rows("half.csv", "1.5,0,0,0,1,1,0,0\n"), "trajectory 1.5 is no whole number"},
      {"learn " + rows("few.csv", good), "the model has 41 parameters"},
      {"learn " + noisy, "or the size of the noise"},
      {"learn " + path("broken.h5"), "HDF5 cannot read it"},
      {"learn " + path("empty.h5"), "no data set"},
      {"learn " + data + " --test " + two, "give data of one system"},
      {"learn " + data + " --model forest:3", "polynomial:DEGREE or network:UNITS"},
      {"learn " + data + " --model network:8,", "polynomial:DEGREE or network:UNITS"},
      {"learn " + data + " --model polynomial:30", "lower the degree"},
      {"learn " + data + " --model nowhere.json", "nowhere.json: there is no such file"},
      {model("a.json", "{"), "no JSON object"},
      {model("b.json", "{\"kind\": \"scene\"}"), "kind is not"},
      {model("c.json", kind + ", \"bodies\": 0}"), "bodies is no number of bodies"},
      {model("d.json", kind + ", \"bodies\": 1, \"model\": 3}"), "model is no name"},
      {model("e.json", kind + ", \"bodies\": 1, \"model\": \"forest:1\"}"), "e.json: model \"forest:1\" is none"},
      {model("f.json", kind + ", \"bodies\": 1, \"model\": \"polynomial:1\", \"parameters\": [1, 2]}"),
       "parameters are not the 4 numbers of polynomial:1"},
      {model("g.json", kind + ", \"bodies\": 1, \"model\": \"polynomial:1\", \"parameters\": [1, 2, 3, \"x\"]}"),
       "parameters[3] is no number"},
      {model("i.json", kind + ", \"bodies\": 1, \"model\": \"polynomial:1\", \"parameters\": [1e6, 2, 3, 4]}"),
       "i.json: the mass matrix of its parameters is not finite and positive"},
      {model("j.json", kind + ", \"coordinates\": 0}"), "coordinates is no number of coordinates"},
      {model("k.json", kind + ", \"coordinates\": 1, \"dissipation\": 1}"), "dissipation is neither true nor false"},
      {model("n.json", kind + ", \"bodies\": 1, \"coordinates\": 1}"), "both bodies and coordinates"},
      {model("o.json", kind + ", \"coordinates\": 1, \"friction\": 1}"), "nobody knows its key friction"},
      {model("l.json", kind + ", \"coordinates\": 1, \"model\": \"polynomial:1\", \"parameters\": [1, 2]}"),
       "give data of its system"},
      {model("m.json", kind + ", \"bodies\": 1, \"model\": \"polynomial:1\", \"parameters\": [0, 0, 0, 1]}") +
           " --dissipation",
       "declares no dissipation"},
      {model("h.json", kind + ", \"bodies\": 2, \"model\": \"polynomial:1\", \"parameters\": [0,0,0,0,0,0,0,0,0]}"),
       "give data of its system"},
      {"learn " + data + " --integrator leapfrog", "commutator-free-4"},
      {"learn " + data + " --substeps 0", "--substeps"},
      {"learn " + data + " --validation 1", "--validation"},
      {"learn " + data + " --validation nan", "nan is not a share from 0 to 0.9"},
      {"learn " + data + " --enough nan", "nan is not a finite number"},
      {"learn " + data + " --seconds nan", "nan is not a positive number"},
      {"learn " + data + " --noise -1", "--noise: -1 is not a finite number, zero or positive"},
      {"learn " + data + " --test-noise nan", "nan is not a finite number"},
      {"learn " + data + " --seed 2147483648", "--seed"},
      {"learn " + data + " --seed -1", "--seed"},
      {"learn " + data + " --model " + network, "more than 5000 parameters"},
      {"learn " + data + " --out " + data, "is not a folder"},
      {"learn " + data + " --out " + path("held"), "it holds a run (trajectory.csv), whose files would be lost"},
      {"learn " + file("semicolons.csv", "trajectory;t;q1x;q1y;q1z;p1x;p1y;p1z\n"), "the character ; in the header"},
      {"learn " + file("quotes.csv", "\"trajectory\",\"t\"\n"), "the character \" in the header"},
      {"learn " + wide, "t has 2 columns; give it one"},
      {"learn " + unknown, "row 2 (trajectory 1, t = 0.1): q_1 is nan"},
      {"trajectories", "--out is required"},
      {"trajectories --out a.txt", ".csv and .h5"},
      {"trajectories --out " + path("a.csv") + " --masses 1,2", "one for each, or one for all"},
      {"trajectories --out " + path("a.csv") + " --masses -1", "positive"},
      {"trajectories --out " + path("a.csv") + " --duration 0", "positive time"},
      {"trajectories --out " + path("a.csv") + " --duration inf", "inf is not a finite number"},
      {"trajectories --out " + path("a.csv") + " --gravity inf", "inf is not a finite number"},
      {"trajectories --out " + path("a.csv") + " --noise nan", "nan is not a finite number"},
      {"trajectories --out " + path("a.csv") + " --seed -1", "--seed"},
      {"trajectories --out /proc/a.csv", "choose another place"}};
  for (const auto& [arguments, words] : cases) {
    const Outcome r = expect_refused(arguments, words);
    EXPECT_EQ(nlohmann::json::parse(run(arguments + " --json").out).at("message").get<std::string>() + "\n",
              r.err.substr(std::string("lagroid: ").size()));
  }
  EXPECT_FALSE(fs::exists(path("a.csv")));
}

}  // namespace
}  // namespace learn_command_spheres_tests
