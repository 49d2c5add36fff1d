#pragma once
/// The Transcription of a controlled scene of bodies (SceneControl), with sizes that are known when it runs. Of arrow
/// g_k from (q_k, mu_k) to (q_{k+1}, mu_{k+1}), with controls u_k and multipliers kappa_k of the joints,
///
///     mu_k + h/2 (f + sum_j u_j B_j)(q_k) + f-(g_k) + D(q_k)^T kappa_k = F-(g_k),
///     F+(g_k) + f+(g_k) + h/2 (f + sum_j u_j B_j)(q_{k+1}) = mu_{k+1},    C(q_{k+1}) = 0:
///
/// the steps of Multibody, with half of the controls' impulse at either end, and f-, f+ the discrete forces of drag and
/// dampers (arrow_momenta.hpp, damper_forces.hpp). Controls of a stage are (u, kappa); where
/// a node is kept, momenta are those before the joints' reaction.
///
///     ControlledScene scene(task);
///     SceneTranscription transcription(scene, guess);
///     InteriorPoint solver(transcription);
///
/// Nodes are displaced in coordinates along which the joints are linear (ControlledScene::displace_along_joints): a
/// path on which they hold stays there; or straight, in one chart for all paths (ipopt/scene_chart.hpp). Derivatives
/// are automatic and exact, second ones included: what acts at a node in blocks of two factors (SecondNumber), dampers
/// in blocks of two factors at either end, kinetic terms factor by factor. Requires a path of the scene's nodes, the
/// first its start. The scene must outlive it, and serves one transcription at a time. Nothing throws.
///
/// Ober-Bloebaum, Junge, Marsden, ESAIM COCV 17 (2011); decision 94.

#include <lagroid/solvers/control/transcription.hpp>
#include <lagroid/systems/multibody/control/controlled_scene.hpp>

#include <vector>

namespace lagroid::multibody {

/// Nodes 0 ... N of a controlled scene, and the controls of stages 0 ... N-1, multipliers of joints behind them.
struct ScenePath {
  std::vector<ControlledNode> nodes;
  StageRows controls;
  double step = 0;  ///< h

  long stages() const { return long(nodes.size()) - 1; }
};

class SceneTranscription final : public Transcription {
 public:
  /// By what nodes are displaced: by coordinates along which the joints are linear, or by plain ones.
  enum class Coordinates { along_joints, straight };

  SceneTranscription(ControlledScene& scene, ScenePath start, Coordinates coordinates = Coordinates::along_joints);

  const ScenePath& path() const { return now_; }
  /// The path becomes another one of as many stages.
  void stand_at(const ScenePath& path) { now_ = tried_ = path; }
  /// How many inequalities a stage has before those of the controls' bounds.
  int before_bounds() const { return sizes_.inequality - int(bounds_.size()); }
  /// How many equations a stage has before those of joints and of the end.
  int equations() const { return 2 * scene_.n(); }

  const TranscriptionSizes& sizes() const override { return sizes_; }
  const std::vector<bool>& free_start() const override { return free_start_; }
  const std::vector<bool>& free_end() const override { return free_end_; }
  void values(StageValues& out) const override;
  void derivatives(const StageRows& equality_multipliers, const StageRows& inequality_multipliers,
                   StageDerivatives& out) const override;
  void try_displacement(const TrajectoryDisplacement& by, double fraction) override;
  void accept() override { now_ = tried_; }

 private:
  /// u_control <= its upper bound (sign 1) or >= its lower bound (sign -1).
  struct Bound {
    int control;
    double sign;
    double value;
  };
  /// Of a stage, what its derivatives are put into.
  struct Block {
    double* gradient;
    double* equality;
    double* inequality;
    double* hessian;
    const double* lambda;
    const double* z;
    const double* controls;
  };

  /// What acts at a node as the source (End::source) or the target of a stage.
  void add_forces(const NodeForces<SecondNumber>& at, int left, int right, End end, const Block& out) const;
  /// Joints and limits, at the target of a stage; `is_last` asks for the end's conditions in place of the joints'.
  void add_conditions(const ControlledNode& node, const NodeForces<SecondNumber>& at, int left, int right, bool is_last,
                      const Block& out) const;
  void add_momenta(const ControlledNode& node, bool is_last, const Block& out) const;
  /// Keeps what second derivatives along the joints need of the node.
  void keep_joints(const NodeForces<SecondNumber>& at, int left, int right) const;
  /// Second derivatives are along displacements by which the joints are linear.
  void bend_along_joints(long stage, End end, const Block& out) const;
  void add_kinetic(long stage, const Block& out) const;
  void add_dampers(long stage, const Block& out) const;
  void add_cost(const Block& out) const;
  void add_to(double* hessian, int row, int column, double x) const {
    hessian[row * variables_ + column] += x;
    if (row != column) hessian[column * variables_ + row] += x;
  }

  ControlledScene& scene_;
  Coordinates coordinates_;
  TranscriptionSizes sizes_;
  int variables_ = 0;
  std::vector<bool> free_start_, free_end_;
  std::vector<Bound> bounds_;
  ScenePath now_, tried_;
  mutable std::vector<double> end_values_;
  mutable std::vector<SecondNumber> varied_end_, varied_velocities_;
  mutable Eigen::MatrixXd slopes_of_velocities_;          ///< by the momenta of a node
  mutable std::vector<double> joint_hessians_;            ///< of the node that derivatives are at, row after row
  mutable Eigen::MatrixXd gradients_, along_, reaction_;  ///< D, W D^T and D W D^T there
  mutable Eigen::VectorXd slope_, bent_;
  mutable Eigen::PartialPivLU<Eigen::MatrixXd> factor_;
};

}  // namespace lagroid::multibody
