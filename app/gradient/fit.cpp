#include "fit.hpp"

#include "../reading/csv_table.hpp"

#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/solvers/poisson/wiener_path.hpp>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace lagroid::app {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// What was measured in one run: at which node, which function, and by how much it may be off.
struct Measurement {
  long node;
  double time;
  int observed;  ///< in GradientSubject::observed
  std::size_t column;
  double value;
  double sigma;
};
using MeasuredRun = std::vector<Measurement>;

/// The times of a subject's nodes.
struct Nodes {
  double start;
  double step;
};
Nodes nodes_of(const GradientSubject& subject) {
  if (subject.through_events) throw GradientRefused("a fit takes runs without events; leave out [[event]]");
  if (subject.cost) throw GradientRefused("a fit takes initial values; a path between two ends has no column t to fit");
  const auto motion = subject.begin({}, {});
  if (!motion->has_equal_steps())
    throw GradientRefused(
        "a fit takes equal steps: where their sizes vary, nodes are at other times for other parameters; leave out "
        "time.mode");
  const double start = motion->time();
  if (!motion->advance().converged()) throw GradientRefused("the first step of the scene's own run does not converge");
  return {start, motion->time() - start};
}

long node_at(double time, const Nodes& nodes, const std::string& file, long line) {
  const double steps = (time - nodes.start) / nodes.step;
  const double nearest = std::round(steps);
  if (!(nearest >= 0) || std::abs(steps - nearest) > 1e-6)
    throw DataError(
        fmt::format("{}: row {}: t = {:.10g} is no node of the run, which has them at {:g} + k {:g}; choose "
                    "a time.step that divides the times",
                    file, line, time, nodes.start, nodes.step));
  return long(nearest);
}

/// One who reads the columns of several files.
class Reader {
 public:
  Reader(const GradientSubject& subject, const FitOptions& options, Fit& fit)
      : subject_(subject), options_(options), fit_(fit), nodes_(nodes_of(subject)) {
    for (const auto& [name, sigma] : options.sigma) number_of(name);
    for (const std::string& name : options.columns) column_of(name);
  }

  MeasuredRun read(const std::string& file) {
    const CsvTable table = read_csv_table(file, "t and columns of the run", Gaps::allowed);
    const std::size_t time = table.column("t");
    if (time == CsvTable::npos) throw DataError(fmt::format("{}: no column t, the time, in the header", file));
    MeasuredRun out;
    for (std::size_t c = 0; c < table.names.size(); ++c) {
      const std::string& name = table.names[c];
      if (c == time) continue;
      const auto column = wanted(name);
      if (!column) continue;
      const auto sigma = options_.sigma.find(name);
      for (std::size_t k = 0; k < table.rows.size(); ++k) {
        const double at = table.rows[k][time], value = table.rows[k][c];
        if (!std::isfinite(at)) throw DataError(fmt::format("{}: row {}: it has no time", file, table.lines[k]));
        if (std::isnan(value)) continue;
        if (std::isinf(value))
          throw DataError(fmt::format("{}: row {}: {} is infinite; leave the field empty", file, table.lines[k], name));
        out.push_back({node_at(at, nodes_, file, table.lines[k]), at, number_of(name), *column, value,
                       sigma == options_.sigma.end() ? 1 : sigma->second});
      }
    }
    if (out.empty())
      throw DataError(
          fmt::format("{}: nothing in it is a column of the run; there are {}", file, fmt::join(names(), ", ")));
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
    return out;
  }

 private:
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const GradientName& each : subject_.observed) out.push_back(each.name);
    return out;
  }
  int number_of(const std::string& name) const {
    for (int i = 0; i < int(subject_.observed.size()); ++i)
      if (subject_.observed[std::size_t(i)].name == name) return i;
    throw GradientRefused(fmt::format("{}: no such column of the run; there are {}", name, fmt::join(names(), ", ")));
  }
  std::size_t column_of(const std::string& name) {
    number_of(name);
    for (std::size_t i = 0; i < fit_.columns.size(); ++i)
      if (fit_.columns[i].name == name) return i;
    fit_.columns.push_back({name});
    return fit_.columns.size() - 1;
  }
  /// The column to be fitted of that name, if there is one.
  std::optional<std::size_t> wanted(const std::string& name) {
    const auto all = names();
    const bool is_known = std::find(all.begin(), all.end(), name) != all.end();
    const bool is_chosen = options_.columns.empty() ||
                           std::find(options_.columns.begin(), options_.columns.end(), name) != options_.columns.end();
    if (is_known && is_chosen) return column_of(name);
    if (std::find(fit_.ignored.begin(), fit_.ignored.end(), name) == fit_.ignored.end()) fit_.ignored.push_back(name);
    return std::nullopt;
  }

  const GradientSubject& subject_;
  const FitOptions& options_;
  Fit& fit_;
  Nodes nodes_;
};

/// All runs by all unknowns: those of the start of each run, one after another, then the parameters, as differences
/// from what the scene has. Runs are made once for all measurements.
class Runs final : public ceres::EvaluationCallback {
 public:
  Runs(const GradientSubject& subject, const GradientColumns& columns, std::vector<MeasuredRun> runs)
      : subject_(subject), columns_(columns), runs_(std::move(runs)) {
    for (const int i : columns.parameters) parameters_.push_back(subject.parameters[std::size_t(i)].name);
    for (const MeasuredRun& run : runs_) count_ += run.size();
    x_.assign(unknowns(), 0.0);
    predicted_.resize(Eigen::Index(count_));
    derivatives_ = Eigen::MatrixXd::Zero(Eigen::Index(count_), Eigen::Index(unknowns()));
  }

  std::size_t unknowns() const { return runs_.size() * columns_.start.size() + parameters_.size(); }
  const std::vector<MeasuredRun>& runs() const { return runs_; }
  double* x() { return x_.data(); }
  bool is_defined() const { return failure_.empty(); }
  const std::string& failure() const { return failure_; }
  double predicted(std::size_t i) const { return predicted_(Eigen::Index(i)); }
  auto derivatives(std::size_t i) const { return derivatives_.row(Eigen::Index(i)); }

  void PrepareForEvaluation(bool with_derivatives, bool) override {
    failure_.clear();
    std::size_t first = 0;
    for (std::size_t r = 0; r < runs_.size() && failure_.empty(); ++r) {
      predict(r, first, with_derivatives);
      first += runs_[r].size();
    }
  }

 private:
  std::vector<Nudge> nudges_of(std::size_t run) const {
    std::vector<Nudge> out;
    const std::size_t from_start = columns_.start.size();
    for (std::size_t j = 0; j < from_start; ++j)
      out.push_back({.index = columns_.start[j], .by = x_[run * from_start + j]});
    for (std::size_t j = 0; j < parameters_.size(); ++j)
      out.push_back({.parameter = parameters_[j], .by = x_[runs_.size() * from_start + j]});
    return out;
  }

  void predict(std::size_t run, std::size_t first, bool with_derivatives) try {
    const auto motion = subject_.begin(with_derivatives ? parameters_ : std::vector<std::string>(), nudges_of(run));
    const auto from_start = Eigen::Index(columns_.start.size()), by_parameters = Eigen::Index(parameters_.size());
    const Eigen::Index states = motion->states(), width = with_derivatives ? from_start + by_parameters : 0;
    Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(states + (with_derivatives ? by_parameters : 0), width);
    if (with_derivatives) {
      for (Eigen::Index j = 0; j < from_start; ++j) directions(columns_.start[std::size_t(j)], j) = 1;
      directions.bottomRightCorner(by_parameters, by_parameters).setIdentity();
    }
    long node = 0;
    for (std::size_t i = 0; i < runs_[run].size();) {
      for (; node < runs_[run][i].node; ++node)
        if (!advance(*motion, with_derivatives, directions)) return fail(run, *motion);
      const NodeValues here = motion->observe();
      for (; i < runs_[run].size() && runs_[run][i].node == node; ++i) {
        const auto at = Eigen::Index(first + i);
        predicted_(at) = here.values(runs_[run][i].observed);
        if (!std::isfinite(predicted_(at))) return fail(run, *motion);
        if (!with_derivatives) continue;
        const Eigen::RowVectorXd by = here.derivatives.row(runs_[run][i].observed) * directions;
        derivatives_.block(at, Eigen::Index(run) * from_start, 1, from_start) = by.head(from_start);
        derivatives_.row(at).tail(by_parameters) = by.tail(by_parameters);
      }
    }
  } catch (const std::domain_error& error) {  // of parameters that a system cannot have
    failure_ = error.what();
  }
  static bool advance(LinearisedMotion& motion, bool with_derivatives, Eigen::MatrixXd& directions) {
    if (!motion.advance().converged()) return false;
    if (!with_derivatives) return true;
    if (!motion.linearise()) return false;
    for (int k = 0; k < motion.stages(); ++k) directions = motion.stage(k).forward(directions);
    return true;
  }
  void fail(std::size_t run, const LinearisedMotion& motion) {
    failure_ = fmt::format("run {} fails after t = {:.6g}", run + 1, motion.time());
  }

  const GradientSubject& subject_;
  const GradientColumns& columns_;
  std::vector<MeasuredRun> runs_;
  std::vector<std::string> parameters_;
  std::size_t count_ = 0;
  std::vector<double> x_;
  Eigen::VectorXd predicted_;
  Eigen::MatrixXd derivatives_;
  std::string failure_;
};

/// (y_i - d_i) / sigma_i.
class Residual final : public ceres::CostFunction {
 public:
  Residual(const Runs& runs, std::size_t index, const Measurement& measurement)
      : runs_(runs), index_(index), measurement_(measurement) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(int(runs.unknowns()));
  }
  bool Evaluate(double const* const*, double* residual, double** jacobians) const override {
    if (!runs_.is_defined()) return false;
    *residual = (runs_.predicted(index_) - measurement_.value) / measurement_.sigma;
    if (jacobians != nullptr && jacobians[0] != nullptr)
      Eigen::Map<Eigen::RowVectorXd>(jacobians[0], Eigen::Index(runs_.unknowns())) =
          runs_.derivatives(index_) / measurement_.sigma;
    return true;
  }

 private:
  const Runs& runs_;
  std::size_t index_;
  const Measurement& measurement_;
};

/// An unknown, what the scene has and how large it is taken to be.
struct Unknown {
  std::string name;  ///< without the run
  double start;
  double size;
};

std::vector<Unknown> unknowns_of(const GradientSubject& subject, const GradientColumns& columns, std::size_t runs,
                                 Fit& fit) {
  std::vector<Unknown> out;
  const auto size_of = [](double x) { return x != 0 ? std::abs(x) : 1; };
  for (std::size_t r = 0; r < runs; ++r)
    for (const int i : columns.start) {
      const GradientName& name = subject.start[std::size_t(i)];
      if (name.group == "displacement")
        throw GradientRefused(fmt::format(
            "initial.{}: where a run starts is fitted on vector spaces alone; fit momenta and parameters", name.name));
      const double start = subject.sizes[std::size_t(i)];
      out.push_back({"initial." + name.name, start, size_of(start)});
      fit.unknowns.push_back({out.back().name + (runs > 1 ? fmt::format(" of run {}", r + 1) : ""), start});
    }
  for (const int i : columns.parameters) {
    const double start = subject.sizes[subject.start.size() + std::size_t(i)];
    out.push_back({"parameters." + subject.parameters[std::size_t(i)].name, start, size_of(start)});
    fit.unknowns.push_back({out.back().name, start});
  }
  if (out.empty()) throw GradientRefused("nothing is to be fitted; name what with --wrt");
  return out;
}

std::array<double, 2> bounds_of(const Unknown& unknown, const FitOptions& options) {
  const auto found = options.bounds.find(unknown.name);
  if (found == options.bounds.end()) return {-infinite, infinite};
  const auto [low, high] = found->second;
  if (!(low <= unknown.start && unknown.start <= high))
    throw GradientRefused(
        fmt::format("{}: the scene has {:g}, which is not from {:g} to {:g}", unknown.name, unknown.start, low, high));
  return found->second;
}

/// One solve from the guess that stands in the runs; its cost, infinite where it failed.
double solve(Runs& runs, const std::vector<Unknown>& unknowns, const FitOptions& options, Fit& fit) {
  ceres::Problem::Options how;
  how.evaluation_callback = &runs;
  ceres::Problem problem(how);
  std::size_t index = 0;
  for (const MeasuredRun& run : runs.runs())
    for (const Measurement& each : run)
      problem.AddResidualBlock(new Residual(runs, index++, each),
                               options.huber > 0 ? new ceres::HuberLoss(options.huber) : nullptr, runs.x());
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    const auto [low, high] = bounds_of(unknowns[j], options);
    if (low > -infinite) problem.SetParameterLowerBound(runs.x(), int(j), low - unknowns[j].start);
    if (high < infinite) problem.SetParameterUpperBound(runs.x(), int(j), high - unknowns[j].start);
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = 200;
  solver.function_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-14;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  fit.iterations = int(summary.iterations.size()) - 1;
  if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost)) {
    fit.status = "failed";
    return infinite;
  }
  fit.status = summary.termination_type == ceres::CONVERGENCE ? "converged" : "not_converged";
  return summary.final_cost;
}

/// How each residual goes with the next, of a column of a run after another.
void describe_columns(const Runs& runs, Fit& fit) {
  std::vector<double> squares(fit.columns.size()), products(fit.columns.size());
  std::size_t index = 0;
  for (std::size_t r = 0; r < runs.runs().size(); ++r) {
    std::vector<std::optional<double>> last(fit.columns.size());
    for (const Measurement& each : runs.runs()[r]) {
      const double predicted = runs.predicted(index++);
      const double off = each.value - predicted;
      fit.points.push_back({r, each.time, each.column, each.value, predicted});
      Fit::Column& column = fit.columns[each.column];
      ++column.count;
      column.largest = std::max(column.largest, std::abs(each.value));
      squares[each.column] += off * off;
      if (last[each.column]) products[each.column] += off * *last[each.column];
      last[each.column] = off;
    }
  }
  for (std::size_t c = 0; c < fit.columns.size(); ++c) {
    Fit::Column& column = fit.columns[c];
    if (column.count == 0) continue;
    column.rms = std::sqrt(squares[c] / double(column.count));
    column.correlation = squares[c] > 0 ? products[c] / squares[c] : 0;
    column.white = column.exact() || std::abs(column.correlation) <= 3 / std::sqrt(double(column.count));
  }
}

/// A combination of unknowns in words, by its largest parts.
std::string in_words(const Eigen::VectorXd& direction, const std::vector<Fit::Unknown>& unknowns) {
  std::string out;
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    const double part = direction(Eigen::Index(j));
    if (std::abs(part) < 0.05) continue;
    out += fmt::format("{}{:.2g} {}",
                       out.empty() ? (part < 0 ? "-" : "")
                       : part < 0  ? " - "
                                   : " + ",
                       std::abs(part), unknowns[j].name);
  }
  return out;
}

/// Covariance, and what the data do not tell: singular values of J with columns of length one.
void describe_unknowns(const Runs& runs, const std::vector<Unknown>& unknowns, const FitOptions& options, Fit& fit) {
  const auto n = Eigen::Index(unknowns.size());
  std::size_t count = 0;
  for (const MeasuredRun& run : runs.runs()) count += run.size();
  Eigen::MatrixXd weighted(Eigen::Index(count), n);
  std::size_t index = 0;
  double squares = 0;
  for (const MeasuredRun& run : runs.runs())
    for (const Measurement& each : run) {
      const double residual = (runs.predicted(index) - each.value) / each.sigma;
      // A residual beyond the bound of Huber's loss weighs less.
      const double weight =
          options.huber > 0 && std::abs(residual) > options.huber ? options.huber / std::abs(residual) : 1;
      weighted.row(Eigen::Index(index)) = std::sqrt(weight) / each.sigma * runs.derivatives(index);
      ++index;
      squares += weight * residual * residual;
    }
  // What changes by an unknown's own size, and is rounding beside the others, is nothing.
  Eigen::VectorXd size = weighted.colwise().norm();
  Eigen::VectorXd effect = size;
  for (Eigen::Index j = 0; j < n; ++j) effect(j) *= unknowns[std::size_t(j)].size;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (effect(j) > 1e-12 * effect.maxCoeff()) continue;
    weighted.col(j).setZero();
    size(j) = 1;
  }
  constexpr double not_told = 1e-10;  // of the derivatives, which are exact to round-off and grew on the way
  const RightSingularVectors found = right_singular_vectors(weighted * size.cwiseInverse().asDiagonal(), not_told);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(n);
  Eigen::Index told = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::VectorXd direction = found.v.col(k);
    if (k < found.rank) {
      inverse += direction * direction.transpose() / (found.values(k) * found.values(k));
      ++told;
      continue;
    }
    lost += direction.cwiseAbs2();
    fit.undetermined.push_back(in_words(direction.cwiseQuotient(size).normalized(), fit.unknowns));
  }
  fit.scale = std::sqrt(squares / std::max(1.0, double(count) - double(told)));
  fit.covariance =
      fit.scale * fit.scale * (size.cwiseInverse().asDiagonal() * inverse * size.cwiseInverse().asDiagonal());
  for (Eigen::Index j = 0; j < n; ++j) {
    Fit::Unknown& unknown = fit.unknowns[std::size_t(j)];
    unknown.deviation = lost(j) > 1e-6 ? infinite : std::sqrt(fit.covariance(j, j));
    const auto [low, high] = bounds_of(unknowns[std::size_t(j)], options);
    unknown.at_bound = unknown.value <= low || unknown.value >= high;
  }
}

}  // namespace

Fit fit_scene(const GradientSubject& subject, const std::vector<std::string>& files, const FitOptions& options) {
  Fit fit;
  fit.system = subject.system;
  fit.runs = files.size();
  const GradientColumns columns = columns_of(subject, options.unknowns);
  std::vector<MeasuredRun> measured;
  Reader reader(subject, options, fit);
  for (const std::string& file : files) measured.push_back(reader.read(file));
  const std::vector<Unknown> unknowns = unknowns_of(subject, columns, files.size(), fit);
  for (const auto& [name, bounds] : options.bounds)
    if (std::none_of(unknowns.begin(), unknowns.end(), [&](const Unknown& each) { return each.name == name; }))
      throw GradientRefused(fmt::format("{}: it has bounds, but is not to be fitted", name));
  for (const Unknown& each : unknowns) bounds_of(each, options);

  for (const Fit::Column& column : fit.columns)
    if (std::none_of(measured.begin(), measured.end(), [&](const MeasuredRun& run) {
          return std::any_of(run.begin(), run.end(),
                             [&](const Measurement& each) { return &fit.columns[each.column] == &column; });
        }))
      throw DataError(fmt::format("{}: nothing is measured of it", column.name));

  Runs runs(subject, columns, std::move(measured));
  runs.PrepareForEvaluation(true, true);  // what has no derivative is refused here, and not amid a solve
  if (!runs.is_defined() && options.starts == 1) {
    fit.status = "failed";
    fit.failure = runs.failure();
    return fit;
  }
  const WienerPath stream{.seed = options.seed};
  Fit best = fit;
  std::vector<double> costs, at_best;
  for (int guess = 0; guess < options.starts; ++guess) {
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      const auto [low, high] = bounds_of(unknowns[j], options);
      const double by =
          guess == 0 ? 0 : options.spread * unknowns[j].size * stream.normals(guess, std::uint32_t(j / 2))[j % 2];
      runs.x()[j] = std::clamp(unknowns[j].start + by, low, high) - unknowns[j].start;
    }
    Fit now = fit;
    now.cost = solve(runs, unknowns, options, now);
    costs.push_back(now.cost);
    if (at_best.empty() ? now.cost < infinite : now.cost < best.cost) {
      best = std::move(now);
      at_best.assign(runs.x(), runs.x() + unknowns.size());
    }
  }
  if (at_best.empty()) {
    best.status = "failed";
    best.failure = "no run from any guess came to its end";
    return best;
  }
  std::sort(costs.begin(), costs.end());
  best.other_costs.assign(costs.begin() + 1, costs.end());
  std::copy(at_best.begin(), at_best.end(), runs.x());
  runs.PrepareForEvaluation(true, true);
  for (std::size_t j = 0; j < unknowns.size(); ++j) best.unknowns[j].value = unknowns[j].start + at_best[j];
  describe_unknowns(runs, unknowns, options, best);
  describe_columns(runs, best);
  return best;
}

}  // namespace lagroid::app
