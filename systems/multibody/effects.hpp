#pragma once
/// The effects that scenes can name: weights and other forces, gravity, springs, centrifugal forces, torques and
/// motors. Each struct's comment has its energy or its force.

#include <lagroid/systems/multibody/effect.hpp>

#include <cmath>

namespace lagroid::multibody {

/// A constant force, such as a weight m g: U = -f.x.
struct ConstantForce {
  std::array<Site, 1> sites;
  Vec force;  ///< N

  double energy(const Configuration& at) const { return -force.dot(at(sites[0])); }
  void add_loads(const Configuration&, Loads& f) const { f(sites[0]) += force; }
};

/// Attraction by a fixed centre: U = -strength / |x - centre|.
struct CentralGravity {
  static constexpr bool attracts = true;
  std::array<Site, 1> sites;
  Vec centre = Vec::Zero();  ///< m
  double strength = 1;       ///< G m M, kg m^3/s^2

  double energy(const Configuration& at) const { return -strength / (at(sites[0]) - centre).norm(); }
  void add_loads(const Configuration& at, Loads& f) const {
    const Vec d = at(sites[0]) - centre;
    const double square = d.squaredNorm();
    f(sites[0]) -= (strength / (square * std::sqrt(square))) * d;
  }
};

/// Attraction (or repulsion) of two: U = -strength / sqrt(|x1 - x0|^2 + softening^2): gravity with strength G m0 m1,
/// and charges with strength -k q0 q1.
struct InverseSquare {
  std::array<Site, 2> sites;
  double strength = 1;   ///< kg m^3/s^2
  double softening = 0;  ///< m

  double energy(const Configuration& at) const {
    return -strength / std::sqrt((at(sites[1]) - at(sites[0])).squaredNorm() + softening * softening);
  }
  void add_loads(const Configuration& at, Loads& f) const {
    const Vec d = at(sites[1]) - at(sites[0]);
    const double square = d.squaredNorm() + softening * softening;
    const Vec pull = (strength / (square * std::sqrt(square))) * d;
    f(sites[0]) += pull;
    f(sites[1]) -= pull;
  }
};

/// Attraction of all pairs of bodies: U = -sum_{i<j} G m_i m_j / sqrt(|x_i - x_j|^2 + softening^2).
class MutualGravity final : public Effects {
 public:
  MutualGravity(double constant, double softening) : constant_(constant), square_softening_(softening * softening) {}
  void add(Site site, double mass) {
    sites_.push_back(site);
    masses_.push_back(mass);
  }
  bool attracts() const override { return true; }

  double energy(const Configuration& at) const override {
    double sum = 0;
    for (std::size_t i = 0; i < sites_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        sum -= masses_[i] * masses_[j] / std::sqrt((at(sites_[i]) - at(sites_[j])).squaredNorm() + square_softening_);
    return constant_ * sum;
  }
  void add_loads(const Configuration& at, Loads& f) const override {
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      const Vec x = at(sites_[i]);
      Vec sum = Vec::Zero();
      for (std::size_t j = 0; j < i; ++j) {
        const Vec d = at(sites_[j]) - x;
        const double square = d.squaredNorm() + square_softening_;
        const Vec pull = (constant_ * masses_[i] * masses_[j] / (square * std::sqrt(square))) * d;
        sum += pull;
        f(sites_[j]) -= pull;
      }
      f(sites_[i]) += sum;
    }
  }
  void place(const Places& places) override {
    for (Site& s : sites_) s = places(s);
  }
  std::vector<Site> sites() const override { return sites_; }

 private:
  double constant_;
  double square_softening_;
  std::vector<Site> sites_;
  std::vector<double> masses_;
};

/// U = k (|x1 - x0| - l)^2 / 2. Requires that the ends do not meet, unless l = 0.
struct Spring {
  std::array<Site, 2> sites;
  double stiffness = 1;  ///< k, N/m
  double length = 0;     ///< l, at rest, m

  double energy(const Configuration& at) const {
    const double stretch = (at(sites[1]) - at(sites[0])).norm() - length;
    return 0.5 * stiffness * stretch * stretch;
  }
  void add_loads(const Configuration& at, Loads& f) const {
    const Vec d = at(sites[1]) - at(sites[0]);
    const double factor = length == 0 ? stiffness : stiffness * (1 - length / d.norm());
    f(sites[0]) += factor * d;
    f(sites[1]) -= factor * d;
  }
};

/// A torsional spring between the axes u of one body and v of another (each fixed in it, of unit length): U = k (1 -
/// cos(angle between them)), for small angles k angle^2 / 2.
struct TorsionSpring {
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;
  Vec u{0, 0, 1};
  Vec v{0, 0, 1};
  double stiffness = 1;  ///< k, N m

  double energy(const Configuration& at) const {
    return 0.5 * stiffness * (at(attitudes[0]) * u - at(attitudes[1]) * v).squaredNorm();
  }
  void add_loads(const Configuration& at, Loads& f) const {
    const Mat& a = at(attitudes[0]);
    const Mat& b = at(attitudes[1]);
    f(attitudes[0]) += stiffness * u.cross(Vec(a.transpose() * (b * v)));
    f(attitudes[1]) += stiffness * v.cross(Vec(b.transpose() * (a * u)));
  }
};

/// The same between planar bodies, of angles a and b: U = k (1 - cos(b - a - rest)).
struct PlanarTorsionSpring {
  std::array<Site, 2> sites;  ///< Scene::planar_place of the bodies; the ground's angle is zero at the origin
  double stiffness = 1;       ///< k, N m
  double rest = 0;            ///< b - a at rest, rad

  double energy(const Configuration& at) const {
    const double half = std::sin(0.5 * twist(at));
    return 2 * stiffness * half * half;
  }
  void add_loads(const Configuration& at, Loads& f) const {
    const double torque = stiffness * std::sin(twist(at));
    f(sites[0])(2) += torque;
    f(sites[1])(2) -= torque;
  }

 private:
  double twist(const Configuration& at) const { return at(sites[1])(2) - at(sites[0])(2) - rest; }
};

/// What a frame that turns about an axis through the origin puts on a mass at rest in it: U = -m |Omega x x|^2 / 2. The
/// other part, on a mass that moves, is `Scene::gyroscopic_force` by 2 m Omega.
struct Centrifugal {
  std::array<Site, 1> sites;
  double mass = 1;
  Vec rate{0, 0, 1};  ///< Omega, rad/s

  double energy(const Configuration& at) const { return -0.5 * mass * rate.cross(at(sites[0])).squaredNorm(); }
  void add_loads(const Configuration& at, Loads& f) const {
    f(sites[0]) -= mass * rate.cross(Vec(rate.cross(at(sites[0]))));
  }
};

/// A force f cos(rate t + phase) at a point, in space.
struct PeriodicForce {
  std::array<Site, 1> sites;
  Vec force;         ///< N
  double rate = 0;   ///< rad/s
  double phase = 0;  ///< rad

  double energy(const Configuration&) const { return 0; }
  void add_loads(const Configuration& at, Loads& f) const { f(sites[0]) += std::cos(rate * at.time + phase) * force; }
};

/// A torque fixed in the body.
struct BodyTorque {
  std::array<Site, 0> sites;
  std::array<Attitude, 1> attitudes;
  Vec torque;  ///< N m

  double energy(const Configuration&) const { return 0; }
  void add_loads(const Configuration&, Loads& f) const { f(attitudes[0]) += torque; }
};

/// A motor between two bodies: the torque cos(rate t + phase) on the second about an axis fixed in the first, and its
/// opposite on the first.
struct Motor {
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;
  Vec torque;        ///< in the first body's frame, N m
  double rate = 0;   ///< rad/s
  double phase = 0;  ///< rad

  double energy(const Configuration&) const { return 0; }
  void add_loads(const Configuration& at, Loads& f) const {
    const Vec now = std::cos(rate * at.time + phase) * torque;
    f(attitudes[0]) -= now;
    f(attitudes[1]) += at(attitudes[1]).transpose() * (at(attitudes[0]) * now);
  }
};

}  // namespace lagroid::multibody
