// Events that change the motion of a scene: kicks, parameters, switches; and runs that are taken up after them.
#include "events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace lagroid::scene_tests::event_changes_tests {
namespace {

TEST_F(Events, SetParameters) {
  const fs::path out = folder_ / "moon";
  const Outcome r = run("run " +
                        with("pendulum",
                             "[[event]]\nname = \"moon\"\nwhen = \"t - 20.05\"\nset = [\"gravity = 0.165\"]\n\n"
                             "[[event]]\nname = \"bottom\"\nwhen = \"q\"\ndirection = \"rising\"\n") +
                        " --set time.steps=2000 --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  const Json rows = summary(out).at("events").at("rows");
  // Periods before and after are as the roots of the gravities.
  std::vector<double> bottoms;
  for (const auto& row : rows)
    if (row.at("event") == "bottom") bottoms.push_back(row.at("t").get<double>());
  ASSERT_GT(bottoms.size(), 6u);
  const double before = bottoms[1] - bottoms[0];
  const double after = bottoms.back() - bottoms[bottoms.size() - 2];
  EXPECT_GT(after, 1.5 * before);
  EXPECT_NE(r.out.find("event \"moon\": changed the motion 1 times"), std::string::npos) << r.out;
  expect_refused("run " + with("kepler", "[[event]]\nname = \"x\"\nwhen = \"x\"\nset = [\"gravity 2\"]\n"),
                 "\"gravity 2\" is not of the form \"name = expression\"");
  expect_refused("study " + with("pendulum", "[[event]]\nname = \"x\"\nwhen = \"q\"\nset = [\"gravity = 2\"]\n"),
                 "\"x\" changes the motion or ends it");
}

/// A top whose inertia an event makes unequal has no axial momentum to keep from there.
TEST_F(Events, ThatEndASymmetryEndItsPromise) {
  const auto verdict = [&](const std::string& inertia) {
    const fs::path out = folder_ / "top";
    fs::remove_all(out);
    const Outcome r =
        run("run " +
            with("heavy_top",
                 "[[event]]\nname = \"bent\"\nwhen = \"t - 0.5005\"\nset = [\"inertia.0 = " + inertia + "\"]\n") +
            " --set time.steps=200 --out " + out.string());
    EXPECT_EQ(r.code, 0) << r.err << r.out;
    const Json told = summary(out);
    for (const auto& entry : told.at("ledger").at("entries"))
      if (entry.at("name") == "axial momentum M3") return entry.at("verdict").get<std::string>();
    return std::string("no such entry");
  };
  EXPECT_EQ(verdict("1.5"), "watched");
  EXPECT_EQ(verdict("1"), "kept");
}

/// A bob that is let go on the way flies on a parabola, which variational steps follow exactly.
const std::string sling = R"toml(name = "sling"

[[body]]
kind = "point"
name = "bob"
mass = 2.0
position = [0, 0, -1]
velocity = [4, 0, 0]

[[joint]]
kind = "rod"
name = "string"
between = ["ground", "bob"]

[[effect]]
kind = "gravity"

[time]
step = 0.01
steps = 100
)toml";

/// Let go, made heavier, and under another gravity from then on.
TEST_F(Events, SetNumbersOfBodies) {
  std::string scene = sling;
  scene.replace(scene.find("kind = \"gravity\""), 16,
                "kind = \"gravity\"\nname = \"weight\"\nacceleration = [0, 0, -9.81]");
  scene += R"toml(
[[event]]
name = "release"
when = "t - 0.2034"
switch_off = ["string"]
set = ["bob.mass = 2*2", "weight.acceleration.2 = -1.62 + 0*bob.z"]
)toml";
  const fs::path whole = folder_ / "whole";
  const std::string start = "run " + write(scene).string() + " --set output.checkpoint=10 ";
  const Outcome r = run(start + "--out " + whole.string());
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  EXPECT_EQ(r.out.find("BROKEN"), std::string::npos) << r.out;
  const auto at = [&](const char* name) { return at_event(whole, 0, name); };
  // The momentum stays, and is twice as slow.
  const double t = 1 - 0.2034;
  const Json end = summary(whole).at("final").at("position");
  EXPECT_NEAR(end.at(0).get<double>(), at("bob.x") + t * at("bob.px") / 4, 1e-12);
  EXPECT_NEAR(end.at(2).get<double>(), at("bob.z") + t * at("bob.pz") / 4 - 0.5 * 1.62 * t * t, 1e-12);
  expect_resumable(start, 43, 100);
  auto ended = [&, k = 0](const std::string& set, const std::string& words) mutable {
    std::string other = scene;
    other.replace(other.find("bob.mass = 2*2"), 14, set);
    const Outcome refused =
        run("run " + write(other).string() + " --out " + (folder_ / fmt::format("refused_{}", ++k)).string());
    EXPECT_NE(refused.code, 0);
    EXPECT_NE((refused.out + refused.err).find(words), std::string::npos) << refused.out << refused.err;
  };
  ended("bob.mass = -2", "mass");
  ended("bob.position.0 = 1", "it sets \"bob.position.0\", which is no parameter that is a number; there are bob.mass");
}

/// A string of another length, and caught by it where the bob is then; what does not hold there is refused.
TEST_F(Events, SetAndSwitchJointsTogether) {
  std::string scene = sling;
  scene.replace(scene.find("between = [\"ground\", \"bob\"]"), 27, "between = [\"ground\", \"bob\"]\nlength = 1");
  scene += R"toml(
[[event]]
name = "release"
when = "t - 0.1034"
switch_off = ["string"]

[[event]]
name = "caught"
when = "t - 0.3034"
switch_on = ["string"]
set = ["string.length = sqrt(bob.x^2 + bob.y^2 + bob.z^2)"]
)toml";
  const fs::path out = folder_ / "caught";
  const Outcome r = run("run " + write(scene).string() + " --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  const Json end = summary(out).at("final").at("position");
  const auto radius_of = [](double x, double z) { return std::hypot(x, z); };
  const auto at = [&](const char* name) { return at_event(out, 1, name); };
  EXPECT_NEAR(radius_of(end.at(0).get<double>(), end.at(2).get<double>()), radius_of(at("bob.x"), at("bob.z")), 1e-12);
  EXPECT_GT(radius_of(at("bob.x"), at("bob.z")), 1.05);
  const std::string present = "sqrt(bob.x^2 + bob.y^2 + bob.z^2)";
  scene.replace(scene.find(present), present.size(), "2");
  const Outcome refused = run("run " + write(scene).string() + " --out " + (folder_ / "torn").string());
  EXPECT_NE(refused.code, 0);
  EXPECT_NE((refused.out + refused.err).find("with what it sets the joints do not hold"), std::string::npos)
      << refused.out << refused.err;
}

TEST_F(Events, SwitchJointsAndEffects) {
  const std::string events = R"toml(
[[event]]
name = "release"
when = "t - 0.2034"
switch_off = ["string"]
plot = ["bob.x", "bob.z"]
)toml";
  const fs::path out = folder_ / "thrown";
  const Outcome r = run("run " + write(sling + events).string() + " --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  EXPECT_NE(r.out.find("event \"release\": changed the motion 1 times"), std::string::npos) << r.out;
  EXPECT_EQ(r.out.find("BROKEN"), std::string::npos) << r.out;
  const auto at = [&](const char* name) { return at_event(out, 0, name); };
  const double t = 1 - 0.2034;
  const Json end = summary(out).at("final").at("position");
  EXPECT_NEAR(end.at(0).get<double>(), at("bob.x") + t * at("bob.px") / 2, 1e-12);
  EXPECT_NEAR(end.at(2).get<double>(), at("bob.z") + t * at("bob.pz") / 2 - 0.5 * 9.81 * t * t, 1e-12);
}

TEST_F(Events, SwitchedMotionsGoOnWithTheSameBits) {
  const std::string events = R"toml(
[[event]]
name = "release"
when = "t - 0.2034"
switch_off = ["string"]

[[event]]
name = "blow"
when = "t - 0.7501"
body = "bob"
kick = ["1", "0.5", "-bob.pz"]
)toml";
  expect_resumable("run " + write(sling + events).string() + " --set output.checkpoint=10", 43, 100);
}

/// A string that becomes taut keeps the angular momentum about its end.
TEST_F(Events, SwitchOnWhatIsOffAtTheStart) {
  const std::string scene = R"toml(
[[body]]
kind = "point"
name = "bob"
mass = 2.0
position = [1, -0.75, 0]
velocity = [0, 1.5, 0]

[[joint]]
kind = "rod"
name = "string"
between = ["ground", "bob"]
length = 1.25
on = false

[time]
step = 0.01
steps = 300

[[event]]
name = "taut"
when = "sqrt(bob.x^2 + bob.y^2) - 1.25"
direction = "rising"
switch_on = ["string"]
)toml";
  const fs::path out = folder_ / "caught";
  const Outcome r = run("run " + write(scene).string() + " --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  const Json end = summary(out).at("final");
  const auto number = [&](const char* of, int i) { return end.at(of).at(std::size_t(i)).get<double>(); };
  EXPECT_NEAR(std::hypot(number("position", 0), number("position", 1)), 1.25, 1e-13);
  EXPECT_NEAR(number("position", 0) * number("momentum", 1) - number("position", 1) * number("momentum", 0), 3, 1e-12);
  // Too early it does not hold.
  std::string early = scene;
  early.replace(early.find("- 1.25"), 6, "- 1.10");
  const Outcome failed = run("run " + write(early).string() + " --out " + (folder_ / "early").string());
  EXPECT_NE(failed.code, 0);
  EXPECT_NE(failed.out.find("\"string\" is switched on where it does not hold"), std::string::npos)
      << failed.out << failed.err;
}

TEST_F(Events, ThatSwitchNothingAreRefusedInALine) {
  const auto refused = [&](const std::string& keys, const std::string& words) {
    expect_refused("run " + write(sling + "\n[[event]]\nname = \"x\"\nwhen = \"bob.x\"\n" + keys).string(), words);
  };
  refused("switch_off = [\"rope\"]\n", "it switches \"rope\"; there are string");
  refused("switch_off = [\"string\"]\nswitch_on = [\"string\"]\n", "it switches \"string\" on and off");
  refused("kick = [\"1\", \"0\", \"0\"]\n", "it kicks a body, and \"\" is none; there are bob");
  refused("body = \"bob\"\nkick = [\"1\"]\n", "its kick has 1 numbers, the momentum of \"bob\" has 3");
  refused("body = \"bob\"\n", "it names a body, which nothing kicks");
  expect_refused("run " + with("kepler", "[[event]]\nname = \"x\"\nwhen = \"x\"\nswitch_off = [\"sun\"]\n"),
                 "it switches \"sun\"; nothing here has a name by which it is switched");
  const auto scene_refused = [&](const std::string& key, const std::string& words) {
    std::string scene = sling;
    scene.replace(scene.find("name = \"string\""), 15, key);
    expect_refused("run " + write(scene).string(), words);
  };
  scene_refused("on = false", "needs a name by which an event switches it on");
  scene_refused("name = \"a b\"", "use letters, digits, - and _");
}

/// Steps that vary go on from a change, and a run that is broken off after it goes on as the whole.
TEST_F(Events, ChangeMotionsWhoseStepsVary) {
  const std::string events = R"toml([[event]]
name = "push"
when = "t - 9.03"
kick = ["0.1*px", "0.1*py"]

[[event]]
name = "heavier"
when = "t - 15.05"
set = ["strength = 1.2"]
)toml";
  for (const std::string mode : {"adaptive", "controlled"}) {
    SCOPED_TRACE(mode);
    const fs::path whole = folder_ / (mode + " whole"), parts = folder_ / (mode + " parts");
    const std::string scene =
        "run " + with("kepler_adaptive", events) + " --set output.checkpoint=50 --set time.mode=" + mode + " ";
    const Outcome r = run(scene + "--set time.steps=600 --out '" + whole.string() + "'");
    ASSERT_EQ(r.code, 0) << r.err << r.out;
    EXPECT_EQ(r.out.find("BROKEN"), std::string::npos) << r.out;
    const Json found = summary(whole), rows = found.at("events").at("rows");
    ASSERT_EQ(rows.size(), 2u);
    // H = p^2 / 2 - k / r, of one mass: what the pushes gave.
    const auto numbers = [](const Json& of) { return of.get<std::vector<double>>(); };
    const auto energy = [](const std::vector<double>& q, const std::vector<double>& p, double k) {
      return 0.5 * (p[0] * p[0] + p[1] * p[1]) - k / std::hypot(q[0], q[1]);
    };
    const std::vector<double> at = numbers(rows.at(1).at("values"));
    const double before = energy({at[0], at[1]}, {at[2], at[3]}, 1.2);
    EXPECT_NEAR(energy(numbers(found.at("final").at("position")), numbers(found.at("final").at("momentum")), 1.2),
                before, 6e-2);
    ASSERT_EQ(run(scene + "--set time.steps=400 --out '" + parts.string() + "'").code, 0);
    const Outcome on = run("resume '" + parts.string() + "' --set time.steps=600 --json");
    ASSERT_EQ(on.code, 0) << on.err;
    expect_the_same_bits(whole, parts, on.out);
  }
}

TEST_F(Events, KickTheStateOfPoissonSystems) {
  const fs::path out = folder_ / "hunted";
  const auto hunt = [&](const std::string& share) {
    return "[[event]]\nname = \"hunt\"\nwhen = \"x\"\nat = \"maximum\"\nkick = [\"-" + share + "*x\", \"0\"]\n";
  };
  const Outcome r = run("run " + with("lotka_volterra", hunt("0.25")) + " --set time.steps=200 --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  EXPECT_EQ(r.out.find("BROKEN"), std::string::npos) << r.out;
  const Json rows = summary(out).at("events").at("rows");
  ASSERT_GE(rows.size(), 1u);
  const Outcome dead =
      run("run " + with("lotka_volterra", hunt("1.5")) + " --set time.steps=200 --out " + (folder_ / "dead").string());
  EXPECT_NE(dead.code, 0);
  EXPECT_NE((dead.out + dead.err).find("event \"hunt\": between t = "), std::string::npos) << dead.out << dead.err;
}

/// The first and the last row of a table, by its columns.
struct Ends {
  std::map<std::string, double> first, last;
};
Ends ends_of(const fs::path& file) {
  std::ifstream in(file);
  Ends ends;
  std::vector<std::string> columns;
  const auto cells = [](const std::string& line) {
    std::vector<std::string> out;
    std::istringstream of(line);
    for (std::string cell; std::getline(of, cell, ',');) out.push_back(cell);
    return out;
  };
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    const std::vector<std::string> row = cells(line);
    if (columns.empty()) {
      columns = row;
      continue;
    }
    ends.last.clear();
    for (std::size_t i = 0; i < row.size(); ++i) ends.last[columns[i]] = std::stod(row[i]);
    if (ends.first.empty()) ends.first = ends.last;
  }
  return ends;
}

/// Turned round, a chain goes back to where it came from.
TEST_F(Events, KickSpheres) {
  const auto back = [](int links) {
    std::string kick;
    for (int i = 1; i <= links; ++i)
      for (const char* axis : {"x", "y", "z"}) kick += fmt::format("{}\"-2*p{}{}\"", kick.empty() ? "" : ", ", i, axis);
    return fmt::format("\n[[event]]\nname = \"back\"\nwhen = \"t - 0.501\"\nkick = [{}]\n", kick);
  };
  std::string scene = contents(example("pendulum_chain"));
  scene.replace(scene.find("[time]"), 6, "[time]\nform = \"momenta\"");
  const fs::path path = write(scene + back(3));
  for (const std::string method : {"rattle", "munthe-kaas-54", "extrapolation"}) {
    SCOPED_TRACE(method);
    const fs::path out = folder_ / method;
    const std::string by = "\"" + method + "\"" + (method == "rattle" ? "" : " --set time.tolerance=1e-12");
    const Outcome r =
        run("run " + path.string() + " --set time.steps=501 --set time.method=" + by + " --out " + out.string());
    ASSERT_EQ(r.code, 0) << r.err << r.out;
    EXPECT_EQ(r.out.find("BROKEN"), std::string::npos) << r.out;
    const Ends ends = ends_of(out / "trajectory.csv");
    EXPECT_NEAR(ends.last.at("t"), 1.002, 1e-12);
    for (const char* column : {"x1", "z2", "y3"}) EXPECT_NEAR(ends.last.at(column), ends.first.at(column), 1e-9);
    for (const char* column : {"p1x", "p2z", "p3y"}) EXPECT_NEAR(ends.last.at(column), -ends.first.at(column), 1e-9);
  }
  expect_resumable("run " + path.string() + " --set output.checkpoint=50 --set output.every=1", 251, 400);
  expect_refused("run " + with("pendulum_chain", "[[event]]\nname = \"x\"\nwhen = \"z1\"\nkick = [\"1\"]\n"),
                 "its kick has 1 numbers, the momentum has 9");
}

/// So do three bodies whose steps follow their attraction.
TEST_F(Events, KickBodiesByControlledSteps) {
  std::string scene = contents(example("pythagorean"));
  for (const char* body : {"three", "four", "five"})
    scene += fmt::format(
        "\n[[event]]\nname = \"turn {0}\"\nwhen = \"t - 0.71\"\nbody = \"{0}\"\nkick = [\"-2*{0}.px\", "
        "\"-2*{0}.py\", \"0\"]\n",
        body);
  scene += "\n[[event]]\nname = \"back\"\nwhen = \"t - 1.42\"\nthen = \"stop\"\n";
  const std::string start = "run " + write(scene).string() + " --set time.step=1e-3 --set output.checkpoint=50 ";
  const fs::path whole = folder_ / "whole";
  const Outcome r = run(start + "--set time.steps=20000 --out " + whole.string());
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  EXPECT_EQ(r.out.find("BROKEN"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("ended by event \"back\""), std::string::npos) << r.out;
  const std::vector<double> end = summary(whole).at("final").at("position");
  const std::vector<double> first{1, 3, 0, -2, -1, 0, 1, -1, 0};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(end.at(i), first[i], 1e-6) << i;
  expect_resumable(start, 900, 20000);
}

}  // namespace
}  // namespace lagroid::scene_tests::event_changes_tests
