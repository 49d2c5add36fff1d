#include <lagroid/systems/multibody/multibody.hpp>

#include <lagroid/systems/multibody/solver/assembly.hpp>
#include <lagroid/systems/multibody/solver/island_solver.hpp>
#include <lagroid/systems/multibody/solver/memory.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace lagroid::multibody {

namespace {

/// sum += increment with what earlier sums lost.
LAGROID_INLINE inline void add(Vec& sum, Vec& compensation, const Vec& increment) {
  const Vec step = compensation + increment;
  const Vec before = sum;
  sum += step;
  compensation = step - (sum - before);
}

/// Sets the step of the controller, if it can give one.
bool take_controlled_step(const Model& model, const SceneState& state, Workspace& w) {
  const double size = state.control->step();
  if (!(size > 0)) return false;
  w.inertia.set_step(model.factors, size);
  w.next.time = state.at.time + (state.time_compensation + size);
  return true;
}

/// Momenta without the joints' reactions, and the displacements under them.
void push(const Model& model, const SceneState& state, Workspace& w) {
  std::fill(w.impulse.begin(), w.impulse.end(), Vec::Zero());
  std::fill(w.spin_impulse.begin(), w.spin_impulse.end(), Vec::Zero());
  w.add_impulse(model, state.loads);
  for (std::size_t f = 0; f < w.kicked.size(); ++f) {
    w.kicked[f] = state.momentum[f] + (state.momentum_compensation[f] + w.impulse[f]);
    w.displacement[f] = w.inertia.response[f].cwiseProduct(w.kicked[f]);
  }
  for (std::size_t k = 0; k < w.inertia.dragged_response.size(); ++k) {
    const auto f = std::size_t(model.factors.dragged[k].factor);
    w.displacement[f] = w.inertia.dragged_response[k] * w.kicked[f];
  }
  if (model.rows.vakonomic) w.vakonomic.free_displacement = w.displacement;
  for (std::size_t r = 0; r < w.spin_kicked.size(); ++r)
    w.spin_kicked[r] = state.spin[r] + (state.spin_compensation[r] + w.spin_impulse[r]);
}

StepReport solve_islands(const Model& model, const SceneState& state, const StepOptions& options, Workspace& w) {
  IslandSolver solver(model, state, options, w);
  StepReport worst;
  worst.status = SolveStatus::converged;
  const auto note = [&](const StepReport& report) {
    worst.status = report.status;
    worst.iterations = std::max(worst.iterations, report.iterations);
    worst.residual = std::max(worst.residual, report.residual);
    worst.roundoff_ratio = std::max(worst.roundoff_ratio, report.roundoff_ratio);
    return report.converged();
  };
  for (int r = 0; r < model.free.rotations.last; ++r)
    if (!note(solver.turn_freely(r))) return worst;
  for (int i = 0; i < int(model.islands.size()); ++i)
    if (!note(solver.solve(i))) return worst;
  solver.place(model.free);
  return worst;
}

bool turns_are_in_domain(const Model& model, const Workspace& w) {
  return model.factors.rotation != Retraction::exponential ||
         std::all_of(w.turned.begin(), w.turned.end(),
                     [](const Vec& xi) { return xi.norm() < RotationIncrement::limit; });
}

void add_reactions(const Model& model, const SceneState& state, Workspace& w) {
  const auto& gradients = model.rows.vakonomic ? w.vakonomic.gradients : state.gradients;
  for (std::size_t f = 0; f < w.impulse.size(); ++f) {
    Vec impulse = w.impulse[f];
    for (int e = model.rows.factor_entries[f]; e < model.rows.factor_entries[f + 1]; ++e) {
      const Model::Entry& entry = model.rows.linear_entries[std::size_t(e)];
      impulse += w.rows.multipliers[std::size_t(entry.row)] * gradients[std::size_t(entry.gradient)];
    }
    w.impulse[f] = impulse;
  }
  for (const Model::Entry& e : model.rows.rotation_entries)
    w.spin_impulse[std::size_t(e.factor)] +=
        w.rows.multipliers[std::size_t(e.row)] * gradients[std::size_t(e.gradient)];
}

bool arrow_is_finite(const SceneState& state, const Workspace& w) {
  double sum = 0;  // which no NaN and no infinity escapes
  for (std::size_t f = 0; f < w.impulse.size(); ++f)
    sum += w.displacement[f].lpNorm<1>() + state.momentum[f].lpNorm<1>() + w.impulse[f].lpNorm<1>() +
           w.next_loads.on[f].lpNorm<1>();
  for (std::size_t r = 0; r < w.spin_impulse.size(); ++r)
    sum += w.turned[r].lpNorm<1>() + state.spin[r].lpNorm<1>() + w.spin_impulse[r].lpNorm<1>() +
           w.next_loads.torque[r].lpNorm<1>();
  return std::isfinite(sum);
}

/// The residual of the rows on the arrow.
void note_arrow_residual(const Model& model, const Workspace& w, SceneState& state) {
  state.arrow_residual = 0;
  for (std::size_t row = 0; row < state.precision.size(); ++row)
    if (const Role role = model.rows.roles[row]; role == Role::nonholonomic || role == Role::vakonomic)
      state.arrow_residual = std::max(state.arrow_residual, std::abs(w.rows.values[row]) * state.precision[row]);
}

/// What drag takes on the arrow; momenta of rotations turn with their bodies.
void end_factors(const Model& model, SceneState& state, Workspace& w) {
  const Model::Factors& factors = model.factors;
  for (const Model::Dragged& d : factors.dragged) {
    const Vec& xi = w.displacement[std::size_t(d.factor)];
    const Vec impulse = d.drag * xi;
    w.impulse[std::size_t(d.factor)] -= impulse;
    state.dissipated += xi.dot(impulse) / w.inertia.h;
  }
  for (const int d : factors.damped_turns) {
    const auto r = std::size_t(d);
    const Vec& xi = w.turned[r];
    const Vec impulse = factors.turn_damping[r].cwiseProduct(xi);
    w.spin_impulse[r] -= 0.5 * impulse;
    state.dissipated += xi.dot(impulse) / w.inertia.h;
  }
  for (std::size_t r = 0; r < w.spin_impulse.size(); ++r) {
    const Vec total = state.spin[r] + (state.spin_compensation[r] + w.spin_impulse[r]);
    w.spin_impulse[r] += w.inertia.turns[r].carried_change(w.turned[r], total);
  }
  for (const int d : factors.damped_turns) {
    const auto r = std::size_t(d);
    w.spin_impulse[r] -= factors.turn_damping[r].cwiseProduct(w.turned[r]) * 0.5;
  }
}

/// The momentum that vakonomic rows take away again at the target.
void end_vakonomic(const Model& model, const SceneState& state, Workspace& w) {
  auto& next_gradients = w.rows.next_gradients;
  for (const Model::Batch& batch : model.rows.batches)
    if (batch.role == Role::vakonomic)
      batch.joints->gradients(w.motion(state.at), batch.first, batch.count, next_gradients.data() + batch.gradient);
  for (const Model::Entry& e : model.rows.linear_entries)
    if (e.role == Role::vakonomic)
      w.impulse[std::size_t(e.factor)] -=
          w.rows.multipliers[std::size_t(e.row)] * next_gradients[std::size_t(e.gradient)];
  for (const Model::Entry& e : model.rows.rotation_entries) {
    if (e.role != Role::vakonomic) continue;
    const auto r = std::size_t(e.factor);
    const Mat frame = w.inertia.turns[r].target_frame(w.turned[r]).transpose();
    w.spin_impulse[r] -=
        w.rows.multipliers[std::size_t(e.row)] * (frame.inverse() * next_gradients[std::size_t(e.gradient)]);
  }
}

/// The arrow's target becomes the node where the state stands.
void arrive(const Model& model, SceneState& state, Workspace& w) {
  for (std::size_t f = 0; f < state.place_compensation.size(); ++f) {
    const Vec step = state.place_compensation[f] + w.displacement[f];
    state.place_compensation[f] = step - (w.next.x[f] - state.at.x[f]);
  }
  swap(state.at, w.next);
  std::swap(state.attitude, w.next_attitude);
  swap(state.loads, w.next_loads);
  std::swap(state.guess.turns, w.turned);
  auto& earlier = state.guess.multipliers;
  std::swap(earlier[2], earlier[1]);
  std::swap(earlier[1], earlier[0]);
  std::swap(earlier[0], w.rows.multipliers);
  for (const Model::Island& island : model.islands) model.react(state.at, island, state.gradients, state.sizes);
}

/// Forces of dampers at the node.
void end_damping(const Model& model, SceneState& state, Workspace& w) {
  const auto& multipliers = state.guess.multipliers[0];
  const auto push = [&](const Model::Entry& e, std::vector<Vec>& impulse) {
    if (e.role == Role::damping)
      impulse[std::size_t(e.factor)] += multipliers[std::size_t(e.row)] * state.gradients[std::size_t(e.gradient)];
  };
  for (const Model::Entry& e : model.rows.linear_entries) push(e, w.impulse);
  for (const Model::Entry& e : model.rows.rotation_entries) push(e, w.spin_impulse);
  for (std::size_t row = 0; row < multipliers.size(); ++row)
    if (model.rows.roles[row] == Role::damping)
      state.dissipated += 2 * model.rows.compliance[row] * multipliers[row] * multipliers[row] / w.inertia.h;
}

}  // namespace

Multibody::Multibody(Scene scene, double h, const Options& options)
    : options_{options.max_iterations, options.tolerance}, step_(h) {
  Assembled assembled = assemble(std::move(scene), h);
  model_ = std::move(assembled.model);
  state_ = std::move(assembled.start);
  workspace_ = Workspace(model_, state_, std::move(assembled.matrices));
  begin();
  leave_out_dependent();
  add_multipliers(state_.momentum, state_.spin, -1);
  if (options.controlled) {
    if (!has_time_scale())
      throw std::invalid_argument("steps are controlled by attractions alone: no joints, no other effects");
    state_.control.emplace(h, time_scale_rate());
  }
  if (options.composition.stages() > 1) compose(options.composition);
}

void Multibody::begin() {
  Configuration& at = state_.at;
  for (std::size_t r = 0; r < state_.spin.size(); ++r) at.attitude[r] = SO3::from_quaternion(state_.attitude[r]);
  for (const Model::MovingGround& m : model_.points.moving) at.x[std::size_t(m.site)] = m.at(at.time);
  model_.place_arms(at, {0, int(model_.points.arms.size())}, {0, int(model_.points.planar_arms.size())});
  workspace_.next = at;
  for (const Model::Island& island : model_.islands) model_.react(at, island, state_.gradients, state_.sizes);
  model_.act(at, state_.loads);
}

void Multibody::compose(const Composition& composition) {
  const auto is_holonomic = [](Role role) { return role == Role::holonomic; };
  if (state_.control || !std::all_of(model_.rows.roles.begin(), model_.rows.roles.end(), is_holonomic) ||
      !model_.factors.dragged.empty() || !model_.factors.damped_turns.empty())
    throw std::invalid_argument("a step is composed where it can be taken back");
  for (const double share : composition.coefficients) {
    stage_steps_.push_back(share * step_);
    SceneState::Guess& stage = state_.stages.emplace_back(state_.guess);
    for (auto& multipliers : stage.multipliers)
      for (double& lambda : multipliers) lambda *= share;
    for (Vec& turn : stage.turns) turn *= share;
  }
  before_ = state_;
}

StepReport Multibody::advance() {
  const double end = step_ * double(state_.index + 1);
  const StepReport report =
      stage_steps_.empty() ? advance_to(end) : advance_by_stages(step_ * double(state_.index), end);
  if (report.converged()) ++state_.index;
  return report;
}

StepReport Multibody::advance_by(double size) {
  const double share = size / step();
  const double end = state_.at.time + size;
  const auto shorten = [&](SceneState::Guess& guess) {
    for (auto& multipliers : guess.multipliers)
      for (double& lambda : multipliers) lambda *= share;
    for (Vec& turn : guess.turns) turn *= share;
  };
  std::optional<StepController> control;
  std::swap(control, state_.control);
  shorten(state_.guess);
  StepReport report;
  if (stage_steps_.empty()) {
    workspace_.inertia.set_step(model_.factors, size);
    report = advance_to(end);
  } else {
    std::vector<double> stages = stage_steps_;
    for (double& stage : stages) stage *= share;
    stages.swap(stage_steps_);
    for (SceneState::Guess& stage : state_.stages) shorten(stage);
    report = advance_by_stages(state_.at.time, end);
    stages.swap(stage_steps_);
  }
  std::swap(control, state_.control);
  if (report.converged()) ++state_.index;
  return report;
}

StepReport Multibody::advance_by_stages(double start, double end) {
  before_ = state_;
  StepReport worst;
  worst.status = SolveStatus::converged;
  double gone = 0;
  for (std::size_t i = 0; i < stage_steps_.size() && worst.converged(); ++i) {
    const bool last = i + 1 == stage_steps_.size();
    gone += stage_steps_[i];
    workspace_.inertia.set_step(model_.factors, stage_steps_[i]);
    swap(state_.guess, state_.stages[i]);
    const StepReport report = advance_to(last ? end : start + gone);
    swap(state_.guess, state_.stages[i]);
    worst.status = report.status;
    worst.iterations += report.iterations;
    worst.residual = std::max(worst.residual, report.residual);
    worst.roundoff_ratio = std::max(worst.roundoff_ratio, report.roundoff_ratio);
  }
  if (!worst.converged()) state_ = before_;
  return worst;
}

StepReport Multibody::advance_to(double end) {
  if (state_.index == 0 && model_.rows.dependent > 0 && !dependence_lasts()) return {SolveStatus::singular};
  workspace_.next.time = end;
  const StepReport report = solve();
  if (report.converged()) accept();
  return report;
}

/// Leaves the arrow that begins at the node of the state in the workspace; the state stays as it is.
///
/// 1. `push`: the momenta with which the arrow begins, p + f, with f the impulse of the effects at this node.
/// 2. `solve_islands`: island by island, the displacements xi and the multipliers lambda with
///
///        F-_K(xi) = p + f + D^T lambda,   C(q g) = 0,   phi(g) = 0,
///
///    where D are the gradients of the rows at this node (of vakonomic rows, at the arrow).
/// 3. `add_reactions`: D^T lambda joins the impulse of this node, so that `accept` adds both to the momenta at once.
/// 4. `act`: the effects at the target. Their impulse ends this arrow and begins the next.
///
/// Besides the failures of the islands' solves the report may have `no_step` (the controller has no size for it),
/// `left_domain` (a rotation beyond the reach of exp) or `not_finite`.
StepReport Multibody::solve() {
  Workspace& w = workspace_;
  w.dependence_ended = false;
  if (model_.rows.vakonomic) w.vakonomic.gradients = state_.gradients;
  if (state_.control && !take_controlled_step(model_, state_, w)) return {SolveStatus::no_step};
  for (const Model::MovingGround& m : model_.points.moving) w.next.x[std::size_t(m.site)] = m.at(w.next.time);
  push(model_, state_, w);
  StepReport report = solve_islands(model_, state_, options_, w);
  if (!report.converged()) return report;
  if (!turns_are_in_domain(model_, w)) {
    report.status = SolveStatus::left_domain;
    return report;
  }
  add_reactions(model_, state_, w);
  model_.act(w.next, w.next_loads);
  if (!arrow_is_finite(state_, w)) report.status = SolveStatus::not_finite;
  return report;
}

void Multibody::accept() {
  Workspace& w = workspace_;
  state_.step = w.inertia.h;
  if (state_.control) state_.time_compensation += w.inertia.h - (w.next.time - state_.at.time);
  std::swap(w.rows.precision, state_.precision);
  if (model_.rows.on_arrows) note_arrow_residual(model_, w, state_);
  end_factors(model_, state_, w);
  if (model_.rows.vakonomic) end_vakonomic(model_, state_, w);
  arrive(model_, state_, w);
  if (!model_.rows.compliance.empty()) end_damping(model_, state_, w);
  w.add_impulse(model_, state_.loads);
  for (std::size_t f = 0; f < state_.momentum.size(); ++f)
    add(state_.momentum[f], state_.momentum_compensation[f], w.impulse[f]);
  for (std::size_t r = 0; r < state_.spin.size(); ++r)
    add(state_.spin[r], state_.spin_compensation[r], w.spin_impulse[r]);
  if (state_.control) state_.control->pass(time_scale_rate(), w.inertia.h);
}

void Multibody::restore(const SceneState& state) {
  if (!state_.fits(state)) throw std::invalid_argument("a state of another scene");
  state_ = state;
  follow_state();
}

void Multibody::serialize(NumberArchive& archive) {
  Switches& switches = model_.switches;
  std::vector<double> on(switches.on.begin(), switches.on.end());
  if (on.size() > 1) archive(on);
  const std::vector<char> before = switches.on;
  std::transform(on.begin(), on.end(), switches.on.begin(), [](double each) { return char(each != 0); });
  if (switches.on != before) forget_rows();
  state_.serialize(archive);
  if (switches.on != before) leave_out_dependent();
  if (archive.reading()) follow_state();
}

void Multibody::follow_state() {
  workspace_.next = state_.at;
  if (workspace_.inertia.h != state_.step) workspace_.inertia.set_step(model_.factors, state_.step);
}

void Multibody::reverse() {
  if (state_.control) state_.control->pass(-time_scale_rate(), state_.control->step());
  for (auto* list :
       {&state_.momentum, &state_.momentum_compensation, &state_.spin, &state_.spin_compensation, &state_.guess.turns})
    for (Vec& v : *list) v = -v;
  for (SceneState::Guess& stage : state_.stages)
    for (Vec& v : stage.turns) v = -v;
}

void Multibody::make_tangent() {
  add_multipliers(state_.momentum, state_.spin, 1);
  const Momenta m = momenta();
  state_.momentum = m.linear;
  state_.spin = m.spin;
  add_multipliers(state_.momentum, state_.spin, -1);
}

void Multibody::end_part(const SceneState& node) {
  const double size = state_.control ? node.step : step_;
  state_.index = node.index;
  state_.at.time = node.at.time;
  state_.time_compensation = node.time_compensation;
  // What was long for the part is short for a step; of a very short one there is nothing to be learned.
  const double longer = state_.step > 1e-3 * size ? size / state_.step : 1;
  // But the multipliers of joints have the impulse of what happened between parts, and are no guess for a step: those
  // of the whole step are. The momenta are made of those of vakonomic rows.
  const auto go_on = [&](SceneState::Guess& guess, const SceneState::Guess& of_step) {
    for (const Model::Batch& batch : model_.rows.batches)
      for (std::size_t k = 0; k < guess.multipliers.size(); ++k)
        for (int row = batch.row; row < batch.row + batch.count * batch.joints->rows(); ++row) {
          double& lambda = guess.multipliers[k][std::size_t(row)];
          if (batch.role == Role::vakonomic)
            lambda *= longer;
          else
            lambda = model_.is_on(batch) ? of_step.multipliers[k][std::size_t(row)] : 0;
        }
    for (Vec& turn : guess.turns) turn *= longer;
  };
  go_on(state_.guess, node.guess);
  for (std::size_t i = 0; i < state_.stages.size(); ++i) go_on(state_.stages[i], node.stages[i]);
  state_.step = size;
  if (state_.control) state_.control->pass(time_scale_rate(), size);
  follow_state();
}

void Multibody::switch_to(const std::vector<char>& on) {
  make_tangent();
  model_.switches.on = on;
  forget_rows();
  begin();
  leave_out_dependent();
}

void Multibody::go_on_from(const Multibody& other) {
  if (!state_.fits(other.state_)) throw std::invalid_argument("a motion of another scene");
  state_ = other.state_;
  model_.switches.on = other.model_.switches.on;
  forget_rows();
  begin();
  leave_out_dependent();
  if (state_.control && state_.index == 0) state_.control.emplace(step_, time_scale_rate());
  follow_state();
}

void Multibody::forget_rows() {
  const auto clear = [](std::vector<Vec>& list) { std::fill(list.begin(), list.end(), Vec::Zero()); };
  clear(state_.gradients);
  clear(workspace_.rows.next_gradients);
  std::fill(state_.sizes.begin(), state_.sizes.end(), RowSize{});
  std::fill(workspace_.rows.values.begin(), workspace_.rows.values.end(), 0.0);
  std::fill(model_.rows.left_out.begin(), model_.rows.left_out.end(), char(0));
  model_.rows.dependent = 0;
  for (const Model::Batch& batch : model_.rows.batches) {
    if (batch.switched_by == 0) continue;
    const auto forget = [&](SceneState::Guess& guess) {
      for (auto& multipliers : guess.multipliers)
        std::fill_n(multipliers.begin() + batch.row, batch.count * batch.joints->rows(), 0.0);
    };
    forget(state_.guess);
    for (SceneState::Guess& stage : state_.stages) forget(stage);
  }
}

void Multibody::kick(int linear, const Vec& momentum, Attitude attitude, const Vec& spin) {
  if (linear >= 0) {
    const auto f = std::size_t(linear_place(linear));
    add(state_.momentum[f], state_.momentum_compensation[f], momentum);
  }
  if (attitude.index >= 0) {
    const auto r = std::size_t((*this)(attitude).index);
    add(state_.spin[r], state_.spin_compensation[r], spin);
  }
}

std::size_t Multibody::memory() const {
  return sizeof(*this) + bytes_of(stage_steps_) + model_.memory() + state_.memory() + before_.memory() +
         workspace_.memory();
}

}  // namespace lagroid::multibody
