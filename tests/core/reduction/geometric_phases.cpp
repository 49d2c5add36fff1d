// Geometric phases against formulas: a free rigid body (Montgomery), the linearised Foucault pendulum, a rolling ball.

#include <lagroid/core/reduction/phase.hpp>
#include <lagroid/core/reduction/reduced_system.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/polar.hpp>
#include <lagroid/groupoids/trivial.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

using namespace lagroid;

namespace reduction_geometric_phases_tests {
namespace {

using std::numbers::pi;

/// f of `fewest`, twice as many, ... steps, its errors in h^2, h^4, ... taken out (Richardson).
template <class F> auto extrapolated(const F& f, int fewest, int levels) {
  std::vector<decltype(f(1))> row;
  for (int j = 0; j < levels; ++j) {
    row.push_back(f(fewest << j));
    double factor = 1;
    for (int k = j - 1; k >= 0; --k) {
      factor *= 4;
      row[std::size_t(k)] = row[std::size_t(k) + 1] + (row[std::size_t(k) + 1] - row[std::size_t(k)]) / (factor - 1);
    }
  }
  return row[0];
}

/// (dynamic, geometric) of a run of so many steps.
template <class Level>
Vector<double, 2> phases(const Level& level, const State<typename Level::GroupoidType>& start, int steps,
                         HorizontalArrows horizontal) {
  FixedStepIntegrator<Level> run(level, start, level.groupoid.unit(start.object),
                                 std::make_unique<NewtonStep<Level>>());
  PhaseTally<Level> phase(level, horizontal);
  for (int k = 0; k < steps; ++k) {
    if (!run.advance().converged()) throw std::runtime_error("a step failed");
    phase.add(run.point().step.arrow);
  }
  return {phase.dynamic()(0), phase.geometric()(0)};
}

/// A free body whose momentum goes round the third axis, at latitude cosine `s0` over the first.
struct Polhode {
  Vector<double, 3> inertia{1, 1.5, 2.2};
  double momentum = 1.7;
  double s0 = 0.5;

  double sine(double phi) const {
    const double a = rate(phi) - 1 / inertia(2);
    return std::sqrt(s0 * s0 * (rate(0) - 1 / inertia(2)) / a);
  }
  double energy() const { return 0.5 * momentum * momentum * (s0 * s0 * rate(0) + (1 - s0 * s0) / inertia(2)); }
  Vector<double, 3> start() const { return {s0, 0, std::sqrt(1 - s0 * s0)}; }
  /// The period, and the solid angle that the momentum goes round, by the trapezoidal rule in the angle about the third
  /// axis: both integrands are periodic and analytic.
  double period() const {
    // s^2 phi' = G1 G2' - G2 G1' with G' = G x I^{-1} momentum G.
    return std::abs(over_angle([&](double phi) {
      const double s = sine(phi);
      const Vector<double, 3> g(s * std::cos(phi), s * std::sin(phi), std::sqrt(1 - s * s));
      const Vector<double, 3> turn = g.cross(Vector<double, 3>(momentum * g.cwiseQuotient(inertia)));
      return s * s / (g(0) * turn(1) - g(1) * turn(0));
    }));
  }
  double solid_angle() const {
    return over_angle([&](double phi) { return 1 - std::sqrt(1 - sine(phi) * sine(phi)); });
  }

 private:
  double rate(double phi) const {
    return std::cos(phi) * std::cos(phi) / inertia(0) + std::sin(phi) * std::sin(phi) / inertia(1);
  }
  template <class F> static double over_angle(const F& f) {
    constexpr int points = 400;
    double sum = 0;
    for (int i = 0; i < points; ++i) sum += f(2 * pi * i / points);
    return sum * 2 * pi / points;
  }
};

Vector<double, 2> body_phases(const Polhode& polhode, double period) {
  return extrapolated(
      [&](int steps) {
        HeavyTop body;
        body.inertia = polhode.inertia;
        body.weight.setZero();
        body.h = period / steps;
        const MomentumLevel<ShortestRotation, HeavyTop> level({}, body, Vector<double, 1>(polhode.momentum));
        const auto z = level.state_below({polhode.start(), polhode.momentum * polhode.start()});
        return phases(level, z, steps, HorizontalArrows::of_the_connection);
      },
      40, 6);
}

TEST(GeometricPhase, OfAFreeRigidBodyIsMontgomerys) {
  const Polhode polhode;
  const double period = polhode.period();
  const auto phase = body_phases(polhode, period);
  EXPECT_NEAR(phase(0), 2 * polhode.energy() * period / polhode.momentum, 1e-9);
  // I3 is the largest moment: the momentum goes round its axis in the positive sense.
  EXPECT_NEAR(std::remainder(phase(1) + polhode.solid_angle(), 2 * pi), 0, 1e-9);
}

TEST(BrokenGeometricPhase, OfAnotherBodyIsSeen) {
  Polhode other;
  other.inertia(0) = 1.01;
  EXPECT_GT(std::abs(std::remainder(body_phases(other, other.period())(1) + Polhode().solid_angle(), 2 * pi)), 1e-4);
}

/// The linearised Foucault pendulum in the plane of the laboratory: rotation at the rate `turn` about the vertical.
struct Foucault : System<Foucault, Pair<2>> {
  double h = 0.01;
  double stiffness = 1;  ///< the square of the frequency, 1/s^2, less that of `turn`
  double turn = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    const Vector<S, 2> d = g.target - g.source;
    const S swept = g.source(0) * g.target(1) - g.source(1) * g.target(0);
    return d.squaredNorm() * (0.5 / h) + swept * turn -
           S(g.source.squaredNorm() + g.target.squaredNorm()) * (0.25 * h * stiffness);
  }
};

TEST(GeometricPhase, OfTheLinearisedFoucaultPendulumIsThatOfItsLatitude) {
  const double latitude = 0.85;
  const double day = 40;
  Foucault pendulum;
  pendulum.turn = 2 * pi * std::sin(latitude) / day;
  const Vector<double, 2> q(1, 0);
  const Vector<double, 2> p(0.1, 0.4);
  const auto phase = extrapolated(
      [&](int steps) {
        auto finer = pendulum;
        finer.h = day / steps;
        const ReducedSystem<PolarQuotient, Foucault> polar(finer);
        const auto z = polar.state_below({q, p});
        const MomentumLevel<FactorConnection<Factors<1>, Pair<1>, SO2>, ReducedSystem<PolarQuotient, Foucault>> level(
            {}, polar, Vector<double, 1>(z.momentum(1)));
        return phases(level, level.state_below(z), steps, HorizontalArrows::zero_momentum);
      },
      500, 6);
  EXPECT_NEAR(phase(1), -2 * pi * std::sin(latitude), 1e-9);
  // In the frame that does not turn it is an oscillator.
  const double frequency = std::sqrt(pendulum.stiffness + pendulum.turn * pendulum.turn);
  const Vector<double, 2> velocity = p;  // p = q' + turn J q, the velocity there
  const Vector<double, 2> there = q * std::cos(frequency * day) + velocity * (std::sin(frequency * day) / frequency);
  EXPECT_NEAR(std::remainder(phase.sum() - (std::atan2(there(1), there(0)) - pendulum.turn * day), 2 * pi), 0, 1e-9);
}

TEST(GeometricPhase, OfABallRolledRoundACircleIsItsHolonomy) {
  const double radius = 0.7;  // of the circle, over that of the ball
  using Ball = Trivial<2, SO3>;
  const auto rolled = [&](int steps) {
    std::vector<PairArrow<double, 2>> path;
    const auto at = [&](int k) {
      const double angle = 2 * pi * k / steps;
      return Vector<double, 2>(radius * std::cos(angle), radius * std::sin(angle));
    };
    for (int k = 0; k < steps; ++k) path.push_back({at(k), at(k + 1)});
    const auto without_spin = [](const PairArrow<double, 2>& b) {
      const Vector<double, 2> d = b.target - b.source;
      return ArrowOf<Ball>{b, SO3::exp(Vector<double, 3>(-d(1), d(0), 0))};
    };
    return Matrix<double, 3, 3>(std::get<1>(holonomy(Ball{}, without_spin, path)));
  };
  // omega(t) = Rz(t) omega(0) goes round with the point of contact, so that A(t) = exp(t (omega(0) + e3)) Rz(-t).
  const Matrix<double, 3, 3> exact = SO3::exp(Vector<double, 3>(2 * pi * Vector<double, 3>(-radius, 0, 1)));
  EXPECT_LT((extrapolated(rolled, 40, 6) - exact).norm(), 1e-9);
  EXPECT_GT((rolled(40) - exact).norm(), 1e-5) << "which the chords alone do not reach";
}

}  // namespace
}  // namespace reduction_geometric_phases_tests
