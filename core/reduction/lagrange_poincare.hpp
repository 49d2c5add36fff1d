#pragma once
/// The discrete Lagrange-Poincare equations: those of a discrete Lagrangian on a gauge groupoid that a connection has
/// split (groupoids/split_gauge.hpp), horizontal and vertical apart.
///
///     l(s0, s1, gamma),  X of the fibre, v and w displacements of s0 and s1, m = dl/dX along gamma exp(X)
///
///     vertical     <F-, X> = d l(s0, s1, exp(X) gamma)
///                  <F+, X> = d l(s0, s1, gamma hor exp(X) hor^{-1})
///     horizontal   <F-, v> = -D l(s0 + v, s1, gamma carried parallel) - <m, K-(v)>
///                  <F+, w> =  d l(s0, s1 + w, gamma)                  + <m, K+(w)>
///
/// with hor the horizontal arrow from s0 to s1, K- and K+ the derivatives of the holonomies s0 + v -> s0 -> s1 -> s0 +
/// v and s0 -> s1 -> s1 + w -> s0: the curvature. The equations are F+ of an arrow = F- of the next, part by part, and
/// together those of the unsplit system ([G] (5)).
///
///     const auto into = leaving(split, step);  // split: a system on a SplitGauge, PulledBack along Unsplit
///     const auto from = entering(split, next);
///     const bool solved = into.horizontal.isApprox(from.horizontal) && into.vertical.isApprox(from.vertical);
///
/// (Marsden, Leok & Weinstein as there; on Atiyah groupoids: Marrero, Martin de Diego & Martinez, Discrete Lagrangian
/// and Hamiltonian mechanics on Lie groupoids, Nonlinearity 19 (2006).)
/// Required: a variational system without object constraints. Nothing throws.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/system.hpp>

#include <type_traits>

namespace lagroid {

/// A discrete Legendre transform in its parts. `curvature` is contained in `horizontal`.
template <class Split> struct SplitMomentum {
  Vector<double, Split::base_rank> horizontal;
  Vector<double, Split::base_rank> curvature;
  Vector<double, Split::fibre_rank> vertical;
};

namespace detail {

/// The parts at one arrow, all by first derivatives along dual numbers.
template <class Sys> class SplitDerivatives {
 public:
  using Split = typename Sys::GroupoidType;
  using D = Dual<double>;
  using Base = typename Split::Base;
  using Group = typename Split::Group;
  static constexpr int n = Split::base_rank;
  static constexpr int k = Split::fibre_rank;
  static_assert(Variational<Sys> && Sys::object_constraints == 0,
                "Lagrange-Poincare equations are those of a variational system without object constraints");

  SplitDerivatives(const Sys& system, const Step<Sys>& step)
      : system_(system),
        multipliers_(step.multipliers),
        b_(base().template cast<D>(step.arrow.base)),
        gamma_(group().template cast<D>(step.arrow.element)) {
    for (int a = 0; a < k; ++a) along_(a) = along(group().multiply(gamma_, turn(a)));
  }

  SplitMomentum<Split> minus() const {
    SplitMomentum<Split> out;
    for (int a = 0; a < k; ++a) out.vertical(a) = along(group().multiply(turn(a), gamma_));
    const auto at_source = split().vertical(base().source(b_), gamma_);
    for (int i = 0; i < n; ++i) {
      const auto step = base().tau(base().source(b_), infinitesimal(unit_vector<double, n>(i)));
      const auto there = split().horizontal(step);
      const auto back = gauge().inverse(there);
      const auto moved = base().multiply(base().inverse(step), b_);
      const auto carried = split().split(gauge().multiply(gauge().multiply(back, at_source), there)).element;
      const auto loop =
          gauge().multiply(gauge().multiply(back, split().horizontal(b_)), gauge().inverse(split().horizontal(moved)));
      out.curvature(i) = -along_.dot(holonomy(loop));
      out.horizontal(i) = -value(moved, carried).derivative + out.curvature(i);
    }
    return out;
  }
  SplitMomentum<Split> plus() const {
    SplitMomentum<Split> out;
    const auto over = split().horizontal(b_);
    const auto end = base().target(b_);
    for (int a = 0; a < k; ++a) {
      const auto turned =
          gauge().multiply(gauge().multiply(over, split().vertical(end, turn(a))), gauge().inverse(over));
      out.vertical(a) = along(group().multiply(gamma_, split().split(turned).element));
    }
    for (int i = 0; i < n; ++i) {
      const auto step = base().tau(end, infinitesimal(unit_vector<double, n>(i)));
      const auto moved = base().multiply(b_, step);
      const auto loop = gauge().multiply(gauge().multiply(over, split().horizontal(step)),
                                         gauge().inverse(split().horizontal(moved)));
      out.curvature(i) = along_.dot(holonomy(loop));
      out.horizontal(i) = value(moved, gamma_).derivative + out.curvature(i);
    }
    return out;
  }

 private:
  const Split& split() const { return system_.groupoid; }
  const Base& base() const { return split().base(); }
  const Group& group() const { return split().group; }
  const auto& gauge() const { return split().connection.from; }
  /// exp(e_a), e_a infinitesimal.
  auto turn(int a) const { return group().tau(ObjectOf<Group, D>(), infinitesimal(unit_vector<double, k>(a))); }
  /// L + <lambda, phi>.
  D value(const ArrowOf<Base, D>& b, const ArrowOf<Group, D>& gamma) const {
    const ArrowOf<Split, D> g{b, gamma};
    D sum = system_.lagrangian(g);
    if constexpr (Sys::arrow_constraints > 0) {
      const auto phi = system_.constraint(g);
      for (int i = 0; i < Sys::arrow_constraints; ++i) sum += phi(i) * multipliers_(i);
    }
    return sum;
  }
  double along(const ArrowOf<Group, D>& gamma) const { return value(b_, gamma).derivative; }
  /// The derivative of a loop that is a unit, in the algebra of the group.
  template <class A> Vector<double, k> holonomy(const A& loop) const {
    return derivative_of(group().tau_inverse(split().split(loop).element));
  }

  const Sys& system_;
  typename Sys::Multipliers multipliers_;
  ArrowOf<Base, D> b_;
  ArrowOf<Group, D> gamma_;
  Vector<double, k> along_;  ///< m
};

}  // namespace detail

/// F- of an arrow, what enters it at its source, in its parts.
template <class Sys> SplitMomentum<typename Sys::GroupoidType> entering(const Sys& split, const Step<Sys>& step) {
  return detail::SplitDerivatives<Sys>(split, step).minus();
}
/// F+, what leaves it at its target.
template <class Sys> SplitMomentum<typename Sys::GroupoidType> leaving(const Sys& split, const Step<Sys>& step) {
  return detail::SplitDerivatives<Sys>(split, step).plus();
}

}  // namespace lagroid
