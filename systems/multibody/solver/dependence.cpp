// Rows that depend on others: which they are at the start, and whether they go on to.

#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/multibody/solver/island_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lagroid::multibody {

void Multibody::leave_out_dependent() {
  // Whether rows depend on others is a matter of geometry: neither masses nor units count. Gradients are taken in units
  // of the largest that moves the same factor.
  const auto& gradients = state_.gradients;
  const auto weights = [&](const std::vector<Model::Entry>& entries, std::size_t factors) {
    std::vector<double> unit(factors, 0.0);
    for (const Model::Entry& e : entries) {
      const Vec& gradient = gradients[std::size_t(e.gradient)];
      const double size = gradient.squaredNorm();
      if (!std::isfinite(size)) throw std::invalid_argument("the gradient of a joint is not finite");
      if (size < std::numeric_limits<double>::min() && !gradient.isZero(0))
        throw std::invalid_argument("the gradient of a joint vanishes in round-off");
      unit[std::size_t(e.factor)] = std::max(unit[std::size_t(e.factor)], size);
    }
    std::vector<Vec> out;
    for (const double size : unit) out.push_back(Vec::Constant(size > 0 ? 1 / size : 0));
    return out;
  };
  const auto linear_weights = weights(model_.rows.linear_entries, model_.factors.inertia.size());
  const auto rotation_weights = weights(model_.rows.rotation_entries, model_.factors.moments.size());
  for (std::size_t i = 0; i < model_.islands.size(); ++i) {
    const Model::Range& rows = model_.islands[i].rows;
    Elimination& matrix = workspace_.rows.matrices[i];
    model_.gather(
        model_.islands[i], gradients, linear_weights, rotation_weights, [](Role) { return true; }, matrix);
    for (int row = 0; row < rows.size(); ++row)  // dampers add to what they share with others
      if (model_.role(rows.first + row) == Role::damping) matrix.value(matrix.index(row, row)) += 1;
    std::vector<char> moves_something(std::size_t(rows.size()));
    for (int row = 0; row < rows.size(); ++row)
      moves_something[std::size_t(row)] = matrix.value(matrix.index(row, row)) != 0;
    for (const int row : matrix.leave_out_dependent()) {
      model_.rows.left_out[std::size_t(rows.first + row)] = 1;
      model_.rows.dependent += moves_something[std::size_t(row)];
    }
  }
}

// A small step leaves a singular position by no more than its square, which may be below round-off, and the next ones
// would lead further off. So one that is long enough is tried, and not taken.
bool Multibody::dependence_lasts() {
  constexpr double noticed = 1e-2;  // whose square is seen
  constexpr int most_doublings = 30;
  StepInertia& inertia = workspace_.inertia;
  const double step = inertia.h;
  double change = 0;
  workspace_.dependence_ended = false;
  for (int doubling = 0; doubling <= most_doublings && change < noticed; ++doubling) {
    inertia.set_step(model_.factors, std::ldexp(step, doubling));
    change = bent();
  }
  workspace_.next.time = state_.at.time + inertia.h;
  if (change > 0) solve();
  inertia.set_step(model_.factors, step);
  return !workspace_.dependence_ended;
}

double Multibody::bent() {
  Workspace& w = workspace_;
  IslandSolver solver(model_, state_, options_, w);
  std::fill(w.impulse.begin(), w.impulse.end(), Vec::Zero());
  std::fill(w.spin_impulse.begin(), w.spin_impulse.end(), Vec::Zero());
  w.add_impulse(model_, state_.loads);
  for (std::size_t f = 0; f < w.displacement.size(); ++f)
    w.displacement[f] = w.inertia.response[f].cwiseProduct(state_.momentum[f] + w.impulse[f]);
  for (std::size_t r = 0; r < w.turned.size(); ++r)
    w.turned[r] = (state_.spin[r] + w.spin_impulse[r]).cwiseQuotient(w.inertia.turns[r].inertia_over_h);
  double most = 0;
  for (const Model::Island& island : model_.islands) {
    solver.place(island);
    model_.find_gradients(w.motion(state_.at), island, w.rows.next_gradients);
    // Points and turns apart, whose gradients have other units.
    const auto look = [&](std::span<const Model::Entry> entries) {
      std::fill(w.rows.right.begin() + island.rows.first, w.rows.right.begin() + island.rows.last, 0.0);
      for (const Model::Entry& e : entries) {
        double& size = w.rows.right[std::size_t(e.row)];
        size = std::max(size, size_of(state_.gradients[std::size_t(e.gradient)]));
      }
      for (const Model::Entry& e : entries) {
        const double size = w.rows.right[std::size_t(e.row)];
        const auto g = std::size_t(e.gradient);
        if (size > 0) most = std::max(most, size_of(Vec(w.rows.next_gradients[g] - state_.gradients[g])) / size);
      }
    };
    look(island.linear_entries.of(model_.rows.linear_entries));
    look(island.rotation_entries.of(model_.rows.rotation_entries));
  }
  return most;
}

}  // namespace lagroid::multibody
