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
#include <map>
#include <optional>

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

/// A method's error over a part of the motion, as it was found: e(h) = error (h / step)^p.
struct Found {
  Method method;
  double step = 0;
  double error = 0;
  double step_seconds = 0;

  double step_for(double wanted) const {
    // Never beyond what was tried: above it the law of the error need not hold.
    return step * std::min(1.0, std::pow(wanted / error, 1.0 / method.order));
  }
  double cost(double wanted, double end) const { return end / step_for(wanted) * step_seconds; }
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
        return Found{method, 2 * end / double(steps), error, coarse->seconds / (double(steps) / 2)};
      if (last && error < 1e-9 && error > 0.5 * *last) return std::nullopt;  // no more to be gained
      last = error;
    }
    if (fine && fine->seconds > longest) return std::nullopt;
    coarse = std::move(fine);
  }
  return std::nullopt;
}

/// How the error grew over the second half: e ~ t^power. None where that cannot be told.
std::optional<double> growth(const Experiment& experiment, const Found& found, double end) {
  const long steps = 2 * std::max(2L, std::lround(0.5 * end / found.step));
  const auto error = [&](double until, long n) {
    const auto coarse = reach(experiment, found.method, until, n);
    const auto fine = reach(experiment, found.method, until, 2 * n);
    return coarse && fine ? distance(coarse->state, fine->state) : std::numeric_limits<double>::quiet_NaN();
  };
  const double power = std::log2(error(end, steps) / error(0.5 * end, steps / 2));
  constexpr double most = 6;  // beyond that it is no power
  if (!std::isfinite(power) || power > most) return std::nullopt;
  return std::max(power, 1.0);
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
  std::vector<Method> methods;
  try {
    methods = matching(goal.methods, experiment.methods);
  } catch (const UnknownMethod& error) {
    scene.section("accuracy", "").fail("methods", error.what());
  }
  std::erase_if(methods, [](const Method& m) { return !m.equal_steps || m.to_compare; });
  if (methods.empty()) scene.section("accuracy", "").fail("methods", "leave no method with equal steps");
  const double longest = goal.pilot / (4 * double(methods.size()));
  double share = 1;
  std::vector<Found> found;
  double end = experiment.end;
  for (; share > 1e-7; share *= 0.1) {
    end = share * experiment.end;
    for (const Method& method : methods)
      if (auto each = halve(experiment, method, end, margin * goal.target * share, longest))
        found.push_back(std::move(*each));
    if (!found.empty()) break;
  }
  const auto give_up = [&] {
    scene.section("accuracy", "")
        .fail("target", fmt::format("{:g} at t = {:g} is not reached by any method within the pilot's time: ask for "
                                    "less, for a shorter duration, give pilot more seconds, or look at lagroid study",
                                    goal.target, experiment.end));
  };
  if (found.empty()) give_up();
  const auto grown = share < 1 ? growth(experiment, cheapest(found, margin * goal.target * share, end), end)
                               : std::optional<double>(1);
  if (!grown) give_up();
  const double power = *grown;
  const auto wanted = [&](double target) { return margin * target * std::pow(share, power); };
  const Found& best = cheapest(found, wanted(goal.target), experiment.end);
  long steps = long(std::ceil(experiment.end / best.step_for(wanted(goal.target))));
  // What was found over a part is tried over the whole, where there is time for that.
  bool verified = share == 1;
  double cost = double(steps) * best.step_seconds;
  while (!verified && 3 * cost < 2 * goal.pilot) {
    const auto coarse = reach(experiment, best.method, experiment.end, steps);
    const auto fine = reach(experiment, best.method, experiment.end, 2 * steps);
    verified = coarse && fine && distance(coarse->state, fine->state) <= goal.target;
    if (verified) break;
    steps *= 2;
    cost *= 2;
    if (3 * cost >= 2 * goal.pilot) give_up();
  }
  const double h = experiment.end / double(steps);
  const Found& better = cheapest(found, wanted(0.1 * goal.target), experiment.end);

  AccuracyChoice choice;
  choice.scene = with_method(without_method(timed), best.method, h, experiment.end);
  choice.notes.push_back(
      fmt::format("accuracy: for an error of {:.2g} at t = {:g}, {} with {} steps of {:.4g}; to integrate "
                  "costs about {}",
                  goal.target, experiment.end, best.method.name, steps, h, duration(cost)));
  choice.notes.push_back(fmt::format("accuracy: ten times better would cost about {}, by {} with steps of {:.4g}",
                                     duration(better.cost(wanted(0.1 * goal.target), experiment.end)),
                                     better.method.name, better.step_for(wanted(0.1 * goal.target))));
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
