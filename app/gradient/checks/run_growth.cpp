#include "run_growth.hpp"

#include "../gradient_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>

namespace lagroid::app {

namespace {

/// Whether a group is of the state itself: what is computed of that is a number alone of its kind, or one of these.
bool is_of_state(const std::string& group, const GradientSubject& subject) {
  static const std::set<std::string> others{"energy", "momenta", "Casimirs", "time", "computed"};
  if (others.contains(group)) return false;
  const auto is_of = [&](const GradientName& each) { return each.group == group; };
  return std::any_of(subject.start.begin(), subject.start.end(), is_of) ||
         std::count_if(subject.observed.begin(), subject.observed.end(), is_of) > 1;
}

/// All numbers of the start, as columns.
GradientColumns whole_start(const GradientSubject& subject) {
  GradientColumns out;
  out.start.resize(subject.start.size());
  std::iota(out.start.begin(), out.start.end(), 0);
  return out;
}

}  // namespace

std::string unit_of(const GradientName& name) {
  return name.group == "computed" ? "computed " + name.name : name.group;
}

void see(const GradientSubject& subject, const Eigen::VectorXd& observed, SizesOfUnits& sizes) {
  if (observed.size() != Eigen::Index(subject.observed.size()))
    throw std::logic_error(fmt::format("{} numbers are observed under {} names: this is a fault of the program",
                                       observed.size(), subject.observed.size()));
  for (Eigen::Index i = 0; i < observed.size(); ++i) {
    double& largest = sizes[unit_of(subject.observed[std::size_t(i)])];
    if (std::isfinite(observed(i))) largest = std::max(largest, std::abs(observed(i)));
  }
}

SizesOfUnits sizes_of_run(const GradientSubject& subject) {
  SizesOfUnits out;
  const auto motion = subject.begin({}, {});
  const long stride = std::max(1L, subject.steps / 64);
  for (long k = 0; k <= subject.steps; ++k) {
    if (k > 0 && !motion->pass().converged()) break;
    if (k % stride == 0 || k == subject.steps) see(subject, motion->observe().values, out);
  }
  return out;
}

RunGrowth::RunGrowth(const GradientSubject& subject, SizesOfUnits sizes) : sizes_(std::move(sizes)) {
  for (const GradientName& each : subject.observed) {
    units_.push_back(unit_of(each));
    is_of_state_.push_back(is_of_state(each.group, subject));
  }
  const auto motion = subject.begin({}, {});
  const Eigen::MatrixXd at_start =
      motion->observe().derivatives * directions_of(subject, whole_start(subject), {}, motion->states());
  const Eigen::Index count = at_start.cols();
  Eigen::VectorXd units = Eigen::VectorXd::Zero(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    double inverse = 0;
    for (Eigen::Index i = 0; i < at_start.rows(); ++i)
      if (const double size = sizes_[units_[std::size_t(i)]]; is_of_state_[std::size_t(i)] && size > 0)
        inverse = std::max(inverse, std::abs(at_start(i, j)) / size);
    if (inverse > 0) units(j) = 1 / inverse;
  }
  constexpr Eigen::Index few = 16;
  if (count <= few) {
    along_ = units.asDiagonal();
  } else {
    constexpr Eigen::Index probes = 4;
    along_.resize(count, probes);
    std::mt19937 bits;  // its numbers are the same everywhere
    for (double& x : along_.reshaped()) x = (bits() & 1U) != 0 ? 0.5 : -0.5;
    along_ = (units.asDiagonal() * along_).eval();
  }
  at_start_ = largest(at_start * along_);
}

double RunGrowth::largest(const Eigen::MatrixXd& observed_along) const {
  double out = 0;
  for (Eigen::Index i = 0; i < observed_along.rows(); ++i) {
    if (!is_of_state_[std::size_t(i)]) continue;
    const double size = sizes_.at(units_[std::size_t(i)]);
    if (!observed_along.row(i).allFinite()) return std::numeric_limits<double>::infinity();
    if (size > 0) out = std::max(out, observed_along.row(i).norm() / size);
  }
  return out;
}

double RunGrowth::factor(const Eigen::MatrixXd& observed_along) const {
  return at_start_ > 0 ? std::max(1.0, largest(observed_along) / at_start_) : 1;
}

}  // namespace lagroid::app
