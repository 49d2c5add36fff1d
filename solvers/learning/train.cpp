#include <lagroid/solvers/learning/train.hpp>

#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/solvers/ceres_solve.hpp>
#include <lagroid/solvers/ensemble/tasks.hpp>
#include <lagroid/solvers/learning/compressed.hpp>
#include <lagroid/solvers/learning/squared_error.hpp>
#include <lagroid/solvers/processor_time.hpp>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <Eigen/QR>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace lagroid::learning {

namespace {

/// The errors of all trajectories as one residual block of Ceres, compressed (Compressed). Where Ceres asks for no
/// derivatives it wants their norm alone. Where derivatives cannot be had, because the training was halted or they are
/// not finite, Ceres is told of no error at all (of a failure it would write on standard error), and the callback,
/// which it asks next, sees `failed`.
class TrajectoryCost final : public ceres::CostFunction {
 public:
  TrajectoryCost(const Model& model, const Schedule& schedule, const Trajectories& data, std::function<bool()> halted)
      : model_(model), schedule_(schedule), data_(data), halted_(std::move(halted)), compressed_(model.size()) {
    set_num_residuals(int(model.size()) + 1);
    mutable_parameter_block_sizes()->push_back(int(model.size()));
  }

  bool failed() const { return failed_; }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Index n = model_.size();
    const Eigen::VectorXd theta = Eigen::Map<const Eigen::VectorXd>(parameters[0], n);
    Eigen::Map<Eigen::VectorXd> r(residuals, n + 1);
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      r.setZero();
      r(n) = std::sqrt(squared_error(model_, theta, schedule_, data_, halted_));
      return std::isfinite(r(n));
    }
    failed_ = !compress(theta) || !triangle_.allFinite();
    if (failed_) triangle_.setZero(n + 1, n + 1);
    r = triangle_.col(n);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobians[0], n + 1, n) = triangle_.leftCols(n);
    return true;
  }
  /// (R s) where derivatives were last wanted.
  const Eigen::MatrixXd& triangle() const { return triangle_; }

 private:
  /// False where it is ended.
  bool compress(const Eigen::VectorXd& theta) const {
    const Eigen::Index n = model_.size();
    const Eigen::Index block = block_of(data_);
    compressed_.clear();
    for (Eigen::Index first = 0; first < data_.count(); first += block) {
      if (halted_()) return false;
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
    triangle_ = compressed_.triangle();
    return true;
  }

  const Model& model_;
  const Schedule& schedule_;
  const Trajectories& data_;
  std::function<bool()> halted_;
  mutable Compressed compressed_;
  mutable Eigen::MatrixXd z_, rows_, triangle_;
  mutable bool failed_ = false;
};

/// The least singular value of `moved`, derivatives by some parameters, when the others make up for them as well as
/// they can; zero where they are too few for one.
double least_moved(const Eigen::MatrixXd& moved, const Eigen::MatrixXd& others) {
  constexpr double dependent = 1e-10;  // a column of the others, on the rest of them
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(others);
  qr.setThreshold(dependent);
  const Eigen::MatrixXd turned = qr.householderQ().adjoint() * moved;
  const Eigen::MatrixXd left = turned.bottomRows(turned.rows() - qr.rank());
  if (left.rows() < moved.cols() || !left.allFinite()) return 0;
  return singular_values(left)(moved.cols() - 1);
}

/// A change of size one moves predictions by more than that.
constexpr double felt = 1e-8;

/// Trained::mass_determined. `triangle` is (R s), `total` the sum of the weights of all numbers, `masses` how many of
/// the parameters, the first ones, are the mass matrix's.
bool determines_mass(const Eigen::MatrixXd& triangle, double total, Eigen::Index masses) {
  const Eigen::Index others = triangle.cols() - 1 - masses;
  return least_moved(triangle.leftCols(masses), triangle.middleCols(masses, others)) > felt * std::sqrt(total);
}

/// d(rows of L) by the entries of R = L L^T on and below the diagonal, in the order of RayleighDissipation:
/// dL = L low(L^{-1} dR L^{-T}), of which `low` takes the lower triangle and half of the diagonal (Murray,
/// *Differentiation of the Cholesky decomposition*, 2016). Not finite where L has no inverse.
Eigen::MatrixXd factor_by_dissipation(const Eigen::Ref<const Eigen::VectorXd>& rows, Eigen::Index k) {
  Eigen::MatrixXd l = Eigen::MatrixXd::Zero(k, k);
  for (Eigen::Index i = 0, at = 0; i < k; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) l(i, j) = rows(at++);
  const auto lower = l.triangularView<Eigen::Lower>();
  Eigen::MatrixXd out(rows.size(), rows.size());
  for (Eigen::Index i = 0, entry = 0; i < k; ++i)
    for (Eigen::Index j = 0; j <= i; ++j, ++entry) {
      Eigen::MatrixXd change = Eigen::MatrixXd::Zero(k, k);
      change(i, j) = change(j, i) = 1;
      lower.solveInPlace(change);
      change = lower.solve(change.transpose().eval());
      change.diagonal() /= 2;
      const Eigen::MatrixXd moved = l * Eigen::MatrixXd(change.triangularView<Eigen::Lower>());
      for (Eigen::Index a = 0, at = 0; a < k; ++a)
        for (Eigen::Index b = 0; b <= a; ++b) out(at++, entry) = moved(a, b);
    }
  return out;
}

/// Trained::dissipation_determined, at theta, whose last parameters are those of R, k x k; `mse` is the error left.
bool determines_dissipation(const Eigen::MatrixXd& triangle, const Eigen::VectorXd& theta, double total, double mse,
                            Eigen::Index k) {
  constexpr double known = 0.01;  // R's entries, to two standard deviations
  const Eigen::Index size = k * (k + 1) / 2;
  const Eigen::Index others = theta.size() - size;
  const Eigen::MatrixXd by_entries = triangle.middleCols(others, size) * factor_by_dissipation(theta.tail(size), k);
  const double moved = least_moved(by_entries, triangle.leftCols(others));
  return moved > felt * std::sqrt(total) && 2 * std::sqrt(mse) < known * moved;
}

constexpr double first_radius = 0.1;

/// Where a descent came to.
struct Found {
  Eigen::VectorXd theta;
  double mse = std::numeric_limits<double>::infinity();  ///< on its data; infinite where it has none, or no derivative
  double validation = std::numeric_limits<double>::quiet_NaN();
};

/// A descent, when it is over.
struct Descent {
  Found found;
  TrainingStatus end = TrainingStatus::not_finite;
  std::vector<Stage> history;
  int iterations = 0;
  bool mass_determined = true;
  bool dissipation_determined = true;
  bool falls = false;  ///< the last iterations lowered the error by more than round-off
};

/// What trainings that go on at the same time have in common: their limits and whom they tell.
class Session {
 public:
  explicit Session(const Training& options) : options_(options) {}

  /// Adds processor time that one of them took.
  void spend(double seconds) { spent_ += seconds; }
  double seconds() const { return spent_; }
  /// Whether an interrupt or the time limit has come, and which was first.
  bool halted() {
    const std::lock_guard lock(asking_);
    if (!halt_ && options_.stop && options_.stop()) halt_ = TrainingStatus::interrupted;
    if (!halt_ && seconds() > options_.seconds) halt_ = TrainingStatus::time_limit;
    return halt_.has_value();
  }
  void tell(const Stage& stage) {
    const std::lock_guard lock(asking_);
    if (!halt_ && options_.callback && !options_.callback(stage)) halt_ = TrainingStatus::interrupted;
  }
  std::optional<TrainingStatus> halt() {
    const std::lock_guard lock(asking_);
    return halt_;
  }

 private:
  const Training& options_;
  std::atomic<double> spent_ = 0;
  std::mutex asking_;
  std::optional<TrainingStatus> halt_;
};

/// Carries out one descent, on one thread.
class Trainer final : public ceres::IterationCallback {
 public:
  Trainer(const Model& model, const Training& options, Session& session, const Trajectories& held_out,
          const Schedule& schedule, int start)
      : model_(model), options_(options), session_(session), held_out_(held_out), schedule_(schedule), start_(start) {}

  /// Goes on from `theta` to the best that can be met.
  Descent descend(const Trajectories& data, int iterations, const Eigen::VectorXd& theta) {
    at_ = theta;
    out_.found = {theta};
    scale_ = 2 / data.total_weight();
    round_off_ = 1e-30 * data.ends.squaredNorm() / double(data.ends.size());
    out_.end = TrainingStatus::iteration_limit;
    TrajectoryCost cost(model_, schedule_, data, [this] { return halted(); });
    cost_ = &cost;
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    problem.AddResidualBlock(&cost, nullptr, at_.data());
    const auto summary = lagroid::detail::solve_by_ceres(settings(iterations), problem);
    if (summary.termination_type == ceres::CONVERGENCE) out_.end = TrainingStatus::converged;
    const bool good = summary.IsSolutionUsable() && !cost.failed();
    if (!good) out_.end = TrainingStatus::not_finite;
    if (good && !session_.halt()) {
      const Eigen::Index k = model_.mass(at_).rows();
      const Eigen::Index masses = k * (k + 1) / 2;
      out_.mass_determined = masses == 0 || determines_mass(cost.triangle(), data.total_weight(), masses);
      const Eigen::Index damped = model_.dissipation(at_).rows();
      out_.dissipation_determined =
          damped == 0 || determines_dissipation(cost.triangle(), at_, data.total_weight(), mse_, damped);
    }
    // Whether the last iterations lowered the error by more than round-off.
    out_.falls = !fallen_.empty() && fallen_.front() - fallen_.back() > 1e-12 * fallen_.front() + round_off_;
    spend();
    return std::move(out_);
  }

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
    if (cost_->failed()) return stop(TrainingStatus::not_finite);
    Stage stage;
    stage.start = start_;
    stage.iteration = now.iteration;
    // Of a step that is refused Ceres tells what it would have cost.
    const bool accepted = now.iteration == 0 || now.step_is_successful;
    if (accepted) mse_ = scale_ * now.cost;
    stage.mse = mse_;
    stage.damping = 1 / now.trust_region_radius;
    stage.validation = accepted ? validation(at_) : out_.history.back().validation;
    keep(stage);
    spend();
    stage.seconds = session_.seconds();
    out_.history.push_back(stage);
    if (now.iteration > 0) ++out_.iterations;
    session_.tell(stage);
    if (halted()) return stop(*session_.halt());
    if (options_.enough > 0 && stage.mse <= options_.enough) return stop(TrainingStatus::reached);
    if (stage.mse <= round_off_) return stop(TrainingStatus::converged);
    if (held_out_.count() > 0 && since_ >= options_.patience) return stop(TrainingStatus::early_stopped);
    constexpr std::size_t window = 10;
    fallen_.push_back(stage.mse);
    if (fallen_.size() > window) {
      if (stage.mse > fallen_.front() * (1 - options_.least_progress)) return stop(TrainingStatus::converged);
      fallen_.pop_front();
    }
    return ceres::SOLVER_CONTINUE;
  }

 private:
  bool halted() {
    spend();
    return session_.halted();
  }
  void spend() {
    const double now = processor_time();
    session_.spend(now - until_);
    until_ = now;
  }
  double validation(const Eigen::VectorXd& theta) {
    if (held_out_.count() == 0) return std::numeric_limits<double>::quiet_NaN();
    return squared_error(model_, theta, schedule_, held_out_, [this] { return halted(); }) / held_out_.total_weight();
  }
  ceres::Solver::Options settings(int iterations) {
    auto out = lagroid::detail::to_round_off(iterations);
    out.linear_solver_type = ceres::DENSE_QR;
    out.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
    // Bold first steps saturate a network, or blow masses up.
    out.initial_trust_region_radius = first_radius;
    out.max_trust_region_radius = 1 / options_.damping_floor;
    out.parameter_tolerance = 1e-16;
    out.callbacks.push_back(this);
    return out;
  }
  ceres::CallbackReturnType stop(TrainingStatus why) {
    out_.end = why;
    return ceres::SOLVER_TERMINATE_SUCCESSFULLY;  // after SOLVER_ABORT the parameters would be those of the start
  }
  /// Steps that are accepted lower the training error; of the validation error the least counts.
  void keep(const Stage& stage) {
    const bool better = held_out_.count() == 0 || stage.iteration == 0 || stage.validation < out_.found.validation;
    since_ = better ? 0 : since_ + 1;
    if (better) out_.found = {at_, stage.mse, stage.validation};
  }

  const Model& model_;
  const Training& options_;
  Session& session_;
  const Trajectories& held_out_;
  const Schedule& schedule_;
  int start_;
  double until_ = processor_time();
  const TrajectoryCost* cost_ = nullptr;
  Eigen::VectorXd at_;
  Descent out_;
  int since_ = 0;
  std::deque<double> fallen_;
  double scale_ = 1;
  double round_off_ = 0;
  double mse_ = 0;
};

std::string message_of(TrainingStatus outcome, const Training& options, double mse, bool falls) {
  switch (outcome) {
    case TrainingStatus::iteration_limit:
      if (options.iterations == 0) return {};
      return fmt::format("after {} iterations the mean squared error {:.1e} {}", options.iterations, mse,
                         falls ? "still falls; allow more to go on" : "falls no more; try other starts");
    case TrainingStatus::time_limit:
      return fmt::format("{:g} s did not suffice, the mean squared error is {:.1e}; allow more", options.seconds, mse);
    case TrainingStatus::interrupted:
      return fmt::format("interrupted; the best so far has mean squared error {:.1e}", mse);
    case TrainingStatus::not_finite:
      return fmt::format(
          "the error or its derivative was not finite any more; the best so far has mean squared error {:.1e}; take "
          "more substeps, shorter intervals, or another seed",
          mse);
    default:
      return {};
  }
}

/// Where there are no parameters worth keeping.
std::string message_of_none(TrainingStatus outcome, const Training& options) {
  switch (outcome) {
    case TrainingStatus::time_limit:
      return fmt::format("{:g} s did not suffice to evaluate the error once; allow more", options.seconds);
    case TrainingStatus::interrupted:
      return "interrupted before the error was evaluated once";
    default:
      break;
  }
  if (options.begin.size() > 0)
    return "the parameters to go on from have no finite error, or none that has a finite derivative; take others, more "
           "substeps, or shorter intervals";
  return fmt::format(
      "none of {} starts has a finite error with a finite derivative; take more substeps, or shorter intervals",
      options.starts);
}

void require_training(const Model& model, const Trajectories& data, const Training& options) {
  if (!(options.validation >= 0 && options.validation < 1) || !(options.share > 0 && options.share <= 1) ||
      !(options.damping_floor > 0 && options.damping_floor <= 1 / first_radius) || options.substeps < 1 ||
      options.starts < 1 || options.iterations < 0 || options.trial < 1 || options.patience < 1 ||
      !(options.enough >= 0) || std::isnan(options.seconds) || data.width() != model.space().size ||
      data.bodies != model.bodies() || data.dimension != model.space().dimension ||
      (options.begin.size() > 0 && options.begin.size() != model.size()))
    throw std::invalid_argument(fmt::format(
        "a training has starts, substeps and patience of one or more, shares between zero and one, a floor of the "
        "damping between zero and {:g}, errors and times that are numbers, parameters to begin with as many as the "
        "model's, and data that were put together on the model's space",
        1 / first_radius));
}

/// Why nothing can be learned from these; empty where something can.
std::string too_little(const Model& model, const Trajectories& training, const Trajectories& held_out,
                       const Training& options) {
  if (held_out.count() > 0 && !(held_out.weights.maxCoeff() > 0))
    return "all weights of the trajectories held out are zero; weigh more of the data, or hold out more";
  const Eigen::Index free = training.free_numbers();
  const bool measured_only = options.begin.size() > 0 && options.iterations == 0;
  if (free > 0 && (measured_only || free >= model.size())) return {};
  return fmt::format(
      "{} trajectories of {} points are {} free numbers, the model has {} parameters; give more data, or take a "
      "smaller model",
      training.count(), training.points, free, model.size());
}

/// As few trajectories, the first ones, as are a share of all and have three free numbers for each parameter.
Trajectories for_trials(const Trajectories& training, double share, Eigen::Index parameters) {
  auto few = Eigen::Index(std::ceil(share * double(training.count())));
  Eigen::Index numbers = training.part(0, few).free_numbers();
  for (; few < training.count() && numbers < 3 * parameters; ++few)
    numbers += training.dimension * (training.weights.col(few).array() > 0).count();
  return training.part(0, few);
}

}  // namespace

Trained train(const Model& model, const Trajectories& data, const Training& options) {
  require_training(model, data, options);
  const auto count_held_out = Eigen::Index(std::ceil(options.validation * double(data.count())));
  const Trajectories shuffled = data.shuffled(options.seed);
  const Trajectories held_out = shuffled.part(0, count_held_out);
  const Trajectories all = shuffled.part(count_held_out, data.count() - count_held_out);
  Trained out;
  out.start = options.seed;
  out.message = too_little(model, all, held_out, options);
  if (!out.message.empty()) {
    out.outcome = TrainingStatus::too_little_data;
    return out;
  }
  const Schedule schedule{options.method, data.interval, data.points - 1, options.substeps};
  Session session(options);
  const auto descend = [&](int start, const Trajectories& some, int iterations, const Eigen::VectorXd& theta) {
    return Trainer(model, options, session, held_out, schedule, start).descend(some, iterations, theta);
  };
  Descent best;
  if (options.begin.size() > 0) {
    best.found = {options.begin};
  } else if (options.starts == 1) {
    best.found = {model.start(options.seed)};
  } else {
    const Trajectories some = for_trials(all, options.share, model.size());
    const auto trial = [&](long s) {
      return session.halted() ? Descent{}
                              : descend(int(s), some, options.trial, model.start(options.seed + unsigned(s)));
    };
    auto trials = results_of_tasks(options.starts, options.threads, trial, [](int) {});
    std::size_t first = 0;
    for (std::size_t s = 0; s < trials.size(); ++s) {
      out.history.insert(out.history.end(), trials[s].history.begin(), trials[s].history.end());
      out.iterations += trials[s].iterations;
      if (trials[s].found.mse < trials[first].found.mse) first = s;
    }
    best = std::move(trials[first]);
    if (std::isfinite(best.found.mse)) {
      out.start = options.seed + unsigned(first);
    } else {
      best.found.theta.resize(0);
    }
  }
  if (best.found.theta.size() > 0 && !session.halted()) {
    Descent last = descend(options.starts, all, options.iterations, best.found.theta);
    out.history.insert(out.history.end(), last.history.begin(), last.history.end());
    out.iterations += last.iterations;
    if (!std::isfinite(last.found.mse)) last.found = std::move(best.found);
    best = std::move(last);
  }
  out.seconds = session.seconds();
  out.outcome = session.halt().value_or(best.end);
  if (!std::isfinite(best.found.mse)) {
    out.message = message_of_none(out.outcome, options);
    return out;
  }
  out.parameters = std::move(best.found.theta);
  out.mse = best.found.mse;
  out.validation = best.found.validation;
  out.mass_determined = best.mass_determined;
  out.dissipation_determined = best.dissipation_determined;
  out.message = message_of(out.outcome, options, out.mse, best.falls);
  return out;
}

}  // namespace lagroid::learning
