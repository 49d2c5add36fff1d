// Scenes of bodies through the program: every kind of body, joint and effect, and what is wrong is said.
#include "scenes.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::scene_tests::kinds_tests {
namespace {

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
       "drag and gyroscopic forces do not go together with vakonomic joints"},
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

/// The arrows inside a composed step are looked at once there is one: the unit arrow keeps no prescribed spin.
TEST_F(Scenes, ComposedStepsKeepConstraintsFromTheStart) {
  const Outcome r = run("run " + example("plate_ball_initial_value") + " --set time.order=4 --json");
  ASSERT_EQ(r.code, 0) << r.err;
  const auto entry = nlohmann::json::parse(r.out).at("ledger").at("entries").at(0);
  EXPECT_EQ(entry.at("name"), "constraint residual");
  EXPECT_EQ(entry.at("verdict"), "kept");
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

}  // namespace
}  // namespace lagroid::scene_tests::kinds_tests
