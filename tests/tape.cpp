// A march that is written to a tape and read from it goes on with the same bits, whatever steps it takes.
#include <lagroid/core/balance.hpp>
#include <lagroid/solvers/march.hpp>
#include <lagroid/systems/damped_pendulum.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulum.hpp>
#include <lagroid/systems/plate_ball.hpp>
#include <lagroid/systems/rigid_body.hpp>
#include <lagroid/systems/spherical_pendulum.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

using namespace lagroid;

namespace {

template <class Sys> std::vector<double> tape_of(March<Sys>& march) {
  Tape tape;
  march.persist(tape);
  return tape.numbers();
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Broken off and taken up before the first step, after one, after some.
template <class Sys>
void goes_on(const Sys& system, const State<typename Sys::GroupoidType>& start, const MarchOptions& options) {
  const auto begin = [&] { return make_march(system, start, system.groupoid.unit(start.object), options); };
  for (const int at : {0, 1, 7, 40}) {
    const auto whole = begin();
    for (int k = 0; k < at; ++k) ASSERT_TRUE(whole->advance().converged());
    const std::vector<double> written = tape_of(*whole);
    const auto taken_up = begin();
    Tape tape(written);
    taken_up->persist(tape);
    EXPECT_TRUE(tape.at_end());
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

TEST(Marches, OfEqualStepsGoOnWithTheSameBits) {
  goes_on(kepler(), ellipse, {});
  goes_on(kepler(), ellipse, {.method = StepMethod::ceres});
  RigidBody body;
  body.h = 0.05;
  goes_on(body, {{}, {0.3, 1.5, 0.4}}, {});
  SphericalPendulum pendulum;
  pendulum.h = 0.02;
  goes_on(pendulum, {{1, 0, 0}, {0, 0.7, 0}}, {});
}

TEST(Marches, ComposedOrSplitGoOnWithTheSameBits) {
  goes_on(kepler(), ellipse, {.composition = compositions::suzuki});
  goes_on(kepler(), ellipse, {.fixed = StepKind::splitting, .composition = compositions::kahan_li_8});
}

TEST(Marches, WhoseStepsVaryGoOnWithTheSameBits) {
  goes_on(kepler(), ellipse, {.mode = TimeMode::controlled});
  goes_on(kepler(), ellipse, {.mode = TimeMode::adaptive, .without_root = WithoutRoot::controlled});
  Pendulum pendulum;
  pendulum.h = 0.1;
  goes_on(pendulum, {Vector<double, 1>(2.0), Vector<double, 1>(0.1)},
          {.mode = TimeMode::adaptive, .without_root = WithoutRoot::constant});
}

TEST(Marches, WithMultipliersGoOnWithTheSameBits) {
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
  const auto march = make_march(system, {angle, Vector<double, 1>(0.0)}, {angle, angle}, {});
  auto seen = energy_balance(system);
  double value = 0;
  for (int k = 0; k < 20; ++k) {
    seen.evaluate(march->point(), &value);
    ASSERT_TRUE(march->advance().converged());
  }
  Tape written;
  seen.persist(written);
  auto taken_up = energy_balance(system);
  Tape tape(written.numbers());
  taken_up.persist(tape);
  double again = 0;
  seen.evaluate(march->point(), &value);
  taken_up.evaluate(march->point(), &again);
  EXPECT_EQ(value, again);
  auto forgetful = energy_balance(system);
  forgetful.evaluate(march->point(), &again);
  EXPECT_TRUE(std::isnan(again));
}

TEST(BrokenTape, OfAnotherComputationIsRefused) {
  const auto whole = make_march(kepler(), ellipse, Kepler{}.groupoid.unit(ellipse.object), {});
  ASSERT_TRUE(whole->advance().converged());
  std::vector<double> numbers = tape_of(*whole);
  numbers.pop_back();
  Tape tape(numbers);
  EXPECT_THROW(whole->persist(tape), std::out_of_range);
  numbers.resize(numbers.size() + 2);
  Tape longer(numbers);
  whole->persist(longer);
  EXPECT_FALSE(longer.at_end());
}

/// The suite sees a march that forgets something.
TEST(BrokenMarch, ThatForgetsItsInverseGoesOnWithOtherBits) {
  const auto whole = make_march(kepler(), ellipse, Kepler{}.groupoid.unit(ellipse.object), {});
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(whole->advance().converged());
  const auto& at = whole->point();
  const auto anew = make_march(kepler(), at.state, at.configuration, {});
  bool same = true;
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(whole->advance().converged());
    ASSERT_TRUE(anew->advance().converged());
    same = same && (whole->point().state.momentum - anew->point().state.momentum).isZero(0);
  }
  EXPECT_FALSE(same);
}

}  // namespace
