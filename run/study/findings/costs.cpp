#include <lagroid/run/study/findings/costs.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid {

const char* name_of(Axis axis) {
  switch (axis) {
    case Axis::trajectory:
      return "trajectory";
    case Axis::invariants:
      return "invariants";
    default:
      return "constraint";
  }
}

double error_of(const Measurement& m, Axis axis) {
  switch (axis) {
    case Axis::trajectory:
      return m.trajectory;
    case Axis::invariants:
      return m.invariants;
    default:
      return m.constraint;
  }
}

bool is_point(const Measurement& m, Axis axis) { return m.converged() && error_of(m, axis) <= 1; }

std::vector<std::string> methods_of(const std::vector<Measurement>& all) {
  std::vector<std::string> out;
  for (const Measurement& m : all)
    if (std::find(out.begin(), out.end(), m.method) == out.end()) out.push_back(m.method);
  return out;
}

std::optional<Cost> cost_of(const std::vector<Measurement>& all, const std::string& method, Axis axis, double error) {
  std::vector<const Measurement*> runs;
  for (const Measurement& m : all)
    if (m.method == method && !m.seconds.empty() && is_point(m, axis)) runs.push_back(&m);
  std::sort(runs.begin(), runs.end(), [](const auto* a, const auto* b) { return a->step > b->step; });
  const auto below = [&](const Measurement* m) { return error_of(*m, axis) <= error; };
  // From the fine end, past what drowned in round-off: a coarse run may be below the error by chance.
  auto first = runs.end();
  while (first != runs.begin() && !below(*(first - 1))) --first;
  if (first == runs.begin()) return std::nullopt;
  while (first != runs.begin() && below(*(first - 1))) --first;
  const Measurement& to = **first;
  if (first == runs.begin()) return Cost{method, to.step, to.median(), double(to.work.evaluations)};
  const Measurement& from = **(first - 1);
  const double e0 = std::log(error_of(from, axis));
  const double e1 = std::log(std::max(error_of(to, axis), 1e-300));
  const double share = e0 > e1 ? std::clamp((e0 - std::log(error)) / (e0 - e1), 0.0, 1.0) : 1;
  const auto between = [&](double a, double b) { return std::exp(std::log(a) + share * (std::log(b) - std::log(a))); };
  return Cost{method, between(from.step, to.step), between(from.median(), to.median()),
              between(double(from.work.evaluations), double(to.work.evaluations))};
}

namespace {

std::optional<Cost> least(const std::vector<Measurement>& all, Axis axis, double error, double Cost::*of) {
  std::optional<Cost> best;
  for (const std::string& method : methods_of(all))
    if (const auto cost = cost_of(all, method, axis, error); cost && (!best || (*cost).*of < (*best).*of)) best = cost;
  return best;
}

}  // namespace

std::optional<Cost> least_cost(const std::vector<Measurement>& all, Axis axis, double error) {
  return least(all, axis, error, &Cost::seconds);
}

std::vector<std::string> cheapest_methods(const std::vector<Measurement>& all, Axis axis, double Cost::*cost,
                                          double least_error) {
  std::vector<std::string> out;
  for (double error = 0.1; error >= least_error; error /= std::sqrt(10.0)) {
    const auto best = least(all, axis, error, cost);
    if (!best) break;
    if (std::find(out.begin(), out.end(), best->method) == out.end()) out.push_back(best->method);
  }
  return out;
}

}  // namespace lagroid
