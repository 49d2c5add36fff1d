#pragma once
/// The effects that scenes can name: weights and other forces, gravity, springs, centrifugal forces, torques and
/// motors. Each struct's comment has its energy or its force.

#include <lagroid/systems/multibody/effect.hpp>

#include <cmath>

namespace lagroid::multibody {

/// A constant force, such as a weight m g: U = -f.x.
template <class S = double> struct BasicConstantForce {
  std::array<Site, 1> sites;
  Vector<S, 3> force;  ///< N

  S energy(const BasicConfiguration<S>& at) const { return -force.dot(at(sites[0])); }
  void add_loads(const BasicConfiguration<S>&, BasicLoads<S>& f) const { f(sites[0]) += force; }
};
using ConstantForce = BasicConstantForce<>;

/// Attraction by a fixed centre: U = -strength / |x - centre|.
template <class S = double> struct BasicCentralGravity {
  static constexpr bool attracts = true;
  std::array<Site, 1> sites;
  Vector<S, 3> centre = Vector<S, 3>::Zero();  ///< m
  S strength = 1;                              ///< G m M, kg m^3/s^2

  S energy(const BasicConfiguration<S>& at) const { return -strength / (at(sites[0]) - centre).norm(); }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    using std::sqrt;
    const Vector<S, 3> d = at(sites[0]) - centre;
    const S square = d.squaredNorm();
    f(sites[0]) -= (strength / (square * sqrt(square))) * d;
  }
};
using CentralGravity = BasicCentralGravity<>;

/// Attraction (or repulsion) of two: U = -strength / sqrt(|x1 - x0|^2 + softening^2): gravity with strength G m0 m1,
/// and charges with strength -k q0 q1.
template <class S = double> struct BasicInverseSquare {
  std::array<Site, 2> sites;
  S strength = 1;   ///< kg m^3/s^2
  S softening = 0;  ///< m

  S energy(const BasicConfiguration<S>& at) const {
    using std::sqrt;
    return -strength / sqrt((at(sites[1]) - at(sites[0])).squaredNorm() + softening * softening);
  }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    using std::sqrt;
    const Vector<S, 3> d = at(sites[1]) - at(sites[0]);
    const S square = d.squaredNorm() + softening * softening;
    const Vector<S, 3> pull = (strength / (square * sqrt(square))) * d;
    f(sites[0]) += pull;
    f(sites[1]) -= pull;
  }
};
using InverseSquare = BasicInverseSquare<>;

/// Attraction of all pairs of bodies: U = -sum_{i<j} G m_i m_j / sqrt(|x_i - x_j|^2 + softening^2).
template <class S = double> class BasicMutualGravity final : public BasicEffects<S> {
 public:
  BasicMutualGravity(const S& constant, const S& softening)
      : constant_(constant), square_softening_(softening * softening) {}
  void add(Site site, const S& mass) {
    sites_.push_back(site);
    masses_.push_back(mass);
  }
  bool attracts() const override { return true; }

  S energy(const BasicConfiguration<S>& at) const override {
    using std::sqrt;
    S sum = 0;
    for (std::size_t i = 0; i < sites_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        sum -= masses_[i] * masses_[j] / sqrt((at(sites_[i]) - at(sites_[j])).squaredNorm() + square_softening_);
    return constant_ * sum;
  }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const override {
    using std::sqrt;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      const Vector<S, 3> x = at(sites_[i]);
      Vector<S, 3> sum = Vector<S, 3>::Zero();
      for (std::size_t j = 0; j < i; ++j) {
        const Vector<S, 3> d = at(sites_[j]) - x;
        const S square = d.squaredNorm() + square_softening_;
        const Vector<S, 3> pull = (constant_ * masses_[i] * masses_[j] / (square * sqrt(square))) * d;
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
  S constant_;
  S square_softening_;
  std::vector<Site> sites_;
  std::vector<S> masses_;
};
using MutualGravity = BasicMutualGravity<>;

/// U = k (|x1 - x0| - l)^2 / 2. Requires that the ends do not meet, unless l = 0.
template <class S = double> struct BasicSpring {
  std::array<Site, 2> sites;
  S stiffness = 1;  ///< k, N/m
  S length = 0;     ///< l, at rest, m

  S energy(const BasicConfiguration<S>& at) const {
    const S stretch = (at(sites[1]) - at(sites[0])).norm() - length;
    return 0.5 * stiffness * stretch * stretch;
  }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    const Vector<S, 3> d = at(sites[1]) - at(sites[0]);
    const S factor = stays_zero(length) ? stiffness : stiffness * (1 - length / d.norm());
    f(sites[0]) += factor * d;
    f(sites[1]) -= factor * d;
  }
};
using Spring = BasicSpring<>;

/// A torsional spring between the axes u of one body and v of another (each fixed in it, of unit length): U = k (1 -
/// cos(angle between them)), for small angles k angle^2 / 2.
template <class S = double> struct BasicTorsionSpring {
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;
  Vector<S, 3> u{0, 0, 1};
  Vector<S, 3> v{0, 0, 1};
  S stiffness = 1;  ///< k, N m

  S energy(const BasicConfiguration<S>& at) const {
    return 0.5 * stiffness * (at(attitudes[0]) * u - at(attitudes[1]) * v).squaredNorm();
  }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    const Matrix<S, 3, 3>& a = at(attitudes[0]);
    const Matrix<S, 3, 3>& b = at(attitudes[1]);
    f(attitudes[0]) += stiffness * u.cross(Vector<S, 3>(a.transpose() * (b * v)));
    f(attitudes[1]) += stiffness * v.cross(Vector<S, 3>(b.transpose() * (a * u)));
  }
};
using TorsionSpring = BasicTorsionSpring<>;

/// The same between planar bodies, of angles a and b: U = k (1 - cos(b - a - rest)).
template <class S = double> struct BasicPlanarTorsionSpring {
  std::array<Site, 2> sites;  ///< Scene::planar_place of the bodies; the ground's angle is zero at the origin
  S stiffness = 1;            ///< k, N m
  S rest = 0;                 ///< b - a at rest, rad

  S energy(const BasicConfiguration<S>& at) const {
    using std::sin;
    const S half = sin(0.5 * twist(at));
    return 2 * stiffness * half * half;
  }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    using std::sin;
    const S torque = stiffness * sin(twist(at));
    f(sites[0])(2) += torque;
    f(sites[1])(2) -= torque;
  }

 private:
  S twist(const BasicConfiguration<S>& at) const { return at(sites[1])(2) - at(sites[0])(2) - rest; }
};
using PlanarTorsionSpring = BasicPlanarTorsionSpring<>;

/// What a frame that turns about an axis through the origin puts on a mass at rest in it: U = -m |Omega x x|^2 / 2. The
/// other part, on a mass that moves, is `Scene::gyroscopic_force` by 2 m Omega.
template <class S = double> struct BasicCentrifugal {
  std::array<Site, 1> sites;
  S mass = 1;
  Vector<S, 3> rate{0, 0, 1};  ///< Omega, rad/s

  S energy(const BasicConfiguration<S>& at) const { return -0.5 * mass * rate.cross(at(sites[0])).squaredNorm(); }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    f(sites[0]) -= mass * rate.cross(Vector<S, 3>(rate.cross(at(sites[0]))));
  }
};
using Centrifugal = BasicCentrifugal<>;

/// A force f cos(rate t + phase) at a point, in space.
template <class S = double> struct BasicPeriodicForce {
  std::array<Site, 1> sites;
  Vector<S, 3> force;  ///< N
  S rate = 0;          ///< rad/s
  S phase = 0;         ///< rad

  S energy(const BasicConfiguration<S>&) const { return 0; }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    using std::cos;
    f(sites[0]) += cos(rate * at.time + phase) * force;
  }
};
using PeriodicForce = BasicPeriodicForce<>;

/// A torque fixed in the body.
template <class S = double> struct BasicBodyTorque {
  std::array<Site, 0> sites;
  std::array<Attitude, 1> attitudes;
  Vector<S, 3> torque;  ///< N m

  S energy(const BasicConfiguration<S>&) const { return 0; }
  void add_loads(const BasicConfiguration<S>&, BasicLoads<S>& f) const { f(attitudes[0]) += torque; }
};
using BodyTorque = BasicBodyTorque<>;

/// A motor between two bodies: the torque cos(rate t + phase) on the second about an axis fixed in the first, and its
/// opposite on the first.
template <class S = double> struct BasicMotor {
  std::array<Site, 0> sites;
  std::array<Attitude, 2> attitudes;
  Vector<S, 3> torque;  ///< in the first body's frame, N m
  S rate = 0;           ///< rad/s
  S phase = 0;          ///< rad

  S energy(const BasicConfiguration<S>&) const { return 0; }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    using std::cos;
    const Vector<S, 3> now = cos(rate * at.time + phase) * torque;
    f(attitudes[0]) -= now;
    f(attitudes[1]) += at(attitudes[1]).transpose() * (at(attitudes[0]) * now);
  }
};
using Motor = BasicMotor<>;

}  // namespace lagroid::multibody
