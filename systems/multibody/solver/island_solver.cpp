#include <lagroid/systems/multibody/solver/island_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace lagroid::multibody {

namespace {

constexpr double round_off = std::numeric_limits<double>::epsilon();
constexpr double infinite = std::numeric_limits<double>::infinity();

Quaternion turned(const Quaternion& q, const RotationIncrement& turn, const Vec& xi) {
  return product(q, turn.quaternion(xi)).normalized();
}

bool vanishes(const Vec& v) { return (v.array() == 0).all(); }

/// When an iteration with one factorisation for many corrections ends, and when it is factorised anew.
class Chord {
 public:
  explicit Chord(double tolerance) : tolerance_(tolerance) {}

  /// How the iteration ends here, if it does.
  std::optional<SolveStatus> end(double residual, double roundoff_ratio) {
    const bool below = roundoff_ratio <= 1 || residual <= tolerance_;
    times_below_ += below ? 1 : 0;
    stalls_ = roundoff_ratio > 0.5 * least_ ? stalls_ + 1 : 0;
    least_ = std::min(least_, roundoff_ratio);
    // Near round-off an iteration may go up and down for ever.
    const bool at_the_floor = roundoff_ratio <= 100 && stalls_ >= 3;
    if (at_the_floor || (below && (times_below_ > 1 || previous_ * rate_ <= 0.1 || tolerance_ > 0)))
      return SolveStatus::converged;
    if (factorised_ && roundoff_ratio > 0.3 * previous_ && !below) {
      if (fresh_ && std::min(previous_, roundoff_ratio) <= 100)
        return roundoff_ratio <= 100 ? SolveStatus::converged : SolveStatus::stagnated;
      factorised_ = false;
    }
    if (std::isfinite(previous_)) rate_ = std::min(1.0, roundoff_ratio / previous_);
    previous_ = roundoff_ratio;
    fresh_ = !factorised_;
    factorised_ = true;
    return std::nullopt;
  }

  /// Whether the next correction asks for a new factorisation.
  bool renews() const { return fresh_; }

 private:
  double tolerance_;
  bool factorised_ = false;
  bool fresh_ = false;
  int times_below_ = 0;
  int stalls_ = 0;
  double least_ = infinite;
  double previous_ = infinite;
  double rate_ = 1;
};

}  // namespace

IslandSolver::IslandSolver(const Model& model, const SceneState& from, const StepOptions& options, Workspace& workspace)
    : model_(model),
      from_(from),
      options_(options),
      workspace_(workspace),
      gradients_(model.rows.vakonomic ? workspace.vakonomic.gradients : from.gradients) {}

StepReport IslandSolver::solve(int number) {
  const Model::Island& island = model_.islands[std::size_t(number)];
  Elimination& matrix = workspace_.rows.matrices[std::size_t(number)];
  StepReport report;
  guess(island);
  if (rests(island)) {
    const auto precision = workspace_.rows.precision.begin();
    std::fill(precision + island.rows.first, precision + island.rows.last, 0.0);
    place(island);
    report.status = SolveStatus::converged;
    return report;
  }
  weigh_rows(island);
  find_linear_responses(island);
  displace(island, workspace_.rows.multipliers.data());
  Chord chord(options_.tolerance);
  for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
    const Residual residual = find_residual(island);
    report.iterations = iteration;
    report.residual = residual.size;
    report.roundoff_ratio = residual.roundoff_ratio;
    if (!std::isfinite(residual.sum)) {
      report.status = SolveStatus::not_finite;
      return report;
    }
    if (const auto end = chord.end(residual.size, residual.roundoff_ratio)) {
      report.status = *end;
      break;
    }
    if (chord.renews() && !factorise(island, matrix)) {
      report.status = SolveStatus::singular;
      return report;
    }
    improve(island, matrix);
  }
  if (report.converged() && !left_out_hold(island)) {
    workspace_.dependence_ended = true;
    report.status = SolveStatus::singular;
  }
  return report;
}

void IslandSolver::guess(const Model::Island& island) {
  const auto& earlier = from_.guess.multipliers;
  for (int row = island.rows.first; row < island.rows.last; ++row) {
    const auto i = std::size_t(row);
    workspace_.rows.multipliers[i] = model_.rows.left_out[i] ? 0 : 3 * (earlier[0][i] - earlier[1][i]) + earlier[2][i];
  }
  for (int r = island.rotations.first; r < island.rotations.last; ++r)
    workspace_.turned[std::size_t(r)] = from_.guess.turns[std::size_t(r)];
}

bool IslandSolver::rests(const Model::Island& island) const {
  const auto is_zero = [](double lambda) { return lambda == 0; };
  const auto multipliers = island.rows.of(workspace_.rows.multipliers);
  const auto all_vanish = [](const auto& list) { return std::all_of(list.begin(), list.end(), vanishes); };
  return !island.moved && std::all_of(multipliers.begin(), multipliers.end(), is_zero) &&
         all_vanish(island.linear.of(workspace_.kicked)) && all_vanish(island.rotations.of(workspace_.spin_kicked)) &&
         all_vanish(island.rotations.of(workspace_.turned));
}

void IslandSolver::weigh_rows(const Model::Island& island) {
  double reach = 0;
  for (const Vec& d : island.linear.of(workspace_.displacement)) reach = std::max(reach, d.lpNorm<Eigen::Infinity>());
  for (const Vec& xi : island.rotations.of(workspace_.turned)) reach = std::max(reach, xi.lpNorm<Eigen::Infinity>());
  // The round-off of places comes to rows on arrows through the multipliers.
  double places = reach;
  if (model_.rows.on_arrows)
    for (const RowSize& size : island.rows.of(from_.sizes)) places = std::max(places, size.terms);
  for (int row = island.rows.first; row < island.rows.last; ++row) {
    const RowSize& size = from_.sizes[std::size_t(row)];
    const double moves = model_.role(row) == Role::holonomic ? reach : places;
    workspace_.rows.precision[std::size_t(row)] =
        1 / (size.terms + size.slope * moves + std::numeric_limits<double>::min());
  }
}

void IslandSolver::find_linear_responses(const Model::Island& island) {
  const auto& entries = model_.rows.linear_entries;
  auto& responses = workspace_.rows.linear_response;
  for (int i = island.linear_entries.first; i < island.linear_entries.last; ++i) {
    const Model::Entry& e = entries[std::size_t(i)];
    responses[std::size_t(i)] =
        workspace_.inertia.response[std::size_t(e.factor)].cwiseProduct(gradients_[std::size_t(e.gradient)]);
  }
  for (int k = island.dragged.first; k < island.dragged.last; ++k) {
    const auto f = std::size_t(model_.factors.dragged[std::size_t(k)].factor);
    const Mat& response = workspace_.inertia.dragged_response[std::size_t(k)];
    for (int i = model_.rows.factor_entries[f]; i < model_.rows.factor_entries[f + 1]; ++i)
      responses[std::size_t(i)] = response * gradients_[std::size_t(entries[std::size_t(i)].gradient)];
  }
}

void IslandSolver::displace(const Model::Island& island, const double* multipliers) {
  const auto& rows = model_.rows;
  for (int f = island.linear.first; f < island.linear.last; ++f) {
    const auto i = std::size_t(f);
    Vec moved = workspace_.displacement[i];
    for (int e = rows.factor_entries[i]; e < rows.factor_entries[i + 1]; ++e)
      moved += multipliers[rows.linear_entries[std::size_t(e)].row] * workspace_.rows.linear_response[std::size_t(e)];
    workspace_.displacement[i] = moved;
  }
}

void IslandSolver::place(const Model::Island& island) {
  Configuration& next = workspace_.next;
  for (int f = island.linear.first; f < island.linear.last; ++f) {
    const auto i = std::size_t(f);
    next.x[i] = from_.at.x[i] + (from_.place_compensation[i] + workspace_.displacement[i]);
  }
  for (int r = island.rotations.first; r < island.rotations.last; ++r) {
    const auto i = std::size_t(r);
    workspace_.next_attitude[i] = turned(from_.attitude[i], workspace_.inertia.turns[i], workspace_.turned[i]);
    next.attitude[i] = SO3::from_quaternion(workspace_.next_attitude[i]);
  }
  model_.place_arms(next, island.arms, island.planar_arms);
}

IslandSolver::Residual IslandSolver::find_residual(const Model::Island& island) {
  const double moved = island.vakonomic ? follow(island) : 0;
  place(island);
  double* const values = workspace_.rows.values.data();
  const double* const precision = workspace_.rows.precision.data();
  const SceneArrow motion = workspace_.motion(from_.at);
  for (const Model::Batch& batch : island.batches.of(model_.rows.batches))
    if (model_.is_on(batch)) batch.joints->values(motion, batch.first, batch.count, values + batch.row);
  const auto& compliance = model_.rows.compliance;
  if (!compliance.empty())
    for (int row = island.rows.first; row < island.rows.last; ++row)
      values[row] += compliance[std::size_t(row)] * workspace_.rows.multipliers[std::size_t(row)];
  Residual residual{moved, 0, moved};
  for (int row = island.rows.first; row < island.rows.last; ++row) {
    if (model_.rows.left_out[std::size_t(row)]) continue;
    const double relative = std::abs(values[row]) * precision[row];
    residual.sum += relative;
    residual.size = std::max(residual.size, relative);
  }
  residual.roundoff_ratio = residual.size / (2 * round_off);
  if (island.rotations.size() > 0) add_turns(island, residual);
  return residual;
}

void IslandSolver::add_turns(const Model::Island& island, Residual& residual) {
  auto& turning = workspace_.turning;
  for (int r = island.rotations.first; r < island.rotations.last; ++r) {
    const auto i = std::size_t(r);
    turning.momentum[i] = workspace_.spin_kicked[i];
    turning.size[i] =
        size_of(from_.spin[i]) + size_of(workspace_.spin_impulse[i]) +
        workspace_.inertia.turns[i].inertia_over_h.cwiseAbs().maxCoeff() * (workspace_.turned[i].norm() + round_off);
  }
  for (const Model::Entry& e : island.rotation_entries.of(model_.rows.rotation_entries)) {
    const Vec reaction = workspace_.rows.multipliers[std::size_t(e.row)] * gradients_[std::size_t(e.gradient)];
    turning.momentum[std::size_t(e.factor)] += reaction;
    turning.size[std::size_t(e.factor)] += reaction.lpNorm<Eigen::Infinity>();
  }
  for (int r = island.rotations.first; r < island.rotations.last; ++r) {
    const auto i = std::size_t(r);
    const Vec& xi = workspace_.turned[i];
    Vec& left = turning.residual[i];
    left = workspace_.inertia.turns[i].momentum(xi) - turning.momentum[i];
    if (!model_.factors.damped_turns.empty()) left += 0.5 * model_.factors.turn_damping[i].cwiseProduct(xi);
    const double relative = left.lpNorm<Eigen::Infinity>() / turning.size[i];
    residual.sum += relative;
    residual.size = std::max(residual.size, relative);
    residual.roundoff_ratio = std::max(residual.roundoff_ratio, relative / (4 * round_off));
  }
}

double IslandSolver::follow(const Model::Island& island) {
  find_vakonomic_gradients(island);
  double moved = 0;
  double size = std::numeric_limits<double>::min();
  for (const RowSize& row : island.rows.of(from_.sizes)) size = std::max(size, row.terms);  // through the multipliers
  auto& gradients = workspace_.vakonomic.gradients;
  for (int f = island.linear.first; f < island.linear.last; ++f) {
    const auto i = std::size_t(f);
    Vec displacement = workspace_.vakonomic.free_displacement[i];
    // The round-off of an angle is that of directions.
    const double turned = model_.factors.planar[i] ? std::abs(from_.at.x[i](2)) : 0;
    for (int k = model_.rows.factor_entries[i]; k < model_.rows.factor_entries[i + 1]; ++k) {
      const Model::Entry& e = model_.rows.linear_entries[std::size_t(k)];
      Vec& response = workspace_.rows.linear_response[std::size_t(k)];
      if (e.role == Role::vakonomic) {
        const auto g = std::size_t(e.gradient);
        gradients[g] = workspace_.rows.next_gradients[g] - workspace_.vakonomic.drifts[g];
        response = workspace_.inertia.response[i].cwiseProduct(gradients[g]);
      }
      const Vec part = workspace_.rows.multipliers[std::size_t(e.row)] * response;
      displacement += part;
      size = std::max(size, (1 + turned) * part.lpNorm<Eigen::Infinity>());
    }
    size = std::max(size, displacement.lpNorm<Eigen::Infinity>());
    moved = std::max(moved, (displacement - workspace_.displacement[i]).lpNorm<Eigen::Infinity>());
    workspace_.displacement[i] = displacement;
  }
  return moved / size;
}

void IslandSolver::find_vakonomic_gradients(const Model::Island& island) {
  auto& next_gradients = workspace_.rows.next_gradients;
  auto& drifts = workspace_.vakonomic.drifts;
  const SceneArrow motion = workspace_.motion(from_.at);
  for (const Model::Batch& batch : island.batches.of(model_.rows.batches)) {
    if (batch.role != Role::vakonomic) continue;
    batch.joints->gradients(motion, batch.first, batch.count, next_gradients.data() + batch.gradient);
    batch.joints->drifts(motion, batch.first, batch.count, drifts.data() + batch.gradient);
  }
  // F- of phi: the derivative along the source, with the opposite sign.
  for (const Model::Entry& e : island.rotation_entries.of(model_.rows.rotation_entries)) {
    if (e.role != Role::vakonomic) continue;
    const auto r = std::size_t(e.factor);
    const auto g = std::size_t(e.gradient);
    const Mat frame = workspace_.inertia.turns[r].target_frame(Vec(-workspace_.turned[r])).transpose();
    workspace_.vakonomic.gradients[g] = frame.inverse() * next_gradients[g] - drifts[g];
  }
}

bool IslandSolver::factorise(const Model::Island& island, Elimination& matrix) {
  auto& next_gradients = workspace_.rows.next_gradients;
  model_.find_gradients(workspace_.motion(from_.at), island, next_gradients);
  matrix.clear();
  for (const Model::Product& p : island.linear_products.of(model_.rows.linear_products))
    matrix.value(p.value) +=
        next_gradients[std::size_t(p.gradient)].dot(workspace_.rows.linear_response[std::size_t(p.entry)]);
  auto& turning = workspace_.turning;
  for (int r = island.rotations.first; r < island.rotations.last; ++r) {
    const auto i = std::size_t(r);
    const RotationIncrement& turn = workspace_.inertia.turns[i];
    Mat a = turn.derivative(workspace_.turned[i]);
    if (!model_.factors.damped_turns.empty()) a.diagonal() += 0.5 * model_.factors.turn_damping[i];
    turning.inverse[i] = inverse(a);
    turning.frame[i] = turn.target_frame(workspace_.turned[i]);
  }
  auto& responses = workspace_.rows.rotation_response;
  auto& turned_gradients = workspace_.rows.rotation_gradient;
  for (int i = island.rotation_entries.first; i < island.rotation_entries.last; ++i) {
    const Model::Entry& e = model_.rows.rotation_entries[std::size_t(i)];
    responses[std::size_t(i)] = turning.inverse[std::size_t(e.factor)] * gradients_[std::size_t(e.gradient)];
    const Vec& gradient = next_gradients[std::size_t(e.gradient)];
    turned_gradients[std::size_t(i)] =
        e.along_arrow ? gradient : Vec(turning.frame[std::size_t(e.factor)].transpose() * gradient);
  }
  for (const Model::Product& p : island.rotation_products.of(model_.rows.rotation_products))
    matrix.value(p.value) += turned_gradients[std::size_t(p.gradient)].dot(responses[std::size_t(p.entry)]);
  if (!model_.rows.compliance.empty())
    for (int row = 0; row < island.rows.size(); ++row)
      matrix.value(matrix.index(row, row)) += model_.rows.compliance[std::size_t(island.rows.first + row)];
  return matrix.factorise();
}

void IslandSolver::improve(const Model::Island& island, const Elimination& matrix) {
  auto& rows = workspace_.rows;
  auto& turning = workspace_.turning;
  for (int row = island.rows.first; row < island.rows.last; ++row)
    rows.right[std::size_t(row)] = -rows.values[std::size_t(row)];
  for (int r = island.rotations.first; r < island.rotations.last; ++r)
    turning.residual[std::size_t(r)] = turning.inverse[std::size_t(r)] * turning.residual[std::size_t(r)];
  for (int i = island.rotation_entries.first; i < island.rotation_entries.last; ++i) {
    const Model::Entry& e = model_.rows.rotation_entries[std::size_t(i)];
    rows.right[std::size_t(e.row)] +=
        rows.rotation_gradient[std::size_t(i)].dot(turning.residual[std::size_t(e.factor)]);
  }
  matrix.solve(rows.right.data() + island.rows.first);
  for (int row = island.rows.first; row < island.rows.last; ++row)
    rows.multipliers[std::size_t(row)] += rows.right[std::size_t(row)];
  displace(island, rows.right.data());
  for (int r = island.rotations.first; r < island.rotations.last; ++r)
    workspace_.turned[std::size_t(r)] -= turning.residual[std::size_t(r)];
  for (int i = island.rotation_entries.first; i < island.rotation_entries.last; ++i) {
    const Model::Entry& e = model_.rows.rotation_entries[std::size_t(i)];
    workspace_.turned[std::size_t(e.factor)] += rows.right[std::size_t(e.row)] * rows.rotation_response[std::size_t(i)];
  }
}

bool IslandSolver::left_out_hold(const Model::Island& island) const {
  for (int row = island.rows.first; row < island.rows.last; ++row) {
    const auto i = std::size_t(row);
    if (model_.rows.left_out[i] && !(std::abs(workspace_.rows.values[i]) * workspace_.rows.precision[i] < 1e-9))
      return false;
  }
  return true;
}

StepReport IslandSolver::turn_freely(int rotation) {
  const auto i = std::size_t(rotation);
  const RotationIncrement& turn = workspace_.inertia.turns[i];
  const bool damped = !model_.factors.damped_turns.empty();
  const Vec& damping = model_.factors.turn_damping[i];
  const Vec& momentum = workspace_.spin_kicked[i];
  Vec& xi = workspace_.turned[i];
  xi = from_.guess.turns[i];
  StepReport report;
  report.status = SolveStatus::converged;
  if (vanishes(momentum)) {
    xi.setZero();
    return report;
  }
  // The free turn of a ball: exact where the moments of inertia are equal.
  if (vanishes(xi)) xi = momentum.cwiseQuotient(turn.inertia_over_h);
  double previous = infinite;
  for (report.iterations = 1; report.iterations <= options_.max_iterations; ++report.iterations) {
    Vec residual = turn.momentum(xi) - momentum;
    if (damped) residual += 0.5 * damping.cwiseProduct(xi);
    report.residual = residual.lpNorm<Eigen::Infinity>() / size_of(momentum);
    report.roundoff_ratio = report.residual / (4 * round_off);
    if (!std::isfinite(report.residual)) {
      report.status = SolveStatus::not_finite;
      return report;
    }
    // A Newton iteration from here leaves about the square of this.
    const bool last = report.residual < 1e-9 || report.residual <= options_.tolerance;
    if (report.roundoff_ratio <= 1 && previous <= 1e-9) return report;
    if (report.roundoff_ratio > 0.5 * previous / (4 * round_off) && previous < 1e-9) {
      if (report.roundoff_ratio > 100) report.status = SolveStatus::stagnated;
      return report;
    }
    Mat a = turn.derivative(xi);
    if (damped) a.diagonal() += 0.5 * damping;
    xi -= inverse(a) * residual;
    if (last && report.residual < 1e-12) return report;
    previous = report.residual;
  }
  report.status = SolveStatus::not_converged;
  return report;
}

}  // namespace lagroid::multibody
