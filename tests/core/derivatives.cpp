// The two-sided derivative of every system, against nested dual numbers; a wrong analytic one is caught.
#include "../support/affine.hpp"
#include "../support/badly_framed.hpp"
#include "../support/broken.hpp"
#include "../support/draws.hpp"
#include "../support/turning_plate.hpp"

#include <lagroid/core/testing/derivative_laws.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

using namespace lagroid;

namespace core_derivatives_tests {
namespace {

template <class Sys> void expect_laws(const Sys& system) {
  const auto report = laws::derivative_laws(system, [&] { return draw_step(system, 0.4); });
  EXPECT_TRUE(report.holds()) << report;
}

TEST(Derivatives, PlateBallInEveryForm) {
  PlateBall system;
  system.h = 0.1;
  system.radius = 0.7;
  system.plate_rate = 1.3;
  system.spin = -0.4;
  for (const auto form : {RotationForm::trace, RotationForm::exponential, RotationForm::cayley}) {
    system.rotation = form;
    expect_laws(system);
  }
}

TEST(Derivatives, RigidBodyInBothForms) {
  RigidBody system;
  expect_laws(system);
  system.rotation = RotationMap::cayley;
  expect_laws(system);
}

TEST(Derivatives, NonholonomicSystems) {
  const RollingBall ball = ball_on_turning_plate();
  const auto on_plate = laws::derivative_laws(ball, [&] { return draw_step(ball, 0.5); });
  EXPECT_TRUE(on_plate.holds()) << on_plate;
  const auto sleigh = laws::derivative_laws(ChaplyginSleigh{}, [] { return draw_step(ChaplyginSleigh{}, 0.5); });
  EXPECT_TRUE(sleigh.holds()) << sleigh;
}

TEST(Derivatives, PointMasses) {
  for (const auto quadrature : {Quadrature::midpoint, Quadrature::trapezoid}) {
    Pendulum pendulum;
    pendulum.quadrature = quadrature;
    expect_laws(pendulum);
    Kepler kepler;
    kepler.quadrature = quadrature;
    expect_laws(kepler);
    SphericalPendulum spherical;
    spherical.quadrature = quadrature;
    expect_laws(spherical);
  }
}

TEST(Derivatives, RigidBodyAtTheUnitArrow) {
  const RigidBody system;
  const Matrix<double, 3, 3> unit = Matrix<double, 3, 3>::Identity();
  const auto fast = automatic_two_sided(system, unit, {});
  EXPECT_LT(laws::derivative_defect(fast, laws::nested_two_sided(system, unit, {})), 1e-13);
  EXPECT_LT((fast.mixed + Matrix<double, 3, 3>(system.inertia.asDiagonal()) / system.h).norm(), 1e-10);
}

/// A pendulum with hand-written derivatives, right or wrong.
template <bool Right> struct HandWritten : System<HandWritten<Right>, Pair<1>> {
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    using std::cos;
    const S d = g.target(0) - g.source(0);
    return d * d * (0.5 / h) + cos((g.source(0) + g.target(0)) * S(0.5)) * h;
  }
  TwoSided<1, 0> two_sided(const PairArrow<double, 1>& g, const Vector<double, 0>&) const {
    const double d = g.target(0) - g.source(0);
    const double middle = 0.5 * (g.source(0) + g.target(0));
    TwoSided<1, 0> out;
    out.value = lagrangian(g);
    out.source_gradient(0) = -d / h - 0.5 * h * std::sin(middle);
    out.target_gradient(0) = d / h - 0.5 * h * std::sin(middle);
    out.mixed(0, 0) = -1 / h - (Right ? 0.25 : -0.25) * h * std::cos(middle);
    return out;
  }
};

TEST(Derivatives, AnalyticOverrideIsUsedAndChecked) {
  const HandWritten<true> right;
  static_assert(HasAnalyticDerivatives<HandWritten<true>>);
  EXPECT_TRUE(laws::derivative_laws(right, [&] { return draw_step(right, 0.4); }).holds());
  const HandWritten<false> wrong;
  const auto report = laws::derivative_laws(wrong, [&] { return draw_step(wrong, 0.4); });
  EXPECT_TRUE(laws::seen_broken(report.law("analytic derivatives")));
  EXPECT_TRUE(report.law("automatic derivatives").holds());
}

/// Derivatives by hand that could never be called, and a time step that is no number.
struct NotConst : System<NotConst, Pair<1>> {
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return g.source.dot(g.target); }
  TwoSided<1, 0> two_sided(const PairArrow<double, 1>&, const Multipliers&) { return {}; }
};
struct WrongResult : System<WrongResult, Pair<1>> {
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return g.source.dot(g.target); }
  double gradients(const PairArrow<double, 1>&, const Multipliers&) const { return 0; }
};
struct ConstantStep : System<ConstantStep, Pair<1>> {
  const double h = 1;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return g.source.dot(g.target); }
};
TEST(Derivatives, OverridesThatWouldBePassedOverAreRefused) {
  static_assert(optional_members_fit<PlateBall> && optional_members_fit<RigidBody> && optional_members_fit<Kepler>);
  static_assert(!optional_members_fit<NotConst>);
  static_assert(!optional_members_fit<WrongResult>);
  static_assert(!optional_members_fit<ConstantStep>);
}

TEST(Derivatives, OneSidedHessiansAreSecondDerivativesOfTheRetraction) {
  PlateBall system;
  system.plate_rate = 0.8;
  system.rotation = RotationForm::exponential;
  const Step<PlateBall> step{
      {PairArrow<double, 2>{{0.1, 0.2}, {0.3, 0.1}}, SO3::exp(Vector<double, 3>(0.2, -0.1, 0.3))}, {0.5, -0.7, 0.3}};
  using D = Dual<Dual<double>>;
  for (const End end : {End::source, End::target}) {
    const auto hessian = one_sided_hessian(system, step.arrow, step.multipliers, end);
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j) {
        Vector<D, 5> v = Vector<D, 5>::Constant(D(0.0));
        v(i).derivative += Dual<double>(1.0);
        v(j).value.derivative += 1.0;
        const Vector<D, 5> zero = Vector<D, 5>::Constant(D(0.0));
        const auto g = system.groupoid.cast<D>(step.arrow);
        const auto moved =
            end == End::source ? system.groupoid.translate(v, g, zero) : system.groupoid.translate(zero, g, v);
        const D f = lagroid::detail::augmented_lagrangian<D>(system, moved, step.multipliers);
        EXPECT_NEAR(hessian(i, j), f.derivative.derivative, 1e-11);
      }
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-12);
  }
}

/// One pass along the arrow's frame gives what three passes give.
template <class Sys> void expect_one_pass(const Sys& system) {
  const auto law = laws::second_derivative_law(system, [&] { return draw_step(system, 0.4); });
  EXPECT_TRUE(law.holds()) << law;
}

/// A Lagrangian without any symmetry on an arbitrary groupoid.
template <class G> struct Generic : System<Generic<G>, G, 1> {
  template <class S> S lagrangian(const typename G::template Arrow<S>& g) const {
    using std::cos;
    const auto x = this->groupoid.coordinates_of_arrow(g);
    S sum(0);
    for (int i = 0; i < x.size(); ++i) sum += cos(x(i) * S(1.0 + 0.3 * i)) * x((i + 1) % x.size());
    return sum;
  }
  template <class S> Vector<S, 1> constraint(const typename G::template Arrow<S>& g) const {
    const auto x = this->groupoid.coordinates_of_arrow(g);
    return Vector<S, 1>(x(0) * x(x.size() - 1));
  }
};

TEST(SecondDerivatives, OnePassIsThreePasses) {
  PlateBall plate;
  plate.plate_rate = 0.8;
  for (const auto form : {RotationForm::trace, RotationForm::exponential, RotationForm::cayley}) {
    plate.rotation = form;
    expect_one_pass(plate);
  }
  expect_one_pass(RigidBody());
  expect_one_pass(Kepler());
  expect_one_pass(SphericalPendulum());
  expect_one_pass(Generic<SE2>());
  expect_one_pass(Generic<SpecialEuclidean3<Retraction::cayley>>());
  expect_one_pass(Generic<Product<SE2, VectorGroup<2>, Pair<1>>>());
}

TEST(BrokenDerivatives, OfClosedFormsThatAreWrong) {
  Generic<Affine> seeded;
  seeded.groupoid.fault = Fault::seed;
  const auto curved = laws::derivative_laws(seeded, [&] { return draw_step(seeded, 0.4); });
  EXPECT_TRUE(laws::seen_broken(curved.law("automatic derivatives"))) << curved;
  EXPECT_TRUE(curved.law("gradients").holds()) << curved;
  const Generic<BadlyFramed<FrameFault::ends>> swapped;
  const auto displaced = laws::derivative_laws(swapped, [&] { return draw_step(swapped, 0.4); });
  EXPECT_TRUE(displaced.law("automatic derivatives").holds()) << displaced;
  EXPECT_TRUE(laws::seen_broken(displaced.law("gradients"))) << displaced;
}

TEST(BrokenDerivatives, OfAFrameWithTheWrongBracket) {
  const Generic<BadlyFramed<FrameFault::bracket>> system;
  const auto law = laws::second_derivative_law(system, [&] { return draw_step(system, 0.4); });
  EXPECT_TRUE(laws::seen_broken(law.law("one pass is three"))) << law;
}

}  // namespace
}  // namespace core_derivatives_tests
