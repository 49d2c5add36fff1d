#include <lagroid/systems/multibody/multibody.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lagroid::multibody {

namespace {

constexpr double round_off = std::numeric_limits<double>::epsilon();

Quaternion turned(const Quaternion& q, const Turn& turn, const Vec& xi) {
  return product(q, turn.quaternion(xi)).normalized();
}

/// |v|, also where squares overflow or underflow.
LAGROID_INLINE inline double size_of(const Vec& v) {
  const double largest = v.lpNorm<Eigen::Infinity>();
  return largest == 0 || (largest > 1e-150 && largest < 1e150) ? v.norm() : v.stableNorm();
}

/// The inverse, also where the determinant overflows or underflows.
Mat inverse(const Mat& a) {
  const double size = a.lpNorm<Eigen::Infinity>();
  if (size > 1e-90 && size < 1e90) return a.inverse();
  return Mat(a / size).inverse() / size;
}

/// sum += increment with what earlier sums lost.
LAGROID_INLINE inline void add(Vec& sum, Vec& carry, const Vec& increment) {
  const Vec step = carry + increment;
  const Vec before = sum;
  sum += step;
  carry = step - (sum - before);
}

}  // namespace

void Multibody::act(const Configuration& at) {
  if (effects_.empty()) return;
  std::fill(loads_.on.begin(), loads_.on.end(), Vec::Zero());
  std::fill(loads_.torque.begin(), loads_.torque.end(), Vec::Zero());
  for (const auto& effect : effects_) effect->add_loads(at, loads_);
  for (const Arm& a : pushed_arms_) {
    const Vec& f = loads_.on[std::size_t(a.site)];
    loads_.on[std::size_t(a.base)] += f;
    loads_.torque[std::size_t(a.rotation)] += a.arm.cross(Vec(at.attitude[std::size_t(a.rotation)].transpose() * f));
  }
  for (const Arm& a : pushed_planar_arms_) {
    const Vec& f = loads_.on[std::size_t(a.site)];
    const Vec d = at.x[std::size_t(a.site)] - at.x[std::size_t(a.base)];
    loads_.on[std::size_t(a.base)] += Vec(f(0), f(1), d(0) * f(1) - d(1) * f(0));
  }
}

void Multibody::place_arms(Configuration& at, const Range& arms, const Range& planar_arms) const {
  for (int i = arms.first; i < arms.last; ++i) {
    const Arm& a = arms_[std::size_t(i)];
    at.x[std::size_t(a.site)] = at.x[std::size_t(a.base)] + at.attitude[std::size_t(a.rotation)] * a.arm;
  }
  for (int i = planar_arms.first; i < planar_arms.last; ++i) {
    const Arm& a = planar_arms_[std::size_t(i)];
    const Vec& q = at.x[std::size_t(a.base)];
    const double c = std::cos(q(2));
    const double s = std::sin(q(2));
    at.x[std::size_t(a.site)] = {q(0) + c * a.arm(0) - s * a.arm(1), q(1) + s * a.arm(0) + c * a.arm(1), 0};
  }
}

void Multibody::correct(const Island& island, const double* multipliers) {
  for (int f = island.linear.first; f < island.linear.last; ++f) {
    const auto i = std::size_t(f);
    Vec moved = displacement_[i];
    for (int e = factor_entries_[i]; e < factor_entries_[i + 1]; ++e)
      moved += multipliers[linear_entries_[std::size_t(e)].row] * linear_response_[std::size_t(e)];
    displacement_[i] = moved;
  }
}

void Multibody::try_place(const Island& island) {
  for (int f = island.linear.first; f < island.linear.last; ++f) {
    const auto i = std::size_t(f);
    next_.x[i] = now_.x[i] + (place_carry_[i] + displacement_[i]);
  }
  for (int r = island.rotations.first; r < island.rotations.last; ++r) {
    const auto i = std::size_t(r);
    next_quaternions_[i] = turned(quaternions_[i], turns_[i], turned_[i]);
    next_.attitude[i] = SO3::from_quaternion(next_quaternions_[i]);
  }
  place_arms(next_, island.arms, island.planar_arms);
}

void Multibody::react(const Island& island) {
  for (int b = island.batches.first; b < island.batches.last; ++b) {
    const Batch& batch = batches_[std::size_t(b)];
    batch.joints->reactions(now_, batch.first, batch.count, gradients_.data() + batch.gradient,
                            sizes_.data() + batch.row);
  }
  pull_back(now_, island, gradients_);
}

void Multibody::pull_back(const Configuration& at, const Island& island, std::vector<Vec>& gradients) const {
  for (int i = island.levers.first; i < island.levers.last; ++i) {
    const Lever& l = levers_[std::size_t(i)];
    gradients[std::size_t(l.to)] =
        l.arm.cross(Vec(at.attitude[std::size_t(l.rotation)].transpose() * gradients[std::size_t(l.from)]));
  }
  for (int i = island.planar_levers.first; i < island.planar_levers.last; ++i) {
    const PlanarLever& l = planar_levers_[std::size_t(i)];
    const Vec& g = gradients[std::size_t(l.from)];
    const Vec d = at.x[std::size_t(l.site)] - at.x[std::size_t(l.body)];
    gradients[std::size_t(l.to)] = {g(0), g(1), d(0) * g(1) - d(1) * g(0)};
  }
}

double Multibody::follow(const Island& island) {
  for (int b = island.batches.first; b < island.batches.last; ++b) {
    const Batch& batch = batches_[std::size_t(b)];
    if (batch.role != Role::vakonomic) continue;
    batch.joints->gradients(motion(), batch.first, batch.count, next_gradients_.data() + batch.gradient);
    batch.joints->drifts(motion(), batch.first, batch.count, drifts_.data() + batch.gradient);
  }
  // F- of phi: the derivative along the source, with the opposite sign.
  for (int i = island.rotation_entries.first; i < island.rotation_entries.last; ++i) {
    const Entry& e = rotation_entries_[std::size_t(i)];
    if (e.role != Role::vakonomic) continue;
    const auto r = std::size_t(e.factor);
    const Mat frame = turns_[r].target_frame(Vec(-turned_[r])).transpose();
    gradients_[std::size_t(e.gradient)] =
        frame.inverse() * next_gradients_[std::size_t(e.gradient)] - drifts_[std::size_t(e.gradient)];
  }
  double moved = 0;
  double size = std::numeric_limits<double>::min();
  for (int row = island.rows.first; row < island.rows.last; ++row)  // through the multipliers
    size = std::max(size, sizes_[std::size_t(row)].terms);
  for (int f = island.linear.first; f < island.linear.last; ++f) {
    const auto i = std::size_t(f);
    Vec displacement = free_displacement_[i];
    const double turned = planar_[i] ? std::abs(now_.x[i](2)) : 0;  // whose round-off is that of directions
    for (int k = factor_entries_[i]; k < factor_entries_[i + 1]; ++k) {
      const Entry& e = linear_entries_[std::size_t(k)];
      if (e.role == Role::vakonomic) {
        gradients_[std::size_t(e.gradient)] =
            next_gradients_[std::size_t(e.gradient)] - drifts_[std::size_t(e.gradient)];
        linear_response_[std::size_t(k)] = response_[i].cwiseProduct(gradients_[std::size_t(e.gradient)]);
      }
      const Vec part = multipliers_[std::size_t(e.row)] * linear_response_[std::size_t(k)];
      displacement += part;
      size = std::max(size, (1 + turned) * part.lpNorm<Eigen::Infinity>());
    }
    size = std::max(size, displacement.lpNorm<Eigen::Infinity>());
    moved = std::max(moved, (displacement - displacement_[i]).lpNorm<Eigen::Infinity>());
    displacement_[i] = displacement;
  }
  return moved / size;
}

bool Multibody::factorise(Island& island) {
  for (int b = island.batches.first; b < island.batches.last; ++b) {
    const Batch& batch = batches_[std::size_t(b)];
    batch.joints->gradients(motion(), batch.first, batch.count, next_gradients_.data() + batch.gradient);
  }
  pull_back(next_, island, next_gradients_);
  Elimination& matrix = island.matrix;
  matrix.clear();
  for (int i = island.linear_pairs.first; i < island.linear_pairs.last; ++i) {
    const Pair& p = linear_pairs_[std::size_t(i)];
    matrix.value(p.value) += next_gradients_[std::size_t(p.gradient)].dot(linear_response_[std::size_t(p.entry)]);
  }
  for (int r = island.rotations.first; r < island.rotations.last; ++r) {
    const auto i = std::size_t(r);
    Mat a = turns_[i].derivative(turned_[i]);
    if (!damped_turns_.empty()) a.diagonal() += 0.5 * turn_damping_[i];
    turn_inverse_[i] = inverse(a);
    turn_frame_[i] = turns_[i].target_frame(turned_[i]);
  }
  for (int i = island.rotation_entries.first; i < island.rotation_entries.last; ++i) {
    const Entry& e = rotation_entries_[std::size_t(i)];
    rotation_response_[std::size_t(i)] = turn_inverse_[std::size_t(e.factor)] * gradients_[std::size_t(e.gradient)];
    const Vec& gradient = next_gradients_[std::size_t(e.gradient)];
    rotation_gradient_[std::size_t(i)] =
        e.along_arrow ? gradient : Vec(turn_frame_[std::size_t(e.factor)].transpose() * gradient);
  }
  for (int i = island.rotation_pairs.first; i < island.rotation_pairs.last; ++i) {
    const Pair& p = rotation_pairs_[std::size_t(i)];
    matrix.value(p.value) += rotation_gradient_[std::size_t(p.gradient)].dot(rotation_response_[std::size_t(p.entry)]);
  }
  if (!softness_.empty())
    for (int row = 0; row < island.rows.size(); ++row)
      matrix.value(matrix.index(row, row)) += softness_[std::size_t(island.rows.first + row)];
  return matrix.factorise();
}

StepReport Multibody::solve(Island& island) {
  StepReport report;
  const Range rows = island.rows;
  double* const lambda = multipliers_.data();
  bool rests = !island.moved;
  for (int row = rows.first; row < rows.last; ++row) {
    const auto i = std::size_t(row);
    lambda[i] = left_out_[i] ? 0 : 3 * (earlier_[0][i] - earlier_[1][i]) + earlier_[2][i];
    rests = rests && lambda[i] == 0;
  }
  for (int f = island.linear.first; f < island.linear.last; ++f)
    rests = rests && (kicked_[std::size_t(f)].array() == 0).all();
  for (int r = island.rotations.first; r < island.rotations.last; ++r) {
    const auto i = std::size_t(r);
    turned_[i] = turned_before_[i];
    rests = rests && (spin_kicked_[i].array() == 0).all() && (turned_[i].array() == 0).all();
  }
  if (rests) {
    std::fill(precision_.begin() + rows.first, precision_.begin() + rows.last, 0.0);
    try_place(island);
    report.status = SolveStatus::converged;
    return report;
  }
  // The size of a row: its own terms, and the motions that it cancels.
  double reach = 0;
  for (int f = island.linear.first; f < island.linear.last; ++f)
    reach = std::max(reach, displacement_[std::size_t(f)].lpNorm<Eigen::Infinity>());
  for (int r = island.rotations.first; r < island.rotations.last; ++r)
    reach = std::max(reach, turned_[std::size_t(r)].lpNorm<Eigen::Infinity>());
  // The round-off of places comes to rows on arrows through the multipliers.
  double places = reach;
  for (int row = rows.first; has_arrow_rows_ && row < rows.last; ++row)
    places = std::max(places, sizes_[std::size_t(row)].terms);
  double* const precision = precision_.data();
  for (int row = rows.first; row < rows.last; ++row) {
    const RowSize& size = sizes_[std::size_t(row)];
    const double moves = role(row) == Role::holonomic ? reach : places;
    precision[row] = 1 / (size.terms + size.slope * moves + std::numeric_limits<double>::min());
  }
  for (int i = island.linear_entries.first; i < island.linear_entries.last; ++i) {
    const Entry& e = linear_entries_[std::size_t(i)];
    linear_response_[std::size_t(i)] =
        response_[std::size_t(e.factor)].cwiseProduct(gradients_[std::size_t(e.gradient)]);
  }
  for (int k = island.dragged.first; k < island.dragged.last; ++k) {
    const Dragged& d = dragged_[std::size_t(k)];
    const auto f = std::size_t(d.factor);
    for (int i = factor_entries_[f]; i < factor_entries_[f + 1]; ++i)
      linear_response_[std::size_t(i)] = d.response * gradients_[std::size_t(linear_entries_[std::size_t(i)].gradient)];
  }
  correct(island, lambda);

  double* const values = values_.data();
  double* const right = right_.data();
  bool factorised = false;
  bool fresh = false;
  int times_below = 0;
  int stalls = 0;
  double least = std::numeric_limits<double>::infinity();
  double previous = std::numeric_limits<double>::infinity();
  double rate = 1;
  for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
    report.iterations = iteration;
    const double moved = island.vakonomic ? follow(island) : 0;
    try_place(island);
    for (int b = island.batches.first; b < island.batches.last; ++b) {
      const Batch& batch = batches_[std::size_t(b)];
      batch.joints->values(motion(), batch.first, batch.count, values + batch.row);
    }
    if (!softness_.empty())
      for (int row = rows.first; row < rows.last; ++row) values[row] += softness_[std::size_t(row)] * lambda[row];
    double residual = moved;
    double sum = moved;  // which no NaN escapes
    for (int row = rows.first; row < rows.last; ++row) {
      if (left_out_[std::size_t(row)]) continue;
      const double relative = std::abs(values[row]) * precision[row];
      sum += relative;
      residual = std::max(residual, relative);
    }
    double excess = residual / (2 * round_off);
    if (island.rotations.size() > 0) {
      for (int r = island.rotations.first; r < island.rotations.last; ++r) {
        const auto i = std::size_t(r);
        spin_total_[i] = spin_kicked_[i];
        spin_size_[i] = size_of(spin_[i]) + size_of(spin_impulse_[i]) +
                        turns_[i].inertia_over_h.cwiseAbs().maxCoeff() * (turned_[i].norm() + round_off);
      }
      for (int i = island.rotation_entries.first; i < island.rotation_entries.last; ++i) {
        const Entry& e = rotation_entries_[std::size_t(i)];
        const Vec reaction = lambda[e.row] * gradients_[std::size_t(e.gradient)];
        spin_total_[std::size_t(e.factor)] += reaction;
        spin_size_[std::size_t(e.factor)] += reaction.lpNorm<Eigen::Infinity>();
      }
      for (int r = island.rotations.first; r < island.rotations.last; ++r) {
        const auto i = std::size_t(r);
        turn_residual_[i] = turns_[i].momentum(turned_[i]) - spin_total_[i];
        if (!damped_turns_.empty()) turn_residual_[i] += 0.5 * turn_damping_[i].cwiseProduct(turned_[i]);
        const double relative = turn_residual_[i].lpNorm<Eigen::Infinity>() / spin_size_[i];
        sum += relative;
        residual = std::max(residual, relative);
        excess = std::max(excess, relative / (4 * round_off));
      }
    }
    report.residual = residual;
    report.excess = excess;
    if (!std::isfinite(sum)) {
      report.status = SolveStatus::not_finite;
      return report;
    }
    const bool below = excess <= 1 || residual <= options_.tolerance;
    times_below += below ? 1 : 0;
    stalls = excess > 0.5 * least ? stalls + 1 : 0;
    least = std::min(least, excess);
    // Near round-off an iteration may go up and down for ever.
    const bool at_the_floor = excess <= 100 && stalls >= 3;
    if (at_the_floor || (below && (times_below > 1 || previous * rate <= 0.1 || options_.tolerance > 0))) {
      report.status = SolveStatus::converged;
      break;
    }
    if (factorised && excess > 0.3 * previous && !below) {
      if (fresh && std::min(previous, excess) <= 100) {
        report.status = excess <= 100 ? SolveStatus::converged : SolveStatus::stagnated;
        break;
      }
      factorised = false;
    }
    if (std::isfinite(previous)) rate = std::min(1.0, excess / previous);
    previous = excess;
    fresh = !factorised;
    if (!factorised) {
      if (!factorise(island)) {
        report.status = SolveStatus::singular;
        return report;
      }
      factorised = true;
    }
    for (int row = rows.first; row < rows.last; ++row) right[row] = -values[row];
    for (int r = island.rotations.first; r < island.rotations.last; ++r)
      turn_residual_[std::size_t(r)] = turn_inverse_[std::size_t(r)] * turn_residual_[std::size_t(r)];
    for (int i = island.rotation_entries.first; i < island.rotation_entries.last; ++i) {
      const Entry& e = rotation_entries_[std::size_t(i)];
      right[e.row] += rotation_gradient_[std::size_t(i)].dot(turn_residual_[std::size_t(e.factor)]);
    }
    island.matrix.solve(right + rows.first);
    for (int row = rows.first; row < rows.last; ++row) lambda[row] += right[row];
    correct(island, right);
    for (int r = island.rotations.first; r < island.rotations.last; ++r)
      turned_[std::size_t(r)] -= turn_residual_[std::size_t(r)];
    for (int i = island.rotation_entries.first; i < island.rotation_entries.last; ++i) {
      const Entry& e = rotation_entries_[std::size_t(i)];
      turned_[std::size_t(e.factor)] += right[e.row] * rotation_response_[std::size_t(i)];
    }
  }
  for (int row = rows.first; row < rows.last && report.converged(); ++row)
    if (left_out_[std::size_t(row)] && !(std::abs(values[row]) * precision[row] < 1e-9)) {
      dependence_ended_ = true;
      report.status = SolveStatus::singular;
    }
  return report;
}

StepReport Multibody::turn_freely(int rotation) {
  const auto i = std::size_t(rotation);
  const Turn& turn = turns_[i];
  const Vec& momentum = spin_kicked_[i];
  Vec& xi = turned_[i];
  xi = turned_before_[i];
  StepReport report;
  report.status = SolveStatus::converged;
  if ((momentum.array() == 0).all()) {
    xi.setZero();
    return report;
  }
  // The free turn of a ball: exact where the moments of inertia are equal.
  if ((xi.array() == 0).all()) xi = momentum.cwiseQuotient(turn.inertia_over_h);
  double previous = std::numeric_limits<double>::infinity();
  for (report.iterations = 1; report.iterations <= options_.max_iterations; ++report.iterations) {
    Vec residual = turn.momentum(xi) - momentum;
    if (!damped_turns_.empty()) residual += 0.5 * turn_damping_[i].cwiseProduct(xi);
    report.residual = residual.lpNorm<Eigen::Infinity>() / size_of(momentum);
    report.excess = report.residual / (4 * round_off);
    if (!std::isfinite(report.residual)) {
      report.status = SolveStatus::not_finite;
      return report;
    }
    // A Newton iteration from here leaves about the square of this.
    const bool last = report.residual < 1e-9 || report.residual <= options_.tolerance;
    if (report.excess <= 1 && previous <= 1e-9) return report;
    if (report.excess > 0.5 * previous / (4 * round_off) && previous < 1e-9) {
      if (report.excess > 100) report.status = SolveStatus::stagnated;
      return report;
    }
    Mat a = turn.derivative(xi);
    if (!damped_turns_.empty()) a.diagonal() += 0.5 * turn_damping_[i];
    xi -= inverse(a) * residual;
    if (last && report.residual < 1e-12) return report;
    previous = report.residual;
  }
  report.status = SolveStatus::not_converged;
  return report;
}

StepReport Multibody::advance() {
  return stages_.empty() ? advance_by(whole_step_ * double(index_ + 1)) : advance_by_stages();
}

StepReport Multibody::advance_by_stages() {
  save(before_);
  StepReport worst;
  worst.status = SolveStatus::converged;
  double share_gone = 0;
  int iterations = 0;
  for (Stage& stage : stages_) {
    std::swap(earlier_, stage.earlier);
    std::swap(turned_before_, stage.turned);
    set_step(stage.step);
    share_gone += stage.step;
    const bool last = &stage == &stages_.back();
    const StepReport report =
        advance_by(last ? whole_step_ * double(index_ + 1) : whole_step_ * double(index_) + share_gone);
    std::swap(earlier_, stage.earlier);
    std::swap(turned_before_, stage.turned);
    iterations += report.iterations;
    worst.residual = std::max(worst.residual, report.residual);
    worst.excess = std::max(worst.excess, report.excess);
    if (!report.converged()) {
      worst.status = report.status;
      restore(before_);
      break;
    }
    if (!last) --index_;
  }
  worst.iterations = iterations;
  return worst;
}

StepReport Multibody::advance_by(double end) {
  const double step_before = h_;
  if (index_ == 0 && dependent_rows_ > 0 && !dependence_lasts()) {
    StepReport refused;
    refused.status = SolveStatus::singular;
    return refused;
  }
  next_.time = end;
  if (has_vakonomic_) reactions_ = gradients_;
  const StepReport report = solve_all();
  if (report.converged()) {
    accept();
    return report;
  }
  if (has_vakonomic_) gradients_ = reactions_;
  if (control_) set_step(step_before);
  return report;
}

// A small step leaves a singular position by no more than its square, which may be below round-off, and the next ones
// would lead further off. So one that is long enough is tried, and not taken.
bool Multibody::dependence_lasts() {
  constexpr double noticed = 1e-2;  // whose square is seen
  constexpr int most_doublings = 30;
  const double step = h_;
  double change = 0;
  dependence_ended_ = false;
  for (int doubling = 0; doubling <= most_doublings && change < noticed; ++doubling) {
    set_step(std::ldexp(step, doubling));
    change = bent();
  }
  next_.time = now_.time + h_;
  if (has_vakonomic_) reactions_ = gradients_;
  if (change > 0) solve_all();
  if (has_vakonomic_) gradients_ = reactions_;
  act(now_);
  set_step(step);
  return !dependence_ended_;
}

double Multibody::bent() {
  std::fill(impulse_.begin(), impulse_.end(), Vec::Zero());
  std::fill(spin_impulse_.begin(), spin_impulse_.end(), Vec::Zero());
  kick();
  for (std::size_t f = 0; f < momentum_.size(); ++f)
    displacement_[f] = response_[f].cwiseProduct(momentum_[f] + impulse_[f]);
  for (std::size_t r = 0; r < spin_.size(); ++r)
    turned_[r] = (spin_[r] + spin_impulse_[r]).cwiseQuotient(turns_[r].inertia_over_h);
  double most = 0;
  for (const Island& island : islands_) {
    try_place(island);
    for (int b = island.batches.first; b < island.batches.last; ++b) {
      const Batch& batch = batches_[std::size_t(b)];
      batch.joints->gradients(motion(), batch.first, batch.count, next_gradients_.data() + batch.gradient);
    }
    pull_back(next_, island, next_gradients_);
    // Points and turns apart, whose gradients have other units.
    const auto look = [&](const std::vector<Entry>& entries, const Range& range) {
      std::fill(right_.begin() + island.rows.first, right_.begin() + island.rows.last, 0.0);
      for (int i = range.first; i < range.last; ++i) {
        const Entry& e = entries[std::size_t(i)];
        double& size = right_[std::size_t(e.row)];
        size = std::max(size, size_of(gradients_[std::size_t(e.gradient)]));
      }
      for (int i = range.first; i < range.last; ++i) {
        const Entry& e = entries[std::size_t(i)];
        const double size = right_[std::size_t(e.row)];
        const auto g = std::size_t(e.gradient);
        if (size > 0) most = std::max(most, size_of(Vec(next_gradients_[g] - gradients_[g])) / size);
      }
    };
    look(linear_entries_, island.linear_entries);
    look(rotation_entries_, island.rotation_entries);
  }
  return most;
}

StepReport Multibody::solve_all() {
  dependence_ended_ = false;
  std::fill(impulse_.begin(), impulse_.end(), Vec::Zero());
  std::fill(spin_impulse_.begin(), spin_impulse_.end(), Vec::Zero());
  StepReport worst;
  worst.status = SolveStatus::converged;
  const auto note = [&](const StepReport& report) {
    worst.iterations = std::max(worst.iterations, report.iterations);
    worst.residual = std::max(worst.residual, report.residual);
    worst.excess = std::max(worst.excess, report.excess);
    if (worst.converged()) worst.status = report.status;
    return report.converged();
  };
  if (control_) {
    const double size = control_->step();
    if (!(size > 0)) {
      worst.status = SolveStatus::no_step;
      return worst;
    }
    set_step(size);
    next_.time = now_.time + (time_carry_ + h_);
  }
  for (const MovingGround& m : moving_) next_.x[std::size_t(m.site)] = m.at(next_.time);
  kick();
  for (std::size_t f = 0; f < momentum_.size(); ++f) {
    kicked_[f] = momentum_[f] + (momentum_carry_[f] + impulse_[f]);
    displacement_[f] = response_[f].cwiseProduct(kicked_[f]);
  }
  for (const Dragged& d : dragged_) displacement_[std::size_t(d.factor)] = d.response * kicked_[std::size_t(d.factor)];
  if (has_vakonomic_) free_displacement_ = displacement_;
  for (std::size_t r = 0; r < spin_.size(); ++r) spin_kicked_[r] = spin_[r] + (spin_carry_[r] + spin_impulse_[r]);
  for (int r = 0; r < free_.rotations.last; ++r)
    if (!note(turn_freely(r))) return worst;
  for (Island& island : islands_)
    if (!note(solve(island))) return worst;
  try_place(free_);
  for (std::size_t r = 0; r < spin_.size(); ++r)
    if (turns_[r].map == Retraction::exponential && !(turned_[r].norm() < Turn::limit)) {
      worst.status = SolveStatus::left_domain;
      return worst;
    }
  // The joints' reactions.
  for (std::size_t f = 0; f < momentum_.size(); ++f) {
    Vec impulse = impulse_[f];
    for (int e = factor_entries_[f]; e < factor_entries_[f + 1]; ++e) {
      const Entry& entry = linear_entries_[std::size_t(e)];
      impulse += multipliers_[std::size_t(entry.row)] * gradients_[std::size_t(entry.gradient)];
    }
    impulse_[f] = impulse;
  }
  for (std::size_t i = 0; i < rotation_entries_.size(); ++i) {
    const Entry& e = rotation_entries_[i];
    spin_impulse_[std::size_t(e.factor)] += multipliers_[std::size_t(e.row)] * gradients_[std::size_t(e.gradient)];
  }
  act(next_);
  if (!next_is_finite()) {
    act(now_);
    worst.status = SolveStatus::not_finite;
  }
  return worst;
}

bool Multibody::next_is_finite() const {
  double sum = 0;  // which no NaN and no infinity escapes
  for (std::size_t f = 0; f < momentum_.size(); ++f)
    sum += displacement_[f].lpNorm<1>() + momentum_[f].lpNorm<1>() + impulse_[f].lpNorm<1>() + loads_.on[f].lpNorm<1>();
  for (std::size_t r = 0; r < spin_.size(); ++r)
    sum += turned_[r].lpNorm<1>() + spin_[r].lpNorm<1>() + spin_impulse_[r].lpNorm<1>() + loads_.torque[r].lpNorm<1>();
  return std::isfinite(sum);
}

void Multibody::accept() {
  ++index_;
  if (control_) time_carry_ += h_ - (next_.time - now_.time);
  std::swap(precision_, accepted_precision_);
  if (has_arrow_rows_) {
    arrow_residual_ = 0;
    for (std::size_t row = 0; row < values_.size(); ++row)
      if (roles_[row] == Role::nonholonomic || roles_[row] == Role::vakonomic)
        arrow_residual_ = std::max(arrow_residual_, std::abs(values_[row]) * accepted_precision_[row]);
  }
  for (const Dragged& d : dragged_) {
    const Vec& xi = displacement_[std::size_t(d.factor)];
    const Vec impulse = d.drag * xi;
    impulse_[std::size_t(d.factor)] -= impulse;
    dissipated_ += xi.dot(impulse) / h_;
  }
  for (const int d : damped_turns_) {
    const auto r = std::size_t(d);
    const Vec& xi = turned_[r];
    const Vec impulse = turn_damping_[r].cwiseProduct(xi);
    spin_impulse_[r] -= 0.5 * impulse;
    dissipated_ += xi.dot(impulse) / h_;
  }
  for (std::size_t r = 0; r < spin_.size(); ++r) {
    const Vec total = spin_[r] + (spin_carry_[r] + spin_impulse_[r]);
    spin_impulse_[r] += turns_[r].carried_change(turned_[r], total);
  }
  for (const int d : damped_turns_) {
    const auto r = std::size_t(d);
    spin_impulse_[r] -= turn_damping_[r].cwiseProduct(turned_[r]) * 0.5;
  }
  if (has_vakonomic_) end_vakonomic();
  for (std::size_t f = 0; f < momentum_.size(); ++f) {
    const Vec step = place_carry_[f] + displacement_[f];
    place_carry_[f] = step - (next_.x[f] - now_.x[f]);
  }
  std::swap(now_, next_);
  std::swap(quaternions_, next_quaternions_);
  std::swap(turned_, turned_before_);
  std::swap(earlier_[2], earlier_[1]);
  std::swap(earlier_[1], earlier_[0]);
  std::swap(earlier_[0], multipliers_);
  for (const Island& island : islands_) react(island);
  if (!softness_.empty()) end_damping();
  kick();
  for (std::size_t f = 0; f < momentum_.size(); ++f) add(momentum_[f], momentum_carry_[f], impulse_[f]);
  for (std::size_t r = 0; r < spin_.size(); ++r) add(spin_[r], spin_carry_[r], spin_impulse_[r]);
  if (control_) control_->pass(time_scale_rate(), h_);
}

void Multibody::end_vakonomic() {
  for (const Batch& batch : batches_)
    if (batch.role == Role::vakonomic)
      batch.joints->gradients(motion(), batch.first, batch.count, next_gradients_.data() + batch.gradient);
  for (const Entry& e : linear_entries_)
    if (e.role == Role::vakonomic)
      impulse_[std::size_t(e.factor)] -= multipliers_[std::size_t(e.row)] * next_gradients_[std::size_t(e.gradient)];
  for (const Entry& e : rotation_entries_) {
    if (e.role != Role::vakonomic) continue;
    const auto r = std::size_t(e.factor);
    const Mat frame = turns_[r].target_frame(turned_[r]).transpose();
    spin_impulse_[r] -= multipliers_[std::size_t(e.row)] * (frame.inverse() * next_gradients_[std::size_t(e.gradient)]);
  }
}

void Multibody::end_damping() {
  const auto push = [&](const Entry& e, std::vector<Vec>& impulse) {
    if (e.role == Role::damping)
      impulse[std::size_t(e.factor)] += earlier_[0][std::size_t(e.row)] * gradients_[std::size_t(e.gradient)];
  };
  for (const Entry& e : linear_entries_) push(e, impulse_);
  for (const Entry& e : rotation_entries_) push(e, spin_impulse_);
  for (std::size_t row = 0; row < roles_.size(); ++row)
    if (roles_[row] == Role::damping) dissipated_ += 2 * softness_[row] * earlier_[0][row] * earlier_[0][row] / h_;
}

void Multibody::set_step(double h) {
  h_ = h;
  for (std::size_t f = 0; f < inertia_.size(); ++f) response_[f] = h_ * inertia_[f].cwiseInverse();
  for (Dragged& d : dragged_) {
    Mat inertia = 0.5 * d.drag;
    inertia.diagonal() += inertia_[std::size_t(d.factor)] / h_;
    d.response = inverse(inertia);
  }
  for (std::size_t r = 0; r < moments_.size(); ++r) turns_[r].inertia_over_h = moments_[r] / h_;
}

double Multibody::time_scale_rate() const {
  double power = 0;  // of the attractions: -dU/dt
  for (std::size_t f = 0; f < momentum_.size(); ++f) power += loads_.on[f].dot(momentum_[f].cwiseQuotient(inertia_[f]));
  for (std::size_t r = 0; r < spin_.size(); ++r) power += loads_.torque[r].dot(spin_[r].cwiseQuotient(moments_[r]));
  return 1.5 * power / potential_energy();
}

void Multibody::kick() {
  if (effects_.empty()) return;
  const double half = 0.5 * h_;
  for (std::size_t f = 0; f < momentum_.size(); ++f) impulse_[f] += half * loads_.on[f];
  for (std::size_t r = 0; r < spin_.size(); ++r) spin_impulse_[r] += half * loads_.torque[r];
}

std::size_t Multibody::memory() const {
  std::size_t bytes = sizeof(*this);
  const auto count = [&](const auto&... lists) {
    ((bytes += lists.capacity() * sizeof(typename std::decay_t<decltype(lists)>::value_type)), ...);
  };
  for (const Configuration* at : {&now_, &next_}) count(at->x, at->attitude);
  count(loads_.on, loads_.torque, places_.sites, places_.attitudes, linear_places_, quaternions_, next_quaternions_,
        planar_, inertia_, moments_, response_, turns_, turn_damping_, dragged_, damped_turns_, momentum_,
        momentum_carry_, place_carry_, spin_, spin_carry_, impulse_, kicked_, displacement_, spin_impulse_,
        spin_kicked_, spin_total_, turned_, turned_before_, turn_residual_, spin_size_, turn_inverse_, turn_frame_,
        arms_, planar_arms_, pushed_arms_, pushed_planar_arms_, islands_, batches_, linear_entries_, rotation_entries_,
        linear_pairs_, rotation_pairs_, levers_, planar_levers_, gradients_, next_gradients_, linear_response_,
        rotation_response_, rotation_gradient_, factor_entries_, sizes_, multipliers_, values_, right_, precision_,
        accepted_precision_, earlier_[0], earlier_[1], earlier_[2], left_out_, roles_, softness_, drifts_,
        free_displacement_, reactions_, moving_, moving_entries_, stages_);
  for (const Stage& stage : stages_) count(stage.earlier[0], stage.earlier[1], stage.earlier[2], stage.turned);
  count(before_.place, before_.place_carry, before_.momentum, before_.momentum_carry, before_.spin, before_.spin_carry,
        before_.turned, before_.attitude, before_.multipliers[0], before_.multipliers[1], before_.multipliers[2]);
  for (const Island& island : islands_) bytes += island.matrix.entries() * sizeof(double);
  return bytes;
}

Multibody::State Multibody::state() const {
  State s;
  save(s);
  return s;
}

void Multibody::save(State& s) const {
  s.index = index_;
  s.dissipated = dissipated_;
  s.place.assign(now_.x.begin(), now_.x.begin() + std::ptrdiff_t(momentum_.size()));
  s.place_carry = place_carry_;
  s.momentum = momentum_;
  s.momentum_carry = momentum_carry_;
  s.spin = spin_;
  s.spin_carry = spin_carry_;
  s.turned = turned_before_;
  s.attitude = quaternions_;
  s.multipliers = earlier_;
  s.stages.resize(stages_.size());
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    s.stages[i].clear();
    for (const auto& multipliers : stages_[i].earlier)
      s.stages[i].insert(s.stages[i].end(), multipliers.begin(), multipliers.end());
    for (const Vec& turn : stages_[i].turned) s.stages[i].insert(s.stages[i].end(), turn.data(), turn.data() + 3);
  }
  s.clock.assign({now_.time, time_carry_, h_});
  if (control_) {
    auto control = *control_;
    Tape tape;
    tape(control);
    s.clock.insert(s.clock.end(), tape.numbers().begin(), tape.numbers().end());
  }
  auto& d = s.derived;
  d.x = now_.x;
  d.forces = loads_.on;
  d.torques = loads_.torque;
  d.gradients = gradients_;
  d.attitude = now_.attitude;
  d.precision = accepted_precision_;
  d.arrow_residual = arrow_residual_;
  d.terms.clear();
  d.slopes.clear();
  for (const RowSize& size : sizes_) {
    d.terms.push_back(size.terms);
    d.slopes.push_back(size.slope);
  }
}

bool Multibody::stages_fit(const State& state) const {
  const std::size_t numbers = 3 * (earlier_[0].size() + turned_before_.size());
  return state.stages.size() == stages_.size() &&
         std::all_of(state.stages.begin(), state.stages.end(), [&](const auto& s) { return s.size() == numbers; });
}

void Multibody::restore(const State& state) {
  const auto as_long_as = [](const auto& list, const auto&... others) {
    return ((others.size() == list.size()) && ...);
  };
  const auto& d = state.derived;
  const bool fits = as_long_as(momentum_, state.place, state.place_carry, state.momentum, state.momentum_carry) &&
                    as_long_as(spin_, state.spin, state.spin_carry, state.turned, state.attitude) &&
                    as_long_as(earlier_[0], state.multipliers[0], state.multipliers[1], state.multipliers[2]) &&
                    (state.stages.empty() || stages_fit(state));
  const bool derived_fits = as_long_as(now_.x, d.x, d.forces) && as_long_as(now_.attitude, d.attitude, d.torques) &&
                            as_long_as(gradients_, d.gradients) && as_long_as(sizes_, d.terms, d.slopes, d.precision);
  if (!fits || (!d.x.empty() && !derived_fits)) throw std::invalid_argument("a state of another scene");
  index_ = state.index;
  dissipated_ = state.dissipated;
  std::copy(state.place.begin(), state.place.end(), now_.x.begin());
  place_carry_ = state.place_carry;
  momentum_ = state.momentum;
  momentum_carry_ = state.momentum_carry;
  spin_ = state.spin;
  spin_carry_ = state.spin_carry;
  turned_before_ = state.turned;
  quaternions_ = state.attitude;
  earlier_ = state.multipliers;
  for (std::size_t i = 0; i < state.stages.size(); ++i) {
    auto at = state.stages[i].begin();
    for (auto& multipliers : stages_[i].earlier)
      for (double& lambda : multipliers) lambda = *at++;
    for (Vec& turn : stages_[i].turned)
      for (double& x : turn) x = *at++;
  }
  Tape clock(state.clock);
  double step = h_;
  clock(now_.time, time_carry_, step);
  if (control_) clock(*control_);
  if (step != h_) set_step(step);
  if (d.x.empty()) {
    begin();
    return;
  }
  now_.x = d.x;
  now_.attitude = d.attitude;
  next_ = now_;
  loads_ = {d.forces, d.torques};
  gradients_ = d.gradients;
  accepted_precision_ = d.precision;
  arrow_residual_ = d.arrow_residual;
  for (std::size_t row = 0; row < sizes_.size(); ++row) sizes_[row] = {d.terms[row], d.slopes[row]};
}

void Multibody::reverse() {
  if (control_) control_->pass(-time_scale_rate(), control_->step());
  for (auto* list : {&momentum_, &momentum_carry_, &spin_, &spin_carry_, &turned_before_})
    for (Vec& v : *list) v = -v;
  for (Stage& stage : stages_)
    for (Vec& v : stage.turned) v = -v;
}

void Multibody::make_tangent() {
  add_multipliers(momentum_, spin_, 1);
  const Momenta m = momenta();
  momentum_ = m.linear;
  spin_ = m.spin;
  add_multipliers(momentum_, spin_, -1);
}

void Multibody::begin() {
  for (std::size_t r = 0; r < spin_.size(); ++r) now_.attitude[r] = SO3::from_quaternion(quaternions_[r]);
  for (const MovingGround& m : moving_) now_.x[std::size_t(m.site)] = m.at(now_.time);
  place_arms(now_, {0, int(arms_.size())}, {0, int(planar_arms_.size())});
  next_ = now_;
  for (const Island& island : islands_) react(island);
  act(now_);
}

Multibody::Momenta Multibody::momenta() const {
  return tangent([](Role role) { return role != Role::damping; });
}

std::vector<double> Multibody::imposed_rates() const {
  std::vector<double> rates(roles_.size(), 0.0);
  for (const MovingEntry& e : moving_entries_)
    rates[std::size_t(e.row)] +=
        gradients_[std::size_t(e.gradient)].dot(moving_[std::size_t(e.ground)].velocity(now_.time));
  const std::vector<Vec> at_rest(std::max(momentum_.size(), spin_.size()), Vec::Zero());
  for (const Batch& batch : batches_) {
    if (batch.role == Role::holonomic || batch.role == Role::damping) continue;
    double* const rate = rates.data() + batch.row;
    batch.joints->values({now_, now_, at_rest, at_rest, h_}, batch.first, batch.count, rate);
    for (int i = 0; i < batch.count * batch.joints->rows(); ++i) rate[i] /= h_;
  }
  return rates;
}

void Multibody::gather(const Island& island, const std::vector<Vec>& linear_weights,
                       const std::vector<Vec>& rotation_weights, const Counts& counts, Elimination& matrix) const {
  matrix.clear();
  const auto product = [&](int gradient, const Entry& b, const std::vector<Vec>& weights) {
    const Vec& response = gradients_[std::size_t(b.gradient)];
    return gradients_[std::size_t(gradient)].dot(response.cwiseProduct(weights[std::size_t(b.factor)]));
  };
  for (int i = island.linear_pairs.first; i < island.linear_pairs.last; ++i) {
    const Pair& p = linear_pairs_[std::size_t(i)];
    const Entry& b = linear_entries_[std::size_t(p.entry)];
    if (counts(role(p.row)) && counts(b.role)) matrix.value(p.value) += product(p.gradient, b, linear_weights);
  }
  for (int i = island.rotation_pairs.first; i < island.rotation_pairs.last; ++i) {
    const Pair& p = rotation_pairs_[std::size_t(i)];
    const Entry& a = rotation_entries_[std::size_t(p.gradient)];
    const Entry& b = rotation_entries_[std::size_t(p.entry)];
    if (counts(a.role) && counts(b.role)) matrix.value(p.value) += product(a.gradient, b, rotation_weights);
  }
  for (int row = 0; row < island.rows.size(); ++row)
    if (!counts(role(island.rows.first + row))) matrix.value(matrix.index(row, row)) = 1;
}

Multibody::Momenta Multibody::tangent(const Counts& counts) const {
  Momenta m{momentum_, spin_};
  const auto inverse = [](const std::vector<Vec>& inertia) {
    std::vector<Vec> out;
    for (const Vec& i : inertia) out.push_back(i.cwiseInverse());
    return out;
  };
  const auto linear_weights = inverse(inertia_);
  const auto rotation_weights = inverse(moments_);
  const std::vector<double> rates = imposed_rates();
  std::vector<double> right;
  for (const Island& island : islands_) {
    Elimination matrix = island.matrix;
    gather(island, linear_weights, rotation_weights, counts, matrix);
    if (!matrix.factorise()) continue;
    right.assign(std::size_t(island.rows.size()), 0.0);
    for (int row = island.rows.first; row < island.rows.last; ++row)
      if (counts(role(row))) right[std::size_t(row - island.rows.first)] = -rates[std::size_t(row)];
    const auto each_entry = [&](const auto& visit) {
      for (int i = island.linear_entries.first; i < island.linear_entries.last; ++i)
        if (const Entry& e = linear_entries_[std::size_t(i)]; counts(e.role))
          visit(e, m.linear[std::size_t(e.factor)], linear_weights[std::size_t(e.factor)]);
      for (int i = island.rotation_entries.first; i < island.rotation_entries.last; ++i)
        if (const Entry& e = rotation_entries_[std::size_t(i)]; counts(e.role))
          visit(e, m.spin[std::size_t(e.factor)], rotation_weights[std::size_t(e.factor)]);
    };
    each_entry([&](const Entry& e, const Vec& momentum, const Vec& weight) {
      right[std::size_t(e.row - island.rows.first)] -=
          gradients_[std::size_t(e.gradient)].dot(momentum.cwiseProduct(weight));
    });
    matrix.solve(right.data());
    each_entry([&](const Entry& e, Vec& momentum, const Vec&) {
      momentum += right[std::size_t(e.row - island.rows.first)] * gradients_[std::size_t(e.gradient)];
    });
  }
  return m;
}

double Multibody::kinetic_energy(const Momenta& m) const {
  double twice = 0;
  for (std::size_t f = 0; f < m.linear.size(); ++f) twice += m.linear[f].cwiseQuotient(inertia_[f]).dot(m.linear[f]);
  for (std::size_t r = 0; r < m.spin.size(); ++r) twice += m.spin[r].cwiseQuotient(moments_[r]).dot(m.spin[r]);
  return 0.5 * twice;
}

double Multibody::arrow_cost() const {
  double twice = 0;
  for (std::size_t f = 0; f < inertia_.size(); ++f)
    twice += inertia_[f].cwiseProduct(displacement_[f]).dot(displacement_[f]);
  for (std::size_t r = 0; r < moments_.size(); ++r)
    twice += moments_[r].cwiseProduct(turned_before_[r]).dot(turned_before_[r]);
  return 0.5 * twice / h_;
}

double Multibody::potential_energy() const {
  double sum = 0;
  for (const auto& effect : effects_) sum += effect->energy(now_);
  return sum;
}

Vec Multibody::linear_momentum(const Momenta& m) const {
  Vec sum = Vec::Zero();
  for (std::size_t f = 0; f < m.linear.size(); ++f)
    sum += planar_[f] ? Vec(m.linear[f](0), m.linear[f](1), 0) : m.linear[f];
  return sum;
}

Vec Multibody::angular_momentum(const Momenta& m) const {
  Vec sum = Vec::Zero();
  for (std::size_t f = 0; f < m.linear.size(); ++f) {
    const Vec& x = now_.x[f];
    const Vec& p = m.linear[f];
    sum += planar_[f] ? Vec(0, 0, x(0) * p(1) - x(1) * p(0) + p(2)) : x.cross(p);
  }
  for (std::size_t r = 0; r < m.spin.size(); ++r) sum += now_.attitude[r] * m.spin[r];
  return sum;
}

double Multibody::constraint_residual() const {
  std::vector<double> values(values_.size());
  double largest = arrow_residual_;
  for (const Batch& batch : batches_) {
    if (batch.role != Role::holonomic) continue;
    batch.joints->values({now_, now_, displacement_, turned_, h_}, batch.first, batch.count, values.data() + batch.row);
    for (int row = batch.row; row < batch.row + batch.count * batch.joints->rows(); ++row) {
      const double value = std::abs(values[std::size_t(row)]);
      const double precision = accepted_precision_[std::size_t(row)];
      const double moved = precision > 0 ? 1 / precision : 0;
      const double relative = value == 0 ? 0 : value / std::max(sizes_[std::size_t(row)].terms, moved);
      largest = std::isnan(relative) ? relative : std::max(largest, relative);
    }
  }
  return largest;
}

double Multibody::velocity_defect() const {
  std::vector<double> rate = imposed_rates();
  std::vector<double> size(rate.size(), 0.0);
  for (std::size_t row = 0; row < rate.size(); ++row) size[row] = std::abs(rate[row]);
  // Inertia times velocity: what was given, without the multipliers.
  std::vector<Vec> linear = momentum_;
  std::vector<Vec> spin = spin_;
  add_multipliers(linear, spin, 1);
  const auto look = [&](const Entry& e, const Vec& velocity) {
    const Vec& g = gradients_[std::size_t(e.gradient)];
    rate[std::size_t(e.row)] += g.dot(velocity);
    size[std::size_t(e.row)] += size_of(g) * size_of(velocity);
  };
  for (const Entry& e : linear_entries_)
    look(e, linear[std::size_t(e.factor)].cwiseQuotient(inertia_[std::size_t(e.factor)]));
  for (const Entry& e : rotation_entries_)
    look(e, spin[std::size_t(e.factor)].cwiseQuotient(moments_[std::size_t(e.factor)]));
  double largest = 0;
  for (std::size_t row = 0; row < rate.size(); ++row)
    if (roles_[row] != Role::damping && size[row] > 0) largest = std::max(largest, std::abs(rate[row]) / size[row]);
  return largest;
}

void Multibody::add_multipliers(std::vector<Vec>& linear, std::vector<Vec>& spin, double times) const {
  const auto add = [&](const Entry& e, std::vector<Vec>& momentum) {
    if (e.role == Role::vakonomic)
      momentum[std::size_t(e.factor)] += times * earlier_[0][std::size_t(e.row)] * gradients_[std::size_t(e.gradient)];
  };
  for (const Entry& e : linear_entries_) add(e, linear);
  for (const Entry& e : rotation_entries_) add(e, spin);
}

double Multibody::hardest_damper() const {
  std::vector<double> response(softness_.size(), 0.0);
  const auto look = [&](const Entry& e, const std::vector<Vec>& inertia) {
    const Vec& g = gradients_[std::size_t(e.gradient)];
    if (e.role == Role::damping)
      response[std::size_t(e.row)] += h_ * g.dot(g.cwiseQuotient(inertia[std::size_t(e.factor)]));
  };
  for (const Entry& e : linear_entries_) look(e, inertia_);
  for (const Entry& e : rotation_entries_) look(e, moments_);
  double hardest = 0;
  for (std::size_t row = 0; row < response.size(); ++row)
    if (roles_[row] == Role::damping) hardest = std::max(hardest, response[row] / softness_[row]);
  return hardest;
}

}  // namespace lagroid::multibody
