#include <lagroid/systems/multibody/solver/workspace.hpp>

#include <lagroid/systems/multibody/solver/memory.hpp>

#include <utility>

namespace lagroid::multibody {

void StepInertia::set_step(const Model::Factors& factors, double step) {
  h = step;
  for (std::size_t f = 0; f < response.size(); ++f) response[f] = h * factors.inertia[f].cwiseInverse();
  for (std::size_t k = 0; k < dragged_response.size(); ++k) {
    const Model::Dragged& d = factors.dragged[k];
    Mat inertia = 0.5 * d.drag;
    inertia.diagonal() += factors.inertia[std::size_t(d.factor)] / h;
    dragged_response[k] = inverse(inertia);
  }
  for (std::size_t r = 0; r < turns.size(); ++r) turns[r].inertia_over_h = factors.moments[r] / h;
}

Workspace::Workspace(const Model& model, const SceneState& start, std::vector<Elimination> matrices)
    : next(start.at), next_attitude(start.attitude), next_loads(start.loads) {
  const auto zeros = [](std::size_t n) { return std::vector<Vec>(n, Vec::Zero()); };
  const std::size_t linears = model.factors.inertia.size();
  const std::size_t rotations = model.factors.moments.size();
  inertia.response = zeros(linears);
  inertia.dragged_response.resize(model.factors.dragged.size());
  inertia.turns.assign(rotations, RotationIncrement{Vec::Zero(), model.factors.rotation});
  inertia.set_step(model.factors, start.step);

  displacement = impulse = kicked = zeros(linears);
  turned = spin_impulse = spin_kicked = turning.momentum = turning.residual = zeros(rotations);
  turning.size.resize(rotations);
  turning.inverse.resize(rotations);
  turning.frame.resize(rotations);

  rows.multipliers = start.guess.multipliers[0];
  rows.values = rows.right = rows.precision = std::vector<double>(model.rows.roles.size(), 0.0);
  rows.next_gradients = zeros(start.gradients.size());
  rows.linear_response = zeros(model.rows.linear_entries.size());
  rows.rotation_response = rows.rotation_gradient = zeros(model.rows.rotation_entries.size());
  rows.matrices = std::move(matrices);
  if (model.rows.vakonomic) {
    vakonomic.gradients = vakonomic.drifts = rows.next_gradients;
    vakonomic.free_displacement = displacement;
  }
}

std::size_t Workspace::memory() const {
  std::size_t bytes = bytes_of(
      inertia.response, inertia.dragged_response, inertia.turns, next.x, next.attitude, next.arm, next_attitude,
      next_loads.on, next_loads.torque, displacement, turned, impulse, spin_impulse, kicked, spin_kicked,
      rows.multipliers, rows.values, rows.right, rows.precision, rows.next_gradients, rows.linear_response,
      rows.rotation_response, rows.rotation_gradient, rows.matrices, turning.momentum, turning.residual, turning.size,
      turning.inverse, turning.frame, vakonomic.gradients, vakonomic.drifts, vakonomic.free_displacement);
  for (const Elimination& matrix : rows.matrices) bytes += matrix.entries() * sizeof(double);
  return bytes;
}

}  // namespace lagroid::multibody
