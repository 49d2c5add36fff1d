// `lagroid learn` in R^n: friction, scenes of the learned H, and runs as data.
#include "learn.hpp"

#include <H5Cpp.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace learn_command_coordinates_tests {
namespace {

/// Motions of q' = p, p' = -q - 2 c p, in closed form.
std::string oscillations(double c) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double w = std::sqrt(1 - c * c);
  std::ostringstream rows;
  rows.precision(17);
  rows << "trajectory,t,q1,p1\n";
  for (int n = 0; n < 30; ++n) {
    const double q = uniform(random);
    const double p = uniform(random);
    for (int j = 0; j < 9; ++j) {
      const double t = 0.1 * j;
      rows << n << ',' << t << ',' << std::exp(-c * t) * (q * std::cos(w * t) + (p + c * q) / w * std::sin(w * t))
           << ',' << std::exp(-c * t) * (p * std::cos(w * t) - (q + c * p) / w * std::sin(w * t)) << '\n';
    }
  }
  return rows.str();
}

TEST_F(Learn, FindsAFrictionInThePlane) {
  const std::string data = file("damped.csv", oscillations(0.1));
  const std::string out = path("out");
  const std::string command = "learn " + data + " --points 5 --substeps 8 --model polynomial:2 --starts 1 ";
  const auto found = summary(command + "--dissipation --test " + data + " --out " + out);
  EXPECT_EQ(found.at("status"), "converged");
  EXPECT_EQ(found.at("coordinates"), 1);
  EXPECT_EQ(found.at("integrator"), "runge-kutta-4");
  EXPECT_EQ(found.at("data").at("trajectories"), 60);
  EXPECT_NEAR(found.at("dissipation")[0][0].get<double>(), 0.2, 1e-7);
  EXPECT_LT(found.at("held_out").at("mse").get<double>(), 1e-14);
  EXPECT_FALSE(found.contains("mass_matrix") || found.contains("bodies"));
  EXPECT_FALSE(found.at("held_out").contains("momentum_change_data"));
  const std::string text = read(out + "/summary.txt");
  EXPECT_NE(text.find("polynomial:2 on R^2, with dissipation, through runge-kutta-4"), std::string::npos) << text;
  EXPECT_NE(text.find("  R              0.2000000"), std::string::npos) << text;
  EXPECT_FALSE(fs::exists(out + "/learned.toml"));
  // Read again it is the same, damped; and without dissipation nothing moves like that.
  const auto same = summary("learn " + data + " --points 5 --substeps 8 --iterations 0 --model " + out + "/model.json");
  EXPECT_EQ(same.at("dissipation"), found.at("dissipation"));
  EXPECT_GT(summary(command).at("training_mse").get<double>(), 1e-6);
  expect_refused("learn " + drawn("spheres.csv") + " --model " + out + "/model.json", "give data of its system");
}

TEST_F(Learn, AModelInThePlaneRunsAsAFormula) {
  const std::string out = path("out");
  for (const char* model : {"polynomial:2", "network:6"}) {
    const std::string data = file("free.csv", oscillations(0));
    const auto found = summary("learn " + data + " --substeps 8 --model " + model + " --out " + out);
    const auto ran = summary("run " + out + "/learned.toml --set time.steps=80");
    const double q = found.at("training_mse").get<double>();
    EXPECT_LT(q, 1e-7);
    // A period is 2 pi: the radius stays, up to the error of the step and of the model.
    const auto norm = [&](const char* when) {
      return std::hypot(ran.at(when).at("position")[0].get<double>(), ran.at(when).at("momentum")[0].get<double>());
    };
    EXPECT_NEAR(norm("final"), norm("initial"), 2e-3) << model;
    fs::remove_all(out);
  }
  // And the run is data again.
  const std::string data = file("free.csv", oscillations(0));
  summary("learn " + data + " --substeps 8 --model polynomial:2 --out " + out);
  summary("run " + out + "/learned.toml --set time.steps=100 --out " + path("run"));
  const auto again = summary("learn " + path("run/trajectory.h5") + " --points 5 --model polynomial:2");
  EXPECT_EQ(again.at("data").at("trajectories"), 25);
  EXPECT_LT(again.at("training_mse").get<double>(), 1e-9);
  expect_refused("run " + file("learned.toml", "system = \"learned_hamiltonian\"\n[parameters]\nmodel = \"" + out +
                                                   "/model.json\"\n[initial]\ntheta = [1.0]\nphi = [0.0]\n"
                                                   "[time]\nstep = 0.01\nsteps = 2\n"),
                 "run the learned.toml");
}

/// A model of so many coordinates, with these parameters, in a file.
std::string model_of(int coordinates, const std::string& name, const std::vector<double>& parameters) {
  return nlohmann::json{
      {"kind", "learned_hamiltonian"}, {"coordinates", coordinates}, {"model", name}, {"parameters", parameters}}
      .dump();
}

TEST_F(Learn, TheSceneIsOfTheModel) {
  // Neither symmetric nor separable, in two coordinates: what is exchanged, left out or of another sign moves
  // otherwise.
  std::vector<double> quadratic;  // q1, q2, p1, p2 and their products
  for (int i = 0; i < 14; ++i) quadratic.push_back(0.1 * ((5 * i) % 14 - 6));
  std::vector<double> network;
  for (int i = 0; i < 3 * 5 + 2 * 4 + 2; ++i) network.push_back(0.2 * ((7 * i) % 11 - 5));
  const std::string q = "0.3,-0.2", p = "0.1,0.4";
  const std::string data =
      file("start.csv", "trajectory,t,q1,q2,p1,p2\n1,0," + q + "," + p + "\n1,0.1," + q + "," + p + "\n");
  const std::vector<std::pair<std::string, std::vector<double>>> models{{"polynomial:2", quadratic},
                                                                        {"network:3,2", network}};
  for (const auto& [name, parameters] : models) {
    const std::string out = path("out_" + name.substr(0, 4));
    const std::string model = file(name.substr(0, 4) + ".json", model_of(2, name, parameters));
    summary("learn " + data + " --model " + model + " --iterations 0 --out " + out);
    const auto ran = summary("run " + out + "/learned.toml --set time.step=0.002 --set time.steps=500");
    // Its own motion until t = 1 is data that the model follows without any error but the integrators'.
    std::ostringstream rows;
    rows.precision(17);
    rows << "trajectory,t,q1,q2,p1,p2\n1,0," << q << ',' << p << "\n1,1";
    double moved = 0;
    for (const char* key : {"position", "momentum"})
      for (std::size_t i = 0; i < 2; ++i) {
        const double x = ran.at("final").at(key)[i].get<double>();
        moved += std::abs(x - ran.at("initial").at(key)[i].get<double>());
        rows << ',' << x;
      }
    EXPECT_GT(moved, 0.1) << name;
    const auto same =
        summary("learn " + file("ran.csv", rows.str() + "\n") + " --model " + model + " --iterations 0 --substeps 200");
    EXPECT_LT(same.at("training_mse").get<double>(), 1e-12) << name;
  }
}

TEST_F(Learn, AFormulaIsLeftAsASceneWhereScenesTakeIt) {
  const std::string data = file("free.csv", oscillations(0));
  // 120 units "(1)*tanh((1)*q1 + (1)*p1 + (1))", eight numbers 1.5 and what joins all have 4093 characters, and scenes
  // allow 4096.
  const auto left = [&](double last) {
    std::vector<double> ones(4 * 120, 1.0);
    std::fill_n(ones.begin(), 8, 1.5);
    ones.back() = last;
    const std::string out = path("out_" + std::to_string(last));
    const auto found = summary("learn " + data + " --model " + file("ones.json", model_of(1, "network:120", ones)) +
                               " --iterations 0 --out " + out);
    EXPECT_EQ(fs::exists(out + "/learned.toml"),
              !found.contains("notes") || found.at("notes").dump().find("no learned.toml") == std::string::npos);
    return out;
  };
  const std::string fits = left(1.25);
  const std::string long_text = left(1.125);
  EXPECT_EQ(run("run " + fits + "/learned.toml --set time.steps=1").code, 0);
  EXPECT_FALSE(fs::exists(long_text + "/learned.toml"));
  EXPECT_NE(read(long_text + "/summary.txt").find("no learned.toml: H as a formula has more than the 4096"),
            std::string::npos);
}

TEST_F(Learn, ADampedModelHasAFolderOfItsOwn) {
  const std::string data = file("damped.csv", oscillations(0.1));
  const std::string out = path("out");
  const std::string command = "learn " + data + " --starts 1 --iterations 5 --out " + out + " --model ";
  ASSERT_EQ(run(command + "polynomial:2 --dissipation").code, 0);
  EXPECT_NE(read(out + "/summary.txt").find("no learned.toml: scenes of formulas have no friction"), std::string::npos);
  // One can go on in it, whether or not the flag says again what the model is.
  EXPECT_EQ(run(command + out + "/model.json").code, 0);
  EXPECT_EQ(run(command + out + "/model.json --dissipation").code, 0);
  const std::string damped = read(out + "/model.json");
  EXPECT_NE(run(command + "polynomial:2").code, 0);
  const std::string free = file("free.json", model_of(1, "polynomial:2", {0, 0, 0.5, 0, 0.5}));
  EXPECT_NE(run(command + free).code, 0);
  EXPECT_EQ(read(out + "/model.json"), damped);
}

TEST_F(Learn, APathCannotAddToTheScene) {
  const std::string data = file("line\nbroken = 1", oscillations(0));
  fs::rename(data, data + ".csv");
  const std::string out = path("out");
  ASSERT_EQ(run("learn '" + data + ".csv' --model polynomial:2 --starts 1 --iterations 3 --out " + out).code, 0);
  EXPECT_NE(read(out + "/learned.toml").find("line\\u000abroken = 1.csv"), std::string::npos);
  EXPECT_EQ(run("run " + out + "/learned.toml --set time.steps=1").code, 0);
}

TEST_F(Learn, SaysWhatIsLeftOutOfPieces) {
  const std::string data = file("free.csv", oscillations(0));  // 30 trajectories of 9 points
  const std::string command = "learn " + data + " --model polynomial:2 --starts 1 --iterations 1 --points ";
  const auto notes = [&](const char* points) {
    return summary(command + points).value("notes", nlohmann::json()).dump();
  };
  EXPECT_EQ(notes("5").find("left out"), std::string::npos);
  EXPECT_NE(notes("4").find("60 points at the ends of trajectories are left out"), std::string::npos);
}

TEST_F(Learn, OneCurveDoesNotDetermineAFriction) {
  std::istringstream all(oscillations(0.1));
  std::string line, one;
  for (int i = 0; i < 10 && std::getline(all, line); ++i) one += line + "\n";
  const std::string out = path("out");
  summary("learn " + file("one.csv", one) +
          " --points 3 --model polynomial:3 --dissipation --iterations 20 --starts 1 " + "--out " + out);
  EXPECT_NE(read(out + "/summary.txt").find("the data do not determine the friction"), std::string::npos);
}

TEST_F(Learn, SaysWhichRunsItLearnsFrom) {
  const auto scene = [&](const std::string& name, const std::string& text) {
    const std::string out = path(name);
    EXPECT_EQ(run("run " + file(name + ".toml", text) + " --out " + out).code, 0) << name;
    return out;
  };
  const std::string free =
      "system = \"hamiltonian\"\n[hamiltonian]\ncoordinates = [\"x\", \"y\"]\nH = \"p_x^2/2 + p_y^2/2 + y\"\n";
  const std::string start = "[initial]\nposition = [0.0, -1.0]\nmomentum = [0.5, 0.0]\n";
  const std::string time = "[time]\nstep = 0.01\nsteps = 20\n";
  const std::string plain = scene("plain", free + start + time);
  summary("learn " + plain + "/trajectory.h5 --points 3 --model polynomial:1");
  expect_refused("learn " + plain, "a run's folder; give " + plain + "/trajectory.h5");
  expect_refused("learn " + plain + "/trajectory.csv", "the table of a run is not read; give " + plain);
  const std::string tied = scene("tied", free + "constraints = [\"x^2 + y^2 - 1\"]\n" + start + time);
  expect_refused("learn " + tied + "/trajectory.h5", "learn from runs in R^n without constraints");
  const std::string chain = scene("chain",
                                  "system = \"pendulum_chain\"\n[parameters]\nlinks = 1\nmasses = 1.0\n"
                                  "lengths = 1.0\ngravity = 1.0\n[initial]\ntheta = [2.0]\nphi = [0.1]\n" +
                                      time);
  expect_refused("learn " + chain + "/trajectory.h5", "cannot be learned from; give a run in R^n");
  {
    const H5::H5File out(path("adaptive.h5"), H5F_ACC_TRUNC);
    const auto add = [&](const char* set, std::vector<double> numbers) {
      const hsize_t size[2] = {numbers.size(), 1};
      out.createDataSet(set, H5::PredType::NATIVE_DOUBLE, H5::DataSpace(2, size))
          .write(numbers.data(), H5::PredType::NATIVE_DOUBLE);
    };
    add("time", {0, 0.1, 0.3});
    add("position", {0, 0.1, 0.3});
    add("momentum", {1, 1, 1});
  }
  expect_refused("learn " + path("adaptive.h5"), "the steps of the run differ");
}

}  // namespace
}  // namespace learn_command_coordinates_tests
