#pragma once
/// The joints that scenes can name are made of these: rods, coincident points, angles, planes; rolling, spins, blades;
/// and dampers of any of them. Each struct's comment has its equation.

#include <lagroid/systems/multibody/joint.hpp>

#include <array>
#include <cmath>

namespace lagroid::multibody {

/// Two points at a fixed distance: (|x1 - x0|^2 - l^2) / 2 = 0.
template <class S = double> struct BasicRod {
  static constexpr int rows = 1;
  std::array<Site, 2> sites;
  S length = 1;  ///< l, m

  void value(const BasicConfiguration<S>& at, S* c) const {
    c[0] = 0.5 * ((at(sites[1]) - at(sites[0])).squaredNorm() - length * length);
  }
  void gradient(const BasicConfiguration<S>& at, Vector<S, 3>* g, RowSize* size) const {
    const Vector<S, 3>& a = at(sites[0]);
    const Vector<S, 3>& b = at(sites[1]);
    g[1] = b - a;
    g[0] = -g[1];
    const double l = value_of(length);
    size[0] = {l * (l + at.size(sites[0]) + at.size(sites[1])), 2 * l};
  }
};
using Rod = BasicRod<>;

/// Two points that are one: x1 - x0 = 0. A ball joint; between planar bodies a pin.
template <class S = double> struct BasicCoincidence {
  static constexpr int rows = 3;
  std::array<Site, 2> sites;

  void value(const BasicConfiguration<S>& at, S* c) const {
    const Vector<S, 3> d = at(sites[1]) - at(sites[0]);
    for (int i = 0; i < 3; ++i) c[i] = d(i);
  }
  void gradient(const BasicConfiguration<S>& at, Vector<S, 3>* g, RowSize* size) const {
    for (int i = 0; i < 3; ++i) {
      g[2 * i] = -Vector<S, 3>::Unit(i);
      g[2 * i + 1] = Vector<S, 3>::Unit(i);
      size[i] = {at.size(sites[0]) + at.size(sites[1]), 2};
    }
  }
};
using Coincidence = BasicCoincidence<>;

/// Two directions, each fixed in a body, that keep their angle: (A0 u).(A1 v) = cosine.
template <class S = double> struct BasicFixedAngle {
  static constexpr int rows = 1;
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;
  Vector<S, 3> u{1, 0, 0};
  Vector<S, 3> v{0, 1, 0};
  S cosine = 0;

  void value(const BasicConfiguration<S>& at, S* c) const {
    c[0] = (at(attitudes[0]) * u).dot(at(attitudes[1]) * v) - cosine;
  }
  void gradient(const BasicConfiguration<S>& at, Vector<S, 3>* g, RowSize* size) const {
    const Matrix<S, 3, 3>& a = at(attitudes[0]);
    const Matrix<S, 3, 3>& b = at(attitudes[1]);
    g[0] = u.cross(Vector<S, 3>(a.transpose() * (b * v)));
    g[1] = v.cross(Vector<S, 3>(b.transpose() * (a * u)));
    size[0] = {3, 2};
  }
};
using FixedAngle = BasicFixedAngle<>;

/// A point that stays in a plane fixed to a body through a point of it: (A n).(x1 - x0) = 0.
template <class S = double> struct BasicInPlane {
  static constexpr int rows = 1;
  std::array<Site, 2> sites;  ///< a point of the plane, the point that stays in it
  std::array<Attitude, 1> attitudes;
  Vector<S, 3> normal{0, 0, 1};

  void value(const BasicConfiguration<S>& at, S* c) const {
    c[0] = (at(attitudes[0]) * normal).dot(at(sites[1]) - at(sites[0]));
  }
  void gradient(const BasicConfiguration<S>& at, Vector<S, 3>* g, RowSize* size) const {
    const Matrix<S, 3, 3>& a = at(attitudes[0]);
    const Vector<S, 3> n = a * normal;
    const Vector<S, 3> d = at(sites[1]) - at(sites[0]);
    g[0] = -n;
    g[1] = n;
    g[2] = normal.cross(Vector<S, 3>(a.transpose() * d));
    size[0] = {at.size(sites[0]) + at.size(sites[1]), 2 + values_of(d).norm()};
  }
};
using InPlane = BasicInPlane<>;

/// A ball whose centre moves at the height of its radius r over a level plate that turns about the origin at the rate
/// Omega: dx = h v of the point of the plate below, without slipping,
///     dx - r w2 + h Omega y = 0,   dy + r w1 - h Omega x = 0,
/// with the turn w = A xi in space and (x, y) the middle of the arrow; the reactions are those of a plate at rest.
template <class S = double> struct BasicRolling {
  static constexpr int rows = 2;
  std::array<Site, 1> sites;
  std::array<Attitude, 1> attitudes;
  S radius = 1;      ///< r, m
  S plate_rate = 0;  ///< Omega, rad/s

  void value(const BasicSceneArrow<S>& motion, S* c) const {
    const Vector<S, 3>& d = motion.displacement(sites[0]);
    const Vector<S, 3> w = motion.before(attitudes[0]) * motion.turn(attitudes[0]);
    const Vector<S, 3> middle = motion.before(sites[0]) + 0.5 * d;
    const S turned = motion.h * plate_rate;
    c[0] = d(0) - radius * w(1) + turned * middle(1);
    c[1] = d(1) + radius * w(0) - turned * middle(0);
  }
  void gradient(const BasicSceneArrow<S>& motion, Vector<S, 3>* g) const {
    RowSize size[rows];
    reaction(motion.before, g, size);
    const S half = 0.5 * motion.h * plate_rate;
    g[0](1) += half;
    g[2](0) -= half;
  }
  void drift(const BasicSceneArrow<S>& motion, Vector<S, 3>* g) const {
    const Matrix<S, 3, 3>& a = motion.before(attitudes[0]);
    const Vector<S, 3> xi = motion.turn(attitudes[0]);
    const S turned = motion.h * plate_rate;
    g[0] = {0, turned, 0};
    g[1] = -radius * xi.cross(Vector<S, 3>(a.row(1)));
    g[2] = {-turned, 0, 0};
    g[3] = radius * xi.cross(Vector<S, 3>(a.row(0)));
  }
  void reaction(const BasicConfiguration<S>& at, Vector<S, 3>* g, RowSize* size) const {
    const Matrix<S, 3, 3>& a = at(attitudes[0]);
    g[0] = Vector<S, 3>::UnitX();
    g[1] = -radius * a.row(1).transpose();
    g[2] = Vector<S, 3>::UnitY();
    g[3] = radius * a.row(0).transpose();
    size[0] = size[1] = {0, 1 + value_of(radius)};
  }
};
using Rolling = BasicRolling<>;

/// A body that does not turn about the n-th axis of space, or turns about it at a given rate: n.(A xi) = h rate.
template <class S = double> struct BasicPrescribedSpin {
  static constexpr int rows = 1;
  std::array<Site, 0> sites;
  std::array<Attitude, 1> attitudes;
  Vector<S, 3> axis{0, 0, 1};  ///< n, of unit length, in space
  S rate = 0;                  ///< rad/s

  void value(const BasicSceneArrow<S>& motion, S* c) const {
    c[0] = axis.dot(motion.before(attitudes[0]) * motion.turn(attitudes[0])) - motion.h * rate;
  }
  void gradient(const BasicSceneArrow<S>& motion, Vector<S, 3>* g) const {
    RowSize size[rows];
    reaction(motion.before, g, size);
  }
  void drift(const BasicSceneArrow<S>& motion, Vector<S, 3>* g) const {
    g[0] = motion.turn(attitudes[0]).cross(Vector<S, 3>(motion.before(attitudes[0]).transpose() * axis));
  }
  void reaction(const BasicConfiguration<S>& at, Vector<S, 3>* g, RowSize* size) const {
    g[0] = at(attitudes[0]).transpose() * axis;
    size[0] = {0, 1};
  }
};
using PrescribedSpin = BasicPrescribedSpin<>;

/// A blade under a planar body, which slides along it and not across (a sleigh, a wheel): n(theta + dtheta / 2).dx +
/// arm dtheta = h rate, with n at right angles to the blade and rate zero. Another rate is that of a belt; a blade at
/// right angles to the first, with a rate, keeps the speed.
template <class S = double> struct BasicBlade {
  static constexpr int rows = 1;
  std::array<Site, 1> sites;  ///< Scene::planar_place of the body
  S direction = 0;            ///< of the blade in the body, rad
  S arm = 0;                  ///< how far the blade stands ahead of the centre of mass, along itself, m
  S rate = 0;                 ///< m/s

  void value(const BasicSceneArrow<S>& motion, S* c) const {
    const Vector<S, 3>& d = motion.displacement(sites[0]);
    c[0] = across(motion.before(sites[0])(2) + 0.5 * d(2)).dot(d) + arm * d(2) - motion.h * rate;
  }
  void gradient(const BasicSceneArrow<S>& motion, Vector<S, 3>* g) const {
    const Vector<S, 3>& d = motion.displacement(sites[0]);
    const S angle = motion.before(sites[0])(2) + 0.5 * d(2);
    g[0] = across(angle);
    g[0](2) = arm + 0.5 * across(angle + 0.5 * M_PI).dot(d);
  }
  void drift(const BasicSceneArrow<S>& motion, Vector<S, 3>* g) const {
    const Vector<S, 3>& d = motion.displacement(sites[0]);
    g[0] = {0, 0, across(motion.before(sites[0])(2) + 0.5 * d(2) + 0.5 * M_PI).dot(d)};
  }
  void reaction(const BasicConfiguration<S>& at, Vector<S, 3>* g, RowSize* size) const {
    g[0] = across(at(sites[0])(2));
    g[0](2) = arm;
    size[0] = {0, (1 + std::abs(value_of(arm))) * (1 + std::abs(value_of(at(sites[0])(2))))};
  }

 private:
  Vector<S, 3> across(const S& angle) const {
    using std::cos, std::sin;
    return {-sin(angle + direction), cos(angle + direction), S(0)};
  }
};
using Blade = BasicBlade<>;

/// A constraint on arrows under the vakonomic principle, with its multipliers at the start: what an optimal control
/// that minimises the kinetic terms obeys.
template <class J, class S = double> struct Vakonomic : J { std::array<S, std::size_t(J::rows)> multipliers{}; };

/// A body that does not turn about an axis of its own, or turns about it at a given rate: n.xi = h rate.
template <class S = double> struct BasicBodySpin {
  static constexpr int rows = 1;
  std::array<Site, 0> sites;
  std::array<Attitude, 1> attitudes;
  Vector<S, 3> axis{0, 0, 1};  ///< n, of unit length, in the body
  S rate = 0;                  ///< rad/s

  void value(const BasicSceneArrow<S>& motion, S* c) const {
    c[0] = axis.dot(motion.turn(attitudes[0])) - motion.h * rate;
  }
  void gradient(const BasicSceneArrow<S>&, Vector<S, 3>* g) const { g[0] = axis; }
  void drift(const BasicSceneArrow<S>&, Vector<S, 3>* g) const { g[0] = Vector<S, 3>::Zero(); }
  void reaction(const BasicConfiguration<S>&, Vector<S, 3>* g, RowSize* size) const {
    g[0] = axis;
    size[0] = {0, 1};
  }
};
using BodySpin = BasicBodySpin<>;

/// Two hinged bodies that turn against each other, about the axis that is u in the first and v in the second, at a
/// given rate: the angle of R^T R' about v is h rate, R = A0^T A1.
template <class S = double> struct BasicHingeTurn {
  static constexpr int rows = 1;
  static constexpr bool along_target = true;
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;
  Vector<S, 3> u{0, 0, 1};
  Vector<S, 3> v{0, 0, 1};
  S rate = 0;  ///< rad/s

  void value(const BasicSceneArrow<S>& motion, S* c) const {
    const auto relative = [&](const BasicConfiguration<S>& at) -> Matrix<S, 3, 3> {
      return at(attitudes[0]).transpose() * at(attitudes[1]);
    };
    const Matrix<S, 3, 3> turn = relative(motion.before).transpose() * relative(motion.after);
    const S sine = 0.5 * v.dot(Vector<S, 3>(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)));
    using std::atan2;
    c[0] = atan2(sine, 0.5 * (turn.trace() - 1)) - motion.h * rate;
  }
  void gradient(const BasicSceneArrow<S>&, Vector<S, 3>* g) const {
    g[0] = -u;
    g[1] = v;
  }
  void reaction(const BasicConfiguration<S>&, Vector<S, 3>* g, RowSize* size) const {
    g[0] = -u;
    g[1] = v;
    size[0] = {2, 2};
  }
};
using HingeTurn = BasicHingeTurn<>;

/// How two bodies turn against each other: A1 xi1 - A0 xi0, in space.
template <class S = double> struct BasicRelativeTurn {
  static constexpr int rows = 3;
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;

  void value(const BasicSceneArrow<S>& motion, S* c) const {
    const Vector<S, 3> w = motion.before(attitudes[1]) * motion.turn(attitudes[1]) -
                           motion.before(attitudes[0]) * motion.turn(attitudes[0]);
    for (int i = 0; i < 3; ++i) c[i] = w(i);
  }
  void gradient(const BasicSceneArrow<S>& motion, Vector<S, 3>* g) const {
    RowSize size[rows];
    reaction(motion.before, g, size);
  }
  void reaction(const BasicConfiguration<S>& at, Vector<S, 3>* g, RowSize* size) const {
    for (int i = 0; i < 3; ++i) {
      g[2 * i] = -at(attitudes[0]).row(i).transpose();
      g[2 * i + 1] = at(attitudes[1]).row(i).transpose();
      size[i] = {0, 2};
    }
  }
};
using RelativeTurn = BasicRelativeTurn<>;

/// The distance of two points.
template <class S = double> struct BasicLength {
  static constexpr int rows = 1;
  std::array<Site, 2> sites;

  void value(const BasicConfiguration<S>& at, S* c) const { c[0] = (at(sites[1]) - at(sites[0])).norm(); }
  void gradient(const BasicConfiguration<S>& at, Vector<S, 3>* g, RowSize* size) const {
    g[1] = (at(sites[1]) - at(sites[0])).normalized();
    g[0] = -g[1];
    size[0] = {at.size(sites[0]) + at.size(sites[1]), 2};
  }
};
using Length = BasicLength<>;

/// A damper: a force -c times the rate of what J measures (of Length N s/m, of turns N m s).
template <class J, class S = double> struct Damper : J {
  S damping = 0;  ///< c
};

}  // namespace lagroid::multibody
