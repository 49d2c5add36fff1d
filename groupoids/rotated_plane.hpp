#pragma once
/// Rotations of the plane and of all bodies on it about the origin: R^2 x R^2 x SO(3) reduced by them.
///
///     (q0, q1, g)  ->  (|q0|, |q1|, R, rho0^T g rho1),    rho(q) the rotation about e3 that takes e1 to q / |q|
///
/// with R = rho0^T rho1, as an element of SO(2). What rolls on a plate that turns about the origin has this symmetry,
/// where translations are none: K in SO(2) takes (q0, q1, g) to (K q0, K q1, K g K^T). At the origin the rotations
/// leave the point of contact where it is, and `free_at` is false.
///
///     const auto reduced = reduce(RotatedPlaneQuotient{}, plate_ball, arrows);

#include <lagroid/core/morphism.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/polar.hpp>

#include <tuple>

namespace lagroid {

struct RotatedPlaneQuotient : Morphism<RotatedPlaneQuotient, Trivial<2, SO3>, Product<Pair<1>, SO2, SO3>> {
  template <class S> using Full = std::tuple<PairArrow<S, 2>, Matrix<S, 3, 3>>;
  template <class S> using Reduced = std::tuple<PairArrow<S, 1>, Matrix<S, 2, 2>, Matrix<S, 3, 3>>;
  template <class S> using Base = std::tuple<Vector<S, 1>, Vector<S, 0>, Vector<S, 0>>;

  template <class S> Reduced<S> operator()(const Full<S>& g) const {
    const auto& [move, turn] = g;
    const auto [radius, angle] = PolarQuotient()(move);
    return {radius, angle, rho(move.source).transpose() * turn * rho(move.target)};
  }
  template <class S> Full<S> lift(const std::tuple<Vector<S, 2>, Vector<S, 0>>& q, const Reduced<S>& g) const {
    const auto& [radius, angle, turn] = g;
    const PairArrow<S, 2> move = PolarQuotient().lift(std::get<0>(q), {radius, angle});
    return {move, rho(move.source) * turn * rho(move.target).transpose()};
  }
  template <class S> std::tuple<Vector<S, 2>, Vector<S, 0>> over(const Base<S>& m) const {
    return {Vector<S, 2>(std::get<0>(m)(0), S(0.0)), Vector<S, 0>()};
  }
  template <class S> Full<S> representative(const Reduced<S>& g) const {
    const auto& [radius, angle, turn] = g;
    Matrix<S, 3, 3> back = Matrix<S, 3, 3>::Identity();
    back.template topLeftCorner<2, 2>() = angle.transpose();
    return {PolarQuotient().representative(PolarQuotient::Polar<S>{radius, angle}), turn * back};
  }
  bool free_at(const Base<double>& m) const { return std::get<0>(m)(0) > 0; }

 private:
  template <class S> static Matrix<S, 3, 3> rho(const Vector<S, 2>& q) {
    using std::sqrt;
    const Vector<S, 2> e = q / S(sqrt(q.squaredNorm()));
    Matrix<S, 3, 3> out;
    out << e(0), -e(1), S(0.0), e(1), e(0), S(0.0), S(0.0), S(0.0), S(1.0);
    return out;
  }
};

}  // namespace lagroid
