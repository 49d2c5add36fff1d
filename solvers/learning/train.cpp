#include <lagroid/solvers/learning/train.hpp>

#include <lagroid/solvers/learning/compressed.hpp>

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <utility>

namespace lagroid::learning {

namespace {

/// Of this thread.
double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// How many trajectories are predicted at a time: some hundred numbers.
Eigen::Index block_of(const Trajectories& data) { return std::max<Eigen::Index>(1, 512 / data.ends.rows()); }

/// r <- z - z_data times the square root of the weights, for the columns from `first` on.
void weigh(const Trajectories& data, Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> z) {
  z -= data.ends.middleCols(first, z.cols());
  for (Eigen::Index n = 0; n < z.cols(); ++n)
    for (Eigen::Index j = 0; j < data.weights.rows(); ++j)
      z.col(n).segment(j * data.width(), data.width()) *= std::sqrt(data.weights(j, first + n));
}

/// The errors of all trajectories as one residual block of Ceres, compressed (Compressed). Where Ceres asks for no
/// derivatives it wants their norm alone.
class TrajectoryCost final : public ceres::CostFunction {
 public:
  TrajectoryCost(const Model& model, const Schedule& schedule, const Trajectories& data)
      : model_(model), schedule_(schedule), data_(data), compressed_(model.size()) {
    set_num_residuals(int(model.size()) + 1);
    mutable_parameter_block_sizes()->push_back(int(model.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index n = model_.size();
    const Eigen::VectorXd theta = Eigen::Map<const Eigen::VectorXd>(parameters[0], n);
    Eigen::Map<Eigen::VectorXd> r(residuals, n + 1);
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      const double mse = mean_squared_error(model_, theta, schedule_, data_);
      r.setZero();
      r(n) = std::sqrt(mse * double(data_.ends.size()));
      return std::isfinite(mse);
    }
    compressed_.clear();
    const Eigen::Index block = block_of(data_);
    for (Eigen::Index first = 0; first < data_.count(); first += block) {
      const Eigen::Index now = std::min(block, data_.count() - first);
      z_.resize(data_.ends.rows(), now);
      rows_.resize(z_.size(), n + 1);
      model_.differentiate(theta, schedule_, data_.starts.middleCols(first, now), z_, rows_.leftCols(n));
      weigh(data_, first, z_);
      rows_.col(n) = z_.reshaped();
      for (Eigen::Index c = 0; c < now; ++c)
        for (Eigen::Index j = 0; j < data_.weights.rows(); ++j)
          rows_.block(c * z_.rows() + j * data_.width(), 0, data_.width(), n) *= std::sqrt(data_.weights(j, first + c));
      compressed_.add(rows_);
    }
    const Eigen::MatrixXd& triangle = compressed_.triangle();
    r = triangle.col(n);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobians[0], n + 1, n) = triangle.leftCols(n);
    return triangle.allFinite();
  }

 private:
  const Model& model_;
  const Schedule& schedule_;
  const Trajectories& data_;
  mutable Compressed compressed_;
  mutable Eigen::MatrixXd z_, rows_;
};

/// Trainings of one model, one after the other, under common limits.
class Trainer final : public ceres::IterationCallback {
 public:
  Trainer(const Model& model, const Training& options, Trajectories held_out, Schedule schedule)
      : model_(model), options_(options), held_out_(std::move(held_out)), schedule_(std::move(schedule)) {}

  /// Goes on from `theta`, which becomes the best met. Its error on `data`; infinite where it has none.
  double descend(int start, const Trajectories& data, int iterations, Eigen::VectorXd& theta) {
    start_ = start;
    at_ = theta;
    best_ = theta;
    least_validation_ = std::numeric_limits<double>::infinity();
    since_ = 0;
    fallen_.clear();
    scale_ = 2 / double(data.ends.size());
    end_ = Outcome::iteration_limit;
    TrajectoryCost cost(model_, schedule_, data);
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    problem.AddResidualBlock(&cost, nullptr, at_.data());
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
    solver.max_num_iterations = iterations;
    // Bold first steps saturate a network, or blow masses up: from 1e4 some starts never came back.
    solver.initial_trust_region_radius = 0.1;
    solver.max_trust_region_radius = 1 / options_.damping_floor;
    solver.function_tolerance = 0;
    solver.gradient_tolerance = 0;
    solver.parameter_tolerance = 1e-16;
    solver.logging_type = ceres::SILENT;
    solver.num_threads = 1;
    solver.update_state_every_iteration = true;
    solver.callbacks.push_back(this);
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (summary.termination_type == ceres::CONVERGENCE) end_ = Outcome::converged;
    theta = held_out_.count() > 0 ? best_ : at_;
    return mean_squared_error(model_, theta, schedule_, data);
  }

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
    Stage stage;
    stage.start = start_;
    stage.iteration = now.iteration;
    // Of a step that is refused Ceres tells what it would have cost.
    if (now.iteration == 0 || now.step_is_successful) mse_ = scale_ * now.cost;
    stage.mse = mse_;
    stage.damping = 1 / now.trust_region_radius;
    stage.seconds = seconds();
    stage.validation = validate(now);
    history_.push_back(stage);
    if (now.iteration > 0) ++iterations_;
    if (options_.callback && !options_.callback(stage)) return stop(Outcome::interrupted);
    if (stage.seconds > options_.seconds) return stop(Outcome::time_limit);
    if (stage.mse <= options_.enough) return stop(Outcome::reached);
    if (held_out_.count() > 0 && since_ >= options_.patience) return stop(Outcome::early_stopped);
    constexpr std::size_t window = 10;
    fallen_.push_back(stage.mse);
    if (fallen_.size() > window) {
      if (stage.mse > fallen_.front() * (1 - options_.least_progress)) return stop(Outcome::converged);
      fallen_.pop_front();
    }
    return ceres::SOLVER_CONTINUE;
  }

  double seconds() const { return processor_seconds() - begun_; }
  Outcome end() const { return end_; }
  int iterations() const { return iterations_; }
  std::vector<Stage>& history() { return history_; }
  bool ended() const { return end_ == Outcome::interrupted || end_ == Outcome::time_limit; }
  double validation(const Eigen::VectorXd& theta) const {
    return held_out_.count() > 0 ? mean_squared_error(model_, theta, schedule_, held_out_)
                                 : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  ceres::CallbackReturnType stop(Outcome why) {
    end_ = why;
    return ceres::SOLVER_TERMINATE_SUCCESSFULLY;  // after SOLVER_ABORT the parameters would be those of the start
  }
  double validate(const ceres::IterationSummary& now) {
    if (now.iteration > 0 && !now.step_is_successful) {
      ++since_;
      return history_.back().validation;
    }
    const double error = validation(at_);
    ++since_;
    if (error < least_validation_) {
      least_validation_ = error;
      best_ = at_;
      since_ = 0;
    }
    return error;
  }

  const Model& model_;
  const Training& options_;
  Trajectories held_out_;
  Schedule schedule_;
  double begun_ = processor_seconds();
  std::vector<Stage> history_;
  int iterations_ = 0;
  // Of the descent that goes on:
  int start_ = 0;
  Eigen::VectorXd at_, best_;
  double least_validation_ = 0;
  int since_ = 0;
  std::deque<double> fallen_;
  double scale_ = 1;
  double mse_ = 0;
  Outcome end_ = Outcome::iteration_limit;
};

std::string message_of(Outcome outcome, const Training& options, double mse) {
  switch (outcome) {
    case Outcome::iteration_limit:
      if (options.iterations == 0) return {};
      return fmt::format("after {} iterations the mean squared error {:.1e} still falls; allow more to go on",
                         options.iterations, mse);
    case Outcome::time_limit:
      return fmt::format("{:g} s did not suffice, the mean squared error is {:.1e}; allow more", options.seconds, mse);
    case Outcome::interrupted:
      return fmt::format("interrupted; the best so far has mean squared error {:.1e}", mse);
    default:
      return {};
  }
}

}  // namespace

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::reached:
      return "reached";
    case Outcome::early_stopped:
      return "early_stopped";
    case Outcome::iteration_limit:
      return "iteration_limit";
    case Outcome::time_limit:
      return "time_limit";
    case Outcome::interrupted:
      return "interrupted";
    case Outcome::too_little_data:
      return "too_little_data";
    case Outcome::not_finite:
      return "not_finite";
  }
  return "unknown";
}

double mean_squared_error(const Model& model, const Eigen::VectorXd& theta, const Schedule& schedule,
                          const Trajectories& data) {
  const Eigen::Index block = block_of(data);
  Eigen::MatrixXd z;
  double sum = 0;
  for (Eigen::Index first = 0; first < data.count(); first += block) {
    z.resize(data.ends.rows(), std::min(block, data.count() - first));
    model.predict(theta, schedule, data.starts.middleCols(first, z.cols()), z);
    weigh(data, first, z);
    sum += z.squaredNorm();
  }
  const double mse = sum / double(data.ends.size());
  return std::isfinite(mse) ? mse : std::numeric_limits<double>::infinity();
}

Trained train(const Model& model, const Trajectories& data, const Training& options) {
  if (!(options.validation >= 0 && options.validation < 1) || !(options.share > 0 && options.share <= 1) ||
      !(options.damping_floor > 0) || options.substeps < 1 || options.starts < 1 || options.iterations < 0 ||
      options.trial < 1 || options.patience < 1 || data.bodies != model.bodies() ||
      (options.begin.size() > 0 && options.begin.size() != model.size()))
    throw std::invalid_argument(
        "a training has starts, substeps and patience of one or more, shares between zero and one, a positive floor of "
        "the damping, parameters to begin with as many as the model's, and data of as many bodies");
  Trained out;
  const auto held_out = Eigen::Index(std::ceil(options.validation * double(data.count())));
  const Eigen::Index kept = data.count() - held_out;
  const Eigen::Index free = 4 * data.bodies * Eigen::Index(data.points - 1);  // numbers of a trajectory, on T*S^2
  if (free * kept < model.size()) {
    out.outcome = Outcome::too_little_data;
    out.message = fmt::format(
        "{} trajectories of {} points are {} free numbers, the model has {} parameters; give more "
        "data, or take a smaller model",
        kept, data.points, free * kept, model.size());
    return out;
  }
  const Trajectories all = data.part(0, kept);
  const Schedule schedule{options.method, data.interval, data.points - 1, options.substeps};
  Trainer trainer(model, options, data.part(kept, held_out), schedule);
  Eigen::VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  const bool goes_on = options.begin.size() > 0;
  if (options.starts > 1 && !goes_on) {
    // Three free numbers for each parameter at least.
    const Eigen::Index few =
        std::max(Eigen::Index(std::ceil(options.share * double(kept))), (3 * model.size() + free - 1) / free);
    const Trajectories some = all.part(0, std::min(few, kept));
    for (int s = 0; s < options.starts && !trainer.ended(); ++s) {
      Eigen::VectorXd theta = model.start(options.seed + unsigned(s));
      const double mse = trainer.descend(s, some, options.trial, theta);
      if (mse < least) {
        least = mse;
        best = theta;
        out.start = int(options.seed) + s;
      }
    }
  } else {
    best = goes_on ? options.begin : model.start(options.seed);
    least = mean_squared_error(model, best, schedule, all);
    out.start = int(options.seed);
  }
  if (std::isfinite(least) && !trainer.ended()) trainer.descend(options.starts, all, options.iterations, best);
  out.history = std::move(trainer.history());
  out.iterations = trainer.iterations();
  out.seconds = trainer.seconds();
  if (!std::isfinite(least)) {
    out.outcome = Outcome::not_finite;
    out.message =
        fmt::format("none of {} starts has a finite error; take more substeps, or shorter intervals", options.starts);
    return out;
  }
  out.parameters = best;
  out.mse = mean_squared_error(model, best, schedule, all);
  out.validation = trainer.validation(best);
  out.outcome = std::isfinite(out.mse) ? trainer.end() : Outcome::not_finite;
  out.message = message_of(out.outcome, options, out.mse);
  return out;
}

}  // namespace lagroid::learning
