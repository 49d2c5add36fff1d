#include <lagroid/systems/multibody/model.hpp>

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/systems/multibody/control/second_number.hpp>
#include <lagroid/systems/multibody/solver/memory.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid::multibody {

template <class S>
void BasicModel<S>::place_arms(BasicConfiguration<S>& at, const Range& arms, const Range& planar_arms) const {
  for (const Arm& a : arms.of(points.arms))
    at.x[std::size_t(a.site)] = at.x[std::size_t(a.base)] + at.attitude[std::size_t(a.rotation)] * a.arm;
  for (const Arm& a : planar_arms.of(points.planar_arms)) {
    const Vector<S, 3>& q = at.x[std::size_t(a.base)];
    using std::cos, std::sin;
    const S c = cos(q(2));
    const S s = sin(q(2));
    at.x[std::size_t(a.site)] = {q(0) + c * a.arm(0) - s * a.arm(1), q(1) + s * a.arm(0) + c * a.arm(1), 0};
  }
}

template <class S> void BasicModel<S>::act(const BasicConfiguration<S>& at, BasicLoads<S>& loads) const {
  if (effects.empty()) return;
  std::fill(loads.on.begin(), loads.on.end(), Vector<S, 3>::Zero());
  std::fill(loads.torque.begin(), loads.torque.end(), Vector<S, 3>::Zero());
  for (const Acting& each : effects)
    if (is_on(each)) each.effects->add_loads(at, loads);
  for (const Arm& a : points.pushed_arms) {
    const Vector<S, 3>& f = loads.on[std::size_t(a.site)];
    loads.on[std::size_t(a.base)] += f;
    loads.torque[std::size_t(a.rotation)] +=
        a.arm.cross(Vector<S, 3>(at.attitude[std::size_t(a.rotation)].transpose() * f));
  }
  for (const Arm& a : points.pushed_planar_arms) {
    const Vector<S, 3>& f = loads.on[std::size_t(a.site)];
    const Vector<S, 3> d = at.x[std::size_t(a.site)] - at.x[std::size_t(a.base)];
    loads.on[std::size_t(a.base)] += Vector<S, 3>(f(0), f(1), d(0) * f(1) - d(1) * f(0));
  }
}

template <class S>
void BasicModel<S>::react(const BasicConfiguration<S>& at, const Island& island, std::vector<Vector<S, 3>>& gradients,
                          std::vector<RowSize>& sizes) const {
  for (const Batch& batch : island.batches.of(rows.batches))
    if (is_on(batch))
      batch.joints->reactions(at, batch.first, batch.count, gradients.data() + batch.gradient,
                              sizes.data() + batch.row);
  pull_back(at, island, gradients);
}

template <class S>
void BasicModel<S>::find_gradients(const BasicSceneArrow<S>& motion, const Island& island,
                                   std::vector<Vector<S, 3>>& gradients) const {
  for (const Batch& batch : island.batches.of(rows.batches))
    if (is_on(batch)) batch.joints->gradients(motion, batch.first, batch.count, gradients.data() + batch.gradient);
  pull_back(motion.after, island, gradients);
}

template <class S>
void BasicModel<S>::pull_back(const BasicConfiguration<S>& at, const Island& island,
                              std::vector<Vector<S, 3>>& gradients) const {
  for (const Lever& l : island.levers.of(rows.levers))
    gradients[std::size_t(l.to)] =
        l.arm.cross(Vector<S, 3>(at.attitude[std::size_t(l.rotation)].transpose() * gradients[std::size_t(l.from)]));
  for (const PlanarLever& l : island.planar_levers.of(rows.planar_levers)) {
    const Vector<S, 3>& g = gradients[std::size_t(l.from)];
    const Vector<S, 3> d = at.x[std::size_t(l.site)] - at.x[std::size_t(l.body)];
    gradients[std::size_t(l.to)] = {g(0), g(1), d(0) * g(1) - d(1) * g(0)};
  }
}

template <>
void Model::gather(const Island& island, const std::vector<Vec>& gradients, const std::vector<Vec>& linear_weights,
                   const std::vector<Vec>& rotation_weights, const Counts& counts, Elimination& matrix) const {
  matrix.clear();
  const auto product = [&](int gradient, const Entry& b, const std::vector<Vec>& weights) {
    const Vec& response = gradients[std::size_t(b.gradient)];
    return gradients[std::size_t(gradient)].dot(response.cwiseProduct(weights[std::size_t(b.factor)]));
  };
  for (const Product& p : island.linear_products.of(rows.linear_products)) {
    const Entry& b = rows.linear_entries[std::size_t(p.entry)];
    if (counts(role(p.row)) && counts(b.role)) matrix.value(p.value) += product(p.gradient, b, linear_weights);
  }
  for (const Product& p : island.rotation_products.of(rows.rotation_products)) {
    const Entry& a = rows.rotation_entries[std::size_t(p.gradient)];
    const Entry& b = rows.rotation_entries[std::size_t(p.entry)];
    if (counts(a.role) && counts(b.role)) matrix.value(p.value) += product(a.gradient, b, rotation_weights);
  }
  for (int row = 0; row < island.rows.size(); ++row)
    if (!counts(role(island.rows.first + row))) matrix.value(matrix.index(row, row)) = 1;
}

template <> std::size_t Model::memory() const {
  return bytes_of(places.sites, places.attitudes, linear_places, factors.inertia, factors.planar, factors.dragged,
                  factors.moments, factors.turn_damping, factors.damped_turns, points.arms, points.planar_arms,
                  points.pushed_arms, points.pushed_planar_arms, points.moving, rows.roles, rows.left_out,
                  rows.compliance, rows.batches, rows.linear_entries, rows.rotation_entries, rows.factor_entries,
                  rows.linear_products, rows.rotation_products, rows.levers, rows.planar_levers, rows.moving_entries,
                  islands);
}

template struct BasicModel<double>;
template void BasicModel<VariedNumber>::place_arms(BasicConfiguration<VariedNumber>&, const Range&, const Range&) const;
template void BasicModel<VariedNumber>::act(const BasicConfiguration<VariedNumber>&, BasicLoads<VariedNumber>&) const;
template void BasicModel<VariedNumber>::react(const BasicConfiguration<VariedNumber>&, const Island&,
                                              std::vector<Vector<VariedNumber, 3>>&, std::vector<RowSize>&) const;
template void BasicModel<VariedNumber>::find_gradients(const BasicSceneArrow<VariedNumber>&, const Island&,
                                                       std::vector<Vector<VariedNumber, 3>>&) const;
template void BasicModel<SecondNumber>::place_arms(BasicConfiguration<SecondNumber>&, const Range&, const Range&) const;
template void BasicModel<SecondNumber>::act(const BasicConfiguration<SecondNumber>&, BasicLoads<SecondNumber>&) const;
template void BasicModel<SecondNumber>::react(const BasicConfiguration<SecondNumber>&, const Island&,
                                              std::vector<Vector<SecondNumber, 3>>&, std::vector<RowSize>&) const;

}  // namespace lagroid::multibody
