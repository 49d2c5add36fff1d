#pragma once
/// An arm of two uniform links in a plane, moved by torques in shoulder and elbow, that keeps out of a disk. With the
/// angles a of the upper arm from the x axis and b of the forearm from the upper arm,
///
///     2 T = (m_1 / 3 + m_2) l_1^2 a'^2 + m_2 l_2^2 (a' + b')^2 / 3 + m_2 l_1 l_2 cos(b) a' (a' + b'),
///     V = gravity ((m_1 / 2 + m_2) l_1 sin a + m_2 l_2 sin(a + b) / 2),
///
/// both at the midpoint of a step. Elbow, hand and points at a third and two thirds of the forearm keep out.
///
///     ControlTask<PushedArm> task{{}, FlowStates<PushedArm::GroupoidType>::arrow({0, 0, 0, 0}, {1, 1, 0, 0}), 2};
///     task.system.system.disk_radius = 0.3;
///     const auto found = search_control(task, 60);  // control_search.hpp
///
/// Requires positive masses and lengths; a disk of radius zero is none. State (shoulder, elbow; and their momenta).

#include <lagroid/core/parameter.hpp>
#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/control/actuated_system.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <cmath>
#include <string_view>
#include <tuple>

namespace lagroid {

struct TwoLinkArm : System<TwoLinkArm, Pair<2>> {
  double h = 0.01;
  Vector<double, 2> masses{1, 1};       ///< m_1, m_2, kg
  Vector<double, 2> lengths{1, 1};      ///< l_1, l_2, m
  double gravity = 0;                   ///< along -y, m/s^2
  Vector<double, 2> disk_center{0, 0};  ///< m, from the shoulder
  double disk_radius = 0;               ///< m

  static auto parameters() {
    return std::tuple(parameter("masses", &TwoLinkArm::masses, "kg", "of upper arm and forearm", positive),
                      parameter("lengths", &TwoLinkArm::lengths, "m", "of upper arm and forearm", positive),
                      parameter("gravity", &TwoLinkArm::gravity, "m/s^2", "downward, along -y"),
                      parameter("disk_center", &TwoLinkArm::disk_center, "m", "of the disk to keep out of"),
                      parameter("disk_radius", &TwoLinkArm::disk_radius, "m", "its radius; 0: no disk", nonnegative));
  }

  template <class S, class T> S lagrangian(const PairArrow<S, 2>& g, const T& step) const {
    using std::cos;
    using std::sin;
    const S upper = (g.target(0) - g.source(0)) / step;
    const S fore = upper + (g.target(1) - g.source(1)) / step;
    const S a = (g.source(0) + g.target(0)) * 0.5;
    const S b = (g.source(1) + g.target(1)) * 0.5;
    const double m1 = masses(0);
    const double m2 = masses(1);
    const double l1 = lengths(0);
    const double l2 = lengths(1);
    const S kinetic = upper * upper * (0.5 * (m1 / 3 + m2) * l1 * l1) + fore * fore * (m2 * l2 * l2 / 6) +
                      upper * fore * cos(b) * (0.5 * m2 * l1 * l2);
    const S potential = (sin(a) * ((0.5 * m1 + m2) * l1) + sin(a + b) * (0.5 * m2 * l2)) * gravity;
    return (kinetic - potential) * step;
  }
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const { return lagrangian(g, h); }
};

/// Moved at the least |torque|^2.
struct PushedArm : ActuatedSystem<PushedArm, TwoLinkArm, /*controls*/ 2, /*inequalities*/ 4> {
  static constexpr std::array<std::string_view, 4> states{"shoulder", "elbow", "momentum1", "momentum2"};
  static constexpr std::array<std::string_view, 4> state_units{"rad", "rad", "kg m^2/s", "kg m^2/s"};
  static constexpr std::array<std::string_view, 2> control_names{"shoulder_torque", "elbow_torque"};
  static constexpr std::array<std::string_view, 2> control_units{"N m", "N m"};

  template <class Q, class S> Vector<S, 2> force(const Q&, const Vector<S, 2>& u) const { return u; }
  template <class Z, class S> S running_cost(const Z&, const Vector<S, 2>& u) const {
    return u(0) * u(0) + u(1) * u(1);
  }
  /// 1 <= |x - center|^2 / radius^2 of each point x.
  template <class A, class S> Vector<S, 4> inequality(const A& g, const Vector<S, 2>&, const S&) const {
    using std::cos;
    using std::sin;
    if (system.disk_radius == 0) return Vector<S, 4>::Constant(S(-1.0));
    const Vector<S, 2>& q = std::get<0>(g).target;
    const S elbow_x = cos(q(0)) * system.lengths(0) - system.disk_center(0);
    const S elbow_y = sin(q(0)) * system.lengths(0) - system.disk_center(1);
    const S fore_x = cos(q(0) + q(1)) * system.lengths(1);
    const S fore_y = sin(q(0) + q(1)) * system.lengths(1);
    Vector<S, 4> out;
    for (int i = 0; i < 4; ++i) {
      const S x = elbow_x + fore_x * (i / 3.0);
      const S y = elbow_y + fore_y * (i / 3.0);
      out(i) = S(1.0) - (x * x + y * y) * (1 / (system.disk_radius * system.disk_radius));
    }
    return out;
  }
};

}  // namespace lagroid
