#pragma once
/// The alpha-fibre of a groupoid as a Ceres manifold.

#include <lagroid/core/groupoid.hpp>

#include <ceres/manifold.h>
#include <Eigen/LU>

namespace lagroid {

/// Points: arrows with a fixed source, in arrow coordinates. Plus(g, w) = g tau(w), Minus(h, g) = tau^{-1}(g^{-1} h).
/// As in NewtonStep, iterates are not projected: that would move the source, and arrows that nothing moves. Plus(g, 0)
/// is g to the bit, because by the distance from g to Plus(g, -gradient) Ceres judges whether it has arrived.
template <Groupoid G> class AlphaFibreManifold final : public ceres::Manifold {
 public:
  static constexpr int ambient = G::arrow_coordinate_count();
  static constexpr int tangent = G::dimension;
  using Ambient = Vector<double, ambient>;
  using Tangent = Vector<double, tangent>;
  using ToAmbient = Eigen::Matrix<double, ambient, tangent, tangent == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
  using ToTangent = Eigen::Matrix<double, tangent, ambient, ambient == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

  explicit AlphaFibreManifold(G groupoid = {}) : groupoid_(std::move(groupoid)) {}

  int AmbientSize() const override { return ambient; }
  int TangentSize() const override { return tangent; }

  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const Tangent w = Eigen::Map<const Tangent>(delta);
    Eigen::Map<Ambient> out(x_plus_delta);
    out = Eigen::Map<const Ambient>(x);
    if (!w.isZero(0)) out = groupoid_.coordinates_of_arrow(groupoid_.extend(arrow(x), w));
    return out.allFinite();
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<ToAmbient> out(jacobian);
    out = frame(arrow(x));
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Tangent> out(y_minus_x);
    out = groupoid_.tau_inverse(groupoid_.multiply(groupoid_.inverse(arrow(x)), arrow(y)));
    return out.allFinite();
  }
  bool MinusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<ToTangent> out(jacobian);
    out = coframe(arrow(x));
    return true;
  }

  /// The left-invariant fields of the basis of AG at g, column by column, in arrow coordinates.
  ToAmbient frame(const ArrowOf<G>& g) const {
    ToAmbient f;
    for (int i = 0; i < tangent; ++i) f.col(i) = groupoid_.left_invariant(g, Tangent(Tangent::Unit(i)));
    return f;
  }
  /// The left inverse of `frame` of least norm: turns a derivative along the fibre into one in arrow coordinates.
  ToTangent coframe(const ArrowOf<G>& g) const {
    const ToAmbient f = frame(g);
    const Matrix<double, tangent, tangent> gram = f.transpose() * f;
    return gram.inverse() * f.transpose();
  }
  ArrowOf<G> arrow(const double* x) const {
    return groupoid_.template arrow_at<double>(Ambient(Eigen::Map<const Ambient>(x)));
  }

 private:
  G groupoid_;
};

}  // namespace lagroid
