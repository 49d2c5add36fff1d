#pragma once
/// The order of a discrete Lagrangian, measured on the action itself: L(g) - L^E(g) = O(h^{r+1}), L^E the exact
/// discrete Lagrangian, which makes the step of order r. No step is taken, and no reference motion is needed.
///
///     const auto draw = [] {
///       return State<Pair<1>>{Vector<double, 1>(0.5), Vector<double, 1>(laws::draw_uniform())};
///     };
///     EXPECT_TRUE(laws::exact_action_laws(Midpoint<Pendulum>{}, draw, /*longest*/ 0.2).holds());
///
/// Requires RapidCheck, a rule of a continuous Lagrangian without constraints, and states (q, xi), `momentum` the
/// velocity, beside which l is smooth. Returns a LawReport; a law that does not hold is no exception. Where the
/// difference is round-off, or the exact action is not known, another sample is drawn.
///
/// Source: [G] 7.2; Marsden and West, Acta Numerica 10 (2001), Theorem 2.3.1.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/galerkin/exact_lagrangian.hpp>

#include <cmath>
#include <functional>

namespace lagroid::laws {

/// "the action is exact to the declared order": between steps `longest` and half as long, within a third of an order;
/// more is no fault.
template <class Rule>
LawReport exact_action_laws(const Rule& rule, const std::function<State<typename Rule::GroupoidType>()>& draw,
                            double longest) {
  constexpr double known = 1e-13;  // to which both actions are
  return {Rule::traits().name + ", action", {check_law("the action is exact to the declared order", 1.0 / 3, [&] {
            const auto [q, xi] = draw();
            const auto difference = [&, from = q, along = xi](double h) {
              const auto [value, size] = action_difference(rule, from, along, h);
              if (!(std::abs(value) > known * size)) throw NotSampled("the difference is round-off, or no number");
              return std::abs(value);
            };
            const double slope = std::log2(difference(longest) / difference(longest / 2));
            return std::max(0.0, Rule::traits().order + 1 - slope);
          })}};
}

}  // namespace lagroid::laws
