// What is seen of a motion at a node.

#include <lagroid/systems/multibody/multibody.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid::multibody {

Multibody::Momenta Multibody::momenta() const {
  return tangent([](Role role) { return role != Role::damping; });
}

Multibody::Momenta Multibody::tangent(const Model::Counts& counts) const {
  Momenta m{state_.momentum, state_.spin};
  const auto inverse = [](const std::vector<Vec>& inertia) {
    std::vector<Vec> out;
    for (const Vec& i : inertia) out.push_back(i.cwiseInverse());
    return out;
  };
  const auto linear_weights = inverse(model_.factors.inertia);
  const auto rotation_weights = inverse(model_.factors.moments);
  const std::vector<double> rates = imposed_rates();
  std::vector<double> right;
  for (std::size_t i = 0; i < model_.islands.size(); ++i) {
    const Model::Island& island = model_.islands[i];
    Elimination matrix = workspace_.rows.matrices[i];
    model_.gather(island, state_.gradients, linear_weights, rotation_weights, counts, matrix);
    if (!matrix.factorise()) continue;
    right.assign(std::size_t(island.rows.size()), 0.0);
    for (int row = island.rows.first; row < island.rows.last; ++row)
      if (counts(model_.role(row))) right[std::size_t(row - island.rows.first)] = -rates[std::size_t(row)];
    const auto each_entry = [&](const auto& visit) {
      for (const Model::Entry& e : island.linear_entries.of(model_.rows.linear_entries))
        if (counts(e.role)) visit(e, m.linear[std::size_t(e.factor)], linear_weights[std::size_t(e.factor)]);
      for (const Model::Entry& e : island.rotation_entries.of(model_.rows.rotation_entries))
        if (counts(e.role)) visit(e, m.spin[std::size_t(e.factor)], rotation_weights[std::size_t(e.factor)]);
    };
    each_entry([&](const Model::Entry& e, const Vec& momentum, const Vec& weight) {
      right[std::size_t(e.row - island.rows.first)] -=
          state_.gradients[std::size_t(e.gradient)].dot(momentum.cwiseProduct(weight));
    });
    matrix.solve(right.data());
    each_entry([&](const Model::Entry& e, Vec& momentum, const Vec&) {
      momentum += right[std::size_t(e.row - island.rows.first)] * state_.gradients[std::size_t(e.gradient)];
    });
  }
  return m;
}

std::vector<double> Multibody::imposed_rates() const {
  std::vector<double> rates(model_.rows.roles.size(), 0.0);
  for (const Model::MovingEntry& e : model_.rows.moving_entries)
    rates[std::size_t(e.row)] += state_.gradients[std::size_t(e.gradient)].dot(
        model_.points.moving[std::size_t(e.ground)].velocity(state_.at.time));
  const std::vector<Vec> at_rest(std::max(state_.momentum.size(), state_.spin.size()), Vec::Zero());
  for (const Model::Batch& batch : model_.rows.batches) {
    if (batch.role == Role::holonomic || batch.role == Role::damping || !model_.is_on(batch)) continue;
    double* const rate = rates.data() + batch.row;
    batch.joints->values({state_.at, state_.at, at_rest, at_rest, state_.step}, batch.first, batch.count, rate);
    for (int i = 0; i < batch.count * batch.joints->rows(); ++i) rate[i] /= state_.step;
  }
  return rates;
}

void Multibody::add_multipliers(std::vector<Vec>& linear, std::vector<Vec>& spin, double times) const {
  const auto add = [&](const Model::Entry& e, std::vector<Vec>& momentum) {
    if (e.role == Role::vakonomic)
      momentum[std::size_t(e.factor)] +=
          times * state_.guess.multipliers[0][std::size_t(e.row)] * state_.gradients[std::size_t(e.gradient)];
  };
  for (const Model::Entry& e : model_.rows.linear_entries) add(e, linear);
  for (const Model::Entry& e : model_.rows.rotation_entries) add(e, spin);
}

double Multibody::kinetic_energy(const Momenta& m) const {
  double twice = 0;
  for (std::size_t f = 0; f < m.linear.size(); ++f)
    twice += m.linear[f].cwiseQuotient(model_.factors.inertia[f]).dot(m.linear[f]);
  for (std::size_t r = 0; r < m.spin.size(); ++r)
    twice += m.spin[r].cwiseQuotient(model_.factors.moments[r]).dot(m.spin[r]);
  return 0.5 * twice;
}

double Multibody::arrow_cost() const {
  double twice = 0;
  for (std::size_t f = 0; f < model_.factors.inertia.size(); ++f)
    twice += model_.factors.inertia[f].cwiseProduct(workspace_.displacement[f]).dot(workspace_.displacement[f]);
  for (std::size_t r = 0; r < model_.factors.moments.size(); ++r)
    twice += model_.factors.moments[r].cwiseProduct(state_.guess.turns[r]).dot(state_.guess.turns[r]);
  return 0.5 * twice / state_.step;
}

double Multibody::potential_energy() const {
  double sum = 0;
  for (const Model::Acting& each : model_.effects)
    if (model_.is_on(each)) sum += each.effects->energy(state_.at);
  return sum;
}

Vec Multibody::linear_momentum(const Momenta& m) const {
  Vec sum = Vec::Zero();
  for (std::size_t f = 0; f < m.linear.size(); ++f)
    sum += model_.factors.planar[f] ? Vec(m.linear[f](0), m.linear[f](1), 0) : m.linear[f];
  return sum;
}

Vec Multibody::angular_momentum(const Momenta& m) const {
  Vec sum = Vec::Zero();
  for (std::size_t f = 0; f < m.linear.size(); ++f) {
    const Vec& x = state_.at.x[f];
    const Vec& p = m.linear[f];
    sum += model_.factors.planar[f] ? Vec(0, 0, x(0) * p(1) - x(1) * p(0) + p(2)) : x.cross(p);
  }
  for (std::size_t r = 0; r < m.spin.size(); ++r) sum += state_.at.attitude[r] * m.spin[r];
  return sum;
}

double Multibody::constraint_residual() const {
  std::vector<double> values(model_.rows.roles.size());
  double largest = state_.arrow_residual;
  for (const Model::Batch& batch : model_.rows.batches) {
    if (batch.role != Role::holonomic || !model_.is_on(batch)) continue;
    batch.joints->values({state_.at, state_.at, workspace_.displacement, workspace_.turned, state_.step}, batch.first,
                         batch.count, values.data() + batch.row);
    for (int row = batch.row; row < batch.row + batch.count * batch.joints->rows(); ++row) {
      const double value = std::abs(values[std::size_t(row)]);
      const double precision = state_.precision[std::size_t(row)];
      const double moved = precision > 0 ? 1 / precision : 0;
      const double relative = value == 0 ? 0 : value / std::max(state_.sizes[std::size_t(row)].terms, moved);
      largest = std::isnan(relative) ? relative : std::max(largest, relative);
    }
  }
  return largest;
}

double Multibody::violation(int switched) const {
  std::vector<double> values(model_.rows.roles.size());
  std::vector<Vec> gradients(std::size_t(model_.rows.gradients));
  std::vector<RowSize> sizes(model_.rows.roles.size());
  double largest = 0;
  for (const Model::Batch& batch : model_.rows.batches) {
    if (batch.role != Role::holonomic || batch.switched_by != switched || model_.is_on(batch)) continue;
    batch.joints->values({state_.at, state_.at, workspace_.displacement, workspace_.turned, state_.step}, batch.first,
                         batch.count, values.data() + batch.row);
    batch.joints->reactions(state_.at, batch.first, batch.count, gradients.data() + batch.gradient,
                            sizes.data() + batch.row);
    for (int row = batch.row; row < batch.row + batch.count * batch.joints->rows(); ++row) {
      const double relative =
          std::abs(values[std::size_t(row)]) / (sizes[std::size_t(row)].terms + std::numeric_limits<double>::min());
      largest = std::isnan(relative) ? relative : std::max(largest, relative);
    }
  }
  return largest;
}

Multibody::Momenta Multibody::given() const {
  Momenta out{state_.momentum, state_.spin};
  add_multipliers(out.linear, out.spin, 1);
  return out;
}

double Multibody::velocity_defect(double kinetic_energy) const {
  std::vector<double> rate = imposed_rates();
  std::vector<double> size(rate.size(), 0.0);
  for (std::size_t row = 0; row < rate.size(); ++row) size[row] = std::abs(rate[row]);
  std::vector<double> response(rate.size(), 0.0);  // g M^{-1} g
  const Momenta momentum = given();
  const auto look = [&](const Model::Entry& e, const Vec& of_factor, const Vec& inertia) {
    const Vec& g = state_.gradients[std::size_t(e.gradient)];
    const Vec velocity = of_factor.cwiseQuotient(inertia);
    response[std::size_t(e.row)] += g.dot(g.cwiseQuotient(inertia));
    rate[std::size_t(e.row)] += g.dot(velocity);
    size[std::size_t(e.row)] += size_of(g) * size_of(velocity);
  };
  for (const Model::Entry& e : model_.rows.linear_entries)
    look(e, momentum.linear[std::size_t(e.factor)], model_.factors.inertia[std::size_t(e.factor)]);
  for (const Model::Entry& e : model_.rows.rotation_entries)
    look(e, momentum.spin[std::size_t(e.factor)], model_.factors.moments[std::size_t(e.factor)]);
  double largest = 0;
  for (std::size_t row = 0; row < rate.size(); ++row) {
    const double most = std::max(size[row], std::sqrt(2 * kinetic_energy * response[row]));
    if (model_.rows.roles[row] != Role::damping && most > 0) largest = std::max(largest, std::abs(rate[row]) / most);
  }
  return largest;
}

double Multibody::hardest_damper() const {
  std::vector<double> response(model_.rows.compliance.size(), 0.0);
  const auto look = [&](const Model::Entry& e, const std::vector<Vec>& inertia) {
    const Vec& g = state_.gradients[std::size_t(e.gradient)];
    if (e.role == Role::damping)
      response[std::size_t(e.row)] += state_.step * g.dot(g.cwiseQuotient(inertia[std::size_t(e.factor)]));
  };
  for (const Model::Entry& e : model_.rows.linear_entries) look(e, model_.factors.inertia);
  for (const Model::Entry& e : model_.rows.rotation_entries) look(e, model_.factors.moments);
  double hardest = 0;
  for (std::size_t row = 0; row < response.size(); ++row)
    if (model_.rows.roles[row] == Role::damping)
      hardest = std::max(hardest, response[row] / model_.rows.compliance[row]);
  return hardest;
}

double Multibody::time_scale_rate() const {
  double power = 0;  // of the attractions: -dU/dt
  for (std::size_t f = 0; f < state_.momentum.size(); ++f)
    power += state_.loads.on[f].dot(state_.momentum[f].cwiseQuotient(model_.factors.inertia[f]));
  for (std::size_t r = 0; r < state_.spin.size(); ++r)
    power += state_.loads.torque[r].dot(state_.spin[r].cwiseQuotient(model_.factors.moments[r]));
  return 1.5 * power / potential_energy();
}

bool Multibody::has_time_scale() const {
  const auto attracts = [](const Model::Acting& each) { return each.effects->attracts(); };
  return std::all_of(model_.effects.begin(), model_.effects.end(), attracts) && model_.islands.empty() &&
         model_.factors.dragged.empty() && model_.factors.damped_turns.empty() && std::isfinite(time_scale_rate());
}

}  // namespace lagroid::multibody
