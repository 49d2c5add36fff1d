#pragma once
/// The motion on (TS^2)^k or (T*S^2)^k as one whose steps are linearised: by Lie group methods the chain rule through
/// their stages, by implicit ones the equations that hold at the solution.
///
///     LinearisedSphereMotion motion([&](const auto& by) { return make_chain_integrator(chain, start, by); }, options,
///                                   make_chain_derivatives(chain, options, options.form, {"masses.0"}));
///     const Propagated end = propagate_forward(motion, 100, directions);
///
/// States are the 6 k numbers of a point, column by column, in the form of the integrator: directions at the start are
/// tangent to the bundle (`tangent_directions`), and so is what becomes of them, but for methods that leave it. Inner
/// steps that a tolerance controls are held, each a stage: how their sizes change with the start is not smooth, and
/// what it does to the end is below the tolerance.
///
/// Requires an integrator at its start by these options, and derivatives of the same steps. Throws what `begin` does.

#include <lagroid/systems/spheres/sphere_derivatives.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace lagroid {

class LinearisedSphereMotion final : public LinearisedMotion {
 public:
  using Points = SphereIntegrator::Points;
  using Begin = std::function<std::unique_ptr<SphereIntegrator>(const SphereIntegratorOptions&)>;

  LinearisedSphereMotion(const Begin& begin, SphereIntegratorOptions options,
                         std::unique_ptr<SphereDerivatives> derivatives);
  LinearisedSphereMotion(const LinearisedSphereMotion&) = delete;  // its integrator tells it of inner steps
  LinearisedSphereMotion& operator=(const LinearisedSphereMotion&) = delete;

  int states() const override { return int(before_.size()); }
  int parameters() const override { return derivatives_->parameters(); }
  double time() const override { return integrator_->time(); }
  StepReport advance() override;
  bool linearise() override;
  int stages() const override { return int(made_.size()); }
  const LinearStep& stage(int k) const override { return stages_[std::size_t(k)]; }
  NodeValues observe() const override { return derivatives_->observe(integrator_->point()); }
  void serialize(NumberArchive& archive) override { integrator_->serialize(archive); }

 private:
  std::unique_ptr<SphereIntegrator> integrator_;
  std::unique_ptr<SphereDerivatives> derivatives_;
  double step_;                   ///< from node to node
  std::vector<SphereStep> made_;  ///< between the last two nodes
  Points before_;                 ///< the former of them
  std::vector<LinearStep> stages_;
};

/// Unit vectors that are tangent to the sphere at q, where theta and phi grow: to the south and to the east. At a pole
/// they are those of phi = 0.
Eigen::Matrix<double, 3, 2> tangent_frame(const Vector<double, 3>& q);

/// The derivatives of a point with respect to 4 k coordinates of the bundle around it, at these values of them: turns
/// of each q_i along its tangent frame, south and east, then what is added to the second halves, along frames that turn
/// with q_i. 6 k x 4 k; `moved` is the point there.
Eigen::MatrixXd tangent_directions(const SphereIntegrator::Points& z, const Eigen::VectorXd& coordinates,
                                   SphereIntegrator::Points& moved);

}  // namespace lagroid
