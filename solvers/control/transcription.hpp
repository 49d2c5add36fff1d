#pragma once
/// An optimal control problem seen through numbers: N arrows g_k with controls u_k, of which the solver knows values
/// and derivatives along displacements of nodes and controls.
///
///     minimise  sum_k l(g_k, u_k, h),    phi(g_k, u_k, h) = 0,    gamma(g_k, u_k, h) <= 0.
///
/// All that solves such problems is compiled once: it knows a Transcription, never the groupoid.
///
///     TranscriptionOf<DubinsCar> transcription(task, straight_trajectory(task, 100));  // transcription_of.hpp
///     StageValues at(transcription.sizes());
///     transcription.values(at);  // of the trajectory as it stands
///
/// The variables of a stage k = 0 ... N-1 (arrow k leads from node k to node k+1) stand in the order
///
///     x = (a, b, du, t):    g_k -> tau(a)^{-1} g_k tau(b),    u_k -> u_k + du,    h -> h exp(t),
///
/// t the same for all stages of a phase.
///
/// Nothing throws; values that are not finite are the caller's to notice.

#include <lagroid/solvers/control/stage_rows.hpp>

#include <vector>

namespace lagroid {

/// Costs and constraints of every stage.
struct StageValues {
  StageValues() = default;
  explicit StageValues(const TranscriptionSizes& sizes)
      : cost(sizes.stages, 1), equality(sizes.stages, sizes.equality), inequality(sizes.stages, sizes.inequality) {}
  StageRows cost;
  StageRows equality;
  StageRows inequality;
};

/// Their derivatives: of the cost, of each constraint row by row, and the Hessian of the stage's Lagrangian
/// l + <lambda, phi> + <z, gamma>. Bounds of controls have none here: theirs are their signs.
struct StageDerivatives {
  StageDerivatives() = default;
  explicit StageDerivatives(const TranscriptionSizes& sizes)
      : gradient(sizes.stages, sizes.variables()),
        equality(sizes.stages, sizes.equality * sizes.variables()),
        inequality(sizes.stages, sizes.general_inequality() * sizes.variables()),
        hessian(sizes.stages, sizes.variables() * sizes.variables()) {}
  StageRows gradient;
  StageRows equality;
  StageRows inequality;
  StageRows hessian;
};

/// An optimal control problem with a trajectory that moves.
class Transcription {
 public:
  virtual ~Transcription() = default;

  virtual const TranscriptionSizes& sizes() const = 0;
  /// Which components of the first and of the last node's displacement are free.
  virtual const std::vector<bool>& free_start() const = 0;
  virtual const std::vector<bool>& free_end() const = 0;

  /// At the trajectory tried last, or where it stands.
  virtual void values(StageValues& out) const = 0;
  /// Where the trajectory stands, with multipliers of the constraints.
  virtual void derivatives(const StageRows& equality_multipliers, const StageRows& inequality_multipliers,
                           StageDerivatives& out) const = 0;

  /// How large the numbers are that a displacement changes, where the trajectory stands: what they round to bounds how
  /// well constraints can be satisfied. One, where nothing is known of them.
  virtual void sizes_of_displaced(TrajectoryDisplacement& out) const { set_all(out, 1); }

  /// Tries the trajectory displaced by `fraction` of `by`; `accept` lets it stand.
  virtual void try_displacement(const TrajectoryDisplacement& by, double fraction) = 0;
  virtual void accept() = 0;
};

}  // namespace lagroid
