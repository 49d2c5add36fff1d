#pragma once
/// What a controlled motion is to cost: effort, the integral of |u|^2, or time.
///
///     DoubleIntegrator cart;
///     cart.cost_of = ControlCost::time;
///
/// Nothing throws.

#include <array>
#include <string_view>

namespace lagroid {

enum class ControlCost { effort, time };
inline constexpr std::array<std::string_view, 2> control_cost_words{"effort", "time"};

/// |u|^2 or 1.
template <class V> typename V::Scalar running_cost_of(ControlCost cost, const V& u) {
  using S = typename V::Scalar;
  if (cost == ControlCost::time) return S(1.0);
  S sum = u(0) * u(0);
  for (int i = 1; i < u.size(); ++i) sum += u(i) * u(i);
  return sum;
}

}  // namespace lagroid
