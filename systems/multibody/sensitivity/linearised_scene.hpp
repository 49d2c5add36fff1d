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
/// change with it. What of this changes the start is part of the first step's derivative. Its steps can be cut, kicked
/// and switched (cuttable_motion.hpp): what was held until then goes on with the velocity that it had, so that a switch
/// has the derivative of a projection of the momentum.
///
/// Requires a motion at its start, of equal steps, single or composed, of the very scene that is written. Errors:
/// std::invalid_argument, one line, for other motions and scenes; WithoutDerivative naming a number by which joints
/// that hold at the start would not any more, at the first step also one by which those of a closed loop would not, and
/// for switches where there are vakonomic joints, or after which rows depend on others anew; std::domain_error for a
/// joint that is switched on where it does not hold.
/// Source: implicit function theorem at the solved step (linear_step.hpp).

#include <lagroid/solvers/sensitivity/times/cuttable_motion.hpp>
#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/multibody/sensitivity/scene_adjoint.hpp>
#include <lagroid/systems/multibody/sensitivity/scene_variations.hpp>

#include <Eigen/Core>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::multibody {

class LinearisedScene final : public CuttableMotion {
 public:
  /// A scene as a function of its numbers.
  using Write = WriteScene;

  /// Of a motion by composed steps: the same motion at its start by single ones, and the shares of its stages.
  struct Stages {
    Multibody motion;
    std::vector<double> shares;
  };

  LinearisedScene(Multibody motion, std::vector<std::string> names, std::vector<double> numbers, Write write,
                  std::optional<Stages> stages = std::nullopt);

  const Multibody& motion() const { return motion_; }
  int states() const override { return 6 * int(motion_.state().momentum.size() + motion_.state().spin.size()); }
  int parameters() const override { return int(names_.size()); }
  double time() const override { return motion_.time(); }
  StepReport advance() override;
  bool linearise() override;
  /// Those of the step; before the first, what numbers do to the start.
  int stages() const override { return int(linear_.size()) + (begins_ ? 1 : 0); }
  const StepDerivative& stage(int k) const override;
  NodeValues observe() const override;
  void serialize(NumberArchive& archive) override;

  StepReport pass() override { return motion_.advance(); }
  void keep_node(std::unique_ptr<KeptNode>& node) override;
  void return_to(const KeptNode& node) override;
  bool takes_back() const override;
  bool take_back(const KeptNode& before, const KeptNode& after, Eigen::MatrixXd& gradients) override;

  void keep() override { kept_ = motion_.state(); }
  StepReport go(double duration) override;
  Derivatives part() override;
  void end_step() override {
    motion_.end_part(end_);
    end_ = motion_.state();
  }
  void leave_step() override { motion_.restore(end_); }
  Eigen::VectorXd seen() const override { return variations().seen(motion_.state()); }
  NodeValues observe_in_part() const override { return variations().observe(motion_.state(), /*by_time=*/true); }
  void kick(const Eigen::VectorXd& by) override;
  Switched switch_to(const Switching& what, bool linearised) override;

  /// The derivative of a start by what displaces it (`displace`): a projection onto what the joints allow.
  Eigen::MatrixXd allowed_directions() const;
  /// The derivatives of the start, (v, mu), by the numbers.
  const Eigen::MatrixXd& start_by_numbers() const { return start_; }
  /// How often the equations of a step are evaluated for its derivative: of a chain the same, however long it is.
  int evaluations() const { return variations().evaluations(); }

 private:
  /// Of the scene as it is switched now.
  SceneVariations& variations() const;
  /// Linearises a step, or a stage of one.
  bool linearise(const SolvedStep& solved, bool by_times, std::optional<SparseStep>& out);
  /// The same of all stages of a step of this size.
  bool linearise_stages(const SceneState& before, double size, bool by_times,
                        std::vector<std::optional<SparseStep>>& out);

  Multibody motion_;
  std::vector<std::string> names_;
  std::vector<double> numbers_;
  Write write_;
  mutable std::map<std::vector<char>, SceneVariations> variations_;  ///< by what acts, and what is left out of it
  SceneState before_;                                                ///< the last step
  SceneState kept_, end_;                                            ///< where parts begin, and where their step ends
  std::vector<Vec> displacements_;                                   ///< of that step
  std::vector<std::optional<SparseStep>> linear_;                    ///< of the stages
  std::optional<Stages> stages_;
  std::optional<SceneAdjoint> adjoint_;  ///< of scenes that have one
  std::vector<int> left_out_;            ///< rows, at the start
  Eigen::MatrixXd start_;
  LinearStep begin_;     ///< (v, mu, theta) of the start, by displacements of it and theta
  bool begins_ = false;  ///< whether the last step was the first
};

/// Moves and turns what a motion at its start moves, and changes its momenta, by (v, mu); then brings places back to
/// where the joints hold, along their reactions W D^T at the start, W the inverse inertia, and takes from the momenta
/// what they do not allow. Throws std::domain_error where joints are not reached from there.
void displace(Multibody& motion, const Eigen::VectorXd& by);

}  // namespace lagroid::multibody
