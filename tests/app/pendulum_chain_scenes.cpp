// Scenes of pendulum chains from the command line: the motion is that of the reference by every method, what is broken
// off goes on with the same bits, what is wrong is said.

#include "command_line.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace app_pendulum_chain_scenes_tests {
namespace {

using Json = nlohmann::json;

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Chains with their states at the end, computed elsewhere in float128.
Json reference(const std::string& id) {
  const Json all = Json::parse(contents(std::string(LAGROID_TEST_DATA) + "/pendulum-chains.json"));
  for (const Json& one : all.at("cases"))
    if (one.at("id") == id) return one;
  throw std::out_of_range(id);
}

std::vector<double> flat(const Json& rows) {
  std::vector<double> out;
  for (const Json& row : rows)
    for (const Json& x : row) out.push_back(x);
  return out;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) square += (a.at(i) - b.at(i)) * (a.at(i) - b.at(i));
  return std::sqrt(square);
}

class PendulumChains : public CommandLine {
 protected:
  /// The chain of a reference, by `time`.
  static std::string scene_of(const Json& chain, const std::string& time) {
    return "system = \"pendulum_chain\"\n[parameters]\nmasses = " + chain.at("masses").dump() +
           "\nlengths = " + chain.at("lengths").dump() + "\ngravity = " + chain.at("g").dump() +
           "\n[initial]\ntheta = " + chain.at("theta").dump() + "\nphi = " + chain.at("phi").dump() +
           "\nangular_velocities = " + chain.at("a").dump() +
           "\nproject_velocities = true\n[time]\nduration = " + chain.at("T").dump() + "\n" + time;
  }
  Json run_json(const std::string& arguments) const {
    const Outcome r = run("run " + arguments + " --json");
    EXPECT_EQ(r.code, 0) << arguments << r.err;
    return Json::parse(r.out);
  }
  static Json entry(const Json& result, const std::string& name) {
    for (const Json& e : result.at("ledger").at("entries"))
      if (e.at("name") == name) return e;
    throw std::out_of_range(name);
  }
};

TEST_F(PendulumChains, EndWhereTheReferenceDoes) {
  for (const char* id :
       {"pub_k1_generic", "pub_k2_equal", "pub_k3_mixed", "pub_k10", "hard_k2_mass1e6_lighttip", "hard_k20_drop"}) {
    const Json chain = reference(id);
    for (const char* form : {"velocities", "momenta"}) {
      const Json result =
          run_json(write(scene_of(chain, "steps = 10\nmethod = \"munthe-kaas-54\"\ntolerance = 1e-14\n")).string() +
                   " --set time.form=" + form);
      const std::vector<double> q = result.at("final").at("position");
      const std::vector<double> p = result.at("final").at("momentum");
      const auto momenta = flat(chain.at("pT"));
      EXPECT_LT(distance(q, flat(chain.at("qT"))), 1e-10) << id << ' ' << form;
      EXPECT_LT(distance(p, momenta) / distance(momenta, std::vector<double>(momenta.size(), 0.0)), 1e-10) << id;
      EXPECT_NEAR(entry(result, "energy").at("initial").at(0), chain.at("E0"),
                  1e-13 * (1 + std::abs(double(chain.at("E0")))));
      EXPECT_NEAR(entry(result, "vertical angular momentum").at("initial").at(0), chain.at("Jz0"), 1e-14 * 10);
      EXPECT_EQ(entry(result, "constraint residual").at("verdict"), "kept") << id;
    }
  }
}

/// The state at the end is one to begin with.
TEST_F(PendulumChains, StartFromDirectionsAndMomenta) {
  const Json chain = reference("pub_k3_mixed");
  const std::string method = "method = \"munthe-kaas-54\"\ntolerance = 1e-13\n";
  const Json whole = run_json(write(scene_of(chain, "steps = 20\n" + method)).string());
  const Json half = run_json("'" + write(scene_of(chain, "steps = 20\n" + method)).string() +
                             "' --set time.steps=20 --set time.duration=1");
  const auto rows = [](const Json& values) {
    std::string out = "[";
    for (std::size_t i = 0; i < values.size(); ++i)
      out += (i % 3 == 0 ? "[" : "") + values[i].dump() + (i % 3 == 2 ? "]," : ",");
    return out + "]";
  };
  for (const char* form : {"velocities", "momenta"}) {
    const Json rest =
        run_json(write("system = \"pendulum_chain\"\n[parameters]\nmasses = [1, 0.5, 2]\nlengths = [1, "
                       "0.7, 0.4]\n[initial]\ndirections = " +
                       rows(half.at("final").at("position")) + "\nmomenta = " + rows(half.at("final").at("momentum")) +
                       "\n[time]\nduration = 1\nsteps = 20\n" + method + "form = \"" + form + "\"\n")
                     .string());
    EXPECT_LT(distance(rest.at("final").at("position"), whole.at("final").at("position")), 1e-9) << form;
  }
}

/// A scene of bodies whose joints are rods has the same discrete Lagrangian: rattle's places, to round-off.
TEST_F(PendulumChains, AreBodiesOnRods) {
  const Json chain = reference("pub_k3_mixed");
  const fs::path out = folder_ / "chain";
  run_json(write(scene_of(chain, "steps = 400\n")).string() + " --out " + out.string());
  std::istringstream csv(contents(out / "trajectory.csv"));
  std::string header, first, row, last;
  std::getline(csv, header);
  std::getline(csv, first);
  while (std::getline(csv, row)) last = row;
  const auto read = [&](const std::string& line) {
    std::map<std::string, double> at;
    std::istringstream names(header), numbers(line);
    for (std::string name, number; std::getline(names, name, ',') && std::getline(numbers, number, ',');)
      at[name] = std::stod(number);
    return at;
  };
  auto start = read(first);
  auto end = read(last);
  std::ostringstream bodies;
  bodies.precision(17);
  double velocity[3] = {0, 0, 0};
  for (int i = 1; i <= 3; ++i) {
    const std::string k = std::to_string(i);
    const auto of = [&](const char* what, const char* axis) { return start.at(what + k + axis); };
    const double l = chain.at("lengths").at(std::size_t(i - 1));
    velocity[0] += l * (of("w", "y") * of("q", "z") - of("w", "z") * of("q", "y"));
    velocity[1] += l * (of("w", "z") * of("q", "x") - of("w", "x") * of("q", "z"));
    velocity[2] += l * (of("w", "x") * of("q", "y") - of("w", "y") * of("q", "x"));
    bodies << "[[body]]\nkind = \"point\"\nname = \"b" << k
           << "\"\nmass = " << chain.at("masses").at(std::size_t(i - 1)) << "\nposition = [" << start.at("x" + k)
           << ", " << start.at("y" + k) << ", " << start.at("z" + k) << "]\nvelocity = [" << velocity[0] << ", "
           << velocity[1] << ", " << velocity[2] << "]\n[[joint]]\n"
           << "kind = \"rod\"\nbetween = [\"" << (i == 1 ? "ground" : "b" + std::to_string(i - 1)) << "\", \"b" << k
           << "\"]\n";
  }
  bodies << "[[effect]]\nkind = \"gravity\"\nacceleration = [0, 0, -9.81]\n[time]\nduration = 2\nsteps = 400\n";
  const std::vector<double> places = run_json(write(bodies.str()).string()).at("final").at("position");
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_NEAR(places.at(i), end.at(std::string(1, "xyz"[i % 3]) + std::to_string(i / 3 + 1)), 1e-10) << i;
}

TEST_F(PendulumChains, GoOnWithTheSameBits) {
  for (const std::string settings :
       {"", " --set time.form=momenta", " --set time.method=munthe-kaas-54",
        " --set time.method=munthe-kaas-54 --set time.form=momenta --set time.tolerance=1e-9",
        " --set time.method=commutator-free-4", " --set time.method=runge-kutta-4 --set time.form=momenta"}) {
    const fs::path whole = folder_ / "whole";
    const fs::path parts = folder_ / "parts";
    for (const fs::path& folder : {whole, parts}) fs::remove_all(folder);
    const std::string scene =
        "run " + example("pendulum_chain") + settings + " --set output.every=7 --set output.checkpoint=50 ";
    ASSERT_EQ(run(scene + "--set time.steps=300 --out " + whole.string()).code, 0) << settings;
    ASSERT_EQ(run(scene + "--set time.steps=83 --out " + parts.string()).code, 0) << settings;
    ASSERT_EQ(run("resume " + parts.string() + " --set time.steps=150").code, 0) << settings;
    const Outcome on = run("resume " + parts.string() + " --set time.steps=300 --json");
    ASSERT_EQ(on.code, 0) << settings << on.err;
    EXPECT_TRUE(contents(whole / "trajectory.csv") == contents(parts / "trajectory.csv")) << settings;
    EXPECT_TRUE(contents(whole / "trajectory.h5") == contents(parts / "trajectory.h5")) << settings;
    auto a = Json::parse(contents(whole / "summary.json"));
    auto b = Json::parse(on.out);
    a.erase("seconds");
    b.erase("seconds");
    EXPECT_EQ(a, b) << settings;
  }
}

TEST_F(PendulumChains, WhatIsWrongIsSaidInOneLine) {
  const std::string two = "[parameters]\nmasses = [1, 2]\nlengths = 1\n";
  const std::string hanging = "[initial]\ntheta = [1, 2]\n";
  const std::string grid = "[time]\nstep = 0.01\nsteps = 10\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"[initial]\ntheta = 1\n" + grid, "missing key \"parameters\""},
      {"[parameters]\nmasses = 1\nlengths = 1\n" + hanging + grid, "parameters: missing key \"links\""},
      {"[parameters]\nmasses = [1, 2]\nlengths = [1, 2, 3]\n" + hanging + grid,
       "parameters.lengths: are 3, and the chain has 2 links"},
      {"[parameters]\nlinks = 3\nmasses = [1, 2]\nlengths = 1\n" + hanging + grid,
       "parameters.masses: are 2, and the chain has 3 links"},
      {"[parameters]\nlinks = 0\nmasses = 1\nlengths = 1\n" + hanging + grid, "parameters.links: must be from 1"},
      {"[parameters]\nmasses = [1, 0]\nlengths = 1\n" + hanging + grid,
       "parameters.masses: must be positive, from 1e-300 to 1e300, got 0"},
      {"[parameters]\nmasses = [1, nan]\nlengths = 1\n" + hanging + grid, "parameters.masses: must be finite"},
      {"[parameters]\nmasses = [1, 2]\nlengths = -1\n" + hanging + grid, "parameters.lengths: must be positive"},
      {"[parameters]\nmasses = \"heavy\"\nlengths = 1\n" + hanging + grid, "parameters.masses: expected"},
      {"[parameters]\nmass = [1, 2]\nlengths = 1\n" + hanging + grid, "parameters.mass: unknown key; did you mean"},
      {two + "colour = 3\n" + hanging + grid, "parameters.colour: unknown key"},
      {two + grid, "missing key \"initial\""},
      {two + "[initial]\n" + grid, "give directions"},
      {two + "[initial]\nphi = [1, 2]\n" + grid, "initial.phi: goes with theta"},
      {two + hanging + "directions = [0, 0, 1]\n" + grid, "leave one of them out"},
      {two + "[initial]\ntheta = [1, 2, 3]\n" + grid, "initial.theta: expected 2 numbers"},
      {two + "[initial]\ndirections = [[0, 0, 1]]\n" + grid, "initial.directions: expected 2 arrays of 3 numbers"},
      {two + "[initial]\ndirections = [[0, 0, 1], [0, 0]]\n" + grid, "initial.directions: expected 2 arrays of 3"},
      {two + "[initial]\ndirections = [[0, 0, 1], [3, 0, 4]]\n" + grid,
       "initial.directions: that of link 2 has length 5, not 1; write [0.6, 0, 0.8]"},
      {two + "[initial]\ndirections = [[0, 0, 1], [0, 0, 0]]\n" + grid, "that of link 2 is zero"},
      {two + "[initial]\ndirections = [[0, 0, 1], [0, 0, inf]]\n" + grid, "initial.directions: must be finite"},
      {two + "[initial]\ndirections = [0, 0, 1]\nangular_velocities = [[1, 0, 0], [1, 0, 0.5]]\n" + grid,
       "initial.angular_velocities: that of link 2 has a part 0.5 along its rod"},
      {two + "[initial]\ndirections = [0, 0, 1]\nmomenta = [0, 0, 1]\n" + grid, "initial.project_velocities = true"},
      {two + "[initial]\ndirections = [0, 0, 1]\nmomenta = [1, 0, 0]\nangular_velocities = [1, 0, 0]\n" + grid,
       "initial.momenta: stand there beside angular_velocities"},
      {two + "[initial]\ndirections = [0, 0, 1]\nangular_velocities = [1e200, 0, 0]\n" + grid,
       "energy or momentum at the start is no finite number"},
      {two + hanging + "velocities = 3\n" + grid, "initial.velocities: unknown key"},
      {two + hanging, "[time]"},
      {two + hanging + grid + "method = \"ratle\"\n", "did you mean \"rattle\"?"},
      {two + hanging + grid + "form = \"positions\"\n", "time.form: \"positions\" is none of velocities, momenta"},
      {two + hanging + grid + "tolerance = 1e-6\n", "time.tolerance: goes with a method that estimates its error"},
      {two + hanging + grid + "method = \"extrapolation\"\n", "time.method: takes its order and its steps"},
      {two + hanging + grid + "method = \"munthe-kaas-54\"\ntolerance = 0\n", "time.tolerance: must be between"},
      {two + hanging + grid + "mode = \"adaptive\"\n", "time.mode: unknown key"},
      {two + hanging + grid + "accuracy = 1e-3\n", "time.accuracy"},
      {two + hanging + grid + "[solver]\ntolerance = 1e-3\n", "solver: unknown key"},
      {two + "[boundary]\n" + grid, "missing key \"initial\""},
  };
  for (const auto& [text, words] : cases) expect_scene_refused("system = \"pendulum_chain\"\n" + text, words);
}

/// Steps that cannot be made end the run with what was computed, and say what to do.
TEST_F(PendulumChains, StepsThatFailAreNamed) {
  const fs::path out = folder_ / "out";
  const auto fails = [&](const std::string& settings, double step, const std::string& status, const char* words) {
    fs::remove_all(out);
    const Outcome r = run("run " + example("pendulum_chain") + settings + " --set time.step=" + std::to_string(step) +
                          " --json --out " + out.string());
    EXPECT_EQ(r.code, 3) << settings;
    EXPECT_NE(r.err.find(words), std::string::npos) << r.err;
    const Json result = Json::parse(r.out);
    EXPECT_EQ(result.at("status"), status);
    EXPECT_EQ(result.at("final").at("time"), double(result.at("steps")) * step);
    EXPECT_TRUE(fs::exists(out / "trajectory.csv"));
  };
  fails("", 0.5, "left_domain", "use a smaller time.step");
  fails(" --set time.method=euler", 0.25, "not_finite", "use a smaller");
  fails(" --set time.method=munthe-kaas-54 --set time.tolerance=1e-9", 1e9, "not_converged",
        "inner steps did not reach the next node");
}

TEST_F(PendulumChains, RattleKeepsWhatItPromises) {
  const auto kept = [&](const std::string& start) {
    const Json result = run_json(example("pendulum_chain") + " --set time.steps=200000" + start);
    EXPECT_EQ(entry(result, "constraint residual").at("verdict"), "kept");
    EXPECT_EQ(entry(result, "vertical angular momentum").at("verdict"), "kept");
    return entry(result, "energy");
  };
  const auto bounded = [&](const Json& energy, double most) {
    EXPECT_EQ(energy.at("verdict"), "bounded");
    EXPECT_LT(energy.at("drift"), most);
  };
  bounded(kept(""), 0.15);
  bounded(kept(" --set initial.theta=[2.9,2.8,2.9] --set "
               "initial.angular_velocities=[[0.1,0.2,0.1],[0.1,-0.2,0.1],[0,0.2,-0.1]]"),
          1e-3);
}

/// In any unit of mass a chain is judged alike, and where masses leave no digits to energy and momentum that is said.
TEST_F(PendulumChains, MassesInEveryUnitAreJudgedAlike) {
  for (const std::string mass : {"1", "1e300", "1e200", "1e-160", "1e-280", "1e-300"}) {
    const Json result = run_json(example("pendulum_chain") + " --set parameters.masses=" + mass);
    const bool small = mass == "1e-300";
    EXPECT_EQ(entry(result, "constraint residual").at("verdict"), "kept") << mass;
    EXPECT_EQ(entry(result, "vertical angular momentum").at("verdict"), small ? "unjudged" : "kept") << mass;
    EXPECT_EQ(entry(result, "energy").at("verdict"), small ? "unjudged" : "bounded") << mass;
    EXPECT_EQ(entry(result, "energy").contains("reason"), small) << mass;
    EXPECT_LT(entry(result, "energy").at("relative_drift").get<double>(), 1e-2) << mass;
  }
}

TEST_F(PendulumChains, OthersPromiseTheSpheresOrNothing) {
  const auto ledger = [&](const std::string& method) {
    return run_json(example("pendulum_chain") + " --set time.steps=2000 --set time.method=" + method);
  };
  const Json lie = ledger("commutator-free-4");
  EXPECT_EQ(entry(lie, "constraint residual").at("verdict"), "kept");
  EXPECT_EQ(entry(lie, "energy").at("promise"), "none");
  EXPECT_EQ(entry(lie, "energy").at("verdict"), "watched");
  EXPECT_GT(entry(lie, "energy").at("drift"), 1e-7);
  const Json classical = ledger("runge-kutta-4");
  EXPECT_EQ(entry(classical, "constraint residual").at("promise"), "none");
  EXPECT_GT(entry(classical, "constraint residual").at("drift"), 1e-9) << "it leaves the spheres";
}

TEST_F(PendulumChains, AreSeenAsRodsAndBobs) {
  const fs::path out = folder_ / "out";
  const Json result = run_json(example("pendulum_chain") + " --set time.steps=50 --out " + out.string());
  EXPECT_EQ(result.at("picture").at("shapes").size(), 6U);
  const std::string csv = contents(out / "trajectory.csv");
  const std::string header = "," + csv.substr(0, csv.find('\n')) + ",";
  for (const Json& shape : result.at("picture").at("shapes"))
    for (const char* ends : {"position", "to"})
      for (const Json& column : shape.at(ends)) {
        if (!column.is_string()) continue;
        EXPECT_NE(header.find("," + column.get<std::string>() + ","), std::string::npos) << column;
      }
  for (const Json& panel : result.at("picture").at("panels"))
    for (const Json& curve : panel.at("curves"))
      EXPECT_NE(header.find("," + curve.get<std::string>() + ","), std::string::npos) << curve;
  EXPECT_EQ(run("view " + out.string()).code, 0);
  EXPECT_TRUE(fs::exists(out / "view.html"));
}

TEST_F(PendulumChains, AScenesTargetIsReached) {
  const Json chain = reference("pub_k3_mixed");
  const Json result = run_json(write(scene_of(chain, "[accuracy]\ntarget = 1e-6\npilot = 4\n")).string());
  const auto q = flat(chain.at("qT"));
  EXPECT_LT(distance(result.at("final").at("position"), q) / std::sqrt(3.0), 1e-6);
  const Outcome both = run("run " + write(scene_of(chain, "form = \"momenta\"\n[accuracy]\ntarget = 1e-6\n")).string());
  EXPECT_EQ(both.code, 2);
  EXPECT_NE(both.err.find("time.form"), std::string::npos) << both.err;
}

}  // namespace
}  // namespace app_pendulum_chain_scenes_tests
