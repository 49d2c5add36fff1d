// Events of scenes: of systems, bodies and spheres, in every file of a run, resumed and ended by them.
#include "events.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace lagroid::scene_tests::events_tests {
namespace {

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
  EXPECT_EQ(line, "event,t,t_error,step,passing,together,x,y,px,py");
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
        std::pair("kepler_prescribed", "x"), std::pair("figure_eight", "a.x - b.x"),
        std::pair("six_bar", "energy*t - 1"), std::pair("tops", "t - 0.3"), std::pair("rolling_balls", "t - 0.2"),
        std::pair("pendulum_chain", "z1 + 0.5"), std::pair("pendulum_chain_adaptive", "t - 0.3"),
        std::pair("rolling_disk", "x")}) {
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
  expect_resumable("run " + with("kepler_order_8", apsides) + " --set output.checkpoint=50", 183, 400);
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
}  // namespace lagroid::scene_tests::events_tests
