#include <lagroid/systems/multibody/sensitivity/varied_scene.hpp>

#include <lagroid/systems/multibody/solver/assembly.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace lagroid::multibody {

namespace {

using V = VariedNumber;
using VariedMat = Matrix<V, 3, 3>;

/// x, of which the three numbers have the tangents from `at` on.
VariedVec varied(const Vec& x, std::span<const VariedTangent> tangents, int at) {
  const VariedTangent* const of = tangents.data() + at;
  return {V(x(0), of[0]), V(x(1), of[1]), V(x(2), of[2])};
}

VariedMat constant_of(const Mat& a) { return a.cast<V>(); }

VariedMat turned(Retraction map, const VariedVec& xi) {
  return map == Retraction::exponential ? SO3::exp(xi) : SO3::cayley(xi);
}

}  // namespace

SceneSizes sizes_of(const Multibody& motion) {
  const Model& model = motion.model();
  SceneSizes out{int(model.factors.inertia.size()), int(model.factors.moments.size()), {}, {}};
  std::vector<char> on(model.rows.roles.size(), 0);
  for (const Model::Batch& batch : model.rows.batches)
    std::fill_n(on.begin() + batch.row, batch.count * batch.joints->rows(), char(model.is_on(batch)));
  for (std::size_t row = 0; row < on.size(); ++row)
    if (on[row]) (model.rows.left_out[row] ? out.left_out : out.rows).push_back(int(row));
  return out;
}

VariedScene::VariedScene(WrittenScene written, const Multibody& motion)
    : observe_(std::move(written.observe)), projects_(written.projects) {
  BasicAssembled<V> assembled = assemble(std::move(written.scene), motion.step());
  model_ = std::move(assembled.model);
  start_ = std::move(assembled.start);
  const lagroid::multibody::Model& plain = motion.model();
  if (model_.factors.inertia.size() != plain.factors.inertia.size() ||
      model_.factors.moments.size() != plain.factors.moments.size() || model_.rows.roles != plain.rows.roles)
    throw std::invalid_argument("the scene with derivatives has other bodies or joints than the motion");
  model_.switches = plain.switches;
  const std::size_t linear = model_.factors.inertia.size(), rotations = model_.factors.moments.size();
  const VariedVec zero = VariedVec::Zero();
  before_ = after_ = start_.at;
  loads_ = next_loads_ = start_.loads;
  displacements_.assign(linear, zero);
  turns_.assign(rotations, zero);
  momentum_ = impulse_ = displacements_;
  spin_ = spin_impulse_ = turns_;
  quaternions_ = start_.attitude;
  gradients_.assign(std::size_t(model_.rows.gradients), zero);
  next_gradients_ = drifts_ = gradients_;
  row_sizes_.resize(model_.rows.roles.size());
  multipliers_.assign(model_.rows.roles.size(), V(0));
  values_ = multipliers_;
}

void VariedScene::place_points(BasicConfiguration<V>& at) const {
  for (const Model::MovingGround& m : model_.points.moving) at.x[std::size_t(m.site)] = m.at(at.time);
  model_.place_arms(at, {0, int(model_.points.arms.size())}, {0, int(model_.points.planar_arms.size())});
}

std::span<const VariedTangent> VariedScene::unit_tangents(int count, int first) {
  tangents_.assign(std::size_t(count), VariedTangent{});
  for (int k = std::max(0, first); k < std::min(count, first + varied_at_once); ++k)
    tangents_[std::size_t(k)] = VariedTangent::unit(k - first);
  return tangents_;
}

/// A node's places, attitudes and momenta, its states varied.
void VariedScene::place(const SceneState& node, const SceneSizes& sizes, std::span<const VariedTangent> tangents) {
  const int n = sizes.n();
  const auto time = std::size_t(sizes.states());
  before_.time = tangents.size() > time ? V(node.at.time, tangents[time]) : V(node.at.time);
  for (int f = 0; f < sizes.linear; ++f) {
    const auto i = std::size_t(f);
    before_.x[i] = varied(node.at.x[i], tangents, 3 * f);
    momentum_[i] = varied(node.momentum[i], tangents, n + 3 * f);
  }
  for (int r = 0; r < sizes.rotations; ++r) {
    const auto i = std::size_t(r);
    const int at = 3 * (sizes.linear + r);
    const VariedMat a = constant_of(node.at.attitude[i]);
    const VariedVec turn = varied(Vec::Zero(), tangents, at);
    before_.attitude[i] = a + a * SO3::hat(turn);
    const Quaternion& q = node.attitude[i];
    for (int k = 0; k < 4; ++k) {
      quaternions_[i](k) = q(k);
      for (int axis = 0; axis < 3; ++axis)
        quaternions_[i](k) += 0.5 * product(q, Quaternion::Unit(1 + axis))(k) * turn(axis);
    }
    spin_[i] = varied(node.spin[i], tangents, n + at);
  }
  place_points(before_);
  for (const Model::Island& island : model_.islands) model_.react(before_, island, gradients_, row_sizes_);
}

void VariedScene::place(const SceneState& node, const SceneSizes& sizes, int first) {
  place(node, sizes, unit_tangents(sizes.directions(), first));
}

template <class Counts>
void VariedScene::react(const std::vector<V>& multipliers, const std::vector<VariedVec>& gradients,
                        const Counts& counts, std::vector<VariedVec>& linear, std::vector<VariedVec>& spin) const {
  const auto add = [&](const Model::Entry& e, std::vector<VariedVec>& momentum) {
    if (counts(e.role))
      momentum[std::size_t(e.factor)] += multipliers[std::size_t(e.row)] * gradients[std::size_t(e.gradient)];
  };
  for (const Model::Entry& e : model_.rows.linear_entries) add(e, linear);
  for (const Model::Entry& e : model_.rows.rotation_entries) add(e, spin);
}

/// Covectors of vakonomic rows are those of the arrow: F- of phi in the source's frame, and at the target its F+.
void VariedScene::find_vakonomic_gradients(const BasicSceneArrow<V>& motion) {
  for (const Model::Batch& batch : model_.rows.batches) {
    if (batch.role != Role::vakonomic) continue;
    batch.joints->gradients(motion, batch.first, batch.count, next_gradients_.data() + batch.gradient);
    batch.joints->drifts(motion, batch.first, batch.count, drifts_.data() + batch.gradient);
  }
  for (const Model::Entry& e : model_.rows.linear_entries) {
    const auto g = std::size_t(e.gradient);
    if (e.role == Role::vakonomic) gradients_[g] = next_gradients_[g] - drifts_[g];
  }
  for (const Model::Entry& e : model_.rows.rotation_entries) {
    if (e.role != Role::vakonomic) continue;
    const auto g = std::size_t(e.gradient);
    const VariedVec& xi = turns_[std::size_t(e.factor)];
    const BasicRotationIncrement<V> turn{VariedVec::Zero(), model_.factors.rotation};
    const VariedMat at_source = turn.target_frame(VariedVec(-xi)).transpose();
    const VariedMat at_target = turn.target_frame(xi).transpose();
    gradients_[g] = at_source.inverse() * next_gradients_[g] - drifts_[g];
    next_gradients_[g] = VariedVec(at_target.inverse() * next_gradients_[g]);
  }
}

void VariedScene::step(const SolvedStep& solved, const SceneSizes& sizes, int first) {
  step(solved, sizes, unit_tangents(sizes.unknowns() + sizes.states(), first));
}

void VariedScene::step(const SolvedStep& solved, const SceneSizes& sizes, std::span<const VariedTangent> tangents) {
  const int n = sizes.n(), unknowns = sizes.unknowns();
  const Model::Factors& factors = model_.factors;
  place(solved.before, sizes, tangents.subspan(std::size_t(unknowns)));
  const auto timed = std::size_t(unknowns + sizes.states());
  const VariedTangent of_size = tangents.size() > timed ? tangents[timed + 1] : VariedTangent{};
  const V h(solved.h, of_size), per_step = 1.0 / h, half = 0.5 * h;
  after_.time = V(solved.end, tangents.size() > timed ? tangents[timed] + of_size : VariedTangent{});
  for (int f = 0; f < sizes.linear; ++f) {
    const auto i = std::size_t(f);
    displacements_[i] = varied(solved.displacements[i], tangents, 3 * f);
    after_.x[i] = before_.x[i] + displacements_[i];
  }
  for (int r = 0; r < sizes.rotations; ++r) {
    const auto i = std::size_t(r);
    turns_[i] = varied(solved.turns[i], tangents, 3 * (sizes.linear + r));
    after_.attitude[i] = before_.attitude[i] * turned(factors.rotation, turns_[i]);
  }
  place_points(after_);
  std::fill(multipliers_.begin(), multipliers_.end(), V(0));
  for (std::size_t k = 0; k < sizes.rows.size(); ++k) {
    const auto row = std::size_t(sizes.rows[k]);
    multipliers_[row] = V(solved.multipliers[row], tangents[std::size_t(n) + k]);
  }
  const BasicSceneArrow<V> motion{before_, after_, displacements_, turns_, h};
  if (model_.rows.vakonomic) find_vakonomic_gradients(motion);

  // What the node gives, with which the arrow begins.
  model_.act(before_, loads_);
  model_.act(after_, next_loads_);
  for (std::size_t i = 0; i < impulse_.size(); ++i) impulse_[i] = momentum_[i] + half * loads_.on[i];
  for (std::size_t i = 0; i < spin_impulse_.size(); ++i) spin_impulse_[i] = spin_[i] + half * loads_.torque[i];
  react(
      multipliers_, gradients_, [](Role) { return true; }, impulse_, spin_impulse_);

  equations_.resize(unknowns);
  for (int f = 0; f < sizes.linear; ++f) {
    const auto i = std::size_t(f);
    equations_.segment<3>(3 * f) = factors.inertia[i].cwiseProduct(displacements_[i]) * per_step - impulse_[i];
  }
  for (const Model::Dragged& d : factors.dragged)
    equations_.segment<3>(3 * d.factor) += 0.5 * (d.drag * displacements_[std::size_t(d.factor)]);
  for (int r = 0; r < sizes.rotations; ++r) {
    const auto i = std::size_t(r);
    const BasicRotationIncrement<V> turn{factors.moments[i] * per_step, factors.rotation};
    equations_.segment<3>(3 * (sizes.linear + r)) = turn.momentum(turns_[i]) - spin_impulse_[i];
  }
  for (const int r : factors.damped_turns) {
    const auto i = std::size_t(r);
    equations_.segment<3>(3 * (sizes.linear + r)) += 0.5 * factors.turn_damping[i].cwiseProduct(turns_[i]);
  }
  for (const Model::Batch& batch : model_.rows.batches)
    if (model_.is_on(batch)) batch.joints->values(motion, batch.first, batch.count, values_.data() + batch.row);
  for (std::size_t k = 0; k < sizes.rows.size(); ++k) {
    const auto row = std::size_t(sizes.rows[k]);
    V& equation = equations_(n + int(k));
    equation = values_[row];
    if (model_.role(int(row)) == Role::damping) equation += model_.rows.compliance[row] * multipliers_[row];
  }
  left_out_.resize(Eigen::Index(sizes.left_out.size()));
  for (std::size_t k = 0; k < sizes.left_out.size(); ++k)
    left_out_(Eigen::Index(k)) = values_[std::size_t(sizes.left_out[k])];

  // The end.
  for (const Model::Dragged& d : factors.dragged)
    impulse_[std::size_t(d.factor)] -= d.drag * displacements_[std::size_t(d.factor)];
  for (int r = 0; r < sizes.rotations; ++r) {
    const auto i = std::size_t(r);
    const BasicRotationIncrement<V> turn{factors.moments[i], factors.rotation};
    const VariedVec damped = 0.5 * factors.turn_damping[i].cwiseProduct(turns_[i]);
    const VariedVec total = spin_impulse_[i] - damped;
    spin_impulse_[i] = total + turn.carried_change(turns_[i], total) - damped;
  }
  const auto is_vakonomic = [](Role role) { return role == Role::vakonomic; };
  if (model_.rows.vakonomic) {
    for (V& lambda : multipliers_) lambda = -lambda;
    react(multipliers_, next_gradients_, is_vakonomic, impulse_, spin_impulse_);
    for (V& lambda : multipliers_) lambda = -lambda;
  }
  if (!model_.rows.compliance.empty()) {
    for (const Model::Island& island : model_.islands) model_.react(after_, island, next_gradients_, row_sizes_);
    react(
        multipliers_, next_gradients_, [](Role role) { return role == Role::damping; }, impulse_, spin_impulse_);
  }
  end_.resize(sizes.states());
  for (int f = 0; f < sizes.linear; ++f) {
    const auto i = std::size_t(f);
    end_.segment<3>(3 * f) = after_.x[i];
    end_.segment<3>(n + 3 * f) = impulse_[i] + half * next_loads_.on[i];
  }
  for (int r = 0; r < sizes.rotations; ++r) {
    const auto i = std::size_t(r);
    const int at = 3 * (sizes.linear + r);
    Mat there;
    for (int k = 0; k < 9; ++k) there(k) = after_.attitude[i](k).value;
    end_.segment<3>(at) = SO3::vee(VariedMat(constant_of(there.transpose()) * after_.attitude[i]));
    end_.segment<3>(n + at) = spin_impulse_[i] + half * next_loads_.torque[i];
  }
}

std::vector<V> VariedScene::rates(const std::vector<VariedVec>& linear, const std::vector<VariedVec>& spin,
                                  double h) const {
  std::vector<V> out(model_.rows.roles.size(), V(0));
  const std::vector<VariedVec> at_rest(std::max(linear.size(), spin.size()), VariedVec::Zero());
  for (const Model::Batch& batch : model_.rows.batches) {
    if (batch.role == Role::holonomic || batch.role == Role::damping || !model_.is_on(batch)) continue;
    batch.joints->values({before_, before_, at_rest, at_rest, h}, batch.first, batch.count, out.data() + batch.row);
    for (int i = 0; i < batch.count * batch.joints->rows(); ++i) out[std::size_t(batch.row + i)] *= V(1 / h);
  }
  for (const Model::MovingEntry& e : model_.rows.moving_entries)
    out[std::size_t(e.row)] +=
        gradients_[std::size_t(e.gradient)].dot(model_.points.moving[std::size_t(e.ground)].velocity(before_.time));
  const auto add = [&](const Model::Entry& e, const VariedVec& momentum, const VariedVec& inertia) {
    out[std::size_t(e.row)] += gradients_[std::size_t(e.gradient)].dot(momentum.cwiseQuotient(inertia));
  };
  for (const Model::Entry& e : model_.rows.linear_entries)
    add(e, linear[std::size_t(e.factor)], model_.factors.inertia[std::size_t(e.factor)]);
  for (const Model::Entry& e : model_.rows.rotation_entries)
    add(e, spin[std::size_t(e.factor)], model_.factors.moments[std::size_t(e.factor)]);
  return out;
}

/// p + D^T mu with D M^{-1} (p + D^T mu) + rate = 0: mu is solved for in plain numbers, and its derivatives follow from
/// what is left of the equation with that mu.
void VariedScene::project(const SceneSizes& sizes, double h, std::vector<VariedVec>& linear,
                          std::vector<VariedVec>& spin) {
  std::vector<int> rows;
  for (const int row : sizes.rows)
    if (model_.role(row) != Role::damping) rows.push_back(row);
  if (rows.empty()) return;
  const auto count = Eigen::Index(rows.size());
  std::vector<int> place(model_.rows.roles.size(), -1);
  for (Eigen::Index k = 0; k < count; ++k) place[std::size_t(rows[std::size_t(k)])] = int(k);
  // Rows that move the same factor have an entry of D M^{-1} D^T.
  struct Moved {
    Vec inertia;
    std::vector<std::pair<int, Vec>> by;  ///< a row's place and its gradient
  };
  std::vector<Moved> moved;
  for (const VariedVec& inertia : model_.factors.inertia) moved.push_back({values_of(inertia), {}});
  for (const VariedVec& moments : model_.factors.moments) moved.push_back({values_of(moments), {}});
  const auto put = [&](const Model::Entry& e, int from) {
    if (const int k = place[std::size_t(e.row)]; k >= 0)
      moved[std::size_t(from + e.factor)].by.emplace_back(k, values_of(gradients_[std::size_t(e.gradient)]));
  };
  for (const Model::Entry& e : model_.rows.linear_entries) put(e, 0);
  for (const Model::Entry& e : model_.rows.rotation_entries) put(e, sizes.linear);
  Elimination& matrix = projection_;
  if (projection_rows_ == rows) {
    matrix.clear();
  } else {
    std::vector<std::pair<int, int>> pairs;
    for (const Moved& factor : moved)
      for (const auto& a : factor.by)
        for (const auto& b : factor.by) pairs.emplace_back(a.first, b.first);
    matrix = Elimination(int(count), pairs);
    projection_rows_ = rows;
  }
  for (const Moved& factor : moved)
    for (const auto& a : factor.by)
      for (const auto& b : factor.by)
        matrix.value(matrix.index(a.first, b.first)) += a.second.dot(b.second.cwiseQuotient(factor.inertia));
  const bool regular = matrix.factorise();

  const auto counts = [](Role role) { return role != Role::damping; };
  std::vector<V> mu(model_.rows.roles.size(), V(0));
  // Once for the values, which then vanish from what is left, and once for the derivatives.
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<VariedVec> p = linear, s = spin;
    react(mu, gradients_, counts, p, s);
    const std::vector<V> left = rates(p, s, h);
    Eigen::Matrix<double, Eigen::Dynamic, 1 + varied_at_once, Eigen::RowMajor> right(count, 1 + varied_at_once);
    for (Eigen::Index k = 0; k < count; ++k) {
      const V& each = left[std::size_t(rows[std::size_t(k)])];
      right(k, 0) = -each.value;
      for (int i = 0; i < varied_at_once; ++i) right(k, 1 + i) = pass == 0 ? 0 : -each.tangent(i);
    }
    matrix.solve(right.data(), int(right.cols()));
    if (!regular) right.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index k = 0; k < count; ++k) {
      V& each = mu[std::size_t(rows[std::size_t(k)])];
      each += V(right(k, 0));
      for (int i = 0; i < varied_at_once; ++i) each += V::variable(0, i) * right(k, 1 + i);
    }
  }
  react(mu, gradients_, counts, linear, spin);
}

VariedNumbers VariedScene::observe(const SceneState& node, const SceneSizes& sizes, int first) {
  if (observe_ == nullptr) return {};
  place(node, sizes, first);
  project(sizes, node.step, momentum_, spin_);
  V kinetic = 0, potential = 0;
  for (std::size_t f = 0; f < momentum_.size(); ++f)
    kinetic += 0.5 * momentum_[f].cwiseQuotient(model_.factors.inertia[f]).dot(momentum_[f]);
  for (std::size_t r = 0; r < spin_.size(); ++r)
    kinetic += 0.5 * spin_[r].cwiseQuotient(model_.factors.moments[r]).dot(spin_[r]);
  for (const Model::Acting& each : model_.effects)
    if (model_.is_on(each)) potential += each.effects->energy(before_);
  return observe_({model_, before_, momentum_, spin_, quaternions_, kinetic, potential});
}

VariedNumbers VariedScene::tangent_momenta(const SceneState& node, const SceneSizes& sizes, int first) {
  place(node, sizes, first);
  const auto is_vakonomic = [](Role role) { return role == Role::vakonomic; };
  const std::vector<double>& multipliers = node.guess.multipliers[0];
  std::vector<V> added(multipliers.begin(), multipliers.end());
  react(added, gradients_, is_vakonomic, momentum_, spin_);
  project(sizes, node.step, momentum_, spin_);
  for (V& each : added) each = -each;
  react(added, gradients_, is_vakonomic, momentum_, spin_);
  VariedNumbers out(sizes.n());
  for (int f = 0; f < sizes.linear; ++f) out.segment<3>(3 * f) = momentum_[std::size_t(f)];
  for (int r = 0; r < sizes.rotations; ++r) out.segment<3>(3 * (sizes.linear + r)) = spin_[std::size_t(r)];
  return out;
}

VariedNumbers VariedScene::held_places(const SceneState& node, const SceneSizes& sizes, int first) {
  place(node, sizes, first);
  const std::vector<VariedVec> at_rest(std::max(momentum_.size(), spin_.size()), VariedVec::Zero());
  std::vector<V> out;
  for (const Model::Batch& batch : model_.rows.batches) {
    if (batch.role != Role::holonomic || !model_.is_on(batch)) continue;
    const std::size_t before = out.size();
    out.resize(before + std::size_t(batch.count * batch.joints->rows()));
    batch.joints->values({before_, before_, at_rest, at_rest, node.step}, batch.first, batch.count,
                         out.data() + before);
  }
  return Eigen::Map<const VariedNumbers>(out.data(), Eigen::Index(out.size()));
}

V VariedScene::time_scale_rate(const SceneState& node, const SceneSizes& sizes, int first) {
  place(node, sizes, first);
  model_.act(before_, loads_);
  V power = 0, potential = 0;  // of the attractions: -dU/dt, and U
  for (std::size_t f = 0; f < momentum_.size(); ++f)
    power += loads_.on[f].dot(momentum_[f].cwiseQuotient(model_.factors.inertia[f]));
  for (std::size_t r = 0; r < spin_.size(); ++r)
    power += loads_.torque[r].dot(spin_[r].cwiseQuotient(model_.factors.moments[r]));
  for (const Model::Acting& each : model_.effects)
    if (model_.is_on(each)) potential += each.effects->energy(before_);
  return 1.5 * power / potential;
}

VariedNumbers VariedScene::start(const SceneSizes& sizes) {
  const int n = sizes.n();
  const std::size_t linear = momentum_.size(), rotations = spin_.size();
  VariedNumbers out(sizes.states());
  before_ = start_.at;
  momentum_ = start_.momentum;
  spin_ = start_.spin;
  for (std::size_t r = 0; r < rotations; ++r) {
    // Of a unit quaternion the turn is twice the vector part of q^-1 dq.
    const Vector<V, 4>& q = start_.attitude[r];
    const Quaternion now(q(0).value, q(1).value, q(2).value, q(3).value);
    const VariedVec v(q(1), q(2), q(3));
    const Vec u = now.tail<3>();
    const VariedVec turn = 2.0 * (now(0) * v - u.cast<V>() * q(0) - u.cast<V>().cross(v));
    const VariedMat a = constant_of(SO3::from_quaternion(now));
    before_.attitude[r] = a + a * SO3::hat(turn);
    out.segment<3>(Eigen::Index(3 * (linear + r))) = turn;
  }
  place_points(before_);
  for (const Model::Island& island : model_.islands) model_.react(before_, island, gradients_, row_sizes_);
  if (projects_) project(sizes, start_.step, momentum_, spin_);
  std::vector<V> multipliers = start_.guess.multipliers[0];
  for (V& lambda : multipliers) lambda = -lambda;
  std::vector<VariedVec> p = momentum_, s = spin_;
  react(
      multipliers, gradients_, [](Role role) { return role == Role::vakonomic; }, p, s);
  for (std::size_t f = 0; f < linear; ++f) {
    out.segment<3>(Eigen::Index(3 * f)) = before_.x[f];
    out.segment<3>(Eigen::Index(n + 3 * f)) = p[f];
  }
  for (std::size_t r = 0; r < rotations; ++r) out.segment<3>(Eigen::Index(n + 3 * (linear + r))) = s[r];
  return out;
}

std::vector<VariedScene::Held> VariedScene::held(const SceneSizes& sizes) {
  start(sizes);  // leaves places and momenta
  const BasicSceneArrow<V> here{before_, before_, displacements_, turns_, start_.step};
  for (const Model::Batch& batch : model_.rows.batches)
    if (batch.role == Role::holonomic && model_.is_on(batch))
      batch.joints->values(here, batch.first, batch.count, values_.data() + batch.row);
  const std::vector<V> rate = rates(momentum_, spin_, start_.step);
  std::vector<double> size(rate.size(), 0.0), response(rate.size(), 0.0);
  const auto look = [&](const Model::Entry& e, const VariedVec& momentum, const VariedVec& inertia) {
    const Vec g = values_of(gradients_[std::size_t(e.gradient)]), m = values_of(inertia);
    size[std::size_t(e.row)] += g.norm() * values_of(momentum).cwiseQuotient(m).norm();
    response[std::size_t(e.row)] += g.dot(g.cwiseQuotient(m));
  };
  for (const Model::Entry& e : model_.rows.linear_entries)
    look(e, momentum_[std::size_t(e.factor)], model_.factors.inertia[std::size_t(e.factor)]);
  for (const Model::Entry& e : model_.rows.rotation_entries)
    look(e, spin_[std::size_t(e.factor)], model_.factors.moments[std::size_t(e.factor)]);
  // Of what is projected nothing but rounding of what was given may be left (Multibody::velocity_defect).
  double twice_kinetic = 0;
  const auto add = [&](const VariedVec& momentum, const VariedVec& inertia) {
    twice_kinetic += values_of(momentum).dot(values_of(momentum).cwiseQuotient(values_of(inertia)));
  };
  for (std::size_t f = 0; f < start_.momentum.size(); ++f) add(start_.momentum[f], model_.factors.inertia[f]);
  for (std::size_t r = 0; r < start_.spin.size(); ++r) add(start_.spin[r], model_.factors.moments[r]);
  for (std::size_t row = 0; row < size.size(); ++row)
    size[row] = std::max(size[row], std::sqrt(twice_kinetic * response[row]));
  std::vector<Held> out;
  // Those that depend on others have to hold, too.
  for (const Model::Batch& batch : model_.rows.batches) {
    if (batch.role == Role::damping || !model_.is_on(batch)) continue;
    const auto first = std::size_t(batch.row);
    for (std::size_t row = first; row < first + std::size_t(batch.count * batch.joints->rows()); ++row) {
      if (batch.role == Role::holonomic) out.push_back({values_[row], row_sizes_[row].terms});
      out.push_back({rate[row], size[row]});
    }
  }
  return out;
}

}  // namespace lagroid::multibody
