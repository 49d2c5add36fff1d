// Prescribed steps of motions that depend on time or have constraints on arrows, in part, and of time scales that are
// not the same backwards.
#include <lagroid/core/capabilities/discrete_energy.hpp>
#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

using namespace lagroid;

namespace prescribed_kinds_tests {
namespace {

template <class Sys>
PrescribedIntegrator<Sys> prescribed(const Sys& system, const State<typename Sys::GroupoidType>& s) {
  return {system, s, system.groupoid.unit(s.object), std::make_unique<NewtonStep<Sys>>(),
          std::make_unique<NewtonStep<PrescribedStep<Sys, TimeScaleStep>>>()};
}
template <class Sys>
std::unique_ptr<Integrator<Sys>> make(const Sys& system, const State<typename Sys::GroupoidType>& s, TimeMode mode) {
  return make_integrator(system, s, system.groupoid.unit(s.object), {.mode = mode});
}

/// A ball on a spring that is shaken: q'' = -q^3 + 0.4 cos(2 t), in steps that are short where it is far out. Backwards
/// the scale is the same, or not, if it is taken at the source.
template <bool AtTheSource> struct Shaken : System<Shaken<AtTheSource>, Pair<1>> {
  double h = 0.02;
  double time = 0;
  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& start, const T& step) const {
    using std::cos;
    const S q = (g.source(0) + g.target(0)) * 0.5;
    const S change = g.target(0) - g.source(0);
    const T force = cos((start + step * 0.5) * 2.0) * 0.4;
    return change * change / (step * 2.0) + (q * force - q * q * q * q * 0.25) * step;
  }
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return lagrangian(g, time, h); }
  template <class S> S time_scale(const PairArrow<S, 1>& g) const {
    using std::sqrt;
    const S q = AtTheSource ? g.source(0) : S((g.source(0) + g.target(0)) * 0.5);
    return S(1.0) / sqrt(q * q + 0.5);
  }
};

/// A bead in space whose height follows its turning about the axis, z' = (x y' - y x') / 2: [G]'s variational
/// constraint on arrows, of degree one in the velocity.
struct Helix : System<Helix, Pair<3>, /*arrow constraints*/ 1> {
  double h = 0.02;
  template <class S, class T> S lagrangian(const PairArrow<S, 3>& g, const T& step) const {
    const Vector<S, 3> q = (g.source + g.target) * 0.5;
    return (g.target - g.source).squaredNorm() / (step * 2.0) - q.squaredNorm() * q.squaredNorm() * step * 0.25;
  }
  template <class S> S lagrangian(const PairArrow<S, 3>& g) const { return lagrangian(g, h); }
  template <class S, class T> Vector<S, 1> constraint(const PairArrow<S, 3>& g, const T& step) const {
    const S area = (g.source(0) * g.target(1) - g.source(1) * g.target(0)) * 0.5;
    return Vector<S, 1>((g.target(2) - g.source(2) - area) / step);
  }
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 3>& g) const { return constraint(g, h); }
  template <class S> S time_scale(const PairArrow<S, 3>& g) const {
    const Vector<S, 3> q = (g.source + g.target) * 0.5;
    return S(1.0) / (q.squaredNorm() + 1.0);
  }
};
const State<Pair<3>> on_the_helix{{1, 0, 0.2}, {0.3, 0.9, 0.6}};
template <bool AtTheSource> State<Pair<1>> shaken_start() { return {Vector<double, 1>(1.2), Vector<double, 1>(0.3)}; }

/// Where a motion is at a time, by a last step in part.
template <class Sys> State<typename Sys::GroupoidType> at_time(Integrator<Sys>& run, double time) {
  do {
    run.keep_node();
    EXPECT_TRUE(run.advance().converged());
  } while (run.point().time < time);
  double lo = 0;
  double hi = 1;
  TrajectoryPoint<Sys> inside = run.point();
  for (int k = 0; k < 60 && inside.time != time; ++k) {
    const double share = 0.5 * (lo + hi);
    EXPECT_TRUE(run.cut(share, inside).converged());
    (inside.time < time ? lo : hi) = share;
  }
  EXPECT_NEAR(inside.time, time, 1e-13);
  return inside.state;
}
/// By how much two runs at a time are apart, a prescribed one and one of fine equal steps.
template <class Sys> double error_at(Sys system, const State<typename Sys::GroupoidType>& start, double h, double end) {
  system.h = h;
  const auto run = make(system, start, TimeMode::prescribed);
  const auto reached = at_time(*run, end);
  system.h = 5e-4;
  const auto exact = make(system, start, TimeMode::fixed);
  const auto expected = at_time(*exact, end);
  return (reached.object - expected.object).norm() + (reached.momentum - expected.momentum).norm();
}
template <class Sys> void expect_order_two(const Sys& system, const State<typename Sys::GroupoidType>& start) {
  const double coarse = error_at(system, start, 0.04, 3);
  const double fine = error_at(system, start, 0.02, 3);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << coarse << ' ' << fine;
}

TEST(PrescribedKinds, AMotionThatDependsOnTimeIsOfOrderTwo) {
  expect_order_two(Shaken<false>{}, shaken_start<false>());
}
TEST(PrescribedKinds, AMotionWithAnArrowConstraintIsOfOrderTwo) { expect_order_two(Helix{}, on_the_helix); }

TEST(PrescribedKinds, KeepTheirBalance) {
  const Helix system;
  auto run = prescribed(system, on_the_helix);
  ASSERT_TRUE(run.advance().converged());
  const double momentum_of_time = run.momentum_of_time();
  for (int k = 1; k <= 300; ++k) {
    ASSERT_TRUE(run.advance().converged()) << k;
    const auto& point = run.point();
    const double energy = discrete_energy(system, point.step, point.time - point.step_size, point.step_size);
    EXPECT_NEAR(run.step_multiplier() - energy, momentum_of_time, 1e-11) << k;
    EXPECT_NEAR(run.momentum_of_time(), momentum_of_time, 1e-13 * std::abs(momentum_of_time)) << k;
    EXPECT_LT(system.constraint(point.step.arrow, point.step_size).norm(), 1e-11) << k;
  }
}

TEST(PrescribedKinds, APartOfAStepIsTheStepWhereItIsTheWhole) {
  const auto run = make(Helix{}, on_the_helix, TimeMode::prescribed);
  for (int k = 0; k < 20; ++k) {
    run->keep_node();
    const TrajectoryPoint<Helix> before = run->point();
    ASSERT_TRUE(run->advance().converged());
    const TrajectoryPoint<Helix> after = run->point();
    TrajectoryPoint<Helix> whole;
    TrajectoryPoint<Helix> half;
    TrajectoryPoint<Helix> none;
    ASSERT_TRUE(run->cut(1, whole).converged());
    ASSERT_TRUE(run->cut(0.5, half).converged());
    ASSERT_TRUE(run->cut(0, none).converged());
    EXPECT_LT((whole.state.object - after.state.object).norm(), 1e-13) << k;
    EXPECT_LT((whole.state.momentum - after.state.momentum).norm(), 1e-13) << k;
    EXPECT_NEAR(whole.time, after.time, 1e-13);
    EXPECT_GT(half.time, before.time);
    EXPECT_LT(half.time, after.time);
    EXPECT_EQ(none.time, before.time);
    EXPECT_EQ(run->point().state.object, after.state.object) << "nothing changes";
  }
}

TEST(PrescribedKinds, AreSymmetricWhereTheTimeScaleIs) {
  EXPECT_TRUE(make(Shaken<false>{}, shaken_start<false>(), TimeMode::prescribed)->traits().symmetric);
  EXPECT_FALSE(make(Shaken<true>{}, shaken_start<true>(), TimeMode::prescribed)->traits().symmetric);
}

}  // namespace
}  // namespace prescribed_kinds_tests
