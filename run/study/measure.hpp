#pragma once
/// What methods cost, and how far their numbers are from the truth: errors at the end, of invariants and of
/// constraints, and processor time.
///
///     const auto truth = extrapolated_reference(experiment, 20);  // in 20 s
///     const Measurement found = measure_once(experiment, experiment.methods[0], 0.1, truth.get(), 1);
///     std::cout << found.trajectory;
///
/// Requires a reference that is better than what is measured; its `uncertainty` is how much. Errors: std::domain_error
/// where no two extrapolations can be compared. A run that fails is a Measurement with a status.

#include <lagroid/run/study/experiment.hpp>
#include <lagroid/run/study/study_integrator.hpp>

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lagroid {

/// States of a scene's motion that runs are compared with.
class Reference {
 public:
  virtual ~Reference() = default;
  /// At that time. May be called by several threads at once.
  virtual std::vector<NamedVector> at(double time) const = 0;
  /// Of the state at the end, in the measure of `distance`: errors below a few times this cannot be distinguished.
  double uncertainty = 0;
  double seconds_elsewhere = 0;  ///< of wall clock that `at` takes, about, at another time than the end
  std::string description;
};

/// Where a method ends after equal steps: the state, its blocks with the sizes that they had along the run, and the
/// processor time of the steps. None where it fails on the way.
struct Reached {
  std::vector<NamedVector> state;
  double seconds = 0;
};
std::optional<Reached> reach(const Experiment& experiment, const Method& method, double end, long steps);

/// The largest distance of two blocks, each relative to the size that the true motion gave it.
double distance(const std::vector<NamedVector>& state, const std::vector<NamedVector>& truth);

/// The method of highest order among those with equal steps, extrapolated in even powers of the step, or in all where
/// its error has those. Steps are halved until two extrapolations differ no less than before, or the next would be over
/// after more than `budget` seconds (three are computed where twice that is enough). Throws std::domain_error where
/// there are not two.
std::unique_ptr<Reference> extrapolated_reference(const Experiment& experiment, double budget);
/// The numbers of one method with one step, and as uncertainty what half the step changes.
std::unique_ptr<Reference> method_reference(const Experiment& experiment, const Method& method, double h);
/// A state at the end that was computed elsewhere.
std::unique_ptr<Reference> known_reference(const Experiment& experiment, std::vector<NamedVector> state,
                                           double uncertainty, std::string description);

/// Of a run that ends farther from the truth than any two states of the motion are from each other.
inline constexpr const char* astray_status = "astray";

/// One method with one step.
struct Measurement {
  std::string method;
  int order = 2;
  double step = 0;  ///< the first, where they vary
  std::string status = "converged";
  std::string message;
  double reached = 0;  ///< the time
  IntegrationCost work;
  std::vector<double> seconds;                                   ///< of every repetition: processor time of the steps
  double trajectory = std::numeric_limits<double>::quiet_NaN();  ///< error at the end
  double invariants = std::numeric_limits<double>::quiet_NaN();  ///< the largest deviation at any node, relative
  double constraint = std::numeric_limits<double>::quiet_NaN();  ///< the largest residual at any node
  /// The slope of the energy by least squares through the means of twenty parts of the run, times the time, relative to
  /// the energy's size; and its standard error. NaN where the energy is not watched or the run is too short.
  double drift = std::numeric_limits<double>::quiet_NaN();
  double drift_error = std::numeric_limits<double>::quiet_NaN();

  bool converged() const { return status == "converged"; }
  double median() const;
  double spread() const;  ///< distance of the quartiles over the median
};

/// One run with a look at every node, or at 1e5 of them where there are more.
Measurement measure_once(const Experiment& experiment, const Method& method, double h, const Reference* reference,
                         double longest);

/// One run alone; its seconds, or less than zero where it fails.
double time_once(const Experiment& experiment, const Method& method, double h);

}  // namespace lagroid
