#pragma once
/// A scene of bodies whose effects are controlled, between its start and the end that is asked for: what guesses and
/// transcriptions of the problem are made of.
///
///     ControlledScene scene(task);
///     ControlledNode node = scene.start();
///     scene.project(node);  // back to where the joints hold
///
/// The constructor throws std::invalid_argument, one line, for what a problem cannot have: effects that are not there,
/// joints on velocities, points of the ground that move, rows that depend on others, ends that the joints do not allow,
/// and limits that are none or do not hold at the start.

#include <lagroid/systems/multibody/control/damper_forces.hpp>
#include <lagroid/systems/multibody/control/nodes/end_conditions.hpp>
#include <lagroid/systems/multibody/control/nodes/node_forces.hpp>
#include <lagroid/systems/multibody/control/nodes/node_limits.hpp>
#include <lagroid/systems/multibody/control/scene_control.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <Eigen/LU>

#include <memory>
#include <optional>
#include <vector>

namespace lagroid::multibody {

/// Where bodies are, and their momenta before the reaction of the joints there; in the order of the model.
struct ControlledNode {
  std::vector<Vec> places;
  std::vector<Mat> attitudes;
  Eigen::VectorXd momenta;  ///< of linear factors, then of rotations in the bodies
};

/// A factor at one end of an arrow.
struct FactorEnd {
  End end;
  int factor;
};

class ControlledScene {
 public:
  explicit ControlledScene(SceneControl task);

  const SceneControl& task() const { return task_; }
  const Multibody& motion() const { return motion_; }
  int linear() const { return plain_->linear(); }
  int factors() const { return linear() + plain_->rotations(); }
  int n() const { return plain_->size(); }
  int joints() const { return int(rows_.size()); }
  int actuators() const { return int(task_.actuators.size()); }
  /// Of a linear factor or, after these, of a rotation.
  const Vec& inertia(int factor) const {
    return factor < linear() ? motion_.model().factors.inertia[std::size_t(factor)]
                             : motion_.model().factors.moments[std::size_t(factor - linear())];
  }
  /// c of the force or torque -c v on it.
  const Mat& drag(int factor) const { return drag_[std::size_t(factor)]; }
  bool is_damped() const { return plain_dampers_ != nullptr; }
  /// Where it is, the factors that dampers push.
  const std::vector<int>& damped_factors() const { return plain_dampers_->factors(); }
  Retraction rotation() const { return motion_.model().factors.rotation; }

  const ControlledNode& start() const { return start_; }
  /// A node that satisfies what is asked of the end.
  const ControlledNode& end() const { return end_; }
  /// Which of the EndConditions do not follow from those before.
  const std::vector<int>& end_rows() const { return end_rows_; }
  const NodeLimits& limits() const { return limits_; }

  /// The node with places, turns and momenta displaced by a multiple of `by`, 2n numbers.
  void displace(const ControlledNode& node, const double* by, double fraction, ControlledNode& out) const;
  /// The same in coordinates along which the joints are linear: C(out) = C(node) + fraction D by, by a correction of
  /// second order along their reactions W D(node)^T; where that is not reached, as `displace`.
  void displace_along_joints(const ControlledNode& node, const double* by, double fraction, ControlledNode& out);
  /// From one to another: what `displace` takes, but for momenta.
  Eigen::VectorXd difference(const ControlledNode& from, const ControlledNode& to) const;
  /// Moves the node to where the joints hold, along their reactions. False where they are not reached.
  bool project(ControlledNode& node);
  /// The motion from the start without controls; none where a step has no solution.
  std::optional<std::vector<ControlledNode>> drift(long stages) const;

  /// What acts at a node, and what the end asks of it.
  const NodeForces<double>& forces(const ControlledNode& node);
  void end_values(const ControlledNode& node, std::vector<double>& out);
  /// The same, varied along the displacements of one factor to the left and of one to the right.
  const NodeForces<SecondNumber>& forces(const ControlledNode& node, int left, int right);
  /// What dampers put on an arrow, where there are any (`is_damped`), as it stands and varied.
  const DamperForces<double>& dampers(const ControlledNode& from, const ControlledNode& to);
  const DamperForces<SecondNumber>& dampers(const ControlledNode& from, const ControlledNode& to, FactorEnd left,
                                            FactorEnd right);
  /// Of what was evaluated last, with the momenta of a factor varied to the right; -1: of none.
  void end_values(const ControlledNode& node, int momenta_right, std::vector<SecondNumber>& out);
  /// W (mu - D^T nu) at a node: velocities, and angular ones in the bodies; behind them, three numbers each, those of
  /// the points whose speed is limited.
  std::vector<double> velocities(const ControlledNode& node);
  /// The same of what was evaluated last, as `end_values`.
  void velocities(const ControlledNode& node, int momenta_right, std::vector<SecondNumber>& out);

 private:
  static Multibody motion_of(const SceneControl& task);
  void require_task() const;
  void find_controls();
  void find_rows();
  void find_damping();
  void require_limits();
  /// What nothing outside changes: momenta along symmetries of all forces, controls and joints, and the centre of mass.
  std::vector<HeldByMotion> held_by_motion();
  std::optional<double> drag_by_mass(const Vec& along) const;
  void find_end();
  /// How far off the first conditions are left.
  double approach_end(int conditions, int numbers);
  void vary_momenta(const ControlledNode& node, int right);
  /// First derivatives of what is asked of the end, by the 2n numbers of the node.
  Eigen::MatrixXd end_jacobian(const ControlledNode& node);

  SceneControl task_;
  Multibody motion_;
  std::vector<int> controls_;  // numbers of switches
  std::vector<int> rows_;
  std::vector<int> end_rows_;
  std::unique_ptr<NodeForces<double>> plain_;
  std::unique_ptr<NodeForces<SecondNumber>> varied_;
  std::unique_ptr<DamperForces<double>> plain_dampers_;
  std::unique_ptr<DamperForces<SecondNumber>> varied_dampers_;
  std::vector<Mat> drag_;
  EndConditions conditions_;
  NodeLimits limits_;
  ControlledNode start_, end_;
  std::vector<double> momenta_;
  std::vector<SecondNumber> varied_momenta_;
  // Of displacements along joints.
  Eigen::MatrixXd gradients_, along_, matrix_;
  Eigen::VectorXd aim_, left_, by_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
};

}  // namespace lagroid::multibody
