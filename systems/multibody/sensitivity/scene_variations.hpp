#pragma once
/// A scene over numbers with derivatives, as it is switched at one time: its steps linearised, and what is seen at its
/// nodes.
///
///     SceneVariations varied(motion, numbers, write);
///     std::optional<SparseStep> step;
///     if (varied.linearise(motion, solved, /*by_times=*/false, step)) x = step->forward(x);
///     const NodeValues seen = varied.observe(motion.state(), /*by_time=*/false);
///
/// A detail of LinearisedScene and LinearisedControlledScene. Columns are (v, mu, theta), and where times are asked for
/// that at which the step begins, or at which the node is, and the step's size. Requires a motion that is switched as
/// it was for the constructor. Errors: WithoutDerivative, naming a number.

#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/multibody/sensitivity/scene_derivatives.hpp>

#include <Eigen/Core>

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::multibody {

/// The numbers, a few from `first` on varied in directions of their own.
std::vector<VariedNumber> varied_from(const std::vector<double>& numbers, int first);

class SceneVariations {
 public:
  SceneVariations(const Multibody& motion, const std::vector<double>& numbers, const WriteScene& write);

  const SceneSizes& sizes() const { return sizes_; }
  int parameters() const { return parameters_; }
  /// How often the equations of a whole step are evaluated for its derivative.
  int evaluations() const { return of_steps_.evaluations(); }

  /// (v, mu) of the start by the numbers. Throws WithoutDerivative for one by which its joints would not hold.
  Eigen::MatrixXd start(const std::vector<std::string>& names, const std::vector<double>& numbers);
  /// False where the equations are singular.
  bool linearise(const Multibody& motion, const SolvedStep& solved, bool by_times, std::optional<SparseStep>& out);
  /// Refuses numbers with which rows that depend on others no longer do, in a step that begins with these derivatives.
  void require_dependence(const SolvedStep& solved, const SparseStep& step, const Eigen::MatrixXd& start,
                          const std::vector<std::string>& names);

  NodeValues observe(const SceneState& node, bool by_time);
  /// What is observed, without derivatives.
  Eigen::VectorXd seen(const SceneState& node);
  NodeValues time_scale_rate(const SceneState& node);
  NodeValues held_places(const SceneState& node);
  NodeValues tangent_momenta(const SceneState& node);

 private:
  /// of(scene, first), which varies as VariedScene::observe does.
  template <class Of> NodeValues along_all(bool by_time, const Of& of);
  VariedScene& by_numbers(int first) { return scenes_[std::size_t(1 + first / varied_at_once)]; }

  SceneSizes sizes_;
  int parameters_;
  std::deque<VariedScene> scenes_;  ///< the first constant, each other varied by the next few numbers
  SceneDerivatives of_steps_, of_parts_;
};

}  // namespace lagroid::multibody
