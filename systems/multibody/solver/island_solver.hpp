#pragma once
/// The equations of one step of an island, the bodies that joints tie together:
///
///     F-_K(xi) = p + D^T lambda,    C(q g) = 0,
///
/// solved for the multipliers alone, by Newton's iteration with S = D' A^{-1} D^T. A detail of Multibody.

#include <lagroid/solvers/step/step_solver.hpp>
#include <lagroid/systems/multibody/model.hpp>
#include <lagroid/systems/multibody/solver/workspace.hpp>
#include <lagroid/systems/multibody/state.hpp>

#include <vector>

namespace lagroid::multibody {

/// Solves what joints tie together for the arrow from the node of a state, and rotations that no joint ties:
///     F-_K(xi) = p + D^T lambda,   C(q g) = 0,
/// p the momenta `Workspace::kicked`, D the rows' gradients at the source. Momenta are solved for factor by factor,
/// what is left are the multipliers, with the matrix S = D' A^{-1} D^T, A the derivative of F-_K (docs/multibody.md).
class IslandSolver {
 public:
  /// Requires that all outlive it. Displacements in the workspace are those without the joints.
  IslandSolver(const Model& model, const SceneState& from, const StepOptions& options, Workspace& workspace);

  /// Leaves the island's part of the arrow in the workspace, and its multipliers; `singular` also where rows that were
  /// left out do not hold (`Workspace::dependence_ended`).
  StepReport solve(int island);
  /// The turn of a rotation that no joint ties.
  StepReport turn_freely(int rotation);
  /// The island's part of the arrow's target.
  void place(const Model::Island& island);
  /// Covectors along which the rows react in this step: those at its source, but for vakonomic rows.
  const std::vector<Vec>& reactions() const { return gradients_; }

 private:
  /// What is left of the equations, over their terms and over what round-off leaves of these.
  struct Residual {
    double size = 0;
    double roundoff_ratio = 0;
    double sum = 0;  ///< which no NaN escapes
  };

  /// Multipliers and turns that the last steps lead to.
  void guess(const Model::Island& island);
  bool rests(const Model::Island& island) const;
  /// The size of a row: its own terms, and the motions that it cancels.
  void weigh_rows(const Model::Island& island);
  void find_linear_responses(const Model::Island& island);
  /// Adds what multipliers do to displacements.
  void displace(const Model::Island& island, const double* multipliers);

  Residual find_residual(const Model::Island& island);
  void add_turns(const Model::Island& island, Residual& residual);
  /// Computes the covectors of vakonomic rows at the present arrow, and the displacements that follow from them.
  /// Returns the largest change of a displacement, relative to their size.
  double follow(const Model::Island& island);
  void find_vakonomic_gradients(const Model::Island& island);
  bool factorise(const Model::Island& island, Elimination& matrix);
  /// One iteration with the matrix as it was factorised.
  void improve(const Model::Island& island, const Elimination& matrix);
  bool left_out_hold(const Model::Island& island) const;

  const Model& model_;
  const SceneState& from_;
  const StepOptions& options_;
  Workspace& workspace_;
  const std::vector<Vec>& gradients_;
};

}  // namespace lagroid::multibody
