#pragma once
/// Rotations of the plane about the origin: its pair groupoid, reduced by them.
///
///     (q0, q1)  ->  (|q0|, |q1|, R),    R the rotation by the angle from q0 to q1
///
/// The gauge groupoid of the plane without its origin under SO(2), in polar coordinates: the trivial groupoid of the
/// half-line and SO(2). A planar system with rotational symmetry becomes one of the radius and an angle that itself
/// does not appear; fixing its momentum leaves the radius alone (core/reduction/momentum_level.hpp). At the origin the
/// rotations leave a point where it is, and `free_at` is false.

#include <lagroid/core/morphism.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/trivial.hpp>

#include <cmath>
#include <tuple>

namespace lagroid {

struct PolarQuotient : Morphism<PolarQuotient, Pair<2>, Trivial<1, SO2>> {
  template <class S> using Radius = Vector<S, 1>;
  template <class S> using Polar = std::tuple<PairArrow<S, 1>, Matrix<S, 2, 2>>;

  template <class S> Polar<S> operator()(const PairArrow<S, 2>& g) const {
    const S r0 = length(g.source);
    const S r1 = length(g.target);
    const S c = g.source.dot(g.target) / (r0 * r1);
    const S s = (g.source(0) * g.target(1) - g.source(1) * g.target(0)) / (r0 * r1);
    Matrix<S, 2, 2> turn;
    turn << c, -s, s, c;
    return {PairArrow<S, 1>{Radius<S>(r0), Radius<S>(r1)}, turn};
  }
  template <class S> PairArrow<S, 2> lift(const Vector<S, 2>& q, const Polar<S>& g) const {
    const auto& [radius, turn] = g;
    return {q, turn * q * (radius.target(0) / length(q))};
  }
  template <class S> Vector<S, 2> over(const std::tuple<Radius<S>, Vector<S, 0>>& m) const {
    return {std::get<0>(m)(0), S(0.0)};
  }
  template <class S> PairArrow<S, 2> representative(const Polar<S>& g) const {
    const auto& [radius, turn] = g;
    return {Vector<S, 2>(radius.source(0), S(0.0)), turn.col(0) * radius.target(0)};
  }
  /// (q.mu / |q|, q x mu): radial and angular momentum.
  template <class S> Vector<S, 2> reduced_momentum(const Vector<S, 2>& q, const Vector<S, 2>& mu) const {
    return {q.dot(mu) / length(q), q(0) * mu(1) - q(1) * mu(0)};
  }
  bool free_at(const std::tuple<Radius<double>, Vector<double, 0>>& m) const { return std::get<0>(m)(0) > 0; }

 private:
  template <class S> static S length(const Vector<S, 2>& q) {
    using std::sqrt;
    return sqrt(q.squaredNorm());
  }
};

}  // namespace lagroid
