#include "accuracy.hpp"

#include "experiment.hpp"
#include "measure.hpp"
#include "methods.hpp"

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
  goal.target = accuracy.number("target", {"between 1e-14 and 0.5", [](double x) { return x >= 1e-14 && x <= 0.5; }});
  goal.pilot =
      accuracy.number_or("pilot", 2, {"between 0.01 and 100000", [](double x) { return x >= 0.01 && x <= 1e5; }});
  if (accuracy.has("methods"))
    goal.methods = accuracy.text("methods", "patterns of names, as lagroid study takes them");
  accuracy.finish();
  const Section time = scene.section("time", "duration");
  for (const char* key : {"mode", "method", "order", "composition", "accuracy", "without_root"})
    if (time.has(key)) time.fail(key, "accuracy.target chooses the method and the step; leave one of them out");
  return goal;
}

/// The end state after `steps` equal steps and what it took.
struct End {
  std::vector<Block> state;
  double seconds = 0;
};
std::optional<End> run_to(const Experiment& experiment, const Method& method, double end, long steps) {
  Experiment until = experiment;
  until.end = end;
  try {
    const auto trial = until.begin(method, end / double(steps));
    Work work;
    const auto start = std::chrono::steady_clock::now();
    if (!trial->run(end, work).converged()) return std::nullopt;
    return End{trial->see().state, seconds_since(start)};
  } catch (const SceneError&) {
    return std::nullopt;
  }
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

/// Halves the step of the method until its error over the time `end` is below `wanted`, or a run takes over `longest`.
std::optional<Found> halve(const Experiment& experiment, const Method& method, double end, double wanted,
                           const std::vector<double>& sizes, double longest) {
  constexpr long first = 4;
  std::optional<End> coarse;
  std::optional<double> last;
  for (long steps = first; steps < (1L << 40); steps *= 2) {
    const auto fine = run_to(experiment, method, end, steps);
    if (fine && coarse) {
      auto state = fine->state;
      set_sizes(state, sizes);
      const double gain = std::pow(2.0, method.order);
      const double error = distance(coarse->state, state) * gain / (gain - 1);
      // The error must fall as its order says, or be round-off: two coarse runs may agree by chance.
      const bool exact = error < 1e-12;
      if (last && error <= wanted && (exact || (error < *last && *last < 4 * gain * error)))
        return Found{method, 2 * end / double(steps), error, coarse->seconds / (double(steps) / 2)};
      if (last && error < 1e-9 && error > 0.5 * *last) return std::nullopt;  // no more to be gained
      last = error;
    }
    if (fine && fine->seconds > longest) return std::nullopt;
    coarse = fine;
  }
  return std::nullopt;
}

/// The largest norms of the blocks along a run that need not be accurate.
std::vector<double> sizes_of_motion(const Experiment& experiment, const Method& method, double end) {
  for (long steps = 64; steps <= (1L << 16); steps *= 4) {
    Experiment until = experiment;
    until.end = end;
    try {
      const auto trial = until.begin(method, end / double(steps));
      std::vector<double> sizes;
      Work work;
      bool whole = true;
      for (long k = 0; k <= steps && whole; ++k) {
        const auto state = trial->see().state;
        raise_sizes(sizes, state);
        whole = k == steps || trial->advance(work).converged();
      }
      if (whole) return sizes;
    } catch (const SceneError&) {
    }
  }
  return {};
}

/// How the error grew over the second half: e ~ t^power.
double growth(const Experiment& experiment, const Found& found, double end, const std::vector<double>& sizes) {
  const long steps = 2 * std::max(2L, std::lround(0.5 * end / found.step));
  const auto error = [&](double until, long n) {
    const auto coarse = run_to(experiment, found.method, until, n);
    const auto fine = run_to(experiment, found.method, until, 2 * n);
    if (!coarse || !fine) return std::numeric_limits<double>::quiet_NaN();
    auto state = fine->state;
    set_sizes(state, sizes);
    return distance(coarse->state, state);
  };
  const double power = std::log2(error(end, steps) / error(0.5 * end, steps / 2));
  return std::isfinite(power) ? std::clamp(power, 1.0, 8.0) : 1;
}

std::string duration(double seconds) {
  return seconds < 1e-3 ? fmt::format("{:.3g} us", 1e6 * seconds)
         : seconds < 1  ? fmt::format("{:.3g} ms", 1e3 * seconds)
                        : fmt::format("{:.3g} s", seconds);
}

const Found& cheapest(const std::vector<Found>& all, double wanted, double end) {
  return *std::min_element(all.begin(), all.end(),
                           [&](const Found& a, const Found& b) { return a.cost(wanted, end) < b.cost(wanted, end); });
}

}  // namespace

AccuracyChoice choose_by_accuracy(const Section& scene) {
  const Goal goal = read_goal(scene);
  const auto start = std::chrono::steady_clock::now();
  const bool only_duration = scene.section("time", "").has("duration") && !scene.section("time", "").has("steps");
  const Experiment experiment = read_experiment(only_duration ? scene.set({"time.steps=1000"}) : scene);
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
  std::vector<double> sizes;
  for (; found.empty() && share > 1e-7; share *= 0.1) {
    end = share * experiment.end;
    sizes = sizes_of_motion(experiment, methods.front(), end);
    if (sizes.empty()) continue;
    for (const Method& method : methods)
      if (auto each = halve(experiment, method, end, margin * goal.target * share, sizes, longest))
        found.push_back(std::move(*each));
    if (!found.empty()) break;
  }
  if (found.empty())
    scene.section("accuracy", "")
        .fail("target",
              fmt::format("{:g} is not reached by any method within the pilot's time: ask for less, give pilot more "
                          "seconds, or look at lagroid study",
                          goal.target));
  const double power =
      share < 1 ? growth(experiment, cheapest(found, margin * goal.target * share, end), end, sizes) : 1;
  const auto wanted = [&](double target) { return margin * target * std::pow(share, power); };
  const Found& best = cheapest(found, wanted(goal.target), experiment.end);
  const long steps = long(std::ceil(experiment.end / best.step_for(wanted(goal.target))));
  const double h = experiment.end / double(steps);
  const Found& better = cheapest(found, wanted(0.1 * goal.target), experiment.end);

  AccuracyChoice choice;
  choice.scene = with_method(experiment.scene, best.method, h, experiment.end);
  choice.notes.push_back(fmt::format(
      "accuracy: for an error of {:.2g} at t = {:g}, {} with {} steps of {:.4g}; to march "
      "costs about {}",
      goal.target, experiment.end, best.method.name, steps, h, duration(double(steps) * best.step_seconds)));
  choice.notes.push_back(fmt::format("accuracy: ten times better would cost about {}, by {} with steps of {:.4g}",
                                     duration(better.cost(wanted(0.1 * goal.target), experiment.end)),
                                     better.method.name, better.step_for(wanted(0.1 * goal.target))));
  choice.notes.push_back(
      share < 1
          ? fmt::format("accuracy: chosen in {} by runs over {:.2g} of the duration, where the error grew as t^{:.2g}; "
                        "whether it goes on so is not known",
                        duration(seconds_since(start)), share, power)
          : fmt::format("accuracy: chosen in {} by runs over the whole duration, of {} methods that reached it",
                        duration(seconds_since(start)), found.size()));
  return choice;
}

}  // namespace lagroid::app
