#pragma once
/// A cat that turns in the air: two equal halves, axially symmetric or not, joined between them so that each may bend
/// against the other about two axes, x and then y, and moved by torques in that joint alone. Angular momentum about the
/// centre of mass is conserved whatever the torques; where it is zero the cat turns by bending round (Kane and Scher,
/// Int. J. Solids Struct. 5 (1969); Montgomery, Fields Inst. Commun. 1 (1993)).
///
/// With R the turn of the front half in a step, J(b) = R_x(b_1) R_y(b_2) and K = tr(I)/2 - I the second moments of each
/// half, every particle goes straight from node to node:
///
///     L = (tr((1 - R) K) + tr((1 - J(b)^T R J(b')) K)) / h + m |R d(b') - d(b)|^2 / (4 h),    d(b) = reach (e_3 + J(b)
///     e_3),
///
/// on SO(3) x R^2 x R^2 => R^2, that is Moser and Veselov's Lagrangian of the two halves and the motion of their
/// centres of mass. It is invariant under SO(3), so that each discrete step conserves the momentum to round-off.
///
///     ControlTask<BendingCat> task{{}, FlowStates<BendingCat::GroupoidType>::arrow(start, end), 0.5};
///     const auto found = search_control(task, 40);  // control_search.hpp
///
/// Requires positive masses and moments of which none exceeds the sum of the others. State (r1, r2, r3, b1, b2; M1, M2,
/// M3, p1, p2): rotation vector of the front half, bends in rad; momenta conjugate to them, M in the front half.

#include <lagroid/core/parameter.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/control/actuated_system.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <tuple>

namespace lagroid {

struct FallingCat : System<FallingCat, Product<SO3, Pair<2>>> {
  double h = 0.01;
  double mass = 1.5;                             ///< m of each half, kg
  Vector<double, 3> inertia{0.01, 0.01, 0.005};  ///< I of each half about its centre of mass, the spine third, kg m^2
  double reach = 0.12;                           ///< from the joint to each centre of mass, m
  double largest_bend = 1.5;                     ///< rad, between the halves

  static auto parameters() {
    return std::tuple(
        parameter("mass", &FallingCat::mass, "kg", "of each half", positive),
        parameter("inertia", &FallingCat::inertia, "kg m^2", "of each half, the spine third", positive),
        parameter("reach", &FallingCat::reach, "m", "from the joint to either centre of mass", nonnegative),
        parameter("largest_bend", &FallingCat::largest_bend, "rad", "angle between the halves", positive));
  }

  template <class S, class T> S lagrangian(const Arrow<S>& g, const T& step) const {
    const auto& [turn, bend] = g;
    const Matrix<S, 3, 3> before = bent(bend.source);
    const Matrix<S, 3, 3> after = bent(bend.target);
    S sum(0.0);
    Vector<S, 3> shift;  // R d' - d, over the reach
    for (int i = 0; i < 3; ++i) {
      S rear(0.0);  // (J^T R J')_ii
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) rear += before(a, i) * turn(a, b) * after(b, i);
      const double second_moment = 0.5 * inertia.sum() - inertia(i);
      sum += (2.0 - turn(i, i) - rear) * second_moment;
      shift(i) = turn(i, 0) * after(0, 2) + turn(i, 1) * after(1, 2) + turn(i, 2) * (after(2, 2) + 1.0) - before(i, 2);
    }
    shift(2) -= 1.0;
    sum += (shift(0) * shift(0) + shift(1) * shift(1) + shift(2) * shift(2)) * (0.25 * mass * reach * reach);
    return sum / step;
  }
  template <class S> S lagrangian(const Arrow<S>& g) const { return lagrangian(g, h); }

  /// J(b), from the rear half to the front one.
  template <class S> static Matrix<S, 3, 3> bent(const Vector<S, 2>& b) {
    using std::cos;
    using std::sin;
    const S c1 = cos(b(0));
    const S s1 = sin(b(0));
    const S c2 = cos(b(1));
    const S s2 = sin(b(1));
    Matrix<S, 3, 3> j;
    j(0, 0) = c2, j(0, 1) = S(0.0), j(0, 2) = s2;
    j(1, 0) = s1 * s2, j(1, 1) = c1, j(1, 2) = -s1 * c2;
    j(2, 0) = -c1 * s2, j(2, 1) = s1, j(2, 2) = c1 * c2;
    return j;
  }
};

/// Moved at the least |torque|^2.
struct BendingCat : ActuatedSystem<BendingCat, FallingCat, /*controls*/ 2, /*inequalities*/ 3> {
  static constexpr std::array<std::string_view, 10> states{"r1", "r2", "r3", "b1", "b2", "M1", "M2", "M3", "p1", "p2"};
  static constexpr std::array<std::string_view, 10> state_units{
      "rad", "rad", "rad", "rad", "rad", "kg m^2/s", "kg m^2/s", "kg m^2/s", "kg m^2/s", "kg m^2/s"};
  static constexpr std::array<std::string_view, 2> control_names{"torque1", "torque2"};
  static constexpr std::array<std::string_view, 2> control_units{"N m", "N m"};
  /// The angular momentum: at the end it is what it was at the start, and not another condition.
  static constexpr std::array<bool, 10> conserved{false, false, false, false, false, true, true, true, false, false};

  template <class Q, class S> Vector<S, 5> force(const Q&, const Vector<S, 2>& u) const {
    Vector<S, 5> out;
    for (int i = 0; i < 5; ++i) out(i) = i < 3 ? S(0.0) : u(i - 3);
    return out;
  }
  template <class Z, class S> S running_cost(const Z&, const Vector<S, 2>& u) const {
    return u(0) * u(0) + u(1) * u(1);
  }
  /// cos of the largest bend <= e_3.J e_3, and no step turns the front half, or moves the bends, by more than a quarter
  /// turn: L is of chords, and momentum goes as the sine of what a step turns by, so that half turns would be free.
  template <class A, class S> Vector<S, 3> inequality(const A& g, const Vector<S, 2>&, const S&) const {
    using std::cos;
    const auto& [turn, bend] = std::get<0>(g);
    const Vector<S, 2>& b = bend.target;
    const Vector<S, 2> by = b - bend.source;
    Vector<S, 3> out;
    out(0) = cos(system.largest_bend) - cos(b(0)) * cos(b(1));
    out(1) = 1.0 - turn(0, 0) - turn(1, 1) - turn(2, 2);  // the trace is 1 + 2 cos
    out(2) = by(0) * by(0) + by(1) * by(1) - 0.25 * std::numbers::pi * std::numbers::pi;
    return out;
  }
};

}  // namespace lagroid
