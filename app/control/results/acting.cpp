#include "acting.hpp"

#include <algorithm>
#include <cmath>

namespace lagroid::app {

namespace {

template <class Mark> std::vector<StageRange> ranges(const ControlResult& found, const Mark& is_marked) {
  std::vector<StageRange> out;
  const std::size_t stages = found.control_rows.size();
  for (std::size_t k = 0, next = 0; k < stages; k = next + 1) {
    for (next = k; next < stages && is_marked(next); ++next) continue;
    if (next > k) out.push_back({k, next});
  }
  return out;
}

/// A multiplier that is larger acts; those of an iterate say nothing, nor do those that an interior point leaves of
/// what is far from acting.
double threshold(const ControlResult& found) {
  constexpr double left_by_interior_points = 1e-9;
  if (!found.report.converged()) return HUGE_VAL;
  double largest = 0;
  for (const auto& row : found.inequality_rows)
    for (const double z : row) largest = std::max(largest, z);
  return std::max(1e-6 * largest, found.crossover.crossed() ? 0 : left_by_interior_points);
}

}  // namespace

std::vector<std::size_t> phase_of_stages(const ControlResult& found) {
  std::vector<std::size_t> out;
  for (std::size_t p = 0; p < found.phases.size(); ++p) out.insert(out.end(), std::size_t(found.phases[p].stages), p);
  return out;
}

std::vector<StageRange> where_inequalities_act(const ControlResult& found) {
  const double least = threshold(found);
  return ranges(found, [&](std::size_t k) {
    return k < found.inequality_rows.size() &&
           std::any_of(found.inequality_rows[k].begin(), found.inequality_rows[k].end(),
                       [&](double z) { return z > least; });
  });
}

std::vector<StageRange> where_it_acts(const ControlResult& found, const std::string& name) {
  const double least = threshold(found);
  return ranges(found, [&](std::size_t k) {
    if (k >= found.inequality_rows.size()) return false;
    for (std::size_t row = 0; row < found.inequalities.size(); ++row)
      if (found.inequalities[row] == name && found.inequality_rows[k][row] > least) return true;
    return false;
  });
}

std::vector<StageRange> where_bounds_are_reached(const ControlResult& found) {
  const std::vector<std::size_t> phase_of = phase_of_stages(found);
  return ranges(found, [&](std::size_t k) {
    const auto& lower = phase_of.empty() ? found.lower : found.phases[phase_of[k]].lower;
    const auto& upper = phase_of.empty() ? found.upper : found.phases[phase_of[k]].upper;
    const auto is_at = [](double bound, double u) {
      return std::isfinite(bound) && std::abs(u - bound) <= 1e-6 * std::abs(bound);
    };
    for (std::size_t i = 0; i < found.controls.size(); ++i)
      if (is_at(lower[i], found.control_rows[k][i]) || is_at(upper[i], found.control_rows[k][i])) return true;
    return false;
  });
}

}  // namespace lagroid::app
