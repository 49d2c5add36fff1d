#include <lagroid/systems/multibody/state.hpp>

#include <lagroid/systems/multibody/solver/memory.hpp>

namespace lagroid::multibody {

namespace {

std::vector<std::size_t> lengths_of(const SceneState& s) {
  std::vector<std::size_t> out{s.at.x.size(),
                               s.at.arm.size(),
                               s.at.attitude.size(),
                               s.attitude.size(),
                               s.spin.size(),
                               s.spin_compensation.size(),
                               s.momentum.size(),
                               s.momentum_compensation.size(),
                               s.sizes.size(),
                               s.precision.size(),
                               s.place_compensation.size(),
                               s.gradients.size(),
                               s.loads.on.size(),
                               s.loads.torque.size()};
  const auto add = [&](const SceneState::Guess& guess) {
    out.push_back(guess.turns.size());
    for (const auto& multipliers : guess.multipliers) out.push_back(multipliers.size());
  };
  add(s.guess);
  for (const auto& stage : s.stages) add(stage);
  return out;
}

std::size_t bytes_of_guess(const SceneState::Guess& g) {
  return bytes_of(g.multipliers[0], g.multipliers[1], g.multipliers[2], g.turns);
}

}  // namespace

template <> bool SceneState::fits(const SceneState& other) const {
  return control.has_value() == other.control.has_value() && lengths_of(*this) == lengths_of(other);
}

template <> void SceneState::serialize(NumberArchive& archive) {
  archive(index, step, time_compensation, dissipated, at.time, at.x, at.attitude, attitude);
  archive(place_compensation, momentum, momentum_compensation, spin, spin_compensation, guess, stages);
  if (control) archive(*control);
  archive(loads.on, loads.torque, gradients, precision, arrow_residual);
  for (RowSize& size : sizes) archive(size.terms, size.slope);
}

template <> std::size_t SceneState::memory() const {
  std::size_t bytes = bytes_of(at.x, at.attitude, at.arm, attitude, place_compensation, momentum, momentum_compensation,
                               spin, spin_compensation, stages, loads.on, loads.torque, gradients, sizes, precision);
  bytes += bytes_of_guess(guess);
  for (const Guess& stage : stages) bytes += bytes_of_guess(stage);
  return bytes;
}

}  // namespace lagroid::multibody
