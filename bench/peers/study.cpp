#include "study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

namespace peers {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Runs once more, short ones until they add up to something that the clock can tell.
double timed(const Method& method, double end, double setting, Outcome& outcome) {
  constexpr double enough = 2e-3;
  double total = 0;
  int count = 0;
  while (count == 0 || (total < enough && count < 100)) {
    const Task task = method.begin(end, setting);
    const double start = processor_time();
    outcome = task();
    total += processor_time() - start;
    ++count;
  }
  return total / count;
}

Run first_run(const Problem& problem, std::size_t method, double end, double setting, const Reference& reference,
              std::vector<double>& seconds) {
  Run run{method, setting};
  Outcome outcome;
  try {
    seconds.push_back(timed(problem.methods[method], end, setting, outcome));
    run.steps = outcome.steps;
    run.drift = outcome.drift;
    run.failure = outcome.failure;
    run.error = problem.distance(outcome.state, reference.state);
  } catch (const std::exception& error) {
    run.failure = error.what();
  }
  if (!run.failure.empty()) run.error = infinity;
  run.seconds = seconds.empty() ? 0 : seconds.front();
  return run;
}

}  // namespace

Study study(const Problem& problem, double end, const Effort& effort) {
  constexpr int most_settings = 40;
  constexpr double long_run = 0.3;    // s
  constexpr double tightest = 1e-15;  // tolerance
  Study out;
  out.end = end;
  out.reference = problem.reference(end);
  std::vector<std::vector<double>> seconds;
  for (std::size_t m = 0; m < problem.methods.size(); ++m) {
    const Method& method = problem.methods[m];
    // Under error control errors fall in stairs.
    const int patience = method.tolerance ? 4 : 2;
    double setting = std::min(method.coarsest, method.tolerance ? 1 : end);
    double best = infinity;
    int without_gain = 0;
    double last_seconds = 0;
    double growth = 1;
    int too_long = 0;
    for (int k = 0; k < most_settings; ++k, setting /= method.ratio) {
      // Under error control a motion gone astray can take longer than the true one.
      constexpr double astray = 0.1;
      const bool predictable = !method.tolerance || best < astray;
      if (predictable && last_seconds * growth > effort.longest) break;
      if (too_long == 3) break;
      if (method.tolerance && setting < tightest) break;
      std::vector<double> taken;
      out.runs.push_back(first_run(problem, m, end, setting, out.reference, taken));
      seconds.push_back(taken);
      const Run& run = out.runs.back();
      if (run.seconds > effort.longest || run.failure == took_too_long) ++too_long;
      // A coarse run that failed tells nothing of how long finer ones take.
      if (run.failure.empty()) {
        if (last_seconds > 0) growth = std::max(1.0, run.seconds / last_seconds);
        last_seconds = run.seconds;
      }
      // Below this a method is on its way, and what no longer falls is round-off.
      constexpr double underway = 1e-5;
      without_gain = best < underway && run.error > 0.7 * best ? without_gain + 1 : 0;
      best = std::min(best, run.error);
      if (without_gain == patience || (!run.failure.empty() && std::isfinite(best))) break;
    }
    fmt::print(stderr, ".");
  }
  std::vector<std::size_t> order;
  std::mt19937 draw(1);
  for (int repetition = 1; repetition < effort.repetitions; ++repetition) {
    order.clear();
    for (std::size_t i = 0; i < out.runs.size(); ++i)
      if (out.runs[i].failure.empty() && out.runs[i].seconds < long_run) order.push_back(i);
    std::shuffle(order.begin(), order.end(), draw);
    for (const std::size_t i : order) {
      const Run& run = out.runs[i];
      Outcome again;
      seconds[i].push_back(timed(problem.methods[run.method], end, run.setting, again));
    }
  }
  fmt::print(stderr, "\n");
  out.floor = infinity;
  for (std::size_t i = 0; i < out.runs.size(); ++i) {
    Run& run = out.runs[i];
    out.floor = std::min(out.floor, run.error);
    auto& taken = seconds[i];
    if (taken.empty()) continue;
    std::sort(taken.begin(), taken.end());
    run.seconds = taken[taken.size() / 2];
    run.spread = (taken[(3 * taken.size()) / 4] - taken[taken.size() / 4]) / run.seconds;
  }
  out.floor = std::max(out.floor, out.reference.uncertainty);
  return out;
}

Cost cost(const Study& study, std::size_t method, double error) {
  std::vector<const Run*> runs;
  for (const Run& run : study.runs)
    if (run.method == method) runs.push_back(&run);
  if (runs.empty()) return {infinity, 0};
  const auto best =
      std::min_element(runs.begin(), runs.end(), [](const Run* a, const Run* b) { return a->error < b->error; });
  if (!((*best)->error <= error)) return {infinity, 0};
  auto above = best;
  while (above != runs.begin() && (*above)->error <= error) --above;
  const Run& a = **above;
  if (a.error <= error) return {a.seconds, a.setting};  // the coarsest is good enough
  const Run& b = **(above + 1);
  if (!std::isfinite(a.error) || a.seconds <= 0) return {b.seconds, b.setting};
  const double s = std::log(error / a.error) / std::log(b.error / a.error);
  return {a.seconds * std::pow(b.seconds / a.seconds, s), a.setting * std::pow(b.setting / a.setting, s)};
}

Cheapest cheapest(const Problem& problem, const Study& study, double error,
                  const std::function<bool(const Method&)>& eligible) {
  Cheapest out{{infinity, 0}};
  for (std::size_t m = 0; m < problem.methods.size(); ++m) {
    if (!eligible(problem.methods[m])) continue;
    const Cost at = cost(study, m, error);
    if (at.seconds < out.cost.seconds) out = {at, m};
  }
  return out;
}

std::vector<double> error_levels(const Study& study) {
  std::vector<double> out;
  for (int digits = 2; std::pow(10, -digits) >= 10 * study.floor; ++digits) out.push_back(std::pow(10, -digits));
  return out;
}

}  // namespace peers
