// Events against reference numbers: passages of Kepler's problem, a Henon-Heiles section, close encounters.
#include "orbits.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <numbers>
#include <tuple>

using namespace lagroid;

namespace events_references_tests {
namespace {

using Json = nlohmann::json;

double number(const Json& text) { return std::stod(text.get<std::string>()); }

std::vector<double> numbers(const Json& texts) {
  std::vector<double> out;
  for (const Json& each : texts) out.push_back(number(each));
  return out;
}

Json reference(const std::string& id) {
  std::ifstream file(std::string(LAGROID_TEST_DATA) + "/events.json");
  const Json all = Json::parse(file);
  for (const Json& each : all.at("cases"))
    if (each.at("id") == id) return each;
  throw std::invalid_argument(id);
}

void expect_times(const std::vector<double>& found, const std::vector<double>& wanted, double relative) {
  ASSERT_GE(found.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found[i], wanted[i], relative * wanted[i]) << i;
}

TEST(EventReferences, KeplerPassesItsApsides) {
  for (const char* id : {"A9-kepler-e0.7", "A9-kepler-e0.7-from-apo"}) {
    SCOPED_TRACE(id);
    const Json wanted = reference(id);
    const auto q = numbers(wanted["initial"]["q"]), v = numbers(wanted["initial"]["v"]);
    Orbit system;
    const double period = 2 * std::numbers::pi;
    system.h = period / 500;
    const long steps = std::lround(10.02 * period / system.h);
    const std::string turning = "q1*mu1 + q2*mu2", away = "sqrt(q1^2 + q2^2) - 1";
    using enum Event::Direction;
    Event nearest{"nearest", "sqrt(q1^2 + q2^2)"};
    nearest.at = Event::At::minimum;
    const RunResult result = run_split(
        system, {{q[0], q[1]}, {v[0], v[1]}}, compositions::kahan_li_8,
        {.steps = steps,
         .events = {event_at_zero("pericentre", turning, rising), event_at_zero("apocentre", turning, falling),
                    event_at_zero("outward", away, rising), event_at_zero("inward", away, falling), nearest}});
    ASSERT_TRUE(result.converged()) << result.message;
    const Json& there = wanted["results"];
    const auto pericentres = numbers(there["pericentre_times"]), apocentres = numbers(there["apocentre_times"]);
    EXPECT_EQ(times_of(result, "pericentre").size(), pericentres.size());
    EXPECT_EQ(times_of(result, "apocentre").size(), apocentres.size());
    expect_times(times_of(result, "pericentre"), pericentres, 1e-12);
    expect_times(times_of(result, "apocentre"), apocentres, 1e-12);
    expect_times(times_of(result, "outward"), numbers(there["times_r_equals_a_outward"]), 1e-12);
    expect_times(times_of(result, "inward"), numbers(there["times_r_equals_a_inward"]), 1e-12);
    expect_times(times_of(result, "nearest"), pericentres, 1e-9);
    for (const Happening& row : result.events.rows) {
      const double r = std::hypot(row.values[0], row.values[1]);
      const std::string& name = result.events.watched[row.event].name;
      if (name == "pericentre" || name == "nearest") {
        EXPECT_NEAR(r, number(there["r_peri"]), 1e-12);
      }
      if (name == "apocentre") {
        EXPECT_NEAR(r, number(there["r_apo"]), 1e-12);
      }
    }
  }
}

TEST(EventReferences, HenonHeilesCrossesItsSection) {
  for (const char* id : {"A9-henonheiles-a", "A9-henonheiles-b"}) {
    SCOPED_TRACE(id);
    const Json wanted = reference(id);
    const Json& start = wanted["initial"];
    HenonHeiles system;
    system.h = 0.02;
    Event section = event_at_zero("section", "q1", Event::Direction::rising);
    section.then = Event::Then::stop;
    section.count = 20;
    const RunResult result = run_split(system, {{0, number(start["y"])}, {number(start["px"]), number(start["py"])}},
                                       compositions::kahan_li_8, {.steps = 10000, .events = {section}});
    ASSERT_TRUE(result.converged()) << result.message;
    const Json& crossings = wanted["results"]["crossings"];
    ASSERT_EQ(result.events.rows.size(), crossings.size());  // the start is not counted
    // An error at the start grows along the second of them by 1e4.
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      const Happening& row = result.events.rows[i];
      EXPECT_NEAR(row.time, number(crossings[i]["t"]), 1e-9) << i;
      EXPECT_NEAR(row.values[0], 0, 1e-14) << i;
      EXPECT_NEAR(row.values[1], number(crossings[i]["y"]), 1e-9) << i;
      EXPECT_NEAR(row.values[3], number(crossings[i]["py"]), 1e-9) << i;
    }
    EXPECT_EQ(result.final.time, result.events.rows.back().time);
    EXPECT_EQ(result.trajectory.time.back(), result.events.rows.back().time);
  }
}

/// Distance of two of the points, "i-j", less `radius`.
std::string distance(const ThreePoints& system, const std::string& pair, double radius) {
  const int i = pair[0] - '1', j = pair[2] - '1';
  const auto across = [&](int axis) {
    return fmt::format("(q{}/{:.17g} - q{}/{:.17g})^2", 2 * i + axis, std::sqrt(system.masses(i)), 2 * j + axis,
                       std::sqrt(system.masses(j)));
  };
  return fmt::format("sqrt({} + {}) - {}", across(1), across(2), radius);
}

TEST(EventReferences, ThreeBodiesMeetClosely) {
  // Two light planets that meet make the steps of transformed time no shorter: theirs are equal.
  for (const auto& [id, h, is_transformed] :
       {std::tuple("A9-pythagorean", 0.004, true), std::tuple("A9-star-two-planets", 7e-5, false)}) {
    SCOPED_TRACE(id);
    const Json wanted = reference(id);
    ThreePoints system;
    State<Pair<6>> start;
    for (int i = 0; i < 3; ++i) {
      const double root = std::sqrt(number(wanted["params"]["m"][std::size_t(i)]));
      system.masses(i) = number(wanted["params"]["m"][std::size_t(i)]);
      for (int axis = 0; axis < 2; ++axis) {
        start.object(2 * i + axis) = root * number(wanted["initial"]["x"][std::size_t(i)][std::size_t(axis)]);
        start.momentum(2 * i + axis) = root * number(wanted["initial"]["v"][std::size_t(i)][std::size_t(axis)]);
      }
    }
    system.h = h;
    const double radius = number(wanted["params"]["r_c"]), until = number(wanted["params"]["T"]);
    std::vector<Event> events;
    for (const char* pair : {"1-2", "1-3", "2-3"}) {
      const std::string apart = distance(system, pair, radius);
      events.push_back(event_at_zero(std::string(pair) + " enter", apart, Event::Direction::falling));
      events.push_back(event_at_zero(std::string(pair) + " leave", apart, Event::Direction::rising));
      events.push_back({std::string(pair) + " minimum", apart});
      events.back().at = Event::At::minimum;
    }
    events.push_back(event_at_zero("end", fmt::format("t - {}", until)));
    events.back().then = Event::Then::stop;
    const RunOptions<ThreePoints> options{.steps = 1'000'000, .every = 1000, .events = events};
    const RunResult result = is_transformed ? run_transformed(system, start, compositions::kahan_li_8, options)
                                            : run_split(system, start, compositions::kahan_li_8, options);
    ASSERT_TRUE(result.converged()) << result.message;
    std::vector<Happening> near;  // minima farther apart are no encounters
    for (const Happening& row : result.events.rows) {
      const std::string& name = result.events.watched[row.event].name;
      if (name == "end") continue;
      const int i = name[0] - '1', j = name[2] - '1';
      const auto place = [&](int k) -> Vector<double, 2> {
        return Vector<double, 2>(row.values[std::size_t(2 * k)], row.values[std::size_t(2 * k + 1)]) /
               std::sqrt(system.masses(k));
      };
      if (!name.ends_with("minimum") || (place(i) - place(j)).norm() < radius) near.push_back(row);
    }
    const Json& there = wanted["results"]["events"];
    ASSERT_EQ(near.size(), there.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
      EXPECT_EQ(result.events.watched[near[i].event].name,
                there[i]["pair"].get<std::string>() + " " + there[i]["kind"].get<std::string>());
      EXPECT_NEAR(near[i].time, number(there[i]["t"]), 1e-9) << i;
    }
    EXPECT_NEAR(result.final.time, until, 1e-12);
  }
}

}  // namespace
}  // namespace events_references_tests
