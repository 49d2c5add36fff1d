#pragma once
/// Whether a Routhian that a system has in closed form (core/capabilities/routhian.hpp) is that of its Lagrangian:
///
///     R(b) = L(b, theta) - <level, theta>,  -dR/dlevel = theta      at the theta that Newton's method finds
///
/// A level moves by the closed form alone, so that a wrong one would be that of another problem, without a word.
///
///     found = examine_routhian(level, std::span(arrows));  // arrows of the base; the largest differences
///
/// Required: arrows that are many and generic. Those over which Newton's method finds no such angle tell nothing.
/// Returns nothing where the system has no closed form or no arrow tells. Nothing throws.

#include <lagroid/core/reduction/descent.hpp>
#include <lagroid/core/reduction/momentum_level.hpp>

#include <cmath>
#include <span>
#include <vector>

namespace lagroid {

template <class Level>
std::vector<DescentFinding> examine_routhian(const Level& level, std::span<const ArrowOf<typename Level::B>> arrows) {
  std::vector<DescentFinding> findings;
  if constexpr (Level::closed) {
    if (!level.has_closed_form()) return findings;
    using Number = Vector<double, 1>;
    detail::DescentTally value(Ingredient::routhian);
    detail::DescentTally angle(Ingredient::routhian);
    bool told = false;
    for (const auto& b : arrows) {
      const double solved = level.routhian_by_solving(b);
      if (!std::isfinite(solved)) continue;
      told = true;
      const auto at = level.groupoid.coordinates_of_arrow(b);
      value.add(Number(level.lagrangian(b)), Number(solved), at);
      angle.add(level.angle_of(b, level.level), level.template angle_by_solving<0>(b, level.level), at);
    }
    if (told) findings = {value.finding(), angle.finding()};
  }
  return findings;
}

}  // namespace lagroid
