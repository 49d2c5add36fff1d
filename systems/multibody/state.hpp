#pragma once
/// The state of the motion of a scene: all that its next step depends on, to the last bit. Multibody hands it out and
/// goes on from it (`restore`, which throws std::invalid_argument for a state of another scene).

#include <lagroid/core/number_archive.hpp>
#include <lagroid/solvers/integrators/step_control.hpp>
#include <lagroid/systems/multibody/joint.hpp>
#include <lagroid/systems/multibody/rotation_increment.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace lagroid::multibody {

/// All that the motion of a scene depends on: one that goes on from it does so with the same bits.
template <class S = double> struct BasicSceneState {
  /// What the solution of a step is guessed from.
  struct Guess {
    std::array<std::vector<S>, 3> multipliers;  ///< of the last three steps, the last first
    std::vector<Vector<S, 3>> turns;            ///< of the last step, xi

    void serialize(NumberArchive& archive) { archive(multipliers, turns); }
    friend void swap(Guess& a, Guess& b) noexcept {
      a.multipliers.swap(b.multipliers);
      a.turns.swap(b.turns);
    }
  };

  long index = 0;
  double step = 0;               ///< that led here; at the start, the first
  double time_compensation = 0;  ///< of sums of steps that are controlled
  double dissipated = 0;         ///< J
  BasicConfiguration<S> at;      ///< the places of linear factors first
  std::vector<Vector<S, 4>> attitude;
  std::vector<Vector<S, 3>> place_compensation, momentum, momentum_compensation, spin, spin_compensation;
  Guess guess;
  std::vector<Guess> stages;  ///< of a composed step, each with its own
  std::optional<StepController> control;

  // What follows from places and attitudes. Computed anew at another place of the program it could differ in its last
  // bits.
  BasicLoads<S> loads;
  std::vector<Vector<S, 3>> gradients;  ///< of rows, as their reactions act
  std::vector<RowSize> sizes;
  std::vector<double> precision;  ///< one over the size of a row in the step that led here
  double arrow_residual = 0;      ///< of the rows on the arrow that led here

  /// Whether the other is a state of the same scene, as far as sizes tell.
  bool fits(const BasicSceneState& other) const;
  /// Visits all of it.
  void serialize(NumberArchive& archive);
  /// Of its arrays, B.
  std::size_t memory() const;
};
using SceneState = BasicSceneState<>;

}  // namespace lagroid::multibody
