#pragma once
/// The source fibre of a groupoid as a manifold of Ceres: Plus(g, w) = g tau(w), Minus(h, g) = tau^{-1}(g^{-1} h). With
/// it arrows of any groupoid are parameter blocks of a Ceres problem.
///
///     Vector<double, SourceFibreManifold<SO3>::ambient> arrow;  // coordinates_of_arrow of the first guess
///     ceres::Problem problem;
///     problem.AddParameterBlock(arrow.data(), int(arrow.size()), new SourceFibreManifold<SO3>);
///
/// Requires arrows in arrow coordinates, the source of which Plus does not change, and Ceres' headers. Plus and Minus
/// return false where the result is not finite.

#include <lagroid/solvers/newton/fibre_coordinates.hpp>

#include <ceres/manifold.h>

namespace lagroid {

template <Groupoid G> class SourceFibreManifold final : public ceres::Manifold, public SourceFibreCoordinates<G> {
 public:
  using Coordinates = SourceFibreCoordinates<G>;
  using Coordinates::Coordinates;

  int AmbientSize() const override { return Coordinates::ambient; }
  int TangentSize() const override { return Coordinates::tangent; }

  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    return this->plus(x, delta, x_plus_delta);
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<typename Coordinates::ToAmbient> out(jacobian);
    out = this->frame(this->arrow(x));
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    return this->minus(y, x, y_minus_x);
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<typename Coordinates::ToTangent> out(jacobian);
    out = this->coframe(this->arrow(x));
    return true;
  }
};

}  // namespace lagroid
