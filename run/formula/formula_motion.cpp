#include <lagroid/run/formula/formula_motion.hpp>
#include <lagroid/run/run_result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

FormulaNode::FormulaNode(const FormulaSystem& system, bool symplectic)
    : system_(system),
      columns_(2 * system.coordinates().size() + system.parameters().size()),
      momentum_slopes_(system.symmetries().size() * columns_) {
  fields_.push_back({.columns = {"position", system.coordinates(), "1", "coordinates", false, {}}});
  fields_.push_back({.columns = {"velocity", system.velocities(), "1/s", "of the coordinates", false, {}}});
  fields_.push_back({.columns = {"momentum", system.momenta(), "1", "tangent to the constraints", false, {}}});
  const auto watch = [&](const std::string& name, const std::string& column, Promise promise, bool promised,
                         const char* meaning) {
    watched_.push_back({name, {column}, promise, false, SizeOf::terms, promised});
    fields_.push_back({.columns = {column, {column}, "1", meaning, false, {}}});
  };
  watch("energy", "energy", Promise::bounded, symplectic && system.keeps_energy(), system.energy_is());
  for (const ReadSymmetry& each : system.symmetries())
    watch(each.name, "J " + each.name, Promise::conserved, each.affine, "<p, xi(q)>");
  for (std::size_t i = 0; i < watched_.size(); ++i)
    fields_.push_back(drift_field(i, watched_[i].name, watched_[i].components.front()));
  // No name of a coordinate has a blank.
  if (system.constraint_count() > 0)
    fields_.push_back({.columns = {"constraint_residual", {"constraint residual"}, "1", "largest |g|", false, {}}});
}

void FormulaNode::see(long index, double time, const SizedState& state, const SizedStep& step) {
  index_ = index;
  time_ = time;
  state_ = state;
  step.find_velocity(state, time, tangent_);
  system_.momentum_slopes(state.position.data(), tangent_.momentum.data(), momentum_slopes_.data());
  if (system_.constraint_count() == 0) return;
  const Eigen::MatrixXd c = system_.constraint_rows(state.position);
  residual_ = c.col(0).cwiseAbs().maxCoeff();
  residual_size_ = (c.rightCols(c.cols() - 1).cwiseAbs() * state.position.cwiseAbs()).maxCoeff();
  if (!(residual_size_ > 0)) residual_size_ = 1;
}

Endpoint FormulaNode::endpoint() const {
  Endpoint end;
  end.time = time_;
  end.position.assign(state_.position.begin(), state_.position.end());
  end.momentum.assign(tangent_.momentum.begin(), tangent_.momentum.end());
  return end;
}

void FormulaNode::read(std::size_t field, double* row) const {
  const auto copy = [&](const Eigen::VectorXd& from) { std::copy(from.begin(), from.end(), row); };
  if (field == 0) {
    copy(state_.position);
  } else if (field == 1) {
    copy(tangent_.velocity);
  } else if (field == 2) {
    copy(tangent_.momentum);
  } else if (system_.constraint_count() > 0 && field + 1 == fields_.size()) {
    *row = residual_;
  } else {
    measure(field - 3, row);
  }
}

double FormulaNode::measure(std::size_t quantity, double* values) const {
  if (quantity == 0) {
    *values = tangent_.energy;
    return tangent_.energy_size;
  }
  // Symmetries leave the constraints, so that the part of p across them does not count.
  double sum = 0, size = 0;
  const double* by_place = momentum_slopes_.data() + (quantity - 1) * columns_;
  const double* xi = by_place + state_.position.size();
  for (Eigen::Index i = 0; i < state_.momentum.size(); ++i) {
    const double term = tangent_.momentum(i) * xi[i];
    sum += term;
    size += std::abs(term);
  }
  // The rounding of q in xi.
  for (Eigen::Index j = 0; j < state_.position.size(); ++j) size += std::abs(by_place[j] * state_.position(j));
  *values = sum;
  return size;
}

std::optional<double> FormulaNode::residual() const {
  if (system_.constraint_count() == 0) return {};
  return residual_;
}

FormulaMotion::FormulaMotion(std::string name, std::unique_ptr<FormulaSystem> system, FormulaMethod method,
                             SizedState start, double step, double begin)
    : name_(std::move(name)),
      system_(std::move(system)),
      method_(std::move(method)),
      state_(std::move(start)),
      size_(step),
      begin_(begin),
      node_(*system_, method_.traits.symplectic) {
  // Part of the state, so that a resumed run goes on with the same bits.
  if (state_.velocity.size() == 0) {
    TangentState tangent;
    method_.step->find_velocity(state_, begin_, tangent);
    state_.velocity = tangent.velocity;
  }
}

StepReport FormulaMotion::advance() {
  const StepReport report = method_.step->take(state_, time(), size_);
  if (report.converged()) ++index_;
  return report;
}

std::string FormulaMotion::failure(const StepReport& report, long step) const {
  const std::string where = fmt::format("step {} (from t = {:.6g})", step, time());
  switch (report.status) {
    case SolveStatus::singular:
      return fmt::format(
          "{}: the step's equations are singular: momenta do not determine velocities there, constraints depend on "
          "each other, or the step is too long",
          where);
    case SolveStatus::not_finite:
      return fmt::format("{}: a formula is no finite number there; use a smaller time.step", where);
    default:
      return fmt::format(
          "{}: the step's equations were not solved ({}, residual {:.3g} after {} iterations); use a "
          "smaller time.step",
          where, to_string(report.status), report.residual, report.iterations);
  }
}

const Observables& FormulaMotion::look() {
  node_.see(index_, time(), state_, *method_.step);
  return node_;
}

std::vector<NamedVector> FormulaMotion::state() const {
  // Momenta that differ across the constraints are one.
  TangentState tangent;
  method_.step->find_velocity(state_, time(), tangent);
  const auto numbers = [](const Eigen::VectorXd& x) { return std::vector<double>(x.begin(), x.end()); };
  return {{"configuration", numbers(state_.position)}, {"momentum", numbers(tangent.momentum)}};
}

std::optional<double> FormulaMotion::defect() const {
  FormulaNode node(*system_, method_.traits.symplectic);
  node.see(index_, time(), state_, *method_.step);
  return node.residual();
}

void FormulaMotion::describe(RunResult& result) const {
  const std::vector<std::string>& names = system_->coordinates();
  const std::vector<std::string>& momenta = system_->momenta();
  result.panels.push_back({"position", "t", "", "t", names});
  if (names.size() > 1)
    result.panels.push_back({names[1] + " over " + names[0], names[0], names[1], names[0], {names[1]}, true});
  if (names.size() == 1) result.panels.push_back({"phase space", names[0], momenta[0], names[0], {momenta[0]}});
  for (const Watched& each : node_.quantities())
    result.panels.push_back({each.name + " error", "t", "deviation", "t", {"drift " + each.components.front()}});
  if (names.size() > 1) {
    Shape point{"sphere", {0.03}};
    point.position = {names[0], names[1], 0.0};
    if (names.size() > 2) point.position[2] = names[2];
    point.trail = true;
    result.shapes = {point};
  }
  result.trajectory.conventions = {{"state", "coordinates of R^n and their momenta"}};
}

void FormulaMotion::keep_node() {
  kept_ = state_;
  kept_time_ = time();
  rest_ = 1;
}

StepReport FormulaMotion::go_within(double share) {
  inside_ = kept_;
  const double size = share * rest_ * size_;
  if (size != 0) return method_.step->take(inside_, kept_time_, size);
  StepReport nothing_to_solve;
  nothing_to_solve.status = SolveStatus::converged;
  return nothing_to_solve;
}

const Observables* FormulaMotion::look_within(double share) {
  if (!go_within(share).converged()) return nullptr;
  node_.see(index_, kept_time_ + share * rest_ * size_, inside_, *method_.step);
  return &node_;
}

Changeable FormulaMotion::changeable() const {
  Changeable out{.momenta = {{"", system_->coordinates().size()}}};
  for (const auto& [name, value] : system_->parameters()) out.parameters.push_back(name);
  return out;
}

namespace {

void set(FormulaSystem& system, const std::vector<ParameterValue>& parameters) {
  for (const ParameterValue& each : parameters) system.set_parameter(each.name, each.value);
}

}  // namespace

SizedState FormulaMotion::kicked(const MotionChange& change) const {
  SizedState out = inside_;
  for (std::size_t i = 0; i < change.kick.size(); ++i) out.momentum(Eigen::Index(i)) += change.kick[i];
  return out;
}

std::string FormulaMotion::refused_by(const FormulaSystem& after, double t) const {
  constexpr double rounding = 1e-9;
  const double size = inside_.position.norm() + (inside_.position - kept_.position).norm();
  if (const OffConstraint off = after.off_constraints(inside_.position, size); !(off.share <= rounding))
    return fmt::format("with these parameters it is off constraint {}, by {:.3g} of its size", off.which, off.share);
  TangentState tangent;
  method_.step->find_velocity(inside_, t, tangent);
  if (const OffConstraint off = after.leaving_constraints(inside_.position, tangent.velocity); !(off.share <= rounding))
    return fmt::format(
        "with these parameters its velocity leaves constraint {}, by {:.3g} of its size: let the event stop the run, "
        "and "
        "begin another from there",
        off.which, off.share);
  const Eigen::VectorXd& along = after.by_velocity() ? tangent.velocity : tangent.momentum;
  for (std::size_t i = 0; i < after.symmetries().size(); ++i)
    if (const double defect = after.symmetry_defect(i, t, inside_.position.data(), along.data()); !(defect <= rounding))
      return fmt::format(
          "with these parameters \"{}\" is no symmetry, by {:.3g} of the terms: leave it out of the scene",
          after.symmetries()[i].name, defect);
  return "";
}

std::string FormulaMotion::refused(double share, const MotionChange& change) {
  if (!go_within(share).converged()) return "a part of the step does not converge; use a smaller time.step";
  if (!kicked(change).momentum.allFinite()) return "the kick is no number there";
  for (const ParameterValue& each : change.parameters)
    if (!std::isfinite(each.value)) return fmt::format("{} becomes {:g}, and is to be finite", each.name, each.value);
  if (change.parameters.empty()) return "";
  const std::unique_ptr<FormulaSystem> after = system_->clone();
  set(*after, change.parameters);
  return refused_by(*after, kept_time_ + share * rest_ * size_);
}

StepReport FormulaMotion::change_within(double share, const MotionChange& change) {
  if (const StepReport report = go_within(share); !report.converged()) return report;
  kept_ = kicked(change);
  kept_time_ += share * rest_ * size_;
  rest_ *= 1 - share;
  const std::vector<std::pair<std::string, double>> before = system_->parameters();
  set(*system_, change.parameters);
  const StepReport report = go_within(1);
  if (report.converged()) {
    state_ = inside_;
  } else {
    for (const auto& [name, value] : before) system_->set_parameter(name, value);
  }
  return report;
}

void FormulaMotion::serialize(NumberArchive& archive) {
  for (double& each : state_.position) archive(each);
  for (double& each : state_.momentum) archive(each);
  for (double& each : state_.velocity) archive(each);
  archive(index_);
  for (auto [name, value] : system_->parameters()) {
    archive(value);
    system_->set_parameter(name, value);
  }
}

}  // namespace lagroid
