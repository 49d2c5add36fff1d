// The exact discrete Lagrangian ([G] 7.2) as the oracle of order: the action of the continuous solution over one step.
#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss.hpp>

#include <cmath>
#include <functional>
#include <vector>

using namespace lagroid;

namespace integrators_exact_lagrangian_tests {
namespace {

/// An arrow of the exact flow, and the exact discrete Lagrangian there.
template <class Sys> struct Exact {
  ArrowOf<typename Sys::GroupoidType> arrow;
  State<typename Sys::GroupoidType> end;
  double lagrangian;
};

/// The integral of l along the solution, by Gauss quadrature.
double integral(const std::function<double(double)>& l, double h) {
  return boost::math::quadrature::gauss<double, 10>::integrate(l, 0.0, h);
}

template <class Sys> Exact<Sys> exact_point(const Sys& system, const State<Pair<Sys::dimension>>& start, double h) {
  const auto end = system.reference(start, h);
  const auto l = [&](double t) {
    const auto z = system.reference(start, t);
    return z.momentum.squaredNorm() / system.mass() - system.energy(z);  // p.q' - H
  };
  return {{start.object, end.object}, end, integral(l, h)};
}
Exact<RigidBody> exact(const RigidBody& system, const State<SO3>& start, double h) {
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto end = system.reference(start, attitude, h);
  return {attitude, end, h * system.energy(start)};
}
Exact<HeavyTop> exact(const HeavyTop& system, const State<HeavyTop::GroupoidType>& start, double h) {
  Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const auto end = system.reference(start, attitude, h);
  const auto l = [&](double t) {
    Matrix<double, 3, 3> unused = Matrix<double, 3, 3>::Identity();
    return system.energy(start) - 2 * system.weight.dot(system.reference(start, unused, t).object);  // T - U = H - 2 U
  };
  return {{attitude, start.object}, end, integral(l, h)};
}
Exact<Kepler> exact(const Kepler& system, const State<Pair<2>>& start, double h) {
  return exact_point(system, start, h);
}
Exact<Pendulum> exact(const Pendulum& system, const State<Pair<1>>& start, double h) {
  return exact_point(system, start, h);
}

/// On arrows of the exact flow L - L_exact = O(h^3) and the Legendre transforms are those of the exact flow up to
/// O(h^2): order two.
template <class Sys> void expect_order_two(Sys system, const State<typename Sys::GroupoidType>& start) {
  std::vector<double> action;
  std::vector<double> momentum;
  for (const double h : {0.04, 0.02, 0.01}) {
    system.h = h;
    const auto e = exact(system, start, h);
    action.push_back(std::abs(system.lagrangian(e.arrow) - e.lagrangian));
    const Step<Sys> step{e.arrow, {}};
    momentum.push_back((legendre_minus(system, step).momentum - start.momentum).norm() +
                       (legendre_plus(system, step).momentum - e.end.momentum).norm());
  }
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(std::log2(action[i] / action[i + 1]), 3, 0.15);
    EXPECT_NEAR(std::log2(momentum[i] / momentum[i + 1]), 2, 0.15);
  }
}

TEST(ExactLagrangian, OfKepler) {
  for (const auto quadrature : {Quadrature::midpoint, Quadrature::trapezoid}) {
    Kepler system;
    system.quadrature = quadrature;
    expect_order_two(system, {{1, 0.2}, {0.1, 0.9}});
  }
}
TEST(ExactLagrangian, OfThePendulum) {
  for (const auto quadrature : {Quadrature::midpoint, Quadrature::trapezoid}) {
    Pendulum system;
    system.quadrature = quadrature;
    expect_order_two(system, {Vector<double, 1>(0.8), Vector<double, 1>(0.5)});
  }
}
TEST(ExactLagrangian, OfTheRigidBody) {
  for (const auto map : {RotationMap::exponential, RotationMap::cayley}) {
    RigidBody system;
    system.rotation = map;
    expect_order_two(system, {{}, Vector<double, 3>(0.7, 1.2, -0.4)});
  }
}
TEST(ExactLagrangian, OfTheHeavyTop) {
  for (const auto map : {RotationMap::exponential, RotationMap::cayley}) {
    HeavyTop system;
    system.inertia << 1.1, 0.8, 0.5;
    system.weight << 0.3, -0.2, 0.9;
    system.rotation = map;
    expect_order_two(system, {Vector<double, 3>(0.48, 0.6, 0.64), Vector<double, 3>(0.3, -0.2, 0.5)});
  }
}

}  // namespace
}  // namespace integrators_exact_lagrangian_tests
