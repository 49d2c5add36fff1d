// An integrator that is written to an archive and read from it goes on with the same bits, whatever steps it takes.
#include <lagroid/core/capabilities/balance.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

using namespace lagroid;

namespace core_number_archive_tests {
namespace {

template <class Sys> std::vector<double> tape_of(Integrator<Sys>& integrator) {
  NumberArchive archive;
  integrator.serialize(archive);
  return archive.numbers();
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Broken off and taken up before the first step, after one, after some.
template <class Sys>
void goes_on(const Sys& system, const State<typename Sys::GroupoidType>& start, const IntegratorOptions& options) {
  const auto begin = [&] { return make_integrator(system, start, system.groupoid.unit(start.object), options); };
  for (const int at : {0, 1, 7, 40}) {
    const auto whole = begin();
    for (int k = 0; k < at; ++k) ASSERT_TRUE(whole->advance().converged());
    const std::vector<double> written = tape_of(*whole);
    const auto taken_up = begin();
    NumberArchive archive(written);
    taken_up->serialize(archive);
    EXPECT_TRUE(archive.at_end());
    EXPECT_TRUE(same_bits(tape_of(*taken_up), written)) << "what is read is written again";
    for (int k = 0; k < 60; ++k) {
      const StepReport a = whole->advance();
      const StepReport b = taken_up->advance();
      ASSERT_TRUE(a.converged());
      ASSERT_EQ(a.iterations, b.iterations);
    }
    EXPECT_TRUE(same_bits(tape_of(*whole), tape_of(*taken_up))) << "from step " << at;
    EXPECT_EQ(whole->without_root(), taken_up->without_root());
  }
}

Kepler kepler() {
  Kepler system;
  system.h = 0.02;
  return system;
}
const State<Pair<2>> ellipse{{0.6, 0}, {0, std::sqrt(1.4 / 0.6)}};

TEST(Integrators, OfEqualStepsGoOnWithTheSameBits) {
  goes_on(kepler(), ellipse, {});
  goes_on(kepler(), ellipse, {.method = StepMethod::ceres});
  RigidBody body;
  body.h = 0.05;
  goes_on(body, {{}, {0.3, 1.5, 0.4}}, {});
  SphericalPendulum pendulum;
  pendulum.h = 0.02;
  goes_on(pendulum, {{1, 0, 0}, {0, 0.7, 0}}, {});
}

TEST(Integrators, ComposedOrSplitGoOnWithTheSameBits) {
  goes_on(kepler(), ellipse, {.composition = compositions::suzuki});
  goes_on(kepler(), ellipse, {.fixed = StepKind::splitting, .composition = compositions::kahan_li_8});
}

TEST(Integrators, WhoseStepsVaryGoOnWithTheSameBits) {
  goes_on(kepler(), ellipse, {.mode = TimeMode::controlled});
  goes_on(kepler(), ellipse, {.mode = TimeMode::adaptive, .without_root = WithoutRoot::controlled});
  Pendulum pendulum;
  pendulum.h = 0.1;
  goes_on(pendulum, {Vector<double, 1>(2.0), Vector<double, 1>(0.1)},
          {.mode = TimeMode::adaptive, .without_root = WithoutRoot::constant});
}

TEST(Integrators, WithMultipliersGoOnWithTheSameBits) {
  PlateBall system;
  system.h = 0.05;
  system.plate_rate = 0.3;
  State<PlateBall::GroupoidType> start;
  std::get<0>(start.object) = {1.0, 0.5};
  start.momentum << 0.3, -0.2, 0.5, 0.1, 0.2;
  goes_on(system, start, {});
}

TEST(Balances, GoOnFromATape) {
  DampedPendulum system;
  system.h = 0.05;
  const Vector<double, 1> angle(1.0);
  const auto integrator = make_integrator(system, {angle, Vector<double, 1>(0.0)}, {angle, angle}, {});
  auto seen = energy_balance(system);
  double value = 0;
  for (int k = 0; k < 20; ++k) {
    seen.evaluate(integrator->point(), &value);
    ASSERT_TRUE(integrator->advance().converged());
  }
  NumberArchive written;
  seen.serialize(written);
  auto taken_up = energy_balance(system);
  NumberArchive archive(written.numbers());
  taken_up.serialize(archive);
  double again = 0;
  seen.evaluate(integrator->point(), &value);
  taken_up.evaluate(integrator->point(), &again);
  EXPECT_EQ(value, again);
  auto forgetful = energy_balance(system);
  forgetful.evaluate(integrator->point(), &again);
  EXPECT_TRUE(std::isnan(again));
}

TEST(BrokenTape, OfAnotherComputationIsRefused) {
  const auto whole = make_integrator(kepler(), ellipse, Kepler{}.groupoid.unit(ellipse.object), {});
  ASSERT_TRUE(whole->advance().converged());
  std::vector<double> numbers = tape_of(*whole);
  numbers.pop_back();
  NumberArchive archive(numbers);
  EXPECT_THROW(whole->serialize(archive), std::out_of_range);
  numbers.resize(numbers.size() + 2);
  NumberArchive longer(numbers);
  whole->serialize(longer);
  EXPECT_FALSE(longer.at_end());
}

/// The suite sees an integrator that forgets something.
TEST(BrokenMarch, ThatForgetsItsInverseGoesOnWithOtherBits) {
  const auto whole = make_integrator(kepler(), ellipse, Kepler{}.groupoid.unit(ellipse.object), {});
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(whole->advance().converged());
  const auto& at = whole->point();
  const auto anew = make_integrator(kepler(), at.state, at.configuration, {});
  bool same = true;
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(whole->advance().converged());
    ASSERT_TRUE(anew->advance().converged());
    same = same && (whole->point().state.momentum - anew->point().state.momentum).isZero(0);
  }
  EXPECT_FALSE(same);
}

}  // namespace
}  // namespace core_number_archive_tests
