#pragma once
/// All runs of a fit by all its unknowns: those of the start of each run, one after another, then the parameters, as
/// differences from what the scene has. Runs are made once for all measurements.
///
///     PredictedRuns runs(subject, columns, measured);
///     runs.PrepareForEvaluation(true, true);  // at runs.x()
///     if (runs.is_defined()) use(runs.predicted(0), runs.derivatives(0));
///
/// Where steps vary, what is measured between nodes is reached by a part of a step. Requires the subject and its
/// columns to outlive it. A run that fails is told by `failure`, and so is one that scenes refuse and an event that has
/// no derivative; what else has none throws.

#include "measured.hpp"

#include <ceres/evaluation_callback.h>

#include <limits>
#include <string>
#include <vector>

namespace lagroid::app {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

class PredictedRuns final : public ceres::EvaluationCallback {
 public:
  PredictedRuns(const GradientSubject& subject, const GradientColumns& columns, std::vector<MeasuredRun> runs);

  std::size_t unknowns() const { return runs_.size() * columns_.start.size() + columns_.parameters.size(); }
  const std::vector<MeasuredRun>& runs() const { return runs_; }
  double* x() { return x_.data(); }
  /// What is measured later is left out.
  void end_at(double time) { last_ = time; }
  bool is_within(const MeasuredNumber& each) const { return each.time <= last_; }

  bool is_defined() const { return failure_.empty(); }
  const std::string& failure() const { return failure_; }
  double predicted(std::size_t i) const { return predicted_(Eigen::Index(i)); }
  auto derivatives(std::size_t i) const { return derivatives_.row(Eigen::Index(i)); }

  void PrepareForEvaluation(bool with_derivatives, bool new_point) override;

 private:
  class Course;
  std::vector<Nudge> nudges_of(std::size_t run) const;
  void predict(std::size_t run, std::size_t first, bool with_derivatives);
  void fail(std::size_t run, const LinearisedMotion& motion);

  const GradientSubject& subject_;
  const GradientColumns& columns_;
  std::vector<MeasuredRun> runs_;
  double last_ = infinite;
  std::vector<double> x_;
  Eigen::VectorXd predicted_;
  Eigen::MatrixXd derivatives_;
  std::string failure_;
};

}  // namespace lagroid::app
