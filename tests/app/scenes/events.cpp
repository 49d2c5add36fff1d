// Events of scenes: of systems, bodies and spheres, in every file of a run, resumed and ended by them.
#include "scenes.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

TEST_F(Events, OfPoissonSystemsAreFoundWhereTheyAre) {
  const fs::path out = folder_ / "prey";
  const std::string event =
      "[[event]]\nname = \"most prey\"\nwhen = \"x\"\nat = \"maximum\"\n\n[[event]]\nname = \"end\"\n"
      "when = \"t - 7.7\"\nthen = \"stop\"\n";
  const Outcome r = run("run " + with("lotka_volterra", event) + " --out " + out.string());
  ASSERT_EQ(r.code, 0) << r.err << r.out;
  EXPECT_NEAR(summary(out).at("final").at("time").get<double>(), 7.7, 1e-12);
  EXPECT_NE(r.out.find("ended by event \"end\""), std::string::npos) << r.out;
  expect_refused("run " + with("lotka_volterra", "[[event]]\nname = \"x\"\nwhen = \"x - 1\"\nkick = [\"1\", \"0\"]\n"),
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
  expect_refused("run " + with("kepler_reduced", "[[event]]\nname = \"x\"\nwhen = \"x\"\n"), "nothing inside of steps");
}

}  // namespace
}  // namespace lagroid::scene_tests
