#pragma once
/// The source fibre of a groupoid as a Ceres manifold.

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
