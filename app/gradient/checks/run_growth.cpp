#include "run_growth.hpp"

#include "../gradient_table.hpp"

#include <lagroid/solvers/sensitivity/propagate.hpp>

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
bool is_of_state(const GradientName& name, const GradientSubject& subject) {
  static const std::set<std::string> others{"energy", "momenta", "Casimirs", "time"};
  if (name.is_computed || others.contains(name.group)) return false;
  const auto is_of = [&](const GradientName& each) { return each.group == name.group; };
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

/// Of numbers of a start, with some room: values this small beside what these change are no more than their rounding.
constexpr double rounding = 1e-14;

}  // namespace

std::string unit_of(const GradientName& name) { return name.is_computed ? "computed " + name.name : name.group; }

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

RunGrowth::RunGrowth(const GradientSubject& subject, SizesOfUnits sizes)
    : subject_(&subject), sizes_(std::move(sizes)) {
  for (const GradientName& each : subject.observed) {
    units_.push_back(unit_of(each));
    is_of_state_.push_back(is_of_state(each, subject));
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
  at_start_ = at_start * along_;
}

Eigen::MatrixXd RunGrowth::directions(Eigen::Index states, const std::vector<int>& parameters) const {
  GradientColumns whole = whole_start(*subject_);
  whole.parameters = parameters;
  return directions_of(*subject_, whole, {}, states).leftCols(along_.rows()) * along_;
}

double RunGrowth::largest(const Eigen::MatrixXd& observed_along, const Units& left_out) const {
  double out = 0;
  for (Eigen::Index i = 0; i < observed_along.rows(); ++i) {
    if (!is_of_state_[std::size_t(i)] || left_out.contains(units_[std::size_t(i)])) continue;
    const double size = sizes_.at(units_[std::size_t(i)]);
    if (!observed_along.row(i).allFinite()) return std::numeric_limits<double>::infinity();
    if (size > 0) out = std::max(out, observed_along.row(i).stableNorm() / size);
  }
  return out;
}

RunGrowth::Units RunGrowth::units_at_rest() const {
  const auto motion = subject_->begin({}, {});
  const Eigen::MatrixXd along = directions(motion->states());
  if (subject_->begin_along) subject_->begin_along(*motion, along);
  const Eigen::VectorXd start = motion->observe().values;
  const Propagated first = propagate_forward(*motion, 1, along);
  if (!first.converged()) return {};
  std::map<std::string, std::pair<double, double>> units;  // the largest number, and by how much a start changes one
  for (std::size_t i = 0; i < units_.size(); ++i) {
    const auto at = Eigen::Index(i);
    auto& [number, change] = units[units_[i]];
    number = std::max({number, std::abs(start(at)), std::abs(first.values(at))});
    change = std::max(change, first.derivatives.row(at).stableNorm());
  }
  Units out;
  for (const auto& [unit, of] : units)
    if (of.first <= rounding * of.second) out.insert(unit);
  return out;
}

double RunGrowth::factor(const Eigen::MatrixXd& observed_along, const Units& left_out) const {
  const double before = largest(at_start_, left_out);
  return before > 0 ? std::max(1.0, largest(observed_along, left_out) / before) : 1;
}

double RunGrowth::factor(const Eigen::MatrixXd& observed_along) const {
  const double out = factor(observed_along, {});
  return rounding * out > 1 ? factor(observed_along, units_at_rest()) : out;
}

}  // namespace lagroid::app
