// What is drawn of a run: of how much, over which numbers, and that rotation is among it.

#include "../app/command_line.hpp"

#include <lagroid/run/reports/curves.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

using namespace lagroid;

namespace run_pictures_tests {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

Trajectory trajectory(std::size_t nodes, const std::vector<std::pair<std::string, double (*)(double)>>& columns) {
  Trajectory out;
  for (std::size_t k = 0; k < nodes; ++k) out.time.push_back(double(k) / double(nodes - 1));
  for (const auto& [label, f] : columns) {
    Columns s{label, {label}, "1", "", false, {}};
    for (const double t : out.time) s.values.push_back(f(t));
    out.series.push_back(std::move(s));
  }
  return out;
}

std::size_t rows_of(const std::vector<Stroke>& strokes) {
  std::size_t rows = 0;
  for (const Stroke& stroke : strokes) rows += stroke.size();
  return rows;
}

TEST(Curves, OverTimeKeepTheirSpikesAndEnds) {
  constexpr std::size_t nodes = 1'500'000;
  Trajectory run =
      trajectory(nodes, {{"wave", [](double t) { return std::sin(500 * t); }}, {"flat", [](double) { return 3.0; }}});
  constexpr std::size_t spike = 777'777;
  run.series[1].values[spike] = -20;
  const auto strokes = visible_strokes({"", "t", "", "t", {"wave", "flat"}}, run);
  ASSERT_EQ(strokes.size(), 1U);
  const Stroke& rows = strokes.front();
  EXPECT_LE(rows.size(), 2U * 2U * 1000U + 2U);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
  EXPECT_EQ(rows.front(), 0U);
  EXPECT_EQ(rows.back(), nodes - 1);
  EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), spike));
  // In every column of pixels the line reaches as high and as low as all points do.
  for (int part = 0; part < 1000; part += 37) {
    const auto inside = [&](std::size_t row) { return std::floor(run.time[row] * 1000) == part; };
    double greatest = -1, shown = -1;
    for (std::size_t row = 0; row < nodes; ++row)
      if (inside(row)) greatest = std::max(greatest, run.series[0].values[row]);
    for (const std::size_t row : rows)
      if (inside(row)) shown = std::max(shown, run.series[0].values[row]);
    EXPECT_EQ(shown, greatest) << part;
  }
}

TEST(Curves, OfFewRowsAreWhole) {
  const Trajectory run = trajectory(50, {{"y", [](double t) { return std::exp(t); }}});
  EXPECT_EQ(rows_of(visible_strokes({"", "t", "", "t", {"y"}}, run)), 50U);
}

TEST(Curves, OfArrowsBeginAtTheSecondNode) {
  Trajectory run = trajectory(5, {});
  run.series.push_back({"u", {"u"}, "1", "", true, {1, 2, 3, 4}});
  const std::string table = table_of_visible({{"", "t", "", "t", {"u"}}}, run);
  EXPECT_NE(table.find("\n0,nan\n0.25,1\n"), std::string::npos) << table;
}

/// An orbit run through 1000 times, which then leaves it: one turn and the way out are drawn, and no chord between.
TEST(Curves, InThePlaneAreDrawnOnce) {
  const auto angle = [](double t) { return full_turn * 1000 * std::min(t, 0.9); };
  static constexpr auto out = [](double t) { return 1 + std::max(0.0, t - 0.9); };
  static const auto turn = angle;
  const Trajectory run = trajectory(1'500'001, {{"x", [](double t) { return out(t) * std::cos(turn(t)); }},
                                                {"y", [](double t) { return out(t) * std::sin(turn(t)); }}});
  const auto strokes = visible_strokes({"", "x", "y", "x", {"y"}}, run);
  EXPECT_LT(rows_of(strokes), 8000U);
  const auto& x = run.series[0].values;
  const auto& y = run.series[1].values;
  constexpr int sectors = 360;
  std::set<int> seen;
  double farthest = 0;
  for (const Stroke& stroke : strokes)
    for (std::size_t i = 1; i < stroke.size(); ++i) {
      const double mx = 0.5 * (x[stroke[i]] + x[stroke[i - 1]]);
      const double my = 0.5 * (y[stroke[i]] + y[stroke[i - 1]]);
      const bool on_the_way_out = run.time[stroke[i]] > 0.9;
      if (!on_the_way_out) {
        EXPECT_NEAR(std::hypot(mx, my), 1, 0.005) << "a chord that nothing moved along";
      }
      seen.insert(int((std::atan2(my, mx) / full_turn + 0.5) * sectors));
      farthest = std::max(farthest, std::hypot(mx, my));
    }
  EXPECT_GE(seen.size(), std::size_t(sectors));
  EXPECT_NEAR(farthest, 1.1, 0.01) << "the end, but for a place of 1 / 400 of the picture";
}

TEST(Curves, AreABlockForEachPanel) {
  const Trajectory run = trajectory(
      30'000, {{"x", [](double t) { return std::cos(40 * t); }}, {"y", [](double t) { return std::sin(40 * t); }}});
  const std::string table = table_of_visible({{"", "t", "", "t", {"x", "y"}}, {"", "x", "y", "x", {"y"}, true}}, run);
  const auto second = table.find("\n\n\n# x,y\n");
  ASSERT_EQ(table.find("# t,x,y\n"), 0U);
  ASSERT_NE(second, std::string::npos);
  EXPECT_EQ(table.find("\n\n"), second) << "over time a line is not lifted";
  EXPECT_LT(table.size(), 300'000U);
}

double offset(double (*y)(double)) {
  Panel panel{"", "t", "y", "t", {"y"}};
  take_offsets(panel, trajectory(100, {{"y", y}}));
  EXPECT_EQ(panel.x_offset, 0);
  return panel.y_offset;
}

TEST(Axes, ShowNumbersThatAreNearlyAlikeLessOneOfThem) {
  EXPECT_EQ(offset([](double t) { return 0.8 + 1e-9 * std::sin(10 * t); }), 0.8);
  EXPECT_EQ(offset([](double t) { return -0.8 - 1e-4 * t; }), -0.8);
  EXPECT_NEAR(offset([](double t) { return 1234567 + t; }), 1234567, 1);
  EXPECT_NEAR(offset([](double t) { return 0.1 + (t > 0.5 ? 1e-17 : 0.0); }), 0, 0.1);
  EXPECT_EQ(offset([](double t) { return t; }), 0);
  EXPECT_EQ(offset([](double t) { return 0.8 + 0.01 * t; }), 0);
  EXPECT_EQ(offset([](double) { return 0.8; }), 0) << "a constant has labels enough";
  EXPECT_EQ(label_of("z", 0), "z");
  EXPECT_EQ(label_of("z", 0.8), "z - 0.8");
  EXPECT_EQ(label_of("z", -2.5), "z + 2.5");
}

class Pictures : public CommandLine {
 protected:
  nlohmann::json panels(const std::string& scene, const std::string& more = "") {
    const Outcome r = run("run " + example(scene) + " --json " + more);
    return nlohmann::json::parse(r.out).at("picture").at("panels");
  }
  static std::set<std::string> curves(const nlohmann::json& panels) {
    std::set<std::string> out;
    for (const auto& panel : panels)
      for (const auto& curve : panel.at("curves")) out.insert(curve.get<std::string>());
    return out;
  }
};

/// Attitude (or angle), angular velocity and momentum of what turns.
TEST_F(Pictures, ShowWhatTurns) {
  const std::set<std::string> body{"A_w", "A_x", "A_y", "A_z", "w1", "w2", "w3", "M1", "M2", "M3"};
  const auto of = [&](const std::string& name) {
    std::set<std::string> out;
    for (const std::string& column : body) out.insert(name + "." + column);
    return out;
  };
  const std::pair<const char*, std::set<std::string>> shown[] = {
      {"rigid_body", body},
      {"rigid_body_moser_veselov", body},
      {"heavy_top", body},
      {"driven_body", body},
      {"attitude_control", body},
      {"plate_ball_initial_value", body},
      {"rolling_ball", {"A_w", "A_x", "A_y", "A_z", "w1", "w2", "w3"}},
      {"rolling_disk", {"heading", "roll", "w", "s"}},
      {"unicycle", {"heading", "w"}},
      {"chaplygin_sleigh", {"heading", "w"}},
      {"pendulum_chain", {"w3x", "w3y", "w3z"}},
      {"tops", of("free")},
      {"tumbling_book", of("book")},
  };
  for (const auto& [scene, wanted] : shown) {
    const auto drawn = curves(panels(scene, "--set time.steps=20"));
    for (const std::string& column : wanted) EXPECT_TRUE(drawn.contains(column)) << scene << ": " << column;
  }
  const auto bars = curves(panels("steering", "--set time.steps=5"));
  const auto has = [&](const std::string& what) {
    return std::any_of(bars.begin(), bars.end(), [&](const std::string& column) { return column.ends_with(what); });
  };
  EXPECT_TRUE(has(".angle") && has(".w") && has(".L"));
  EXPECT_FALSE(has(".z")) << "nothing leaves the plane";
  EXPECT_FALSE(curves(panels("tops", "--set time.steps=5")).contains("free.x")) << "a pivot does not move";
}

std::vector<std::vector<double>> read_csv(const fs::path& file, const std::vector<std::string>& labels) {
  std::ifstream in(file);
  std::string line, cell;
  std::getline(in, line);
  std::vector<std::string> header;
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) header.push_back(cell);
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line)) {
    std::vector<std::string> row;
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) row.push_back(cell);
    rows.emplace_back();
    for (const std::string& label : labels) {
      const auto at = std::find(header.begin(), header.end(), label) - header.begin();
      rows.back().push_back(std::stod(row.at(std::size_t(at))));
    }
  }
  return rows;
}

TEST_F(Pictures, AttitudesDoNotJumpAndVelocitiesAreMomentaOverInertia) {
  const fs::path out = folder_ / "body";
  ASSERT_EQ(run("run " + example("rigid_body") + " --out " + out.string()).code, 0);
  const auto rows = read_csv(out / "trajectory.csv", {"A_w", "A_x", "A_y", "A_z", "M1", "w1", "M3", "w3"});
  int negative = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    double dot = 0;
    for (std::size_t i = 0; i < 4; ++i) dot += rows[k][i] * rows[k - 1][i];
    ASSERT_GT(dot, 0.9) << "row " << k;
    negative += rows[k][0] < 0 ? 1 : 0;
    ASSERT_NEAR(rows[k][4] / rows[k][5], rows[1][4] / rows[1][5], 1e-9);
  }
  EXPECT_GT(negative, 0) << "the body turns by more than a half: the shorter quaternion would have jumped";
  const fs::path tops = folder_ / "tops";
  ASSERT_EQ(run("run " + example("tops") + " --set time.steps=100 --out " + tops.string()).code, 0);
  for (const auto& row : read_csv(tops / "trajectory.csv", {"free.M3", "free.w3", "free.M1", "free.w1"})) {
    EXPECT_NEAR(row[0], 0.1 * row[1], 1e-12);
    EXPECT_NEAR(row[2], 0.3 * row[3], 1e-12);
  }
}

TEST_F(Pictures, OfLongRunsAreDrawnFromWhatCanBeSeen) {
  const fs::path out = folder_ / "long";
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=30000 --out " + out.string()).code, 0);
  ASSERT_TRUE(fs::exists(out / "plot.svg"));
  EXPECT_LT(fs::file_size(out / "plot.csv"), fs::file_size(out / "trajectory.csv") / 10);
  EXPECT_EQ(run("plot " + out.string()).code, 0);
  // A short one is drawn from its data itself.
  const fs::path brief = folder_ / "brief";
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=300 --out " + brief.string()).code, 0);
  ASSERT_TRUE(fs::exists(brief / "plot.svg"));
  EXPECT_FALSE(fs::exists(brief / "plot.csv"));
}

}  // namespace
}  // namespace run_pictures_tests
