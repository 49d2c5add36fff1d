#include <lagroid/systems/multibody/control/nodes/node_forces.hpp>

#include <algorithm>
#include <utility>

namespace lagroid::multibody {

template <class S>
NodeForces<S>::NodeForces(BasicScene<S> scene, const std::vector<int>& controls, const std::vector<int>& rows) {
  BasicAssembled<S> assembled = assemble(std::move(scene), 1);
  model_ = std::move(assembled.model);
  at_ = std::move(assembled.start.at);
  loads_ = std::move(assembled.start.loads);
  on_ = model_.switches.on;
  for (const int control : controls) {
    on_[std::size_t(control)] = 0;
    only_.emplace_back(on_.size(), 0)[std::size_t(control)] = 1;
  }
  row_of_.assign(model_.rows.roles.size(), -1);
  for (std::size_t k = 0; k < rows.size(); ++k) row_of_[std::size_t(rows[k])] = int(k);
  const Vec3 zero = Vec3::Zero();
  at_rest_.assign(std::size_t(std::max(linear(), rotations())), zero);
  joint_gradients_.assign(std::size_t(model_.rows.gradients), zero);
  row_sizes_.resize(row_of_.size());
  values_.assign(row_of_.size(), S(0));
  own_.assign(std::size_t(size()), S(0));
  of_controls_.assign(controls.size() * std::size_t(size()), S(0));
  joints_.assign(rows.size(), S(0));
  gradients_.assign(rows.size() * std::size_t(size()), S(0));
}

template <class S> void NodeForces<S>::act(const std::vector<char>& on, S* out) {
  model_.switches.on = on;
  model_.act(at_, loads_);
  for (int f = 0; f < linear(); ++f) out = std::copy_n(loads_.on[std::size_t(f)].data(), 3, out);
  for (int r = 0; r < rotations(); ++r) out = std::copy_n(loads_.torque[std::size_t(r)].data(), 3, out);
}

template <class S> void NodeForces<S>::evaluate() {
  model_.place_arms(at_, {0, int(model_.points.arms.size())}, {0, int(model_.points.planar_arms.size())});
  for (std::size_t j = 0; j < only_.size(); ++j) act(only_[j], of_controls_.data() + j * std::size_t(size()));
  act(on_, own_.data());

  for (const auto& island : model_.islands) model_.react(at_, island, joint_gradients_, row_sizes_);
  std::fill(gradients_.begin(), gradients_.end(), S(0));
  const auto add = [&](const auto& entry, int from) {
    const int row = row_of_[std::size_t(entry.row)];
    if (row < 0) return;
    const Vec3& g = joint_gradients_[std::size_t(entry.gradient)];
    for (int i = 0; i < 3; ++i) gradients_[std::size_t(row * size() + 3 * (from + entry.factor) + i)] += g(i);
  };
  for (const auto& entry : model_.rows.linear_entries) add(entry, 0);
  for (const auto& entry : model_.rows.rotation_entries) add(entry, linear());

  for (const auto& batch : model_.rows.batches)
    if (model_.is_on(batch))
      batch.joints->values({at_, at_, at_rest_, at_rest_, 1}, batch.first, batch.count, values_.data() + batch.row);
  for (std::size_t row = 0; row < row_of_.size(); ++row)
    if (row_of_[row] >= 0) joints_[std::size_t(row_of_[row])] = values_[row];
}

template <class S> Vector<S, 3> NodeForces<S>::velocity_at(int point, const std::vector<S>& velocities) const {
  const auto of_factor = [&](int factor) {
    const S* v = velocities.data() + 3 * factor;
    return Vec3(v[0], v[1], v[2]);
  };
  if (point < linear()) {
    Vec3 v = of_factor(point);
    if (model_.factors.planar[std::size_t(point)]) v(2) = S(0);
    return v;
  }
  for (const auto& arm : model_.points.arms)
    if (arm.site == point) {
      const Vec3 turning = of_factor(linear() + arm.rotation);
      return velocity_at(arm.base, velocities) + attitude(arm.rotation) * Vec3(turning.cross(arm.arm));
    }
  for (const auto& arm : model_.points.planar_arms)
    if (arm.site == point) {
      const Vec3 d = at_.x[std::size_t(point)] - at_.x[std::size_t(arm.base)];
      const S turning = of_factor(arm.base)(2);
      return velocity_at(arm.base, velocities) + Vec3(-turning * d(1), turning * d(0), S(0));
    }
  return Vec3::Constant(S(0));  // of the ground
}

template class NodeForces<double>;
template class NodeForces<SecondNumber>;

}  // namespace lagroid::multibody
