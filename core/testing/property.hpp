#pragma once
/// The bridge to RapidCheck: random laws with a reproducible, printed seed.
///
/// A law of one's own is a function that draws a sample and returns a defect.
///
///     const std::string name = "exp(v) exp(-v) = 1";
///     const laws::Law law = laws::check_law(name, 1e-12, [] {
///       const Vector<double, 3> v = laws::draw_vector<3>(2.0);
///       return (SO3::exp(v) * SO3::exp(Vector<double, 3>(-v)) - Matrix<double, 3, 3>::Identity()).norm();
///     });
///
/// Returns the worst defect, how many samples were drawn and skipped, and the first failure; an exception breaks the
/// law, NotSampled passes the sample over. The environment's RC_PARAMS, where it is set, replaces the fixed seed.

#include <lagroid/core/testing/law_report.hpp>
#include <lagroid/core/types.hpp>

#include <rapidcheck.h>
#include <rapidcheck/detail/TestListenerAdapter.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

namespace lagroid::laws {

/// RapidCheck seeds itself from the clock. Unless the environment sets RC_PARAMS (put a seed into it: "seed=..."), the
/// suites run from this seed.
inline void fix_seed() { ::setenv("RC_PARAMS", "seed=20261120", /*overwrite=*/0); }

/// A number in [-1, 1], whatever RapidCheck's current size (which otherwise pulls ranges towards their lower end).
inline double draw_uniform() { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(-1000000, 1000001)) * 1e-6; }

/// A vector with entries in [-1, 1] times a size drawn from identity, tiny, moderate and large arguments.
template <int N> Vector<double, N> draw_vector(double large) {
  const double size = *rc::gen::element(0.0, 1e-12, 1e-8, 1e-3, 0.3, 1.0, large);
  Vector<double, N> v;
  for (int i = 0; i < N; ++i) v(i) = size * draw_uniform();
  return v;
}

/// Thrown by a law that cannot be tested at the sample drawn: it is passed over and another drawn.
struct NotSampled : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// rc::check that is silent where the property holds, and otherwise prints why not and what reproduces it.
inline void check_quietly(const std::string& name, const std::function<void()>& property) {
  using namespace rc::detail;
  fix_seed();
  Configuration configuration = configFromString(std::getenv("RC_PARAMS"));
  TestListenerAdapter silent;
  const TestResult result =
      checkTestable(property, TestMetadata{name, name}, configuration.testParams, silent, configuration.reproduce);
  if (result.is<SuccessResult>()) return;
  std::cerr << "- " << name << '\n';
  printResultMessage(result, std::cerr);
  FailureResult failure;
  if (result.match(failure)) configuration.reproduce = {{name, failure.reproduce}};
  std::cerr << "\nRC_PARAMS=\"" << configToMinimalString(configuration) << "\"\n\n";
}

/// The share of samples passed over above which a law is left unjudged: those that remain are then no longer drawn from
/// the distribution that the suite states.
inline constexpr double most_skipped = 1.0 / 3;

/// Runs `defect` (which draws its sample with RapidCheck and returns a relative error) and records the worst value.
/// Unjudged, unless broken, where more than `most_skipped` of the samples were passed over; the reason reported is
/// the commonest.
/// (Any law's defect in one type: RapidCheck's machinery is then compiled once.)
inline Law check_law(const std::string& name, double tolerance, const std::function<double()>& defect) {
  Law law;
  law.name = name;
  law.tolerance = tolerance;
  std::map<std::string, int> reasons;
  check_quietly(name, [&] {
    double d = std::numeric_limits<double>::infinity();
    try {
      d = defect();
    } catch (const NotSampled& error) {
      ++law.skipped;
      ++reasons[error.what()];
      RC_DISCARD("not sampled");
    } catch (const std::exception& error) {
      if (law.first_failure.empty()) law.first_failure = error.what();
      throw;
    }
    ++law.samples;
    if (!(d <= law.worst)) law.worst = std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
    RC_ASSERT(d <= tolerance);
  });
  int commonest = 0;
  for (const auto& [reason, count] : reasons)
    if (count > commonest) {
      commonest = count;
      law.skipped_because = reason;
    }
  law.unjudged =
      law.first_failure.empty() && law.worst <= tolerance && law.skipped > most_skipped * (law.samples + law.skipped);
  return law;
}

}  // namespace lagroid::laws
