// Noether's theorem: declared symmetries are examined, and their momenta conserved; false ones are found out.
#include <lagroid/solvers/testing/momentum_laws.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>

#include <lagroid/groupoids/time_extended.hpp>

#include "../support/broken.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace core_noether_tests {
namespace {

template <class Sys, class Draw> std::vector<Step<Sys>> samples(const Sys& system, const Draw& draw) {
  std::vector<Step<Sys>> steps;
  for (int i = 0; i < 20; ++i) steps.push_back(laws::step_from(system, draw(i)));
  return steps;
}

State<Pair<2>> orbit(int i) { return {{1 + 0.05 * i, 0.1}, {0.02 * i, 1 - 0.01 * i}}; }
State<PlateBall::GroupoidType> rolling(int i) {
  State<PlateBall::GroupoidType> s;
  std::get<0>(s.object) = Eigen::Vector2d(0.3 - 0.1 * i, 0.2 * i);
  s.momentum << 0.3, -0.1 * i, 0.5, 0.2, 0.1 * i - 0.4;
  return s;
}

TEST(Examine, TellsSymmetriesFromOthers) {
  const Kepler system;
  const auto steps = samples(system, orbit);
  const auto rotation = examine<Kepler>(system, system.symmetries()[0], steps);
  EXPECT_EQ(rotation.kind, SymmetryKind::symmetric);
  EXPECT_LT(rotation.defect, 1e-13);
  const Symmetry<Kepler> translation{"px", [](const Vector<double, 2>&) { return Vector<double, 2>(1, 0); }};
  const auto moved = examine<Kepler>(system, translation, steps);
  EXPECT_EQ(moved.kind, SymmetryKind::none);
  EXPECT_GT(moved.defect, 1e-4);
}

TEST(Examine, BelievesNothingWithoutSamples) {
  EXPECT_EQ(examine<Kepler>(Kepler{}, Kepler{}.symmetries()[0], {}).kind, SymmetryKind::none);
}

TEST(Examine, ASymmetryOfThePlateAtRestIsNoneOfTheTurningPlate) {
  PlateBall rest;
  const auto candidates = rest.symmetries();
  PlateBall turning;
  turning.plate_rate = 0.5;
  const auto steps = samples(turning, rolling);
  EXPECT_EQ(examine<PlateBall>(turning, candidates[0], steps).kind, SymmetryKind::symmetric);
  EXPECT_EQ(examine<PlateBall>(turning, candidates[1], steps).kind, SymmetryKind::none);
}

/// A charge in the plane and a constant magnetic field B, in the symmetric gauge: translations change L by a difference
/// of boundary terms, and the mean position of the orbit is conserved.
struct Charge : System<Charge, Pair<2>> {
  double h = 0.1;
  double field = 0.7;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    const Vector<S, 2> dq = g.target - g.source;
    return dq.squaredNorm() * (0.5 / h) + (g.source(0) * g.target(1) - g.source(1) * g.target(0)) * (0.5 * field);
  }
};
TEST(QuasiSymmetry, OfAChargeInAMagneticField) {
  const Charge system;
  const Symmetry<Charge> along{"px + B y / 2", [](const auto&) { return Vector<double, 2>(1, 0); },
                               [b = system.field](const auto& q) { return -0.5 * b * q(1); }};
  const auto steps = samples(system, orbit);
  const auto verdict = examine<Charge>(system, along, steps);
  EXPECT_EQ(verdict.kind, SymmetryKind::quasi_symmetric);
  EXPECT_LT(verdict.defect, 1e-13);
  EXPECT_GT(verdict.boundary_defect, 1e-4);
  const auto report =
      laws::noether_laws<Charge>(system, {along}, [] { return orbit(int(5 + 5 * laws::draw_uniform())); });
  EXPECT_TRUE(report.holds()) << report;
}

/// A stone thrown upwards, with time among the objects: height is a quasi-symmetry, with f = m g t.
struct Stone : System<Stone, TimeExtended<Pair<1>>, /*arrow constraints*/ 1> {
  double h = 0.1;
  template <class S> S lagrangian(const Arrow<S>& g) const {
    const auto& [time, place] = g;
    const S dt = time.target(0) - time.source(0);
    const S dy = place.target(0) - place.source(0);
    return dy * dy / dt * 0.5 - (place.source(0) + place.target(0)) * dt * (0.5 * 9.81);
  }
  template <class S> Vector<S, 1> constraint(const Arrow<S>& g) const {
    const auto& time = std::get<0>(g);
    return Vector<S, 1>(time.target(0) - time.source(0) - h);
  }
  Step<Stone> first_guess(const State<GroupoidType>& s) const {
    const auto& [t, y] = s.object;
    return {{{t, Vector<double, 1>(t(0) + h)}, {y, Vector<double, 1>(y(0) + h * s.momentum(1))}}, Multipliers::Zero()};
  }
};
TEST(QuasiSymmetry, OfAFallingStone) {
  const Stone system;
  const Symmetry<Stone> lift{"m (v + g t)", [](const auto&) { return Vector<double, 2>(0, 1); },
                             [](const auto& q) { return 9.81 * std::get<0>(q)(0); }};
  const auto thrown = [](int i) {
    State<Stone::GroupoidType> s;
    s.object = {Vector<double, 1>(0.1 * i), Vector<double, 1>(1.0)};
    s.momentum << 0, 5.0 - i;
    return s;
  };
  const auto verdict = examine<Stone>(system, lift, samples(system, thrown));
  EXPECT_EQ(verdict.kind, SymmetryKind::quasi_symmetric) << verdict.defect;
  const auto report = laws::noether_laws<Stone>(system, {lift}, [&] { return thrown(int(4 * laws::draw_uniform())); });
  EXPECT_TRUE(report.holds()) << report;
}

TEST(BrokenSymmetry, FailsBothLaws) {
  const Symmetry<Kepler> squeezed{"not a rotation",
                                  [](const Vector<double, 2>& q) { return Vector<double, 2>(-q(1), 1.001 * q(0)); }};
  const auto report = laws::noether_laws<Kepler>(Kepler{}, {squeezed}, [] { return orbit(3); });
  EXPECT_TRUE(laws::seen_broken(report.law("not a rotation is a symmetry"))) << report;
  EXPECT_TRUE(laws::seen_broken(report.law("not a rotation is conserved"))) << report;
}

}  // namespace
}  // namespace core_noether_tests
