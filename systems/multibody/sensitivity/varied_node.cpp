#include <lagroid/systems/multibody/sensitivity/varied_node.hpp>

#include <lagroid/systems/multibody/solver/assembly.hpp>

#include <algorithm>
#include <utility>

namespace lagroid::multibody {

VariedNode::VariedNode(BasicScene<VariedNumber> scene, double h) : h_(h) {
  BasicAssembled<VariedNumber> assembled = assemble(std::move(scene), h);
  model_ = std::move(assembled.model);
  at_ = std::move(assembled.start.at);
  loads_ = std::move(assembled.start.loads);
  impulses_.assign(model_.factors.inertia.size(), VariedVec::Zero());
  at_rest_ = impulses_;
  gradients_.assign(std::size_t(model_.rows.gradients), VariedVec::Zero());
  values_.assign(model_.rows.roles.size(), VariedNumber(0));
}

template <class TangentOf> void VariedNode::place(const SceneState& node, const TangentOf& of) {
  at_.time = node.at.time;
  for (std::size_t f = 0; f < impulses_.size(); ++f)
    for (int k = 0; k < 3; ++k) at_.x[f](k) = VariedNumber(node.at.x[f](k), of(f, k));
  for (const auto& m : model_.points.moving) at_.x[std::size_t(m.site)] = m.at(at_.time);
  model_.place_arms(at_, {0, int(model_.points.arms.size())}, {0, int(model_.points.planar_arms.size())});
}

void VariedNode::place(const SceneState& node) {
  place(node, [](std::size_t, int) { return VariedTangent{}; });
}

void VariedNode::place(const SceneState& node, const std::vector<Vec>& first, const std::vector<Vec>& last) {
  place(node, [&](std::size_t f, int k) {
    return first[f](k) * VariedTangent::unit(0) + last[f](k) * VariedTangent::unit(varied_at_once - 1);
  });
}

const std::vector<VariedVec>& VariedNode::push() {
  if (model_.effects.empty()) {
    std::fill(impulses_.begin(), impulses_.end(), VariedVec::Zero());
    return impulses_;
  }
  model_.act(at_, loads_);
  const double half = 0.5 * h_;
  for (std::size_t f = 0; f < impulses_.size(); ++f)
    for (int k = 0; k < 3; ++k) impulses_[f](k) = half * loads_.on[f](k);
  return impulses_;
}

const std::vector<VariedVec>& VariedNode::react(const std::vector<double>& multipliers) {
  for (const auto& island : model_.islands) model_.find_gradients(stays(), island, gradients_);
  for (const auto& e : model_.rows.linear_entries) {
    const VariedVec& gradient = gradients_[std::size_t(e.gradient)];
    const double lambda = multipliers[std::size_t(e.row)];
    for (int k = 0; k < 3; ++k) impulses_[std::size_t(e.factor)](k) += lambda * gradient(k);
  }
  return impulses_;
}

const std::vector<VariedNumber>& VariedNode::values() {
  for (const auto& batch : model_.rows.batches)
    batch.joints->values(stays(), batch.first, batch.count, values_.data() + batch.row);
  return values_;
}

}  // namespace lagroid::multibody
