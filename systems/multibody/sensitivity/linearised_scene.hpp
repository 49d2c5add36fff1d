#pragma once
/// The motion of a scene of bodies, its steps linearised: exact derivatives by its start and by the numbers that the
/// scene is made of.
///
///     const auto write = []<class S>(const std::vector<S>& numbers) {
///       BasicScene<S> scene;
///       const Vector<S, 3> weight(S(0), S(0), numbers[0] * -9.81);
///       const Body bob = scene.point_mass(numbers[0], {S(1), S(0), S(0)}, Vector<S, 3>::Zero());
///       scene.add(BasicConstantForce<S>{{bob.centre}, weight});
///       return scene;
///     };
///     LinearisedScene motion(Multibody(write(std::vector<double>{2.0}), 0.01), {"mass"}, {2.0},
///                            [write](const auto& numbers) { return WrittenScene{write(numbers)}; });
///     const Propagated end = propagate_forward(motion, 100, directions);
///
/// States are (v, mu): displacements of the linear factors and turns of the rotations in their bodies' frames, in the
/// order of the model, then momenta as the state keeps them. A derivative by a number is that of what is computed when
/// the scene is written with another: weights, lengths that follow from places, and the momentum of a given velocity
/// change with it. What of this changes the start is part of the first step's derivative.
///
/// Requires a motion at its start, of equal steps, single or composed, of the very scene that is written. Errors:
/// std::invalid_argument, one line, for other motions and scenes; WithoutDerivative naming a number by which joints
/// that hold at the start would not any more, at the first step also one by which those of a closed loop would not.
/// Source: implicit function theorem at the solved step (linear_step.hpp).

#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/multibody/sensitivity/scene_derivatives.hpp>

#include <Eigen/Core>

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::multibody {

class LinearisedScene final : public LinearisedMotion {
 public:
  /// A scene as a function of its numbers.
  using Write = WriteScene;

  /// Of a motion by composed steps: the same motion at its start by single ones, and the shares of its stages.
  struct Stages {
    Multibody motion;
    std::vector<double> shares;
  };

  LinearisedScene(Multibody motion, std::vector<std::string> names, std::vector<double> numbers, const Write& write,
                  std::optional<Stages> stages = std::nullopt);

  const Multibody& motion() const { return motion_; }
  int states() const override { return sizes_.states(); }
  int parameters() const override { return int(names_.size()); }
  double time() const override { return motion_.time(); }
  StepReport advance() override;
  bool linearise() override;
  /// Those of the step; before the first, what numbers do to the start.
  int stages() const override { return int(linear_.size()) + (begins_ ? 1 : 0); }
  const StepDerivative& stage(int k) const override;
  NodeValues observe() const override;
  void serialize(NumberArchive& archive) override;

  /// The derivative of a start by what displaces it (`displace`): a projection onto what the joints allow.
  Eigen::MatrixXd allowed_directions() const;
  /// The derivatives of the start, (v, mu), by the numbers.
  const Eigen::MatrixXd& start_by_numbers() const { return start_; }
  /// How often the equations of a step are evaluated for its derivative: of a chain the same, however long it is.
  int evaluations() const { return derivatives_.evaluations(); }

 private:
  void find_start();
  /// Linearises a stage, or the whole of a step.
  bool linearise(const SolvedStep& solved, bool is_first, std::optional<SparseStep>& out);
  bool linearise_stages();
  /// Refuses numbers with which rows that depend on others no longer do.
  void require_dependence(const SolvedStep& solved, const SparseStep& step);

  Multibody motion_;
  std::vector<std::string> names_;
  std::vector<double> numbers_;
  SceneSizes sizes_;
  mutable std::deque<VariedScene> scenes_;  ///< the first constant, each other varied by the next few numbers
  SceneDerivatives derivatives_;
  SceneState before_;                              ///< the last step
  std::vector<std::optional<SparseStep>> linear_;  ///< of the stages
  std::optional<Stages> stages_;
  Eigen::MatrixXd start_;
  LinearStep begin_;     ///< (v, mu, theta) of the start, by displacements of it and theta
  bool begins_ = false;  ///< whether the last step was the first
};

/// Moves and turns what a motion at its start moves, and changes its momenta, by (v, mu); then brings places back to
/// where the joints hold, along their reactions W D^T at the start, W the inverse inertia, and takes from the momenta
/// what they do not allow. Throws std::domain_error where joints are not reached from there.
void displace(Multibody& motion, const Eigen::VectorXd& by);

}  // namespace lagroid::multibody
