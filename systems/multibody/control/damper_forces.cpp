#include <lagroid/systems/multibody/control/damper_forces.hpp>

#include <lagroid/systems/multibody/control/arrow_momenta.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace lagroid::multibody {

template <class S> DamperForces<S>::DamperForces(BasicScene<S> scene, const std::vector<char>& on) {
  BasicAssembled<S> assembled = assemble(std::move(scene), 1);
  model_ = std::move(assembled.model);
  model_.switches.on = on;
  row_of_.assign(model_.rows.roles.size(), -1);
  for (const auto& batch : model_.rows.batches) {
    if (batch.role != Role::damping || !model_.is_on(batch)) continue;
    for (int row = batch.row; row < batch.row + batch.count * batch.joints->rows(); ++row) {
      row_of_[std::size_t(row)] = rows();
      rows_.push_back(row);
    }
  }
  std::set<int> pushed;
  const auto add = [&](const auto& entry, int from) {
    if (row_of_[std::size_t(entry.row)] >= 0) pushed.insert(from + entry.factor);
  };
  for (const auto& entry : model_.rows.linear_entries) add(entry, 0);
  for (const auto& entry : model_.rows.rotation_entries) add(entry, linear());
  factors_.assign(pushed.begin(), pushed.end());

  for (Node& node : at_) {
    node.configuration = assembled.start.at;
    node.covectors.assign(rows_.size() * std::size_t(size()), S(0));
    node.force.assign(std::size_t(size()), S(0));
  }
  const Vec3 zero = Vec3::Zero();
  displacements_.assign(model_.factors.inertia.size(), zero);
  turns_.assign(model_.factors.moments.size(), zero);
  gradients_.assign(std::size_t(model_.rows.gradients), zero);
  row_sizes_.resize(row_of_.size());
  values_.assign(row_of_.size(), S(0));
}

template <class S> void DamperForces<S>::react(Node& node) {
  model_.place_arms(node.configuration, {0, int(model_.points.arms.size())},
                    {0, int(model_.points.planar_arms.size())});
  for (const auto& island : model_.islands) model_.react(node.configuration, island, gradients_, row_sizes_);
  std::fill(node.covectors.begin(), node.covectors.end(), S(0));
  const auto add = [&](const auto& entry, int from) {
    const int row = row_of_[std::size_t(entry.row)];
    if (row < 0) return;
    const Vec3& g = gradients_[std::size_t(entry.gradient)];
    for (int i = 0; i < 3; ++i) node.covectors[std::size_t(row * size() + 3 * (from + entry.factor) + i)] += g(i);
  };
  for (const auto& entry : model_.rows.linear_entries) add(entry, 0);
  for (const auto& entry : model_.rows.rotation_entries) add(entry, linear());
}

template <class S> void DamperForces<S>::evaluate() {
  for (Node& node : at_) react(node);
  const BasicConfiguration<S>& before = configuration(End::source);
  const BasicConfiguration<S>& after = configuration(End::target);
  for (std::size_t f = 0; f < displacements_.size(); ++f) displacements_[f] = after.x[f] - before.x[f];
  for (std::size_t r = 0; r < turns_.size(); ++r)
    turns_[r] =
        coordinates_of(model_.factors.rotation, Matrix<S, 3, 3>(SO3::inverse(before.attitude[r]) * after.attitude[r]));
  for (const auto& batch : model_.rows.batches)
    if (batch.role == Role::damping && model_.is_on(batch))
      batch.joints->values({before, after, displacements_, turns_, 1}, batch.first, batch.count,
                           values_.data() + batch.row);
  for (Node& node : at_) {
    std::fill(node.force.begin(), node.force.end(), S(0));
    for (int k = 0; k < rows(); ++k) {
      const auto row = std::size_t(rows_[std::size_t(k)]);
      const S impulse = values_[row] / model_.rows.compliance[row];
      for (const int f : factors_)
        for (int i = 3 * f; i < 3 * f + 3; ++i)
          node.force[std::size_t(i)] -= impulse * node.covectors[std::size_t(k * size() + i)];
    }
  }
}

template class DamperForces<double>;
template class DamperForces<SecondNumber>;

}  // namespace lagroid::multibody
