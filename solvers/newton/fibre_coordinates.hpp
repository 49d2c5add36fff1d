#pragma once
/// The source fibre of a groupoid as a manifold in the coordinates of its arrows:
///
///     plus(g, w) = g tau(w),    minus(h, g) = tau^{-1}(g^{-1} h),    frame(g) w = d/dt g tau(t w).
///
/// All uses of Ceres go through it; it knows nothing of Ceres itself. `plus` and `minus` return false where the result
/// is not finite.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/matrices/regular_inverse.hpp>

#include <utility>

namespace lagroid {

/// Points: arrows with a fixed source, in arrow coordinates. plus(g, w) = g tau(w), minus(h, g) = tau^{-1}(g^{-1} h).
/// As in NewtonStep, points are not projected: that would move the source, and arrows that nothing moves. plus(g, 0)
/// is g to the bit, because by the distance from g to plus(g, -gradient) Ceres judges whether it has arrived.
template <Groupoid G> class SourceFibreCoordinates {
 public:
  static constexpr int ambient = G::arrow_coordinate_count();
  static constexpr int tangent = G::dimension;
  using Ambient = Vector<double, ambient>;
  using Tangent = Vector<double, tangent>;
  /// By rows, as Ceres wants them.
  using ToAmbient = Eigen::Matrix<double, ambient, tangent, tangent == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
  using ToTangent = Eigen::Matrix<double, tangent, ambient, ambient == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

  explicit SourceFibreCoordinates(G groupoid = {}) : groupoid_(std::move(groupoid)) {}

  /// False where the result is not finite.
  bool plus(const double* x, const double* delta, double* x_plus_delta) const {
    const Tangent w = Eigen::Map<const Tangent>(delta);
    Eigen::Map<Ambient> out(x_plus_delta);
    out = Eigen::Map<const Ambient>(x);
    if (!w.isZero(0)) out = groupoid_.coordinates_of_arrow(groupoid_.extend(arrow(x), w));
    return out.allFinite();
  }
  bool minus(const double* y, const double* x, double* y_minus_x) const {
    Eigen::Map<Tangent> out(y_minus_x);
    out = groupoid_.tau_inverse(groupoid_.multiply(groupoid_.inverse(arrow(x)), arrow(y)));
    return out.allFinite();
  }

  /// The left-invariant fields of the basis of AG at g, column by column, in arrow coordinates.
  ToAmbient frame(const ArrowOf<G>& g) const {
    ToAmbient f;
    for (int i = 0; i < tangent; ++i) {
      const Ambient field = groupoid_.left_invariant(g, unit_vector<double, tangent>(i));
      for (int j = 0; j < ambient; ++j) f(j, i) = field(j);
    }
    return f;
  }
  /// The left inverse of `frame` of least norm: turns a derivative along the fibre into one in arrow coordinates.
  ToTangent coframe(const ArrowOf<G>& g) const {
    const ToAmbient f = frame(g);
    Matrix<double, tangent, tangent> gram;
    for (int i = 0; i < tangent; ++i)
      for (int j = 0; j < tangent; ++j) {
        gram(i, j) = 0;
        for (int k = 0; k < ambient; ++k) gram(i, j) += f(k, i) * f(k, j);
      }
    const Matrix<double, tangent, tangent> inverse = regular_inverse(gram);
    ToTangent out;
    for (int i = 0; i < tangent; ++i)
      for (int k = 0; k < ambient; ++k) {
        out(i, k) = 0;
        for (int j = 0; j < tangent; ++j) out(i, k) += inverse(i, j) * f(k, j);
      }
    return out;
  }
  ArrowOf<G> arrow(const double* x) const {
    return groupoid_.template arrow_at<double>(Ambient(Eigen::Map<const Ambient>(x)));
  }

 private:
  G groupoid_;
};

}  // namespace lagroid
