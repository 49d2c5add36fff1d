// A system of one's own, run from C++ by methods that a scene can name.
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/run_by.hpp>
#include <lagroid/run/study_of.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

using namespace lagroid;

namespace run_own_run_by_tests {
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

double error_at_five(const IntegratorOptions& how, double h) {
  Spring system;
  system.h = h;
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.3)};
  const RunResult result = run_by(how, system, start, {.steps = std::lround(5 / h)});
  EXPECT_TRUE(result.converged()) << result.message;
  return std::abs(result.final.position.at(0) - (std::cos(5.0) + 0.3 * std::sin(5.0)));
}

TEST(OwnRunBy, ACompositionHasItsOrder) {
  IntegratorOptions fourth;
  fourth.composition = compositions::triple_jump;
  EXPECT_NEAR(std::log2(error_at_five(fourth, 0.1) / error_at_five(fourth, 0.05)), 4, 0.2);
  EXPECT_NEAR(std::log2(error_at_five({}, 0.1) / error_at_five({}, 0.05)), 2, 0.1);
}

TEST(OwnRunBy, WhatTheSystemDoesNotHaveIsRefused) {
  IntegratorOptions splitting;
  splitting.fixed = StepKind::splitting;
  EXPECT_THROW(run_by(splitting, Spring{}, {Vector<double, 1>(1.0), Vector<double, 1>(0.0)}), std::invalid_argument);
}

TEST(OwnStudy, MeasuresEveryMethodAndItsOrder) {
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.3)};
  Spring system;
  system.h = 0.1;
  const Findings findings =
      study(system, start, {.steps = 50, .name = "spring", .step_sizes = {0.1, 0.05, 0.025}, .budget = 20});
  ASSERT_FALSE(findings.interrupted);
  std::map<std::string, std::map<double, double>> error;
  std::map<std::string, int> order;
  for (const Measurement& m : findings.runs) {
    // The energy of a linear motion need not tell adaptive steps their size.
    EXPECT_TRUE(m.converged() || m.method == "adaptive") << m.method << ": " << m.message;
    error[m.method][m.step] = m.trajectory;
    order[m.method] = m.order;
  }
  ASSERT_TRUE(error.contains("variational") && error.contains("variational/suzuki"));
  for (const char* method : {"variational", "variational/suzuki"})
    EXPECT_NEAR(std::log2(error[method][0.1] / error[method][0.05]), order[method], 0.3) << method;
  // The state at the end, against the motion in closed form.
  const double q = std::cos(5.0) + 0.3 * std::sin(5.0);
  EXPECT_NEAR(findings.reference_state.at(0).values.at(1), q, 1e-9);
  EXPECT_FALSE(recommendation(findings).empty());
}

TEST(OwnStudy, WhatIsNoStudyIsRefused) {
  const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.3)};
  EXPECT_THROW(study(Spring{}, start, {.steps = 0}), std::invalid_argument);
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(study(Spring{}, start, {.step_sizes = {0.1, no_number}}), std::invalid_argument);
  EXPECT_THROW(study(Spring{}, start, {.target = no_number}), std::invalid_argument);
  EXPECT_THROW(study(Spring{}, start, {.budget = no_number}), std::invalid_argument);
  EXPECT_THROW(study(Spring{}, start, {.repetitions = 0}), std::invalid_argument);
  EXPECT_THROW(study(Spring{}, {Vector<double, 1>(no_number), Vector<double, 1>(0.3)}, {.budget = 1}),
               std::invalid_argument);
  EXPECT_THROW(study(Spring{}, start, {.name = "two\nlines"}), std::invalid_argument);
  EXPECT_THROW(study(Spring{}, start, {.methods = "euler"}), UnknownMethod);
}

}  // namespace
}  // namespace run_own_run_by_tests
