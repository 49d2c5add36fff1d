// Events of scenes: of systems, bodies and spheres, in every file of a run, resumed and ended by them.
#include "scenes.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace lagroid::scene_tests {
namespace {

using Json = nlohmann::json;

class Events : public Scenes {
 protected:
  /// The example, with tables after its own.
  std::string with(const std::string& name, const std::string& tables) const {
    return write(contents(example(name)) + "\n" + tables).string();
  }
  Json summary(const fs::path& run) const { return Json::parse(contents(run / "summary.json")); }
};

const std::string apsides = R"toml([[event]]
name = "pericentre"
when = "x*px + y*py"
direction = "rising"
plot = ["x", "y"]

[[event]]
name = "near"
when = "sqrt(x^2 + y^2)"
at = "minimum"
)toml";

TEST_F(Events, AreInEveryFileOfARun) {
  const fs::path out = folder_ / "out";
  const Outcome r = run("run " + with("kepler_order_8", apsides) + " --set time.steps=400 --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("event \"pericentre\": 12 times, first at t 6.28"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("mean interval 6.28318"), std::string::npos) << r.out;
  const Json found = summary(out).at("events");
  ASSERT_EQ(found.at("rows").size(), 24u);
  EXPECT_EQ(found.at("watched").at(0).at("count"), 12);
  // Both happen at once, to rounding: their order among rows is open.
  for (const auto& row : found.at("rows"))
    EXPECT_EQ(row.at("passing"), row.at("event") == "pericentre" ? "rising" : "minimum") << row;
  const double period = 2 * std::numbers::pi;
  for (std::size_t i = 0; i < 24; ++i)
    EXPECT_NEAR(found.at("rows").at(i).at("t").get<double>(), period * double(i / 2 + 1), 1e-5) << i;
  std::istringstream csv(contents(out / "events.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "event,t,step,passing,together,x,y,px,py");
  std::getline(csv, line);
  const std::string name = line.substr(0, line.find(','));
  EXPECT_TRUE(name == "pericentre" || name == "near") << line;
  EXPECT_EQ(line.substr(name.size(), 5), ",6.28");
  const std::string script = contents(out / "plot.gp");
  EXPECT_NE(script.find("'events.csv' using (stringcolumn('event') eq 'pericentre' ? column('x') : NaN):(column('y'))"),
            std::string::npos);
  EXPECT_TRUE(fs::exists(out / "plot.svg"));
  EXPECT_EQ(run("plot " + out.string()).code, 0);
  EXPECT_EQ(run("view " + out.string()).code, 0);
}

TEST_F(Events, RunsWithThemHaveTheRowsOfThoseWithout) {
  for (const auto& [name, when] :
       {std::pair("kepler", "x"), std::pair("kepler_adaptive", "x"), std::pair("kepler_controlled", "x"),
        std::pair("figure_eight", "a.x - b.x"), std::pair("six_bar", "energy*t - 1"), std::pair("tops", "t - 0.3"),
        std::pair("rolling_balls", "t - 0.2"), std::pair("pendulum_chain", "z1 + 0.5"),
        std::pair("pendulum_chain_adaptive", "t - 0.3"), std::pair("rolling_disk", "x")}) {
    SCOPED_TRACE(name);
    const fs::path with_events = folder_ / (std::string("with ") + name),
                   without = folder_ / (std::string("no ") + name);
    const std::string steps = " --set time.steps=300 --out '";
    const std::string event = fmt::format("[[event]]\nname = \"here\"\nwhen = \"{}\"\n", when);
    const Outcome r = run("run " + with(name, event) + steps + with_events.string() + "'");
    ASSERT_EQ(r.code, 0) << r.err << r.out;
    ASSERT_EQ(run("run " + example(name) + steps + without.string() + "'").code, 0);
    EXPECT_TRUE(contents(with_events / "trajectory.csv") == contents(without / "trajectory.csv"));
  }
}

TEST_F(Events, OfBodiesAreFoundWhereTheyAre) {
  // The period of the figure eight is 6.32591398; a begins on the right of the point where two paths cross.
  const fs::path out = folder_ / "eight";
  const Outcome r = run("run " +
                        with("figure_eight",
                             "[[event]]\nname = \"a left\"\nwhen = \"a.x\"\n"
                             "direction = \"falling\"\nthen = \"stop\"\ncount = 3\n") +
                        " --set time.steps=20000 --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err;
  const Json found = summary(out).at("events");
  ASSERT_EQ(found.at("rows").size(), 3u);
  EXPECT_NEAR(found.at("watched").at(0).at("mean_interval").get<double>(), 6.32591398, 1e-4);
  EXPECT_EQ(summary(out).at("final").at("time"), found.at("rows").at(2).at("t"));
  EXPECT_NE(r.out.find("ended by event \"a left\""), std::string::npos) << r.out;
}

TEST_F(Events, GoOnWithTheSameBits) {
  const fs::path whole = folder_ / "whole", parts = folder_ / "parts";
  const std::string scene = "run " + with("kepler_order_8", apsides) + " --set output.checkpoint=50 ";
  ASSERT_EQ(run(scene + "--set time.steps=400 --out " + whole.string()).code, 0);
  ASSERT_EQ(run(scene + "--set time.steps=183 --out " + parts.string()).code, 0);
  const Outcome on = run("resume " + parts.string() + " --set time.steps=400 --json");
  ASSERT_EQ(on.code, 0) << on.err;
  expect_the_same_bits(whole, parts, on.out);
  EXPECT_EQ(contents(whole / "events.csv"), contents(parts / "events.csv"));
}

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
  const Json found = summary(out).at("events");
  const Json columns = found.at("columns");
  const auto at = [&](const char* name) {
    const auto place = std::find(columns.begin(), columns.end(), name) - columns.begin();
    return found.at("rows").at(0).at("values").at(std::size_t(place)).get<double>();
  };
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
  const fs::path whole = folder_ / "whole", parts = folder_ / "parts";
  const std::string scene = "run " + write(sling + events).string() + " --set output.checkpoint=10 ";
  ASSERT_EQ(run(scene + "--out " + whole.string()).code, 0);
  ASSERT_EQ(run(scene + "--set time.steps=43 --out " + parts.string()).code, 0);
  const Outcome on = run("resume " + parts.string() + " --set time.steps=100 --json");
  ASSERT_EQ(on.code, 0) << on.err;
  expect_the_same_bits(whole, parts, on.out);
  EXPECT_EQ(contents(whole / "events.csv"), contents(parts / "events.csv"));
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

/// The full motion of a reduced run is seen inside of steps, too: its angles are those of the run that is not reduced.
TEST_F(Events, OfReducedRunsAreThoseOfTheFullMotion) {
  const auto times = [&](const std::string& name, const std::string& more) {
    const fs::path out = folder_ / (name + more);
    const Outcome r =
        run("run " + with(name, "[[event]]\nname = \"up\"\nwhen = \"y - 0.1*x\"\ndirection = \"rising\"\n") +
            " --set time.steps=3000" + more + " --out '" + out.string() + "'");
    EXPECT_EQ(r.code, 0) << r.err << r.out;
    std::vector<double> found;
    const Json happened = summary(out).at("events");
    for (const Json& row : happened.at("rows")) found.push_back(row.at("t").get<double>());
    return found;
  };
  const std::vector<double> reduced = times("kepler_reduced", ""), full = times("kepler", " --set time.step=0.01");
  ASSERT_EQ(reduced.size(), 5u);
  ASSERT_EQ(full.size(), 5u);
  // Both are of order two.
  for (std::size_t i = 0; i < reduced.size(); ++i) EXPECT_NEAR(reduced[i], full[i], 2e-2) << i;
}

TEST_F(Events, OfPoissonSystemsAreFoundWhereTheyAre) {
  const fs::path out = folder_ / "prey";
  const std::string event =
      "[[event]]\nname = \"most prey\"\nwhen = \"x\"\nat = \"maximum\"\n\n[[event]]\nname = \"end\"\n"
      "when = \"t - 7.7\"\nthen = \"stop\"\n";
  const Outcome r = run("run " + with("lotka_volterra", event) + " --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  EXPECT_NEAR(summary(out).at("final").at("time").get<double>(), 7.7, 1e-12);
  EXPECT_NE(r.out.find("ended by event \"end\""), std::string::npos) << r.out;
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

TEST_F(Events, ThatWouldKickSpheresAreRefused) {
  expect_refused("run " + with("pendulum_chain", "[[event]]\nname = \"x\"\nwhen = \"z1\"\nkick = [\"1\"]\n"),
                 "nothing can be added to the momentum on the way");
}

TEST_F(Events, ThatCannotBeReadAreRefusedInALine) {
  const auto refused = [&](const std::string& keys, const std::string& words) {
    expect_refused("run " + with("pendulum", "[[event]]\n" + keys), words);
  };
  refused("name = \"x\"\nwhen = \"height\"\n", "event \"x\": \"height\": there is no \"height\"; there are t, q, ");
  refused("name = \"x\"\n", "when");
  refused("name = \"x\"\nwhen = \"q\"\nat = \"minimum\"\ndirection = \"rising\"\n", "direction");
  refused("name = \"x\"\nwhen = \"q\"\ncount = 2\n", "count");
  refused("name = \"x\"\nwhen = \"q\"\nplot = [\"q\", \"height\"]\n", "it cannot be drawn over \"height\"");
  const std::string event = "[[event]]\nname = \"x\"\nwhen = \"x\"\n";
  expect_refused("run " + with("kepler_reduced", event) + " --set time.order=4", "nothing inside of steps");
}

}  // namespace
}  // namespace lagroid::scene_tests
