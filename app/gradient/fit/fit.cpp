#include "answer.hpp"

#include <lagroid/solvers/ceres_solve.hpp>
#include <lagroid/solvers/poisson/wiener_path.hpp>

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::app {

namespace {

/// (y_i - d_i) / sigma_i.
class Residual final : public ceres::CostFunction {
 public:
  Residual(const PredictedRuns& runs, std::size_t index, const MeasuredNumber& measurement)
      : runs_(runs), index_(index), measurement_(measurement) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(int(runs.unknowns()));
  }
  bool Evaluate(double const* const*, double* residual, double** jacobians) const override {
    if (!runs_.is_defined()) return false;
    *residual = (runs_.predicted(index_) - measurement_.value) / measurement_.sigma;
    if (!std::isfinite(*residual * *residual)) return false;
    if (jacobians != nullptr && jacobians[0] != nullptr)
      Eigen::Map<Eigen::RowVectorXd>(jacobians[0], Eigen::Index(runs_.unknowns())) =
          runs_.derivatives(index_) / measurement_.sigma;
    return true;
  }

 private:
  const PredictedRuns& runs_;
  std::size_t index_;
  const MeasuredNumber& measurement_;
};

double size_of(double start) { return start != 0 ? std::abs(start) : 1; }

/// The signs that scenes allow a number, which has a value there. What is to be positive comes near zero and no nearer.
std::array<double, 2> range_of(const GradientSubject& subject, Nudge number, double start) {
  std::array<double, 2> out{-infinite, infinite};
  // A start that follows what is allowed is allowed everywhere.
  if (!subject.refusal || (number.parameter.empty() && subject.begun_by)) return out;
  const double size = size_of(start);
  const auto is_refused = [&](double value) {
    number.by = value - start;
    return !subject.refusal({number}).empty();
  };
  const auto nearest = [&] { return is_refused(0) ? 1e-6 * size : 0; };
  if (start >= 0 && is_refused(-size)) out[0] = nearest();
  if (start <= 0 && is_refused(size)) out[1] = -nearest();
  return out;
}

std::array<double, 2> bounds_of(const std::string& name, double start, const std::array<double, 2>& range,
                                const FitOptions& options) {
  const auto found = options.bounds.find(name);
  if (found == options.bounds.end()) return range;
  const auto [low, high] = found->second;
  if (!(low <= start && start <= high))
    throw GradientRefused(
        fmt::format("{}: the scene has {:g}, which is not from {:g} to {:g}", name, start, low, high));
  return {std::max(low, range[0]), std::min(high, range[1])};
}

/// Refuses numbers of the start that cannot be changed alone.
GradientSubject with_what_can_be_fitted(const GradientSubject& subject) {
  GradientSubject out = subject;
  for (std::size_t i = 0; i < subject.start.size(); ++i) {
    const GradientName& name = subject.start[i];
    std::string why;
    if (name.group == "displacement") {
      why = "where a run starts is fitted on vector spaces alone";
    } else if (subject.refusal && !subject.begun_by) {
      const double by = 1e-3 * size_of(subject.sizes[i]);
      why = subject.refusal({{.index = int(i), .by = by}});
      if (!why.empty() && subject.refusal({{.index = int(i), .by = -by}}).empty()) why.clear();
      if (!why.empty()) why = "with another one alone " + why;
    }
    if (!why.empty()) out.refused.emplace_back("initial." + name.name, why + "; fit others");
  }
  return out;
}

/// Names them in the fit, too.
std::vector<Guessed> unknowns_of(const GradientSubject& subject, const GradientColumns& columns, std::size_t runs,
                                 const FitOptions& options, Fit& fit) {
  std::vector<Guessed> out;
  const auto add = [&](const std::string& name, const std::string& of_run, const Nudge& number, double start) {
    const std::array<double, 2> range = range_of(subject, number, start);
    out.push_back({name, start, size_of(start), bounds_of(name, start, range, options)});
    fit.unknowns.push_back({name + of_run, start});
  };
  for (std::size_t r = 0; r < runs; ++r)
    for (const int i : columns.start)
      add("initial." + subject.start[std::size_t(i)].name, runs > 1 ? fmt::format(" of run {}", r + 1) : "",
          {.index = i}, subject.sizes[std::size_t(i)]);
  for (const int i : columns.parameters) {
    const std::string& name = subject.parameters[std::size_t(i)].name;
    add("parameters." + name, "", {.parameter = name}, subject.sizes[subject.start.size() + std::size_t(i)]);
  }
  if (out.empty()) throw GradientRefused("nothing is to be fitted; name what with --wrt");
  return out;
}

/// One solve from where the runs stand; its cost, infinite where it failed.
double solve(PredictedRuns& runs, const std::vector<Guessed>& unknowns, const FitOptions& options, Fit& fit) {
  ceres::Problem::Options how;
  how.evaluation_callback = &runs;
  ceres::Problem problem(how);
  std::size_t index = 0;
  for (const MeasuredRun& run : runs.runs())
    for (const MeasuredNumber& each : run) {
      const std::size_t at = index++;
      if (runs.is_within(each))
        problem.AddResidualBlock(new Residual(runs, at, each),
                                 options.huber > 0 ? new ceres::HuberLoss(options.huber) : nullptr, runs.x());
    }
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    const auto [low, high] = unknowns[j].bounds;
    if (low > -infinite) problem.SetParameterLowerBound(runs.x(), int(j), low - unknowns[j].start);
    if (high < infinite) problem.SetParameterUpperBound(runs.x(), int(j), high - unknowns[j].start);
  }
  ceres::Solver::Options solver = lagroid::detail::to_round_off(200);
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.function_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-14;
  const ceres::Solver::Summary summary = lagroid::detail::solve_by_ceres(solver, problem);
  fit.iterations += int(summary.iterations.size()) - 1;
  if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost)) {
    fit.status = "failed";
    return infinite;
  }
  // What ends by a step to where nothing is known is where the search was stopped, and no solution.
  fit.stopped_by = runs.failure();
  fit.status = summary.termination_type == ceres::CONVERGENCE && runs.is_defined() ? "converged" : "not_converged";
  return summary.final_cost;
}

bool is_explained(const PredictedRuns& runs, Fit fit) {
  describe_columns(runs, fit);
  return std::all_of(fit.columns.begin(), fit.columns.end(), [](const Fit::Column& each) { return each.white; });
}

/// By what was measured first, then by more and more of it: far from the solution late times, at which runs differ
/// most, lead astray.
double solve_growing(PredictedRuns& runs, const std::vector<Guessed>& unknowns, const FitOptions& options, Fit& fit) {
  double first = infinite, last = -infinite;
  for (const MeasuredRun& run : runs.runs()) {
    first = std::min(first, run.front().time);
    last = std::max(last, run.back().time);
  }
  for (const double share : {0.125, 0.25, 0.5}) {
    runs.end_at(first + share * (last - first));
    solve(runs, unknowns, options, fit);
  }
  runs.end_at(infinite);
  return solve(runs, unknowns, options, fit);
}

/// A solve from the guess that stands in the runs; where it leaves over what are no independent errors, another by
/// growing parts of the data.
double solve_from_guess(PredictedRuns& runs, const std::vector<Guessed>& unknowns, const FitOptions& options,
                        Fit& fit) {
  const std::size_t count = unknowns.size();
  const std::vector<double> guess(runs.x(), runs.x() + count);
  const double cost = solve(runs, unknowns, options, fit);
  if (cost < infinite) {
    runs.PrepareForEvaluation(false, true);
    if (is_explained(runs, fit)) return cost;
  }
  const std::vector<double> found(runs.x(), runs.x() + count);
  std::copy(guess.begin(), guess.end(), runs.x());
  Fit other = fit;
  const double better = solve_growing(runs, unknowns, options, other);
  if (better < cost) {
    fit = std::move(other);
    return better;
  }
  std::copy(found.begin(), found.end(), runs.x());
  return cost;
}

}  // namespace

Fit fit_scene(const GradientSubject& scene, const std::vector<std::string>& files, const FitOptions& options) {
  if (scene.cost) throw GradientRefused("a fit takes initial values; a path between two ends has no column t to fit");
  Fit fit;
  const GradientSubject subject = with_what_can_be_fitted(scene);
  fit.system = subject.system;
  fit.runs = files.size();
  const GradientColumns columns = columns_of(subject, options.unknowns);
  fit.notes = notes_on_left_out(subject, columns);
  fit.notes.insert(fit.notes.end(), subject.notes.begin(), subject.notes.end());
  std::vector<MeasuredRun> measured = read_measured(subject, files, options, fit);
  const std::vector<Guessed> unknowns = unknowns_of(subject, columns, files.size(), options, fit);
  for (const auto& bound : options.bounds)
    if (std::none_of(unknowns.begin(), unknowns.end(), [&](const Guessed& each) { return each.name == bound.first; }))
      throw GradientRefused(fmt::format("{}: it has bounds, but is not to be fitted", bound.first));

  PredictedRuns runs(subject, columns, std::move(measured));
  runs.PrepareForEvaluation(true, true);  // what has no derivative is refused here, and not amid a solve
  const std::string own_failure = runs.failure();
  const WienerPath stream{.seed = options.seed};
  Fit best = fit;
  std::vector<double> costs, at_best;
  for (int guess = 0; guess < options.starts; ++guess) {
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      const auto [low, high] = unknowns[j].bounds;
      const double by =
          guess == 0 ? 0 : options.spread * unknowns[j].size * stream.normals(guess, std::uint32_t(j / 2))[j % 2];
      runs.x()[j] = std::clamp(unknowns[j].start + by, low, high) - unknowns[j].start;
    }
    Fit now = fit;
    now.cost = solve_from_guess(runs, unknowns, options, now);
    costs.push_back(now.cost);
    if (at_best.empty() ? now.cost < infinite : now.cost < best.cost) {
      best = std::move(now);
      at_best.assign(runs.x(), runs.x() + unknowns.size());
    }
  }
  if (at_best.empty()) {
    best.status = "failed";
    best.failure = own_failure.empty() ? "no run from any guess came to its end" : own_failure;
    return best;
  }
  std::sort(costs.begin(), costs.end());
  best.other_costs.assign(costs.begin() + 1, costs.end());
  std::copy(at_best.begin(), at_best.end(), runs.x());
  runs.PrepareForEvaluation(true, true);
  for (std::size_t j = 0; j < unknowns.size(); ++j) best.unknowns[j].value = unknowns[j].start + at_best[j];
  describe_unknowns(runs, subject, unknowns, options, best);
  describe_columns(runs, best);
  if (!best.stopped_by.empty())
    best.notes.push_back(fmt::format("the search was stopped where there is no run: {}", best.stopped_by));
  return best;
}

}  // namespace lagroid::app
