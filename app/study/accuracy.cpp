#include "accuracy.hpp"

#include <lagroid/run/study/measure.hpp>
#include <lagroid/run/study/methods.hpp>
#include "../scenes/scene_keys.hpp"
#include "scene_experiment.hpp"

#include <lagroid/run/reports/clock.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

constexpr double margin = 0.7;  // what is aimed at, over what is asked: estimates are estimates

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Goal {
  double target = 0;
  double pilot = 0;
  std::string methods;
};

Goal read_goal(const Section& scene) {
  const Section accuracy = scene.section("accuracy", "the target");
  Goal goal;
  goal.target = read_key(accuracy, accuracy_keys::target);
  goal.pilot = read_key(accuracy, accuracy_keys::pilot);
  goal.methods = read_key_or(accuracy, accuracy_keys::methods, "");
  accuracy.finish();
  const Section time = scene.section("time", "duration");
  for (const char* key : {"mode", "method", "form", "order", "composition", "tolerance", "accuracy", "without_root"})
    if (time.has(key)) time.fail(key, "accuracy.target chooses the method and the step; leave one of them out");
  return goal;
}

/// Nodes of a method that goes by a tolerance, and the least of these.
constexpr long tolerance_nodes = 100;
constexpr double least_tolerance = 1e-15;

constexpr std::string_view tolerance_setting = "time.tolerance=";

bool by_tolerance(const Method& method) {
  return std::any_of(method.settings.begin(), method.settings.end(),
                     [](const std::string& each) { return each.starts_with(tolerance_setting); });
}

/// A method with a step, or one that goes by a tolerance with that.
struct Candidate {
  Method method;
  bool tolerance = false;

  /// The order of errors in what is set, and of the time in its inverse.
  double order() const { return tolerance ? 1 : method.order; }
  double work() const { return tolerance ? 1.0 / method.order : 1; }
  /// What is tried next, and by how much the error then falls.
  double finer(double setting) const { return tolerance ? 0.1 * setting : 0.5 * setting; }
  double gain() const { return tolerance ? 10 : std::pow(2.0, method.order); }

  Method at(double setting) const {
    Method out = method;
    if (!tolerance) return out;
    for (std::string& each : out.settings)
      if (each.starts_with(tolerance_setting)) each = fmt::format("{}{:.3g}", tolerance_setting, setting);
    out.name = out.name.substr(0, out.name.find('/'));
    return out;
  }
  long steps(double setting, double end) const {
    return tolerance ? tolerance_nodes : std::max(2L, long(std::ceil(end / setting * (1 - 1e-12))));
  }
  std::optional<Reached> reach(const Experiment& experiment, double setting, double end) const {
    return lagroid::reach(experiment, at(setting), end, steps(setting, end));
  }
  /// The error with this setting, by that with a finer one; NaN where there is none.
  double error_of(const Experiment& experiment, double setting, double end) const {
    const auto coarse = reach(experiment, setting, end);
    const auto fine = reach(experiment, finer(setting), end);
    if (!coarse || !fine) return std::numeric_limits<double>::quiet_NaN();
    return distance(coarse->state, fine->state) * gain() / (gain() - 1);
  }
  std::string told(double setting, double end) const {
    if (tolerance) return fmt::format("{} with a tolerance of {:.3g}", at(setting).name, setting);
    return fmt::format("{} with {} steps of {:.4g}", method.name, steps(setting, end),
                       end / double(steps(setting, end)));
  }
};

/// A method's error over a part of the motion, as it was found: e = error (set / setting)^order.
struct Found : Candidate {
  double setting = 0;  ///< a step, or a tolerance
  double error = 0;
  double seconds = 0;  ///< for a unit of time

  double setting_for(double wanted) const {
    // Never beyond what was tried: above it the law of the error need not hold.
    return setting * std::min(1.0, std::pow(wanted / error, 1.0 / order()));
  }
  /// Infinite where round-off is in the way.
  double cost(double wanted, double end) const {
    const double needed = setting_for(wanted);
    if (tolerance && needed < least_tolerance) return std::numeric_limits<double>::infinity();
    return end * seconds * std::pow(setting / needed, work());
  }
};

/// Whether two runs agree on how large the motion is: an error relative to that of a run gone astray says nothing.
bool agree_on_sizes(const std::vector<NamedVector>& a, const std::vector<NamedVector>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(a[i].size - b[i].size) > 0.1 * b[i].size) return false;
  return true;
}

/// Halves the step of the method until its error over the time `end` is below `wanted`, or a run takes over `longest`.
std::optional<Found> halve(const Experiment& experiment, const Method& method, double end, double wanted,
                           double longest) {
  constexpr long first = 4;
  const double gain = std::pow(2.0, method.order);
  std::optional<Reached> coarse;
  std::optional<double> last;
  const auto start = std::chrono::steady_clock::now();
  for (long steps = first; seconds_since(start) < 4 * longest; steps *= 2) {
    auto fine = reach(experiment, method, end, steps);
    if (fine && coarse && agree_on_sizes(coarse->state, fine->state)) {
      const double error = distance(coarse->state, fine->state) * gain / (gain - 1);
      // The error must fall as its order says, or be round-off: two coarse runs may agree by chance.
      const bool exact = error < 1e-12;
      if (last && error <= wanted && (exact || (error < *last && *last < 4 * gain * error)))
        return Found{{method}, 2 * end / double(steps), error, coarse->seconds / end};
      if (last && error < 1e-9 && error > 0.5 * *last) return std::nullopt;  // no more to be gained
      last = error;
    }
    if (fine && fine->seconds > longest) return std::nullopt;
    coarse = std::move(fine);
  }
  return std::nullopt;
}

/// Lowers the tolerance of the method tenfold until its error over the time `end` is below `wanted`, and falls, or a
/// run takes over `longest`.
std::optional<Found> tighten(const Experiment& experiment, const Method& method, double end, double wanted,
                             double longest) {
  const Candidate candidate{method, true};
  std::optional<Reached> loose;
  std::optional<double> last;
  const auto start = std::chrono::steady_clock::now();
  for (double tolerance = 1e-3; tolerance > least_tolerance && seconds_since(start) < 4 * longest;
       tolerance = candidate.finer(tolerance)) {
    auto tight = candidate.reach(experiment, tolerance, end);
    if (tight && loose && agree_on_sizes(loose->state, tight->state)) {
      const double error = distance(loose->state, tight->state) * candidate.gain() / (candidate.gain() - 1);
      if (last && error <= wanted && (error < 1e-12 || error < *last))
        return Found{candidate, 10 * tolerance, std::max(error, 1e-300), loose->seconds / end};
      last = error;
    }
    if (tight && tight->seconds > longest) return std::nullopt;
    loose = std::move(tight);
  }
  return std::nullopt;
}

/// How the error grew over the second half: e ~ t^power. None where that cannot be told.
std::optional<double> growth(const Experiment& experiment, const Found& found, double end) {
  const double power =
      std::log2(found.error_of(experiment, found.setting, end) / found.error_of(experiment, found.setting, 0.5 * end));
  constexpr double most = 6;  // beyond that it is no power
  if (!std::isfinite(power) || power > most) return std::nullopt;
  return std::max(power, 1.0);
}

/// What `methods` of the goal leave: those with equal steps, and of each that goes by a tolerance one.
std::vector<Candidate> candidates(const std::vector<Method>& methods) {
  std::vector<Candidate> out;
  for (const Method& each : methods) {
    if (each.to_compare || (!each.equal_steps && !by_tolerance(each))) continue;
    const Candidate candidate{each, by_tolerance(each)};
    const auto same = [&](const Candidate& known) {
      return candidate.tolerance && known.at(1).name == candidate.at(1).name;
    };
    if (std::none_of(out.begin(), out.end(), same)) out.push_back(candidate);
  }
  return out;
}

const Found& cheapest(const std::vector<Found>& all, double wanted, double end) {
  return *std::min_element(all.begin(), all.end(),
                           [&](const Found& a, const Found& b) { return a.cost(wanted, end) < b.cost(wanted, end); });
}

}  // namespace

void check_accuracy(const Section& scene) { read_goal(scene); }

AccuracyChoice choose_by_accuracy(const Section& scene) {
  const Goal goal = read_goal(scene);
  const auto start = std::chrono::steady_clock::now();
  const bool only_duration = scene.section("time", "").has("duration") && !scene.section("time", "").has("steps");
  const Section timed = only_duration ? scene.set({"time.steps=1000"}) : scene;
  const Experiment experiment = read_experiment(timed);
  std::vector<Candidate> methods;
  try {
    methods = candidates(matching(goal.methods, experiment.methods));
  } catch (const UnknownMethod& error) {
    scene.section("accuracy", "").fail("methods", error.what());
  }
  if (methods.empty())
    scene.section("accuracy", "")
        .fail("methods", "leave no method with equal steps, and none that goes by a tolerance");
  const double longest = goal.pilot / (4 * double(methods.size()));
  double share = 1;
  std::vector<Found> found;
  double end = experiment.end;
  for (; share > 1e-7; share *= 0.1) {
    end = share * experiment.end;
    for (const Candidate& each : methods)
      if (auto reached =
              (each.tolerance ? tighten : halve)(experiment, each.method, end, margin * goal.target * share, longest))
        found.push_back(std::move(*reached));
    if (!found.empty()) break;
  }
  const auto give_up = [&] {
    scene.section("accuracy", "")
        .fail("target", fmt::format("{:g} at t = {:g} is not reached by any method within the pilot's time: ask for "
                                    "less, for a shorter duration, give pilot more seconds, or look at lagroid study",
                                    goal.target, experiment.end));
  };
  if (found.empty()) give_up();
  const auto at_part = [&](const Found& a, const Found& b) {
    return a.cost(margin * goal.target * share, end) < b.cost(margin * goal.target * share, end);
  };
  std::sort(found.begin(), found.end(), at_part);
  std::optional<double> grown;
  if (share == 1) grown = 1;
  for (auto each = found.begin(); !grown && each != found.end(); ++each) grown = growth(experiment, *each, end);
  if (!grown) give_up();
  const double power = *grown;
  const auto wanted = [&](double target) { return margin * target * std::pow(share, power); };
  const Found& best = cheapest(found, wanted(goal.target), experiment.end);
  double cost = best.cost(wanted(goal.target), experiment.end);
  if (!std::isfinite(cost)) give_up();
  double setting = best.setting_for(wanted(goal.target));
  // What was found over a part is tried over the whole, where there is time for that.
  bool verified = share == 1;
  while (!verified && 3 * cost < 2 * goal.pilot) {
    verified = best.error_of(experiment, setting, experiment.end) <= goal.target;
    if (verified) break;
    cost *= std::pow(setting / best.finer(setting), best.work());
    setting = best.finer(setting);
    const bool too_long = 3 * cost >= 2 * goal.pilot || seconds_since(start) > 4 * goal.pilot;
    if (too_long || (best.tolerance && setting < least_tolerance)) give_up();
  }
  const long steps = best.steps(setting, experiment.end);
  const Found& better = cheapest(found, wanted(0.1 * goal.target), experiment.end);

  AccuracyChoice choice;
  choice.scene = with_method(without_method(timed), best.at(setting), experiment.end / double(steps), experiment.end);
  choice.notes.push_back(fmt::format("accuracy: for an error of {:.2g} at t = {:g}, {}; to integrate costs about {}",
                                     goal.target, experiment.end, best.told(setting, experiment.end), duration(cost)));
  const double better_cost = better.cost(wanted(0.1 * goal.target), experiment.end);
  choice.notes.push_back(std::isfinite(better_cost)
                             ? fmt::format("accuracy: ten times better would cost about {}, by {}",
                                           duration(better_cost),
                                           better.told(better.setting_for(wanted(0.1 * goal.target)), experiment.end))
                             : "accuracy: ten times better is beyond round-off");
  const std::string took = duration(seconds_since(start));
  if (share == 1)
    choice.notes.push_back(
        fmt::format("accuracy: chosen in {} by runs over the whole duration, of {} methods that reached "
                    "it",
                    took, found.size()));
  else
    choice.notes.push_back(
        fmt::format("accuracy: chosen in {} by runs over {:.2g} of the duration, where the error grew "
                    "as t^{:.2g}; {}",
                    took, share, power,
                    verified ? "verified over the whole of it"
                             : "NOT VERIFIED over the whole of it: give accuracy.pilot more seconds"));
  return choice;
}

}  // namespace lagroid::app
