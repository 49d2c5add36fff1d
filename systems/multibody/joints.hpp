#pragma once
/// The joints that scenes can name are made of these: rods, coincident points, angles, planes; rolling, spins, blades;
/// and dampers of any of them. Each struct's comment has its equation.

#include <lagroid/systems/multibody/joint.hpp>

#include <array>
#include <cmath>

namespace lagroid::multibody {

/// Two points at a fixed distance: (|x1 - x0|^2 - l^2) / 2 = 0.
struct Rod {
  static constexpr int rows = 1;
  std::array<Site, 2> sites;
  double length = 1;  ///< l, m

  void value(const Configuration& at, double* c) const {
    c[0] = 0.5 * ((at(sites[1]) - at(sites[0])).squaredNorm() - length * length);
  }
  void gradient(const Configuration& at, Vec* g, RowSize* size) const {
    const Vec& a = at(sites[0]);
    const Vec& b = at(sites[1]);
    g[1] = b - a;
    g[0] = -g[1];
    size[0] = {length * (length + at.size(sites[0]) + at.size(sites[1])), 2 * length};
  }
};

/// Two points that are one: x1 - x0 = 0. A ball joint; between planar bodies a pin.
struct Coincidence {
  static constexpr int rows = 3;
  std::array<Site, 2> sites;

  void value(const Configuration& at, double* c) const {
    const Vec d = at(sites[1]) - at(sites[0]);
    for (int i = 0; i < 3; ++i) c[i] = d(i);
  }
  void gradient(const Configuration& at, Vec* g, RowSize* size) const {
    for (int i = 0; i < 3; ++i) {
      g[2 * i] = -Vec::Unit(i);
      g[2 * i + 1] = Vec::Unit(i);
      size[i] = {at.size(sites[0]) + at.size(sites[1]), 2};
    }
  }
};

/// Two directions, each fixed in a body, that keep their angle: (A0 u).(A1 v) = cosine.
struct FixedAngle {
  static constexpr int rows = 1;
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;
  Vec u{1, 0, 0};
  Vec v{0, 1, 0};
  double cosine = 0;

  void value(const Configuration& at, double* c) const {
    c[0] = (at(attitudes[0]) * u).dot(at(attitudes[1]) * v) - cosine;
  }
  void gradient(const Configuration& at, Vec* g, RowSize* size) const {
    const Mat& a = at(attitudes[0]);
    const Mat& b = at(attitudes[1]);
    g[0] = u.cross(Vec(a.transpose() * (b * v)));
    g[1] = v.cross(Vec(b.transpose() * (a * u)));
    size[0] = {3, 2};
  }
};

/// A point that stays in a plane fixed to a body through a point of it: (A n).(x1 - x0) = 0.
struct InPlane {
  static constexpr int rows = 1;
  std::array<Site, 2> sites;  ///< a point of the plane, the point that stays in it
  std::array<Attitude, 1> attitudes;
  Vec normal{0, 0, 1};

  void value(const Configuration& at, double* c) const {
    c[0] = (at(attitudes[0]) * normal).dot(at(sites[1]) - at(sites[0]));
  }
  void gradient(const Configuration& at, Vec* g, RowSize* size) const {
    const Mat& a = at(attitudes[0]);
    const Vec n = a * normal;
    const Vec d = at(sites[1]) - at(sites[0]);
    g[0] = -n;
    g[1] = n;
    g[2] = normal.cross(Vec(a.transpose() * d));
    size[0] = {at.size(sites[0]) + at.size(sites[1]), 2 + d.norm()};
  }
};

/// A ball whose centre moves at the height of its radius r over a level plate that turns about the origin at the rate
/// Omega: dx = h v of the point of the plate below, without slipping,
///     dx - r w2 + h Omega y = 0,   dy + r w1 - h Omega x = 0,
/// with the turn w = A xi in space and (x, y) the middle of the arrow; the reactions are those of a plate at rest.
struct Rolling {
  static constexpr int rows = 2;
  std::array<Site, 1> sites;
  std::array<Attitude, 1> attitudes;
  double radius = 1;      ///< r, m
  double plate_rate = 0;  ///< Omega, rad/s

  void value(const SceneArrow& motion, double* c) const {
    const Vec& d = motion.displacement(sites[0]);
    const Vec w = motion.before(attitudes[0]) * motion.turn(attitudes[0]);
    const Vec middle = motion.before(sites[0]) + 0.5 * d;
    const double turned = motion.h * plate_rate;
    c[0] = d(0) - radius * w(1) + turned * middle(1);
    c[1] = d(1) + radius * w(0) - turned * middle(0);
  }
  void gradient(const SceneArrow& motion, Vec* g) const {
    RowSize size[rows];
    reaction(motion.before, g, size);
    const double half = 0.5 * motion.h * plate_rate;
    g[0](1) += half;
    g[2](0) -= half;
  }
  void drift(const SceneArrow& motion, Vec* g) const {
    const Mat& a = motion.before(attitudes[0]);
    const Vec xi = motion.turn(attitudes[0]);
    const double turned = motion.h * plate_rate;
    g[0] = {0, turned, 0};
    g[1] = -radius * xi.cross(Vec(a.row(1)));
    g[2] = {-turned, 0, 0};
    g[3] = radius * xi.cross(Vec(a.row(0)));
  }
  void reaction(const Configuration& at, Vec* g, RowSize* size) const {
    const Mat& a = at(attitudes[0]);
    g[0] = Vec::UnitX();
    g[1] = -radius * a.row(1).transpose();
    g[2] = Vec::UnitY();
    g[3] = radius * a.row(0).transpose();
    size[0] = size[1] = {0, 1 + radius};
  }
};

/// A body that does not turn about the n-th axis of space, or turns about it at a given rate: n.(A xi) = h rate.
struct PrescribedSpin {
  static constexpr int rows = 1;
  std::array<Site, 0> sites;
  std::array<Attitude, 1> attitudes;
  Vec axis{0, 0, 1};  ///< n, of unit length, in space
  double rate = 0;    ///< rad/s

  void value(const SceneArrow& motion, double* c) const {
    c[0] = axis.dot(motion.before(attitudes[0]) * motion.turn(attitudes[0])) - motion.h * rate;
  }
  void gradient(const SceneArrow& motion, Vec* g) const {
    RowSize size[rows];
    reaction(motion.before, g, size);
  }
  void drift(const SceneArrow& motion, Vec* g) const {
    g[0] = motion.turn(attitudes[0]).cross(Vec(motion.before(attitudes[0]).transpose() * axis));
  }
  void reaction(const Configuration& at, Vec* g, RowSize* size) const {
    g[0] = at(attitudes[0]).transpose() * axis;
    size[0] = {0, 1};
  }
};

/// A blade under a planar body, which slides along it and not across (a sleigh, a wheel): n(theta + dtheta / 2).dx +
/// arm dtheta = h rate, with n at right angles to the blade and rate zero. Another rate is that of a belt; a blade at
/// right angles to the first, with a rate, keeps the speed.
struct Blade {
  static constexpr int rows = 1;
  std::array<Site, 1> sites;  ///< Scene::planar_place of the body
  double direction = 0;       ///< of the blade in the body, rad
  double arm = 0;             ///< how far the blade stands ahead of the centre of mass, along itself, m
  double rate = 0;            ///< m/s

  void value(const SceneArrow& motion, double* c) const {
    const Vec& d = motion.displacement(sites[0]);
    c[0] = across(motion.before(sites[0])(2) + 0.5 * d(2)).dot(d) + arm * d(2) - motion.h * rate;
  }
  void gradient(const SceneArrow& motion, Vec* g) const {
    const Vec& d = motion.displacement(sites[0]);
    const double angle = motion.before(sites[0])(2) + 0.5 * d(2);
    g[0] = across(angle);
    g[0](2) = arm + 0.5 * across(angle + 0.5 * M_PI).dot(d);
  }
  void drift(const SceneArrow& motion, Vec* g) const {
    const Vec& d = motion.displacement(sites[0]);
    g[0] = {0, 0, across(motion.before(sites[0])(2) + 0.5 * d(2) + 0.5 * M_PI).dot(d)};
  }
  void reaction(const Configuration& at, Vec* g, RowSize* size) const {
    g[0] = across(at(sites[0])(2));
    g[0](2) = arm;
    size[0] = {0, (1 + std::abs(arm)) * (1 + std::abs(at(sites[0])(2)))};
  }

 private:
  Vec across(double angle) const { return {-std::sin(angle + direction), std::cos(angle + direction), 0}; }
};

/// A constraint on arrows under the vakonomic principle, with its multipliers at the start: what an optimal control
/// that minimises the kinetic terms obeys.
template <class J> struct Vakonomic : J { std::array<double, std::size_t(J::rows)> multipliers{}; };

/// A body that does not turn about an axis of its own, or turns about it at a given rate: n.xi = h rate.
struct BodySpin {
  static constexpr int rows = 1;
  std::array<Site, 0> sites;
  std::array<Attitude, 1> attitudes;
  Vec axis{0, 0, 1};  ///< n, of unit length, in the body
  double rate = 0;    ///< rad/s

  void value(const SceneArrow& motion, double* c) const {
    c[0] = axis.dot(motion.turn(attitudes[0])) - motion.h * rate;
  }
  void gradient(const SceneArrow&, Vec* g) const { g[0] = axis; }
  void drift(const SceneArrow&, Vec* g) const { g[0] = Vec::Zero(); }
  void reaction(const Configuration&, Vec* g, RowSize* size) const {
    g[0] = axis;
    size[0] = {0, 1};
  }
};

/// Two hinged bodies that turn against each other, about the axis that is u in the first and v in the second, at a
/// given rate: the angle of R^T R' about v is h rate, R = A0^T A1.
struct HingeTurn {
  static constexpr int rows = 1;
  static constexpr bool along_target = true;
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;
  Vec u{0, 0, 1};
  Vec v{0, 0, 1};
  double rate = 0;  ///< rad/s

  void value(const SceneArrow& motion, double* c) const {
    const auto relative = [&](const Configuration& at) -> Mat {
      return at(attitudes[0]).transpose() * at(attitudes[1]);
    };
    const Mat turn = relative(motion.before).transpose() * relative(motion.after);
    const double sine = 0.5 * v.dot(Vec(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)));
    c[0] = std::atan2(sine, 0.5 * (turn.trace() - 1)) - motion.h * rate;
  }
  void gradient(const SceneArrow&, Vec* g) const {
    g[0] = -u;
    g[1] = v;
  }
  void reaction(const Configuration&, Vec* g, RowSize* size) const {
    g[0] = -u;
    g[1] = v;
    size[0] = {2, 2};
  }
};

/// How two bodies turn against each other: A1 xi1 - A0 xi0, in space.
struct RelativeTurn {
  static constexpr int rows = 3;
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;

  void value(const SceneArrow& motion, double* c) const {
    const Vec w = motion.before(attitudes[1]) * motion.turn(attitudes[1]) -
                  motion.before(attitudes[0]) * motion.turn(attitudes[0]);
    for (int i = 0; i < 3; ++i) c[i] = w(i);
  }
  void gradient(const SceneArrow& motion, Vec* g) const {
    RowSize size[rows];
    reaction(motion.before, g, size);
  }
  void reaction(const Configuration& at, Vec* g, RowSize* size) const {
    for (int i = 0; i < 3; ++i) {
      g[2 * i] = -at(attitudes[0]).row(i).transpose();
      g[2 * i + 1] = at(attitudes[1]).row(i).transpose();
      size[i] = {0, 2};
    }
  }
};

/// The distance of two points.
struct Length {
  static constexpr int rows = 1;
  std::array<Site, 2> sites;

  void value(const Configuration& at, double* c) const { c[0] = (at(sites[1]) - at(sites[0])).norm(); }
  void gradient(const Configuration& at, Vec* g, RowSize* size) const {
    g[1] = (at(sites[1]) - at(sites[0])).normalized();
    g[0] = -g[1];
    size[0] = {at.size(sites[0]) + at.size(sites[1]), 2};
  }
};

/// A damper: a force -c times the rate of what J measures (of Length N s/m, of turns N m s).
template <class J> struct Damper : J {
  double damping = 0;  ///< c
};

}  // namespace lagroid::multibody
