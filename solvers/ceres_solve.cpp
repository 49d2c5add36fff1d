#include <lagroid/solvers/ceres_solve.hpp>

#include <ceres/iteration_callback.h>
#include <glog/logging.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <vector>

namespace lagroid::detail {

namespace {

/// The parameters of the least cost so far.
class BestPoint final : public ceres::IterationCallback {
 public:
  explicit BestPoint(const ceres::Problem& problem) {
    problem.GetParameterBlocks(&blocks_);
    for (const double* block : blocks_) sizes_.push_back(problem.ParameterBlockSize(block));
  }
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
    if (now.step_is_successful && now.cost < cost_) {
      cost_ = now.cost;
      best_.clear();
      for (std::size_t i = 0; i < blocks_.size(); ++i) best_.insert(best_.end(), blocks_[i], blocks_[i] + sizes_[i]);
    }
    return ceres::SOLVER_CONTINUE;
  }
  /// Unless not even the first point could be evaluated.
  void restore() const {
    if (best_.empty()) return;
    const double* from = best_.data();
    for (std::size_t i = 0; i < blocks_.size(); from += sizes_[i++]) std::copy_n(from, sizes_[i], blocks_[i]);
  }

 private:
  std::vector<double*> blocks_;
  std::vector<int> sizes_;
  std::vector<double> best_;
  double cost_ = std::numeric_limits<double>::infinity();
};

/// Keeps glog quiet while there is one, on any thread, and then restores what its user had set: Ceres writes some of
/// what stands in its summary there, whatever its `logging_type`. What ends the program is still said.
class Quiet {
 public:
  Quiet() {
    const std::lock_guard lock(mutex);
    if (count++ > 0) return;
    before = FLAGS_minloglevel;
    FLAGS_minloglevel = std::max<int>(before, google::GLOG_FATAL);
  }
  ~Quiet() {
    const std::lock_guard lock(mutex);
    if (--count == 0) FLAGS_minloglevel = before;
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  static inline std::mutex mutex;
  static inline int count = 0;
  static inline int before = 0;
};

}  // namespace

ceres::Solver::Options to_round_off(int max_iterations) {
  ceres::Solver::Options options;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 0;
  options.gradient_tolerance = 0;
  options.max_num_consecutive_invalid_steps = std::numeric_limits<int>::max();
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  return options;
}

ceres::Solver::Summary solve_by_ceres(ceres::Solver::Options options, ceres::Problem& problem) {
  BestPoint best(problem);
  options.update_state_every_iteration = true;
  options.callbacks.push_back(&best);
  const Quiet quiet;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) best.restore();
  return summary;
}

}  // namespace lagroid::detail
