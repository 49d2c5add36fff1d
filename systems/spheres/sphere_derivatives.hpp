#pragma once
/// What derivatives of motions on (TS^2)^k and (T*S^2)^k are made of, whatever the system: those of a step, of a change
/// of form and of what is observed, by the 6 k numbers of a point and by parameters theta,
///
///     z' = Phi_h(z; theta),    by = (d z' / d z, d z' / d theta),
///
/// h being held.
///
/// Points are on the bundle; derivatives along directions that are not tangent to it are those of the formulas.
/// Classical methods leave it and have them too.
///
///     const auto derivatives = make_chain_derivatives(chain, options, SphereForm::velocities, {"gravity"});
///     SphereIntegrator::Points end;
///     Eigen::MatrixXd by;
///     if (derivatives->step(start, {.size = 0.01}, end, by)) use(by.rightCols(1));
///
/// Nothing throws. Systems write this interface over numbers with derivatives (core/scalars/varied.hpp) or by jets.

#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/systems/spheres/sphere_integrator.hpp>

#include <Eigen/Core>

namespace lagroid {

/// A step that was made.
struct SphereStep {
  double size = 0;
  int rows = 0;  ///< of extrapolation
};

class SphereDerivatives {
 public:
  using Points = SphereIntegrator::Points;

  virtual ~SphereDerivatives() = default;
  virtual int parameters() const = 0;
  /// end <- where the step from z leads to, by <- its derivatives, 6 k x (6 k + parameters). False where it does not
  /// converge.
  virtual bool step(const Points& z, const SphereStep& step, Points& end, Eigen::MatrixXd& by) = 0;
  /// The derivatives of the point z in another form.
  virtual Eigen::MatrixXd in_form(const Points& z, SphereForm from, SphereForm to) const = 0;
  /// The bobs, the directions, the velocities or the momenta, and what the system keeps, with their derivatives.
  virtual NodeValues observe(const Points& z) const = 0;
};

}  // namespace lagroid
