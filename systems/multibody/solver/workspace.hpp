#pragma once
/// The workspace of a step of a scene: the arrow as far as it is known, and buffers, so that steps allocate nothing.
/// All of it follows from model and state.

#include <lagroid/systems/multibody/model.hpp>
#include <lagroid/systems/multibody/solver/any_size.hpp>
#include <lagroid/systems/multibody/state.hpp>

#include <cstddef>
#include <vector>

namespace lagroid::multibody {

/// What inertia is to steps of one size.
struct StepInertia {
  double h = 0;
  std::vector<Vec> response;          ///< displacement of a linear factor over its momentum, where no drag acts
  std::vector<Mat> dragged_response;  ///< where it does, in the order of `Factors::dragged`
  std::vector<RotationIncrement> turns;

  void set_step(const Model::Factors& factors, double step);
};

/// What a step of a scene is computed in, all of which follows from model and state: the arrow from the node where the
/// state stands, as far as it is known, and what an island's equations are solved with.
struct Workspace {
  Workspace() = default;
  Workspace(const Model& model, const SceneState& start, std::vector<Elimination> matrices);

  StepInertia inertia;

  // The arrow: its target and what acts there, and how far its factors move.
  Configuration next;
  std::vector<Quaternion> next_attitude;
  Loads next_loads;
  std::vector<Vec> displacement, turned;

  std::vector<Vec> impulse, spin_impulse;  ///< what the node where the arrow begins or ends gives
  std::vector<Vec> kicked, spin_kicked;    ///< momenta with which the arrow begins, but for the joints' reactions

  /// Of rows, their gradients and their entries.
  struct Rows {
    std::vector<double> multipliers, values, right;
    std::vector<double> precision;  ///< one over the size of a row
    std::vector<Vec> next_gradients;
    std::vector<Vec> linear_response, rotation_response, rotation_gradient;
    std::vector<Elimination> matrices;  ///< of the islands
  } rows;

  /// Of rotations that joints tie.
  struct Turning {
    std::vector<Vec> momentum, residual;
    std::vector<double> size;  ///< of the terms that a residual is made of
    std::vector<Mat> inverse, frame;
  } turning;

  /// Where there are vakonomic rows, whose covectors depend on the arrow.
  struct Vakonomic {
    std::vector<Vec> gradients, drifts, free_displacement;
  } vakonomic;

  /// Whether rows left out as dependent no longer follow from the others.
  bool dependence_ended = false;

  /// Adds half a step's impulse of what acts.
  void add_impulse(const Model& model, const Loads& loads) {
    if (model.effects.empty()) return;
    const double half = 0.5 * inertia.h;
    for (std::size_t f = 0; f < impulse.size(); ++f) impulse[f] += half * loads.on[f];
    for (std::size_t r = 0; r < spin_impulse.size(); ++r) spin_impulse[r] += half * loads.torque[r];
  }
  SceneArrow motion(const Configuration& from) const { return {from, next, displacement, turned, inertia.h}; }
  /// Of its arrays, B.
  std::size_t memory() const;
};

}  // namespace lagroid::multibody
