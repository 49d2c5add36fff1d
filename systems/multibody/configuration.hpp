#pragma once
/// The configuration of a scene, where its points and bodies are at one time, and the loads on them; `Site` and
/// `Attitude` name a point and a rotation. SI units.
///
/// A scene that runs is one of doubles. Over another scalar it carries derivatives (sensitivity/linearised_scene.hpp),
/// so that what scenes are made of is written for any.

#include <lagroid/core/types.hpp>

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid::multibody {

using Vec = Vector<double, 3>;
using Mat = Matrix<double, 3, 3>;

/// The numbers of a vector without their derivatives.
inline const Vec& values_of(const Vec& x) { return x; }
template <class S> Vec values_of(const Vector<S, 3>& x) { return {value_of(x(0)), value_of(x(1)), value_of(x(2))}; }

/// Whether it is zero and stays so: what has a derivative does not.
template <class S> bool stays_zero(const S& x) {
  bool varies = false;
  if constexpr (requires { x.mixed(); }) {
    varies = !x.left().isZero(0) || !x.right().isZero(0) || !x.mixed().isZero(0);
  } else if constexpr (!std::is_same_v<S, double>) {
    for (int i = 0; i < S::directions; ++i) varies = varies || x.tangent(i) != 0;
  }
  return !varies && value_of(x) == 0;
}
template <class S, int Rows, int Columns> bool stays_zero(const Matrix<S, Rows, Columns>& x) {
  return std::all_of(x.data(), x.data() + x.size(), [](const S& each) { return stays_zero(each); });
}

/// A point of a body or of the ground. In a scene that is being written, its number there; in one that runs, its place
/// in `Configuration::x`.
struct Site {
  int index = -1;
};

/// What turns: a body in space, or the ground (which is the default). In a scene that runs, its place in
/// `Configuration::attitude`.
struct Attitude {
  int index = -1;
};

/// Bodies at one time. `x` holds the places of all point masses and centres of mass, (x, y, angle) of the planar
/// bodies, then the points fixed to bodies and to the ground; `attitude` the rotations A that carry bodies to space,
/// and last the identity, which is the ground's. Lengths in m, time in s.
template <class S = double> struct BasicConfiguration {
  S time = 0;
  std::vector<Vector<S, 3>> x;
  std::vector<Matrix<S, 3, 3>> attitude;
  std::vector<double> arm;  ///< how far each point is from the place that moves it, m

  /// The size of the numbers that a site's place is a sum of, m.
  double size(Site site) const {
    const auto i = std::size_t(site.index);
    return values_of(x[i]).template lpNorm<Eigen::Infinity>() + arm[i];
  }

  const Vector<S, 3>& operator()(Site s) const { return x[std::size_t(s.index)]; }
  const Matrix<S, 3, 3>& operator()(Attitude a) const { return attitude[std::size_t(a.index)]; }

  friend void swap(BasicConfiguration& a, BasicConfiguration& b) noexcept {
    std::swap(a.time, b.time);
    a.x.swap(b.x);
    a.attitude.swap(b.attitude);
    a.arm.swap(b.arm);
  }
};
using Configuration = BasicConfiguration<>;

/// What acts at one time: forces (N) on sites, by their place, and torques (N m) in the body's frame on attitudes. On a
/// planar body's own place: (force, force, torque).
template <class S = double> struct BasicLoads {
  std::vector<Vector<S, 3>> on;
  std::vector<Vector<S, 3>> torque;

  Vector<S, 3>& operator()(Site s) { return on[std::size_t(s.index)]; }
  Vector<S, 3>& operator()(Attitude a) { return torque[std::size_t(a.index)]; }

  friend void swap(BasicLoads& a, BasicLoads& b) noexcept {
    a.on.swap(b.on);
    a.torque.swap(b.torque);
  }
};
using Loads = BasicLoads<>;

}  // namespace lagroid::multibody
