#include <lagroid/solvers/sensitivity/growth/growth.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace lagroid {

namespace {

/// For each component the number of its class, of those that act upon each other, directly or through others: the
/// strongly connected components of the graph of the entries that are not zero (Tarjan 1972).
std::vector<int> classes_of(const Eigen::MatrixXd& matrix) {
  const auto count = std::size_t(matrix.cols());
  std::vector<int> found(count, -1), lowest(count, 0), out(count, -1);
  std::vector<std::size_t> open;
  int visited = 0, classes = 0;
  const std::function<void(std::size_t)> visit = [&](std::size_t i) {
    found[i] = lowest[i] = visited++;
    open.push_back(i);
    for (std::size_t j = 0; j < count; ++j) {
      if (matrix(Eigen::Index(j), Eigen::Index(i)) == 0 || out[j] >= 0) continue;
      if (found[j] < 0) visit(j);
      lowest[i] = std::min(lowest[i], lowest[j]);
    }
    if (lowest[i] != found[i]) return;
    for (bool is_last = false; !is_last; open.pop_back()) {
      out[open.back()] = classes;
      is_last = open.back() == i;
    }
    ++classes;
  };
  for (std::size_t i = 0; i < count; ++i)
    if (found[i] < 0) visit(i);
  return out;
}

std::vector<Eigen::Index> numbered(Eigen::Index count) {
  std::vector<Eigen::Index> out(static_cast<std::size_t>(count));
  std::iota(out.begin(), out.end(), Eigen::Index(0));
  return out;
}

}  // namespace

void OwnUnits::see(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return;
  if (seen_++ == 0) sum_ = Eigen::MatrixXd::Zero(matrix.rows(), matrix.cols());
  sum_ += (matrix - Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols())).cwiseAbs();
}

Eigen::VectorXd OwnUnits::of(Eigen::Index components) const {
  Eigen::VectorXd units = Eigen::VectorXd::Ones(components);
  if (seen_ == 0) return units;
  // What acts one way alone acts back by so little that all steps together count once.
  Eigen::MatrixXd coupling = sum_ / double(seen_);
  const double back = 1 / (double(asked_) * double(asked_));
  const std::vector<int> classes = classes_of(sum_);
  for (Eigen::Index i = 0; i < components; ++i)
    for (Eigen::Index j = 0; j < components; ++j)
      if (sum_(j, i) > 0 && classes[std::size_t(i)] != classes[std::size_t(j)])
        coupling(i, j) += back * double(seen_) / sum_(j, i);
  coupling.diagonal().setZero();
  const Eigen::MatrixXd rows = coupling.transpose();
  Eigen::VectorXd inverses = units;
  constexpr int most_sweeps = 200;
  constexpr double settled = 1e-3;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0;
    for (Eigen::Index i = 0; i < components; ++i) {
      const double row = rows.col(i).dot(units) / units(i);
      const double column = coupling.col(i).dot(inverses) * units(i);
      const double factor = std::sqrt(row / column);
      if (!(factor > 0 && std::isfinite(factor))) continue;
      units(i) *= factor;
      inverses(i) = 1 / units(i);
      change = std::max(change, std::abs(std::log(factor)));
    }
    if (change < settled) break;
  }
  return units;
}

double largest_ratio(const Eigen::MatrixXd& first, const Eigen::MatrixXd& peak, const Eigen::VectorXd& scale) {
  double largest = 1;
  for (Eigen::Index j = 0; j < first.cols(); ++j) {
    const double before = first.col(j).cwiseProduct(scale).norm();
    if (before > 0) largest = std::max(largest, peak.col(j).cwiseProduct(scale).norm() / before);
  }
  return largest;
}

Growth::Growth(const Eigen::MatrixXd& directions)
    : Growth(directions, directions.rows(), numbered(directions.cols())) {}

Growth::Growth(const Eigen::MatrixXd& directions, Eigen::Index rows, std::vector<Eigen::Index> columns)
    : columns_(std::move(columns)),
      first_(directions(Eigen::seqN(0, rows), columns_).cwiseAbs()),
      peak_(first_),
      added_(first_.colwise().maxCoeff().array() == 0),
      last_(first_.colwise().maxCoeff()) {}

void Growth::after_a_step(const Eigen::MatrixXd& directions) {
  ++steps_;
  const Eigen::Index rows = first_.rows();
  for (Eigen::Index j = 0; j < first_.cols(); ++j) {
    const double* const x = directions.col(columns_[std::size_t(j)]).data();
    double* const peak = peak_.col(j).data();
    const double inverse = added_(j) ? 1 / double(steps_) : 1;
    double largest = 0, zero = 0;
    for (Eigen::Index i = 0; i < rows; ++i) {
      largest = std::max(largest, std::abs(x[i]));
      zero += 0 * x[i];
    }
    if (zero != 0) {  // an entry is no finite number
      peak_.col(j).setConstant(std::numeric_limits<double>::infinity());
      continue;
    }
    largest *= inverse;
    // No step makes ten thousand million of one: what was there before was rounding.
    constexpr double rounding = 1e-10;
    if (added_(j) && !(last_(j) > rounding * largest))
      for (Eigen::Index i = 0; i < rows; ++i) first_(i, j) = std::abs(x[i]) * inverse;
    for (Eigen::Index i = 0; i < rows; ++i) peak[i] = std::max(peak[i], std::abs(x[i]) * inverse);
    last_(j) = largest;
  }
}

double Growth::largest() const { return largest_ratio(first_, peak_, units_.of(first_.rows()).cwiseInverse()); }

}  // namespace lagroid
