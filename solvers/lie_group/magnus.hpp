#pragma once
/// Magnus integrators for linear equations z' = A(t)_M(z) on homogeneous spaces, of order 2, 4 or 6:
///
///     z <- exp(Omega) z,    Omega = int A - 1/2 int int_{s < t} [A(s), A(t)] + ...
///
/// Where the equation is linear they need fewer exponentials than general methods: one a step.
///
///     auto a = [](double t, auto& out) { out = Eigen::Vector3d(1, t, 0); };
///     Spheres<1>::Point z(0, 0, 1);
///     MagnusStep<Spheres<1>>({}, 4).advance(a, 0, 0.1, z);  // order 4; t, h
///
/// Any other order throws std::invalid_argument. Whether numbers are finite is for the caller to look at. (Blanes,
/// Casas and Ros, BIT 40 (2000).)

#include <lagroid/core/hamiltonian/homogeneous_space.hpp>
#include <lagroid/solvers/methods/method.hpp>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace lagroid {

/// Steps z' = A(t)_M(z), for matrices Y' = A(t) Y, by z <- exp(Omega) z, where Omega is Magnus' series with integrals
/// by Gauss' points: of order 2, 4 or 6 (Blanes, Casas and Ros, BIT 40 (2000)). A(t) is a map double -> Algebra& to be
/// written.
///
///     2: Omega = h A(t + h/2)
///     4: Omega = h (A_1 + A_2) / 2 - h^2 sqrt(3) [A_1, A_2] / 12
///     6: Omega = a_1 + a_3 / 12 + [-20 a_1 - a_3 + C_1, a_2 + C_2] / 240,
///        C_1 = [a_1, a_2],  C_2 = -[a_1, 2 a_3 + C_1] / 60,
///        a_1 = h A_2,  a_2 = sqrt(15) h (A_3 - A_1) / 3,  a_3 = 10 h (A_3 - 2 A_2 + A_1) / 3
template <HomogeneousSpace M> class MagnusStep {
 public:
  using Point = typename M::Point;
  using Algebra = typename M::Algebra;

  /// Throws std::invalid_argument for any other order.
  MagnusStep(M space, int order) : space_(std::move(space)), order_(order) {
    if (order != 2 && order != 4 && order != 6)
      throw std::invalid_argument("Magnus integrators are of order 2, 4 or 6, not " + std::to_string(order));
    for (Algebra* u : {&a1_, &a2_, &a3_, &c1_, &c2_, &omega_}) *u = space_.zero_algebra();
  }

  const M& space() const { return space_; }
  MethodTraits traits() const { return {"magnus-" + std::to_string(order_), order_, true, false, true, order_ / 2}; }

  template <class A> void advance(A& a, double t, double h, Point& z) {
    if (order_ == 2) {
      a(t + h / 2, omega_);
      omega_ *= h;
    } else if (order_ == 4) {
      const double half = std::sqrt(3.0) / 6;
      a(t + (0.5 - half) * h, a1_);
      a(t + (0.5 + half) * h, a2_);
      space_.bracket(a1_, a2_, c1_);
      omega_ = (a1_ + a2_) * (h / 2) - c1_ * (h * h * std::sqrt(3.0) / 12);
    } else {
      sixth(a, t, h);
    }
    space_.act(omega_, z);
  }

 private:
  template <class A> void sixth(A& a, double t, double h) {
    const double root = std::sqrt(15.0);
    a(t + (0.5 - root / 10) * h, a1_);
    a(t + h / 2, omega_);
    a(t + (0.5 + root / 10) * h, a3_);
    a2_ = (a3_ - a1_) * (root * h / 3);
    a3_ = (a3_ - omega_ * 2.0 + a1_).eval() * (10 * h / 3);
    a1_ = omega_ * h;
    space_.bracket(a1_, a2_, c1_);
    omega_ = a3_ * 2.0 + c1_;
    space_.bracket(a1_, omega_, c2_);
    a2_ -= c2_ * (1.0 / 60);
    omega_ = c1_ - a1_ * 20.0 - a3_;
    space_.bracket(omega_, a2_, c2_);
    omega_ = a1_ + a3_ * (1.0 / 12) + c2_ * (1.0 / 240);
  }

  M space_;
  int order_;
  Algebra a1_, a2_, a3_, c1_, c2_, omega_;
};

}  // namespace lagroid
