// Scenes of bodies from the command line: what is wrong is said, what is broken off goes on with the same bits.

#include "command_line.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <random>
#include <sstream>
#include <vector>

namespace {

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Scenes : public CommandLine {};

const std::string bob = "[[body]]\nkind = \"point\"\nname = \"bob\"\nmass = 1\nposition = [0, 0, -1]\n";
const std::string brick =
    "[[body]]\nkind = \"rigid\"\nname = \"brick\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [1, 0, 0]\n";
const std::string card = "[[body]]\nkind = \"planar\"\nname = \"card\"\nmass = 1\ninertia = 1\nposition = [1, 0]\n";
const std::string grid = "[time]\nstep = 0.01\nsteps = 10\n";

TEST_F(Scenes, EveryKindOfBodyJointAndEffectRuns) {
  const fs::path file = write(
      bob + brick + card +
      "[[body]]\nkind = \"pivoted\"\nname = \"top\"\nmass = 1\ninertia = [1, 1, 0.5]\ncentre = [0, 0, 0.3]\n"
      "[[body]]\nkind = \"chain\"\nname = \"chain\"\nlinks = 3\nmass = 1\nlength = 1\non = \"brick\"\nat = [0.1, 0, "
      "0]\n"
      "[[body]]\nkind = \"rigid\"\nname = \"lid\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [1, 1, 0]\n"
      "[[body]]\nkind = \"rigid\"\nname = \"drawer\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [1, 2, 0]\n"
      "[[body]]\nkind = \"rigid\"\nname = \"knob\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [1, 3, 0]\n"
      "[[body]]\nkind = \"planar\"\nname = \"sled\"\nmass = 1\ninertia = 1\nposition = [4, 0]\nvelocity = [0.3, 0]\n"
      "[[joint]]\nkind = \"blade\"\nbody = \"sled\"\nahead = 0.2\n"
      "[[joint]]\nkind = \"rod\"\nbetween = [\"ground\", \"bob\"]\nground_amplitude = [0.1, 0, 0]\nground_rate = 2\n"
      "[[joint]]\nkind = \"ball\"\nbetween = [\"ground\", \"card\"]\npoints = [[0, 0, 0], [-1, 0, 0]]\n"
      "[[joint]]\nkind = \"hinge\"\nbetween = [\"brick\", \"lid\"]\npoints = [[0, 0.5, 0], [0, -0.5, 0]]\naxis = [1, "
      "0, 0]\ndamping = 0.1\n"
      "[[joint]]\nkind = \"slider\"\nbetween = [\"lid\", \"drawer\"]\naxis = [0, 1, 0]\ndamping = 0.1\n"
      "[[joint]]\nkind = \"weld\"\nbetween = [\"drawer\", \"knob\"]\npoints = [[0, 0.5, 0], [0, -0.5, 0]]\n"
      "[[joint]]\nkind = \"plane\"\nbetween = [\"ground\", \"brick\"]\nnormal = [1, 0, 0]\npoints = [[1, 0, 0], [0, 0, "
      "0]]\n"
      "[[effect]]\nkind = \"gravity\"\n"
      "[[effect]]\nkind = \"central_gravity\"\nstrength = 0.1\ncentre = [0, 0, 9]\n"
      "[[effect]]\nkind = \"mutual_gravity\"\nconstant = 0.1\nbodies = [\"bob\", \"brick\"]\n"
      "[[effect]]\nkind = \"charges\"\nconstant = 0.1\nbodies = [\"bob\", \"brick\"]\ncharges = [1, -1]\n"
      "[[effect]]\nkind = \"spring\"\nbetween = [\"bob\", \"brick\"]\nstiffness = 3\n"
      "[[effect]]\nkind = \"torsion_spring\"\nbetween = [\"ground\", \"top\"]\ndirection = [0, 1, 0]\nstiffness = 3\n"
      "[[effect]]\nkind = \"drag\"\nmotion = 0.1\nturning = 0.1\n"
      "[[effect]]\nkind = \"damper\"\nbetween = [\"sled\", \"brick\"]\ndamping = 0.1\n"
      "[[effect]]\nkind = \"control_cost\"\n"
      "[[effect]]\nkind = \"force\"\nbody = \"brick\"\nat = [0, 0.1, 0]\nforce = [0, 0.1, 0]\nrate = 2\n"
      "[[effect]]\nkind = \"torque\"\nbody = \"top\"\ntorque = [0, 0, 0.1]\n"
      "[[effect]]\nkind = \"motor\"\nbetween = [\"brick\", \"lid\"]\ntorque = [0.1, 0, 0]\nrate = 3\n" +
      grid);
  const fs::path out = folder_ / "out";
  const Outcome r = run("run " + file.string() + " --json --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  const auto summary = nlohmann::json::parse(r.out);
  EXPECT_EQ(summary.at("ledger").at("entries").at(0).at("verdict"), "kept") << "constraints";
  EXPECT_EQ(run("view " + out.string()).code, 0);
}

TEST_F(Scenes, BallsRollAndChargesTurn) {
  const fs::path file =
      write(bob +
            "[[body]]\nkind = \"rigid\"\nname = \"ball\"\nmass = 1\ninertia = [0.4, 0.4, 0.4]\nposition = [0, 1, 1]\n"
            "velocity = [1, 0, 0]\nangular_velocity = [0, 1, 0]\n"
            "[[joint]]\nkind = \"rolling\"\nbody = \"ball\"\nradius = 1\n"
            "[[joint]]\nkind = \"spin\"\nbody = \"ball\"\naxis = [0, 0, 1]\n"
            "[[effect]]\nkind = \"magnetic_field\"\nfield = [0, 0, 1]\nbodies = [\"bob\"]\ncharges = [2]\n"
            "[[effect]]\nkind = \"rotating_frame\"\nrate = [0, 0, 1]\nbodies = [\"bob\"]\n" +
            grid);
  const Outcome r = run("run " + file.string() + " --json");
  ASSERT_EQ(r.code, 0) << r.err;
  const Outcome slips = run("run " + file.string() + " --set body.1.angular_velocity=[0,0.9,0]");
  EXPECT_EQ(slips.code, 2);
  EXPECT_NE(slips.err.find("give it angular_velocity = [0, 1, 0]"), std::string::npos) << slips.err;
  const Outcome brought =
      run("run " + file.string() + " --set body.1.angular_velocity=[0,0.9,0] --set project_velocities=true --json");
  EXPECT_EQ(brought.code, 0) << brought.err;
  const auto momentum = nlohmann::json::parse(brought.out).at("final").at("momentum");
  EXPECT_NEAR(momentum.at(3).get<double>(), momentum.at(7).get<double>() / 0.4, 1e-12) << "it rolls";
  const Outcome turns = run("run " + file.string() + " --set body.1.angular_velocity=[0,1,1]");
  EXPECT_EQ(turns.code, 2);
  const Outcome body = run("run " + file.string() + " --set effect.0.bodies=[\\\"ball\\\"]");
  EXPECT_EQ(body.code, 2);
  EXPECT_NE(body.err.find("point mass"), std::string::npos) << body.err;
}

/// The page on scenes has a row for every kind that is read.
TEST_F(Scenes, EveryKindIsDocumented) {
  const std::string page = contents(fs::path(LAGROID_EXAMPLES).parent_path() / "docs" / "scenes.md");
  int kinds = 0;
  for (const std::string table : {"body", "joint", "effect"}) {
    const fs::path file = write(bob + "[[" + table + "]]\nkind = \"?\"\n" + grid);
    const std::string said = run("run " + file.string()).err;
    const std::string words = "is none of ";
    std::istringstream names(said.substr(said.find(words) + words.size()));
    for (std::string name; names >> name; ++kinds) {
      if (name.ends_with(',')) name.pop_back();
      EXPECT_NE(page.find("| `" + name + "`"), std::string::npos) << table << " " << name;
    }
  }
  EXPECT_GE(kinds, 27);
}

TEST_F(Scenes, WhatIsWrongIsSaidInOneLine) {
  const std::string rod = "[[joint]]\nkind = \"rod\"\nbetween = [\"ground\", \"bob\"]\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {grid, "system"},
      {bob, "[time]"},
      {bob + bob + grid, "name: there is a body \"bob\" already"},
      {bob + "colour = 3\n" + grid, "body.0.colour: unknown key"},
      {bob + "mas = 3\n" + grid, "body.0.mas: unknown key; did you mean \"mass\"?"},
      {"[body]\nkind = \"point\"\n" + grid, "[[body]]"},
      {"body = 3\n" + grid, "[[body]]"},
      {"body = []\n" + grid, "no body"},
      {bob + "velocity = [1, nan, 0]\n" + grid, "body.0.velocity: must be finite"},
      {bob + "velocity = [1, 0]\n" + grid, "body.0.velocity: expected 3 numbers"},
      {bob + rod + "length = 2\n" + grid, "joint.0.length: is 2 m, but its ends are 1 m apart"},
      {bob + rod + "points = [[0, 0, 0], [0, 0, 1]]\n" + grid, "joint.0.points: \"bob\" is a point mass"},
      {bob + "velocity = [0, 0, 1]\n" + rod + grid, "project_velocities"},
      {bob + "[[joint]]\nkind = \"rod\"\nbetween = [\"ground\", \"rob\"]\n" + grid, "there is no body \"rob\""},
      {bob + "[[joint]]\nkind = \"rod\"\nbetween = [\"bob\", \"bob\"]\n" + grid, "tied to itself"},
      {bob + "[[joint]]\nkind = \"rod\"\n" + grid, "between"},
      {bob + "[[joint]]\nkind = \"ball\"\nbetween = [\"ground\", \"bob\"]\n" + grid, "apart at the start"},
      {bob + "[[joint]]\nkind = \"hinge\"\naxis = [1, 0, 0]\nbetween = [\"ground\", \"bob\"]\n" + grid, "point mass"},
      {card + "[[joint]]\nkind = \"hinge\"\naxis = [1, 0, 0]\nbetween = [\"ground\", \"card\"]\n" + grid, "\"ball\""},
      {brick +
           "[[joint]]\nkind = \"hinge\"\naxis = [0, 0, 0]\nbetween = [\"ground\", \"brick\"]\npoints = [[1, 0, 0], [0, "
           "0, 0]]\n" +
           grid,
       "axis: must not vanish"},
      {bob + "[[joint]]\nkind = \"glue\"\nbetween = [\"ground\", \"bob\"]\n" + grid,
       "joint.0.kind: \"glue\" is none of"},
      {bob + "[[effect]]\nkind = \"magic\"\n" + grid, "effect.0.kind: \"magic\" is none of"},
      {bob + "[[effect]]\nkind = \"drag\"\n" + grid, "effect.0: give motion"},
      {bob + "[[effect]]\nkind = \"torque\"\nbody = \"bob\"\ntorque = [1, 0, 0]\n" + grid, "does not turn"},
      {bob + "[[effect]]\nkind = \"charges\"\ncharges = [1, 2]\n" + grid, "expected 1 numbers"},
      {bob + grid + "accuracy = 0.1\n", "time.accuracy"},
      {bob + grid + "mode = \"adaptive\"\n", "time.mode"},
      {bob + grid + "[output]\nbodies = [\"rob\"]\n", "output.bodies"},
      {"[[body]]\nkind = \"rigid\"\nname = \"b\"\nmass = 1\ninertia = [1, 1, 3]\nposition = [0, 0, 0]\n" + grid,
       "no body has these moments"},
      {"[[body]]\nkind = \"rigid\"\nname = \"b\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\nattitude = [1, "
       "1, 0, 0]\n" +
           grid,
       "not a unit quaternion"},
      {"[[body]]\nkind = \"point\"\nname = \"ground\"\nmass = 1\nposition = [0, 0, 0]\n" + grid, "ground"},
      {bob + "[[effect]]\nkind = \"gravity\"\nbodies = [\"bob\", \"bob\"]\n" + grid, "named twice"},
      {bob + "[[effect]]\nkind = \"gravity\"\nbodies = []\n" + grid, "names no body"},
      {bob + "[[effect]]\nkind = \"force\"\nbody = \"bob\"\nforce = [1, 0, 0]\nat = [1, 0, 0]\n" + grid, "point mass"},
      {bob + "[[effect]]\nkind = \"drag\"\nturning = 1\n" + grid, "none of the bodies turns"},
      {card + "[[effect]]\nkind = \"gravity\"\n" + grid, "[0, -9.81, 0]"},
      {card + "[[effect]]\nkind = \"force\"\nbody = \"card\"\nforce = [0, 0, 1]\n" + grid, "third part"},
      {brick +
           "[[effect]]\nkind = \"torsion_spring\"\nbetween = [\"ground\", \"brick\"]\ndirection = [1, 0, 0]\n"
           "stiffness = 1\npoints = [[0, 0, 0], [0, 0, 0]]\n" +
           grid,
       "points: unknown key"},
      {"[[body]]\nkind = \"pivoted\"\nname = \"p\"\nmass = 1000\ninertia = [0.3, 0.3, 0.1]\ncentre = [0, 0, 0.5]\n" +
           grid,
       "moment 1 is 0.3, and must be 250"},
      {"[[body]]\nkind = \"point\"\nname = \"energy\"\nmass = 1\nposition = [0, 0, 0]\n" + grid, "column of every run"},
      {"[[body]]\nkind = \"point\"\nname = \"a\"\nmass = 1\nposition = [1e300, 0, 0]\n[[joint]]\nkind = \"rod\"\n"
       "between = [\"ground\", \"a\"]\n" +
           grid,
       "too large"},
      {bob +
           "[[body]]\nkind = \"point\"\nname = \"other\"\nmass = 1\nposition = [0, 0, -1]\n[[effect]]\n"
           "kind = \"mutual_gravity\"\n" +
           grid,
       "energy at the start"},
      {bob + grid + "mode = \"controlled\"\n", "time.mode: \"controlled\" needs a time scale"},
      {bob + "[time]\nduration = 1\nsteps = 10\nmode = \"controlled\"\n", "time.duration"},
      {bob + "[[effect]]\nkind = \"drag\"\nmotion = 1000\n" + grid, "time.step: drag stops a body"},
      {bob + grid + "[solver]\ntolerance = 0.1\n", "solver.tolerance: must be between 0 and 0.001"},
      {bob + rod + "ground_rate = 3\n" + grid, "missing key \"ground_amplitude\""},
      {bob + rod + "ground_amplitude = [0, 0, 1]\nground_rate = 0\n" + grid, "leave both out"},
      {bob + rod + "damping = 1\n" + grid, "joint.0.damping: unknown key"},
      {bob + "[[joint]]\nkind = \"blade\"\nbody = \"bob\"\n" + grid, "a blade needs a body of kind"},
      {card + "[[joint]]\nkind = \"blade\"\nbody = \"card\"\nrate = 1\n" + grid, "across the blade at 0 m/s"},
      {card + "[[joint]]\nkind = \"blade\"\nbody = \"card\"\nmultipliers = [1]\n" + grid, "go with principle"},
      {card +
           "[[joint]]\nkind = \"blade\"\nbody = \"card\"\nprinciple = \"vakonomic\"\n"
           "[[joint]]\nkind = \"blade\"\nbody = \"card\"\ndirection = 1\n" +
           grid,
       "one principle moves a body"},
      {card +
           "[[joint]]\nkind = \"blade\"\nbody = \"card\"\nprinciple = \"vakonomic\"\n[[effect]]\nkind = \"drag\"\n"
           "motion = 1\n" +
           grid,
       "drag and deflection do not go together with vakonomic joints"},
      {brick +
           "[[joint]]\nkind = \"hinge\"\naxis = [1, 0, 0]\nbetween = [\"ground\", \"brick\"]\npoints = [[1, 0, 0], [0, "
           "0, 0]]\nrate = 7\n" +
           grid,
       "joint.0.rate: the second body turns against the first at"},
      {brick + card + "[[effect]]\nkind = \"motor\"\nbetween = [\"brick\", \"card\"]\ntorque = [0, 0, 1]\n" + grid,
       "two bodies that turn in space, or on two in the plane"},
      {bob + "[[effect]]\nkind = \"torque\"\nbody = \"bob\"\ntorque = [0, 0, 1]\n" + grid, "does not turn"},
      {card + "[[effect]]\nkind = \"torque\"\nbody = \"card\"\ntorque = [0, 1, 0]\n" + grid, "first parts of 0"},
      {"[[body]]\nkind = \"point\"\nname = \"a\"\nmass = 1\nposition = [1e-200, 0, 0]\n[[joint]]\nkind = \"rod\"\n"
       "between = [\"ground\", \"a\"]\n" +
           grid,
       "too small"},
      {"[[body]]\nkind = \"point\"\nname = \"a b\"\nmass = 1\nposition = [0, 0, 0]\n" + grid, "use letters"},
  };
  for (const auto& [text, words] : cases) expect_scene_refused(text, words);
}

TEST_F(Scenes, PlanarBodiesAreTurnedAsBodiesInSpaceAre) {
  const auto momentum = [&](const std::string& body, const std::string& joint, const std::string& spring) {
    const fs::path file =
        write(body + "[[joint]]\n" + joint + "points = [[0, 0, 0], [-1, 0, 0]]\nbetween = [\"ground\", \"it\"]\n" +
              "[[effect]]\nkind = \"torque\"\nbody = \"it\"\ntorque = [0, 0, 0.3]\n"
              "[[effect]]\nkind = \"motor\"\nbetween = [\"ground\", \"it\"]\ntorque = [0, 0, 0.5]\nrate = 2\n"
              "[[effect]]\nkind = \"torsion_spring\"\nbetween = [\"ground\", \"it\"]\nstiffness = 0.7\n" +
              spring + grid);
    const Outcome r = run("run " + file.string() + " --json --set time.steps=300");
    EXPECT_EQ(r.code, 0) << r.err;
    return nlohmann::json::parse(r.out).at("final").at("momentum").get<std::vector<double>>();
  };
  const auto flat = momentum("[[body]]\nkind = \"planar\"\nname = \"it\"\nmass = 1\ninertia = 1\nposition = [1, 0]\n",
                             "kind = \"ball\"\n", "");
  const auto solid =
      momentum("[[body]]\nkind = \"rigid\"\nname = \"it\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [1, 0, 0]\n",
               "kind = \"hinge\"\naxis = [0, 0, 1]\n", "direction = [1, 0, 0]\n");
  ASSERT_EQ(flat.size(), 3U);
  ASSERT_EQ(solid.size(), 6U);
  EXPECT_NEAR(flat[0], solid[0], 1e-10);
  EXPECT_NEAR(flat[1], solid[1], 1e-10);
  EXPECT_NEAR(flat[2], solid[5], 1e-10);
  EXPECT_GT(std::abs(flat[2]), 1e-2);
}

/// A torque that does not change has a potential: with its work the energy is kept, and it is where nothing else acts.
TEST_F(Scenes, AConstantTorqueOnAPlanarBodyKeepsTheEnergy) {
  const fs::path file = write(card + "[[effect]]\nkind = \"torque\"\nbody = \"card\"\ntorque = [0, 0, 0.3]\n" + grid);
  const Outcome r = run("run " + file.string() + " --json --set time.steps=2000 --set body.0.angular_velocity=1");
  ASSERT_EQ(r.code, 0) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_NEAR(json.at("final").at("momentum").at(2).get<double>(), 1 + 0.3 * 20, 1e-10);
  EXPECT_EQ(json.at("ledger").at("entries").at(0).at("verdict"), "bounded") << r.out;
}

/// A snakeboard goes ahead, although all that acts on it acts between its parts.
TEST_F(Scenes, ASnakeboardGoesAhead) {
  const Outcome r = run("run " + example("snakeboard") + " --json");
  ASSERT_EQ(r.code, 0) << r.err;
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_GT(json.at("final").at("position").at(0).get<double>(), 5);
  EXPECT_LT(std::abs(json.at("final").at("position").at(1).get<double>()), 0.5);
  EXPECT_EQ(json.at("ledger").at("entries").at(0).at("verdict"), "kept") << "its wheels do not slide";
  const Outcome still =
      run("run " + example("snakeboard") + " --json --set body.1.angular_velocity=0 --set effect.0.torque=[0,0,0]");
  ASSERT_EQ(still.code, 0) << still.err;
  EXPECT_LT(std::abs(nlohmann::json::parse(still.out).at("final").at("position").at(0).get<double>()), 0.1);
}

TEST_F(Scenes, ATautLineIsRefusedAtTheFirstStepHoweverSmall) {
  const fs::path file = write(
      "[[body]]\nkind = \"point\"\nname = \"a\"\nmass = 1\nposition = [1, 0, 0]\n"
      "[[body]]\nkind = \"point\"\nname = \"b\"\nmass = 1\nposition = [2, 0, 0]\n"
      "[[joint]]\nkind = \"rod\"\nbetween = [\"ground\", \"a\"]\n"
      "[[joint]]\nkind = \"rod\"\nbetween = [\"a\", \"b\"]\n"
      "[[joint]]\nkind = \"rod\"\nbetween = [\"b\", \"ground\"]\npoints = [[0, 0, 0], [3, 0, 0]]\n"
      "[[effect]]\nkind = \"gravity\"\n" +
      grid);
  for (const char* step : {"0.1", "1e-3", "1e-5"}) {
    const Outcome r = run("run " + file.string() + " --json --set time.step=" + step);
    EXPECT_EQ(r.code, 3);
    EXPECT_EQ(nlohmann::json::parse(r.out).at("steps"), 0) << step;
    EXPECT_NE(r.out.find("singular position"), std::string::npos) << r.out;
  }
}

/// In any unit of mass a bob swings alike and is judged alike; at the ends of the range that is said.
TEST_F(Scenes, MassesInEveryUnitMoveAndAreJudgedAlike) {
  const fs::path file = write(
      "[[body]]\nkind = \"point\"\nname = \"bob\"\nmass = 1\nposition = [0.6, 0, -0.8]\n"
      "[[joint]]\nkind = \"rod\"\nbetween = [\"ground\", \"bob\"]\n[[effect]]\nkind = \"gravity\"\n"
      "[time]\nstep = 0.01\nsteps = 2000\n");
  const auto place = [](const Outcome& r) {
    return nlohmann::json::parse(r.out).at("final").at("position").at(0).get<double>();
  };
  const auto energy = [](const Outcome& r) { return nlohmann::json::parse(r.out).at("ledger").at("entries").at(1); };
  const Outcome plain = run("run " + file.string() + " --json");
  EXPECT_EQ(energy(plain).at("verdict"), "bounded");
  for (const char* mass : {"1e300", "1e200", "1e-160", "1e-280", "1e-300", "1e-310"}) {
    const Outcome r = run("run " + file.string() + " --json --set body.0.mass=" + mass);
    if (r.code == 3) {
      EXPECT_EQ(std::string(mass), "1e-310");
      EXPECT_NE(r.out.find("too small to keep its digits"), std::string::npos) << r.out;
      continue;
    }
    EXPECT_NEAR(place(r), place(plain), 1e-9) << mass;
    if (std::string(mass) == "1e-300") {
      EXPECT_EQ(energy(r).at("verdict"), "unjudged");
      EXPECT_TRUE(energy(r).contains("reason"));
    } else {
      EXPECT_EQ(energy(r).at("verdict"), "bounded") << mass;
      EXPECT_NEAR(energy(r).at("relative_drift").get<double>(), energy(plain).at("relative_drift").get<double>(), 1e-9);
    }
  }
}

TEST_F(Scenes, SetReachesIntoTables) {
  const fs::path file = write(bob + grid);
  EXPECT_EQ(run("run " + file.string() + " --set body.0.mass=2").code, 0);
  const Outcome none = run("run " + file.string() + " --set body.1.mass=2");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("--set body.1.mass: \"1\" is no place in the array \"body\" of 1"), std::string::npos)
      << none.err;
}

TEST_F(Scenes, AFinishedRunGoesOnWithTheSameBits) {
  const std::string scene = example("chain_drop") + " --set output.every=7";
  const fs::path whole = folder_ / "whole";
  const fs::path parts = folder_ / "parts";
  ASSERT_EQ(run("run " + scene + " --set time.steps=700 --out " + whole.string()).code, 0);
  ASSERT_EQ(run("run " + scene + " --set time.steps=333 --out " + parts.string()).code, 0);
  const Outcome on = run("resume " + parts.string() + " --set time.steps=700 --json");
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_TRUE(contents(whole / "trajectory.csv") == contents(parts / "trajectory.csv"));
  EXPECT_TRUE(contents(whole / "trajectory.h5") == contents(parts / "trajectory.h5"));
  auto a = nlohmann::json::parse(contents(whole / "summary.json"));
  auto b = nlohmann::json::parse(on.out);
  a.erase("seconds");
  b.erase("seconds");
  EXPECT_EQ(a, b);
}

/// Of bodies that turn too, wherever they are broken off.
TEST_F(Scenes, BodiesThatTurnGoOnWithTheSameBits) {
  for (const std::string name : {"six_bar", "tops", "rolling_balls"}) {
    const fs::path whole = folder_ / ("whole " + name);
    const fs::path parts = folder_ / ("parts " + name);
    const auto quoted = [](const fs::path& path) { return "'" + path.string() + "'"; };
    ASSERT_EQ(run("run " + example(name) + " --set time.steps=400 --set output.every=1 --out " + quoted(whole)).code,
              0);
    ASSERT_EQ(run("run " + example(name) + " --set time.steps=300 --set output.every=1 --out " + quoted(parts)).code,
              0);
    for (int steps = 305; steps <= 400; steps += 19)
      ASSERT_EQ(run("resume " + quoted(parts) + " --set time.steps=" + std::to_string(steps)).code, 0);
    EXPECT_TRUE(contents(whole / "trajectory.csv") == contents(parts / "trajectory.csv")) << name;
  }
}

/// Of systems, by every kind of steps; a ledger with a balance, first steps by accuracy, every n-th row.
TEST_F(Scenes, SystemsGoOnWithTheSameBits) {
  for (const std::string name :
       {"kepler_adaptive", "kepler_controlled", "kepler_order_8", "plate_ball_initial_value", "plate_ball_adaptive",
        "rigid_body_moser_veselov", "spherical_pendulum", "damped_pendulum", "driven_pendulum", "pythagorean",
        "kepler --set solver.method=ceres", "heavy_top --set time.method=splitting --set output.every=7"}) {
    const fs::path whole = folder_ / ("whole" + std::to_string(entries()));
    const fs::path parts = folder_ / ("parts" + std::to_string(entries()));
    const std::string rest = name.find(' ') == std::string::npos ? "" : name.substr(name.find(' '));
    const std::string scene = "run " + example(name.substr(0, name.find(' '))) + rest + " --set output.checkpoint=50 ";
    ASSERT_EQ(run(scene + "--set time.steps=200 --out " + whole.string()).code, 0) << name;
    ASSERT_EQ(run(scene + "--set time.steps=83 --out " + parts.string()).code, 0) << name;
    ASSERT_EQ(run("resume " + parts.string() + " --set time.steps=150").code, 0) << name;
    const Outcome on = run("resume " + parts.string() + " --set time.steps=200 --json");
    ASSERT_EQ(on.code, 0) << name << on.err;
    EXPECT_TRUE(contents(whole / "trajectory.csv") == contents(parts / "trajectory.csv")) << name;
    EXPECT_TRUE(contents(whole / "trajectory.h5") == contents(parts / "trajectory.h5")) << name;
    auto a = nlohmann::json::parse(contents(whole / "summary.json"));
    auto b = nlohmann::json::parse(on.out);
    a.erase("seconds");
    b.erase("seconds");
    EXPECT_EQ(a, b) << name;
  }
}

/// The arrows inside a composed step are looked at once there is one: the unit arrow keeps no prescribed spin.
TEST_F(Scenes, ComposedStepsKeepConstraintsFromTheStart) {
  const Outcome r = run("run " + example("plate_ball_initial_value") + " --set time.order=4 --json");
  ASSERT_EQ(r.code, 0) << r.err;
  const auto entry = nlohmann::json::parse(r.out).at("ledger").at("entries").at(0);
  EXPECT_EQ(entry.at("name"), "constraint residual");
  EXPECT_EQ(entry.at("verdict"), "kept");
}

/// A finished run that is taken up to do no more, one whose last step is recorded besides, one whose step fails.
TEST_F(Scenes, WhatIsTakenUpWithNothingToDoStaysAsItIs) {
  for (const std::string scene : {"rolling_balls --set time.steps=100 --set output.every=7",
                                  "steering --set time.step=0.7 --set time.steps=100000 --set output.every=9",
                                  "spring_pendulum --set time.step=5", "pendulum_adaptive --set time.step=1.5"}) {
    const std::string name = scene.substr(0, scene.find(' '));
    const fs::path out = folder_ / name;
    const int code = run("run " + example(name) + scene.substr(scene.find(' ')) + " --out " + out.string()).code;
    const std::string rows = contents(out / "trajectory.csv");
    auto before = nlohmann::json::parse(contents(out / "summary.json"));
    EXPECT_EQ(run("resume " + out.string()).code, code) << scene;
    auto after = nlohmann::json::parse(contents(out / "summary.json"));
    EXPECT_TRUE(rows == contents(out / "trajectory.csv")) << scene;
    before.erase("seconds");
    after.erase("seconds");
    EXPECT_EQ(before, after) << scene;
  }
}

/// Any bit that is another in a checkpoint is noticed.
TEST_F(Scenes, DamagedCheckpointsAreRefused) {
  const fs::path out = folder_ / "out";
  ASSERT_EQ(run("run " + example("tops") + " --set time.steps=20 --out " + out.string()).code, 0);
  std::mt19937 random(7);
  for (const char* file : {"state.cbor", "rows-000000.cbor", "scene.toml"})
    for (int k = 0; k < 8; ++k) {
      const fs::path kept = out / "checkpoint" / file;
      const std::string good = contents(kept);
      std::string bad = good;
      bad[random() % bad.size()] ^= char(1 << random() % 8);
      std::ofstream(kept, std::ios::binary) << bad;
      EXPECT_EQ(run("resume " + out.string()).code, 2) << file;
      std::ofstream(kept, std::ios::binary) << good;
    }
  EXPECT_EQ(run("resume " + out.string()).code, 0);
}

/// A user's own files in a folder of that name are not ours.
TEST_F(Scenes, AFolderOfThatNameKeepsItsFiles) {
  const fs::path own = folder_ / "out" / "checkpoint" / "mine.txt";
  fs::create_directories(own.parent_path());
  std::ofstream(own) << "mine";
  const std::string out = " --out " + (folder_ / "out").string();
  EXPECT_EQ(run("run " + example("tops") + " --set time.steps=20" + out).code, 0);
  EXPECT_EQ(run("run " + example("tops") + " --set time.steps=20" + out).code, 0);
  EXPECT_EQ(contents(own), "mine");
}

TEST_F(Scenes, TwoRunsDoNotShareAFolder) {
  const fs::path out = folder_ / "out";
  const std::string scene =
      example("tops") + " --set output.every=100000 --set time.steps=100000000 --out " + out.string();
  const Outcome r = run("run " + scene, "(timeout -s INT 3 " + std::string(LAGROID_PROGRAM) + " run " + scene +
                                            " >/dev/null 2>&1 &) ; sleep 1 ; ");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("another run is at work there"), std::string::npos) << r.err;
  run("list", "sleep 3 ; ");
  EXPECT_EQ(run("resume " + out.string() + " --set time.steps=5").code, 2) << "the first one has more steps";
}

TEST_F(Scenes, WideRunsAreDrawnFromAnExcerpt) {
  const fs::path out = folder_ / "out";
  ASSERT_EQ(run("run " + example("chain_drop") +
                " --set body.0.links=200 --set time.step=1e-5 --set time.steps=100 --out " + out.string())
                .code,
            0);
  EXPECT_TRUE(fs::exists(out / "plot.csv"));
  EXPECT_TRUE(fs::exists(out / "plot.png"));
  EXPECT_EQ(run("plot " + out.string()).code, 0);
}

TEST_F(Scenes, AnInterruptedRunGoesOn) {
  const fs::path out = folder_ / "out";
  const Outcome r =
      run("run " + example("tops") + " --set time.steps=100000000 --set output.every=100000 --out " + out.string(),
          "timeout --preserve-status -s INT 1 ");
  EXPECT_EQ(r.code, 4) << r.err;
  EXPECT_NE(r.err.find("lagroid resume"), std::string::npos) << r.err;
  const auto before = nlohmann::json::parse(contents(out / "summary.json")).at("steps").get<long>();
  const Outcome on = run("resume " + out.string() + " --set time.steps=" + std::to_string(before + 1000));
  EXPECT_EQ(on.code, 0) << on.err;
  EXPECT_EQ(nlohmann::json::parse(contents(out / "summary.json")).at("steps"), before + 1000);
}

/// Fifty runs are killed, each where it pleases; each loses at most what came after its last checkpoint.
class Killed : public Scenes {
 protected:
  /// `interval`: steps from one checkpoint to the next.
  void survives(const std::string& name, long interval) {
    const std::string every = std::to_string(interval);
    const std::string scene =
        example(name) + " --set output.every=" + every + " --set output.checkpoint=" + every + " --set time.steps=";
    const fs::path out = folder_ / "killed";
    std::mt19937 random(20261122);
    long reached = 0;
    for (int k = 0; k < 50; ++k) {
      const double moment = 0.02 + 0.0001 * double(random() % 1000);
      const std::string kill = "timeout -s KILL " + std::to_string(moment) + " ";
      const Outcome r =
          run(k == 0 ? "run " + scene + "1000000000 --out " + out.string() : "resume " + out.string(), kill);
      ASSERT_EQ(r.code, 137) << r.err;
      if (!fs::exists(out / "checkpoint" / "state.cbor")) {
        ASSERT_EQ(k, 0) << "a checkpoint is gone";
        k = -1;  // killed before there was anything to lose
        continue;
      }
      const std::string bytes = contents(out / "checkpoint" / "state.cbor").substr(sizeof(std::size_t));
      const auto state = nlohmann::json::from_cbor(bytes).at("state");
      const long now = state.at("steps").get<long>();
      EXPECT_GE(now, reached);
      EXPECT_EQ(now % interval, 0);
      reached = now;
    }
    EXPECT_GT(reached, interval);
    const std::string end = std::to_string(reached + 1000);
    const Outcome last = run("resume " + out.string() + " --set time.steps=" + end);
    ASSERT_EQ(last.code, 0) << last.err;
    const fs::path whole = folder_ / "whole";
    ASSERT_EQ(run("run " + scene + end + " --out " + whole.string()).code, 0);
    EXPECT_TRUE(contents(whole / "trajectory.csv") == contents(out / "trajectory.csv"));
  }
};

TEST_F(Killed, AChainGoesOnWithTheSameBits) { survives("chain_drop", 400); }
TEST_F(Killed, APlateBallGoesOnWithTheSameBits) { survives("plate_ball_initial_value", 2000); }

TEST_F(Scenes, WhatCannotBeTakenUpIsRefused) {
  EXPECT_EQ(run("resume " + (folder_ / "nothing").string()).code, 2);
  const fs::path out = folder_ / "out";
  ASSERT_EQ(run("run " + example("chain_drop") + " --set time.steps=10 --out " + out.string()).code, 0);
  const Outcome other = run("resume " + out.string() + " --set time.step=0.1");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("only time.steps can be set"), std::string::npos) << other.err;
  EXPECT_EQ(run("resume " + out.string() + " --set time.steps=5").code, 2) << "less than it has";
  for (const char* file : {"state.cbor", "rows-000000.cbor", "scene.toml"}) {
    const fs::path broken = out / "checkpoint" / file;
    const std::string good = contents(broken);
    std::ofstream(broken, std::ios::binary) << good.substr(0, good.size() / 2);
    const Outcome r = run("resume " + out.string() + " --set time.steps=20");
    EXPECT_EQ(r.code, 2) << file;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    std::ofstream(broken, std::ios::binary) << good;
  }
  EXPECT_EQ(run("resume " + out.string() + " --set time.steps=20").code, 0);
  const fs::path boundary = folder_ / "boundary";
  ASSERT_EQ(run("run " + example("kepler_boundary") + " --out " + boundary.string()).code, 0);
  EXPECT_EQ(run("resume " + boundary.string()).code, 2) << "a boundary value keeps no checkpoint";
}

}  // namespace
