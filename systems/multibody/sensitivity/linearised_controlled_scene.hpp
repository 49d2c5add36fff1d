#pragma once
/// The motion of a scene of bodies by controlled steps (Options::controlled), its steps linearised: a step of the size
/// h = epsilon / rho and the density of steps that it leads to,
///
///     (v, mu, t, rho) -> (v', mu', t + h, rho'),    rho' = rho - epsilon r(z'),    r = d log sigma / dt,
///
/// as those of systems are (solvers/sensitivity/times/linearised_controlled_motion.hpp). The density of the start is
/// 1 - epsilon r(z_0) / 2, epsilon the first step, which derivatives hold.
///
///     LinearisedControlledScene motion(std::move(controlled), names, numbers, write);
///     const Propagated end = propagate_forward(motion, 100, directions);  // columns (v, mu, t, rho, theta)
///
/// A start varies by (v, mu) alone. Requires a motion at its start, by controlled steps, of the very scene that is
/// written. Errors: std::invalid_argument, one line, for other motions and scenes. Where the controller has no step
/// that is the status.

#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/systems/multibody/sensitivity/scene_variations.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::multibody {

class LinearisedControlledScene final : public LinearisedMotion {
 public:
  LinearisedControlledScene(Multibody motion, std::vector<std::string> names, std::vector<double> numbers,
                            const WriteScene& write);

  const Multibody& motion() const { return motion_; }
  int states() const override { return varied_.sizes().states() + 2; }
  int parameters() const override { return varied_.parameters(); }
  double time() const override { return motion_.time(); }
  bool has_equal_steps() const override { return false; }
  StepReport advance() override;
  bool linearise() override;
  /// The step; before the first, what the start and numbers do to it and to its density.
  int stages() const override { return begins_ ? 2 : 1; }
  const StepDerivative& stage(int k) const override;
  NodeValues observe() const override;
  std::optional<NodeValues> observe_later(double time) override;
  void serialize(NumberArchive& archive) override { motion_.serialize(archive); }

 private:
  /// Columns (v, mu, theta, t) become (v, mu, t, rho, theta).
  Eigen::MatrixXd with_density(const Eigen::MatrixXd& by) const;

  Multibody motion_;
  mutable SceneVariations varied_;
  double first_step_;
  SceneState before_;  ///< the last step
  LinearStep begin_;
  std::unique_ptr<const StepDerivative> step_;
  bool begins_ = false;
};

}  // namespace lagroid::multibody
