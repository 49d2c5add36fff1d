#pragma once
/// What a step on a Poisson manifold keeps of the geometry.
///
///     constexpr KeptStructure midpoint{.bracket = 3, .casimirs = 3};  // both up to h^3 in a step
///
/// Nothing throws.

namespace lagroid {

/// 0 where it is kept exactly, else the power of h of its defect in a step, or `to_the_tolerance`.
struct KeptStructure {
  static constexpr int to_the_tolerance = -1;
  int bracket = 0;
  int casimirs = 0;
  bool energy = false;  ///< kept exactly
};

}  // namespace lagroid
