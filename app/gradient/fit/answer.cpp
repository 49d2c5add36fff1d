#include "answer.hpp"

#include <lagroid/core/matrices/decompositions.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace lagroid::app {

namespace {

/// Directions that span the same, with as many zeros as there are directions to them: Gauss and Jordan, with the
/// largest pivot.
Eigen::MatrixXd with_zeros(Eigen::MatrixXd rows) {
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    Eigen::Index pivot = 0, row = 0;
    rows.bottomRows(rows.rows() - k).cwiseAbs().maxCoeff(&row, &pivot);
    rows.row(k).swap(rows.row(k + row));
    rows.row(k) /= rows(k, pivot);
    for (Eigen::Index i = 0; i < rows.rows(); ++i)
      if (i != k) rows.row(i) -= rows(i, pivot) * Eigen::RowVectorXd(rows.row(k));
  }
  return rows.unaryExpr([](double part) { return std::abs(part) < 1e-5 ? 0 : part; });
}

/// What changes together, unseen: of unknowns that are not zero by factors.
std::string in_words(const Eigen::RowVectorXd& parts, const Eigen::VectorXd& units,
                     const std::vector<Fit::Unknown>& unknowns) {
  std::vector<std::string> names, changes;
  bool is_one_factor = true;
  // The smallest is one, unless it is far smaller than the largest.
  double smallest = 0, largest = 0;
  for (const double part : parts) {
    if (part == 0) continue;
    if (smallest == 0 || std::abs(part) < std::abs(smallest)) smallest = part;
    if (std::abs(part) > std::abs(largest)) largest = part;
  }
  const double one = std::abs(largest) <= 10 * std::abs(smallest) ? smallest : largest;
  for (Eigen::Index j = 0; j < parts.size(); ++j) {
    if (parts(j) == 0) continue;
    const bool by_factor = units(j) == unknowns[std::size_t(j)].value;
    const double part = parts(j) / one;
    is_one_factor = is_one_factor && by_factor && std::abs(part - 1) < 1e-4;
    names.push_back(unknowns[std::size_t(j)].name);
    changes.push_back(by_factor ? fmt::format("{} by {:.4g} %", names.back(), part)
                                : fmt::format("{} by {:.4g}", names.back(), 0.01 * part * units(j)));
  }
  if (names.size() == 1) return names.front();
  if (is_one_factor) return fmt::format("{}, all by one factor", fmt::join(names, ", "));
  return fmt::format("{} together", fmt::join(changes, ", "));
}

/// The directions of these columns, by zeros and in units of the unknowns.
void name_null_space(const Eigen::MatrixXd& directions, const std::vector<Guessed>& unknowns, Fit& fit) {
  Eigen::VectorXd units(directions.rows());
  for (Eigen::Index j = 0; j < units.size(); ++j) {
    const double value = fit.unknowns[std::size_t(j)].value, size = unknowns[std::size_t(j)].size;
    units(j) = std::abs(value) > 1e-6 * size ? value : size;
  }
  const Eigen::MatrixXd parts = with_zeros((units.cwiseInverse().asDiagonal() * directions).transpose());
  fit.null_space = parts * units.asDiagonal();
  for (Eigen::Index k = 0; k < parts.rows(); ++k)
    fit.undetermined.push_back(in_words(parts.row(k), units, fit.unknowns));
}

/// Functions of the unknowns, of which some the data tell though they do not tell all unknowns. `unseen` holds changes
/// that they do not see, and `unit` those of one unknown each by which the data change alike, a column each.
void describe_combinations(const GradientSubject& subject, const FitOptions& options, const Eigen::MatrixXd& unseen,
                           const Eigen::MatrixXd& unit, Fit& fit) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const Fit::Unknown& each : fit.unknowns) {
    names.push_back(each.name);
    values.push_back(each.value);
  }
  for (std::size_t i = 0; i < subject.parameters.size(); ++i) {
    const std::string name = "parameters." + subject.parameters[i].name;
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    names.push_back(name);
    values.push_back(subject.sizes[subject.start.size() + i]);
  }
  for (const NamedText& text : options.combinations) {
    ComputedNumber function(text, names);
    Fit::Combination out{text.first, function.evaluate(values)};
    if (!std::isfinite(out.value))
      throw GradientRefused(
          fmt::format("--combination {}={}: it is no finite number at the solution", text.first, text.second));
    Eigen::VectorXd by = Eigen::VectorXd::Zero(unit.rows());
    for (std::size_t k = 0; k < function.used().size(); ++k)
      if (const auto at = Eigen::Index(function.used()[k]); at < by.size()) by(at) = function.by()[k];
    const bool is_told = (unseen.transpose() * by).norm() <= 1e-6 * (unit.transpose() * by).norm();
    out.deviation = is_told ? std::sqrt(by.dot(fit.covariance * by)) : infinite;
    fit.combinations.push_back(out);
  }
}

constexpr double nothing_known = std::numeric_limits<double>::quiet_NaN();

/// Marks the unknowns that end at a bound; the others as columns.
Eigen::MatrixXd free_unknowns(const std::vector<Guessed>& unknowns, Fit& fit) {
  const auto n = Eigen::Index(unknowns.size());
  Eigen::MatrixXd free(n, n);
  Eigen::Index count = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto& [name, start, size, bounds] = unknowns[std::size_t(j)];
    Fit::Unknown& unknown = fit.unknowns[std::size_t(j)];
    const double rounding = 1e-12 * size;
    unknown.at_bound = unknown.value <= bounds[0] + rounding || unknown.value >= bounds[1] - rounding;
    if (!unknown.at_bound) free.col(count++) = Eigen::VectorXd::Unit(n, j);
  }
  return free.leftCols(count);
}

/// Weighted residuals, as the loss takes them, and their derivatives.
struct LeftOver {
  Eigen::MatrixXd derivatives;
  double squares = 0;   ///< the sum of psi^2
  double rounding = 0;  ///< what is less is no change of the data: epsilon times the norm of them and of the run's
  long within = 0;      ///< how many are not cut off

  /// s, of so many unknowns that are told; nothing is left over of as many numbers.
  double scale(Eigen::Index told) const {
    const auto spare = double(derivatives.rows() - told);
    return spare > 0 ? std::sqrt(squares / spare) : nothing_known;
  }
  /// c, one where nothing is cut off.
  double correction(Eigen::Index told) const {
    const auto count = double(derivatives.rows());
    const double share = double(within) / count;
    return share > 0 ? (1 + double(told) / count * (1 - share) / share) / share : nothing_known;
  }
};
LeftOver left_over(const PredictedRuns& runs, Eigen::Index unknowns, double huber) {
  std::size_t count = 0;
  for (const MeasuredRun& run : runs.runs()) count += run.size();
  LeftOver out{Eigen::MatrixXd(Eigen::Index(count), unknowns)};
  std::size_t index = 0;
  for (const MeasuredRun& run : runs.runs())
    for (const MeasuredNumber& each : run) {
      const double residual = (runs.predicted(index) - each.value) / each.sigma;
      const bool is_within = huber == 0 || std::abs(residual) <= huber;
      out.squares += is_within ? residual * residual : huber * huber;
      out.within += is_within ? 1 : 0;
      const double size = std::max(std::abs(each.value), std::abs(runs.predicted(index)));
      out.rounding = std::hypot(out.rounding, std::numeric_limits<double>::epsilon() * size / each.sigma);
      out.derivatives.row(Eigen::Index(index)) = runs.derivatives(index) / each.sigma;
      ++index;
    }
  return out;
}

}  // namespace

void describe_columns(const PredictedRuns& runs, Fit& fit) {
  std::vector<double> squares(fit.columns.size()), products(fit.columns.size());
  std::size_t index = 0;
  for (std::size_t r = 0; r < runs.runs().size(); ++r) {
    std::vector<std::optional<double>> last(fit.columns.size());
    for (const MeasuredNumber& each : runs.runs()[r]) {
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

void describe_unknowns(const PredictedRuns& runs, const GradientSubject& subject, const std::vector<Guessed>& unknowns,
                       const FitOptions& options, Fit& fit) {
  const Eigen::MatrixXd free = free_unknowns(unknowns, fit);
  const LeftOver left = left_over(runs, Eigen::Index(unknowns.size()), options.huber);
  Eigen::MatrixXd weighted = left.derivatives * free;
  // What changes by an unknown's own size, and is rounding beside the others or beside the data, is nothing.
  Eigen::VectorXd size = weighted.colwise().norm();
  Eigen::VectorXd effect(free.rows());
  for (Eigen::Index j = 0; j < free.rows(); ++j) effect(j) = unknowns[std::size_t(j)].size;
  effect = (free.transpose() * effect).cwiseProduct(size).eval();
  for (Eigen::Index j = 0; j < size.size(); ++j) {
    if (effect(j) > std::max(1e-12 * effect.maxCoeff(), left.rounding)) continue;
    weighted.col(j).setZero();
    size(j) = 1;
  }
  constexpr double not_told = 1e-10;  // of the derivatives, which are exact to round-off and grew on the way
  RightSingularVectors found{};
  if (size.size() > 0) found = right_singular_vectors(weighted * size.cwiseInverse().asDiagonal(), not_told);
  fit.rank = found.rank;
  fit.singular_values = found.values;
  const Eigen::MatrixXd unit = free * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd not_seen = found.v.rightCols(size.size() - found.rank);
  const Eigen::MatrixXd seen = unit * found.v.leftCols(found.rank), unseen = unit * not_seen;
  name_null_space(unseen, unknowns, fit);
  fit.scale = left.scale(fit.rank);
  // As many numbers as unknowns leave nothing over by which their errors could be measured.
  const bool all_have_sigma = std::all_of(fit.columns.begin(), fit.columns.end(),
                                          [&](const Fit::Column& each) { return options.sigma.count(each.name) > 0; });
  const double error = std::isnan(fit.scale) && all_have_sigma ? 1 : left.correction(fit.rank) * fit.scale;
  if (const double share = double(left.within) / double(left.derivatives.rows()); share < 0.5)
    fit.notes.push_back(fmt::format(
        "only {:.0f} % of the numbers are within --huber sigma of the run: deviations are too small then; give "
        "--sigma as large as the errors are",
        100 * share));
  const Eigen::VectorXd parts = found.values.head(fit.rank).cwiseInverse() * error;
  fit.covariance = seen * parts.cwiseAbs2().asDiagonal() * seen.transpose();
  const Eigen::VectorXd lost = (free * not_seen).rowwise().squaredNorm();
  for (Eigen::Index j = 0; j < free.rows(); ++j) {
    Fit::Unknown& unknown = fit.unknowns[std::size_t(j)];
    unknown.deviation = unknown.at_bound ? nothing_known : lost(j) > 1e-6 ? infinite : std::sqrt(fit.covariance(j, j));
  }
  describe_combinations(subject, options, unseen, unit, fit);
}

}  // namespace lagroid::app
