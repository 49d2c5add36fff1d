#pragma once
/// Continuous Lagrangians that tests discretise, and what they are compared with.

#include <lagroid/core/continuous/continuous_lagrangian.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/core/parameter.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>
#include <lagroid/systems/reference.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <tuple>
#include <vector>

namespace lagroid::subjects {

/// v^2 / 2 + cos q.
struct Swing : ContinuousLagrangian<Pair<1>> {
  double gravity = 1;
  static auto parameters() { return std::tuple(parameter("gravity", &Swing::gravity, "m/s^2", "acceleration")); }
  template <class S> S l(const Vector<S, 1>& q, const Vector<S, 1>& v) const {
    using std::cos;
    return v(0) * v(0) * 0.5 + cos(q(0)) * varied<S>(gravity);
  }
};

/// |v|^2 / 2 + 1 / |q|, with its symmetry.
struct Orbit : ContinuousLagrangian<Pair<2>> {
  template <class S> S l(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    using std::sqrt;
    return (v(0) * v(0) + v(1) * v(1)) * 0.5 + 1.0 / sqrt(q(0) * q(0) + q(1) * q(1));
  }
  template <class Sys> std::vector<Symmetry<Sys>> symmetries_of() const {
    return {{"angular momentum", [](const Vector<double, 2>& q) { return Vector<double, 2>(-q(1), q(0)); }}};
  }
};

/// w.I w / 2 on SO(3), with whatever retraction.
template <class Group> struct FreeBody : ContinuousLagrangian<Group> {
  Vector<double, 3> inertia{1, 2, 3};
  template <class S> S l(const Vector<S, 0>&, const Vector<S, 3>& w) const {
    return (w(0) * w(0) * inertia(0) + w(1) * w(1) * inertia(1) + w(2) * w(2) * inertia(2)) * 0.5;
  }
};

/// w.I w / 2 - weight.v, v the vertical seen from the body.
struct Top : ContinuousLagrangian<Action<SO3, RotatedDirections>> {
  Vector<double, 3> inertia{1, 1.3, 0.5};
  Vector<double, 3> weight{0.2, 0, 1};
  template <class S> S l(const Vector<S, 3>& v, const Vector<S, 3>& w) const {
    return (w(0) * w(0) * inertia(0) + w(1) * w(1) * inertia(1) + w(2) * w(2) * inertia(2)) * 0.5 -
           (v(0) * weight(0) + v(1) * weight(1) + v(2) * weight(2));
  }
  template <class Sys> std::vector<Symmetry<Sys>> symmetries_of() const {
    return {{"vertical momentum", [](const Vector<double, 3>& v) { return v; }}};
  }
};

inline const State<Top::GroupoidType> top_start{{0, 0.6, 0.8}, {0.4, 0.2, 1.5}};
/// Vertical and momentum of the top: M' = M x w + v x weight, v' = v x w.
inline Eigen::VectorXd top_end(double t) {
  const auto rates = [top = Top{}](const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    const Vector<double, 3> v = y.head<3>();
    const Vector<double, 3> momentum = y.tail<3>();
    const Vector<double, 3> w = momentum.cwiseQuotient(top.inertia);
    dy.head<3>() = v.cross(w);
    dy.tail<3>() = momentum.cross(w) + v.cross(top.weight);
  };
  Eigen::VectorXd y(6);
  y << top_start.object, top_start.momentum;
  return integrate_reference(rates, y, t);
}

/// A charge in a potential, by the isoperimetric problem: (x'^2 + y'^2) / 2 - x^2 / 4 - y^2 / 3 - x^2 y^2 / 5
/// on R^3 with z' = (x y' - y x') / 2.
struct Area : ContinuousLagrangian<Pair<3>, 1> {
  template <class S> S l(const Vector<S, 3>& q, const Vector<S, 3>& v) const {
    const S x = q(0) * q(0);
    const S y = q(1) * q(1);
    return (v(0) * v(0) + v(1) * v(1)) * 0.5 - x * 0.25 - y / 3.0 - x * y * 0.2;
  }
  template <class S> Vector<S, 1> psi(const Vector<S, 3>& q, const Vector<S, 3>& v) const {
    return Vector<S, 1>(v(2) - (q(0) * v(1) - q(1) * v(0)) * 0.5);
  }
};

/// A bead on the unit sphere under gravity: |v|^2 / 2 - z, |q|^2 = 1.
struct Bead : ContinuousLagrangian<Pair<3>, 0, 1> {
  template <class S> S l(const Vector<S, 3>& q, const Vector<S, 3>& v) const {
    return (v(0) * v(0) + v(1) * v(1) + v(2) * v(2)) * 0.5 - q(2);
  }
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>((q(0) * q(0) + q(1) * q(1) + q(2) * q(2) - 1.0) * 0.5);
  }
};
inline const State<Pair<3>> bead_start{{0.6, 0, -0.8}, {0, 0.7, 0}};
/// Where the bead is: q'' = -e3 + (q_3 - |v|^2) q.
inline Vector<double, 3> bead_end(double t) {
  const auto rates = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) {
    dy.head<3>() = y.tail<3>();
    dy.tail<3>() = (y(2) - y.tail<3>().squaredNorm()) * y.head<3>();
    dy(5) -= 1;
  };
  Eigen::VectorXd y(6);
  y << bead_start.object, bead_start.momentum;
  return integrate_reference(rates, y, t).head<3>();
}

/// Euler's elastica: w^2 / 2 on SE(2), v1 = 1, v2 = 0.
struct Elastica : ContinuousLagrangian<SE2, 2> {
  template <class S> S l(const Vector<S, 0>&, const Vector<S, 3>& xi) const { return xi(0) * xi(0) * 0.5; }
  template <class S> Vector<S, 2> psi(const Vector<S, 0>&, const Vector<S, 3>& xi) const {
    return {xi(1) - 1.0, xi(2)};
  }
};

/// A motion of the elastica: w = M, M' = -p2, p1' = w p2, p2' = -w p1.
inline const Vector<double, 3> elastica_start(0.5, 1.2, -0.7);
inline Eigen::VectorXd elastica_end(double t) {
  const auto rates = [](const Eigen::VectorXd& y, Eigen::VectorXd& dy) { dy << -y(2), y(0) * y(2), -y(0) * y(1); };
  return integrate_reference(rates, elastica_start, t);
}

template <class Sys> FixedStepIntegrator<Sys> make(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  return {system, start, system.groupoid.unit(start.object), std::make_unique<NewtonStep<Sys>>()};
}

/// Objects and momenta, and attitudes where there are any.
template <class Sys> Eigen::VectorXd numbers(const Sys& system, const TrajectoryPoint<Sys>& p) {
  const auto q = system.groupoid.coordinates_of_object(p.state.object);
  const auto g = system.groupoid.coordinates_of_arrow(p.configuration);
  Eigen::VectorXd out(q.size() + p.state.momentum.size() + g.size());
  out << q, p.state.momentum, g;
  return out;
}

template <class Sys> struct Case {
  Sys system;
  State<typename Sys::GroupoidType> start;
  double horizon;
  Eigen::VectorXd exact;
};

/// Measures the order in what `seen(system, point)` has of the end, and expects the declared one.
template <class Sys, class Seen>
void expect_order_in(const Seen& seen, const Case<Sys>& c, int coarsest, double tolerance, double plateau) {
  laws::OrderProblem problem;
  problem.exact = c.exact;
  problem.coarsest = coarsest;
  problem.plateau = plateau;
  problem.end = [&](int steps) {
    Sys system = c.system;
    system.h = c.horizon / steps;
    auto run = make(system, c.start);
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(run.advance().converged()) << k;
    return Eigen::VectorXd(seen(system, run.point()).head(c.exact.size()));
  };
  const auto report = laws::order_laws(Sys::traits(), problem, tolerance);
  const double order = laws::measured_order(problem);
  EXPECT_TRUE(report.holds()) << report << " saw " << order;
  std::cout << "  " << Sys::traits().name << ": declared " << Sys::traits().order << ", measured " << order << '\n';
}
template <class Sys>
void expect_order(const Case<Sys>& c, int coarsest, double tolerance = 0.1, double plateau = 1e-11) {
  expect_order_in(numbers<Sys>, c, coarsest, tolerance, plateau);
}
/// The same of a system with nodes beside its arrows, in the states that it has without them.
template <class Sys> void expect_order_on_nodes(const Case<Sys>& c, int coarsest, double tolerance) {
  const auto seen = [](const Sys& system, const TrajectoryPoint<Sys>& p) {
    const auto s = Sys::reduced(p.state);
    const auto q = system.base().coordinates_of_object(s.object);
    Eigen::VectorXd out(q.size() + s.momentum.size());
    out << q, s.momentum;
    return out;
  };
  expect_order_in(seen, c, coarsest, tolerance, laws::OrderProblem{}.plateau);
}

/// The status of a first step that fails; nothing is taken of it.
template <class Sys> SolveStatus failed_step(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  auto run = make(system, start);
  const StepReport report = run.advance();
  EXPECT_FALSE(report.converged());
  EXPECT_EQ(run.point().time, 0) << "a step that failed was taken";
  EXPECT_EQ((run.point().state.momentum - start.momentum).norm(), 0);
  return report.status;
}

}  // namespace lagroid::subjects
