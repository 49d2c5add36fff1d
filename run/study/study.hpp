#pragma once
/// A study: what accuracy costs a motion, by all methods that apply to it.
///
///     const Findings findings = study(experiment, {.target = 1e-6, .budget = 10});
///     std::cout << study_text(findings);
///
/// Returns Findings, also of a study that was ended early. Errors: std::domain_error where there is nothing to compare
/// with.

#include <lagroid/run/study/findings/study_files.hpp>
#include <lagroid/run/study/survey.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace lagroid {

/// Options of a study.
struct StudyRequest {
  std::vector<Method> methods{};  ///< empty: all of the experiment's
  Steps steps{};
  double target = 1e-6;  ///< the error for which a method is recommended
  double budget = 60;    ///< s of wall clock, all of it
  int repetitions = 5;   ///< of every run, interleaved, to be timed
  /// What runs are compared with; empty: the method of highest order, extrapolated.
  std::function<std::unique_ptr<Reference>(const Experiment&)> reference = nullptr;
  double reference_seconds = share_of_reference * budget;  ///< that an extrapolated one may take
};

/// Measures errors at the end, of invariants and of constraints against processor time. `goes_on(spent)` is called now
/// and then with the part of the budget that is spent, and ends the study where it returns false. Throws
/// std::domain_error where there is nothing to compare with.
Findings study(const Experiment& experiment, const StudyRequest& request,
               const std::function<bool(double spent)>& goes_on = nullptr);

/// The same until Ctrl-C or SIGTERM, with a bar on the terminal where `progress` is set.
Findings study_until_interrupted(Experiment experiment, const StudyRequest& request, bool progress);

}  // namespace lagroid
