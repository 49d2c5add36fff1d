// A system of one's own, run from C++ by methods that a scene can name.
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/run_by.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using namespace lagroid;

namespace {

/// A mass on a spring, whose position after a time t is cos t q + sin t p.
struct Spring : System<Spring, Pair<1>> {
  double h = 0.1;
  template <class S, class T> auto lagrangian(const PairArrow<S, 1>& g, const T& step) const {
    const S v = g.target(0) - g.source(0);
    const S q = (g.target(0) + g.source(0)) * 0.5;
    return v * v * 0.5 / step - q * q * 0.5 * step;
  }
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return lagrangian(g, h); }
};

double error_at_five(const MarchOptions& how, double h) {
  Spring system;
  system.h = h;
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.3)};
  const RunResult result = run_by(how, system, start, {.steps = std::lround(5 / h)});
  EXPECT_TRUE(result.converged()) << result.message;
  return std::abs(result.final.position.at(0) - (std::cos(5.0) + 0.3 * std::sin(5.0)));
}

TEST(OwnRunBy, ACompositionHasItsOrder) {
  MarchOptions fourth;
  fourth.composition = compositions::triple_jump;
  EXPECT_NEAR(std::log2(error_at_five(fourth, 0.1) / error_at_five(fourth, 0.05)), 4, 0.2);
  EXPECT_NEAR(std::log2(error_at_five({}, 0.1) / error_at_five({}, 0.05)), 2, 0.1);
}

TEST(OwnRunBy, WhatTheSystemDoesNotHaveIsRefused) {
  MarchOptions splitting;
  splitting.fixed = StepKind::splitting;
  EXPECT_THROW(run_by(splitting, Spring{}, {Vector<double, 1>(1.0), Vector<double, 1>(0.0)}), std::invalid_argument);
}

}  // namespace
