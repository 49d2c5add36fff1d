#pragma once
/// The time-extended groupoid R x R x G => R x Q, arrows (t0, t1, g), and mechanics on it: time is a coordinate, and
/// the step t1 - t0 part of the arrow.
///
/// Steps that depend on the motion, and motions that depend on time, are then steps of an ordinary discrete Lagrangian
/// system, and keep its structure.
///
///     const FreeTime<Sys> free(system);                          // the step is an unknown
///     const FixedStep<Sys> fixed(system, ConstantStep{0.1});     // t1 - t0 = 0.1
///     const auto boundary = timed_boundary<Sys>(g, 0, 0.1, 20);  // from time 0, 20 steps of 0.1
///
/// Requires a variational system that takes its step, or start and step, as arguments (Timed). A step must run forward
/// in time (`admissible`). Nothing throws.
///
/// Source: [G] 6.3, Examples 6.1, 6.2.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>

#include <utility>

namespace lagroid {

/// Arrows (t0, t1, g): a pair of times beside an arrow of G, `const auto& [time, g] = arrow`. Algebroid TR x AG.
/// [G] 6.3
template <class G> using TimeExtended = Product<Pair<1>, G>;

template <class Base> TimeExtended<typename Base::GroupoidType> time_extended(const Base& base) {
  TimeExtended<typename Base::GroupoidType> groupoid;
  std::get<1>(groupoid.factor) = base.groupoid;
  return groupoid;
}

namespace detail {

/// What the systems on R x R x G have in common: L and phi of `base` over the arrow's own step t1 - t0. Times count
/// from `origin`, so that steps do not lose digits late in a run.
template <class Derived, Timed Base, int ExtraConstraints>
struct OnTimeExtended : System<Derived, TimeExtended<typename Base::GroupoidType>,
                               Base::arrow_constraints + ExtraConstraints, Base::object_constraints> {
  template <class S> using Arrow = typename TimeExtended<typename Base::GroupoidType>::template Arrow<S>;
  template <class S> using Times = PairArrow<S, 1>;
  using Untimed = Base;

  Base base;
  double origin = 0;

  explicit OnTimeExtended(Base system) : base(std::move(system)) { this->groupoid = time_extended(base); }

  template <class S> static S step(const Times<S>& time) { return time.target(0) - time.source(0); }
  template <class S, class A> S lagrangian(const std::tuple<PairArrow<S, 1>, A>& g) const {
    const auto& [time, arrow] = g;
    return lagrangian_over(base, arrow, S(time.source(0) + origin), step(time));
  }
  template <class Q> auto object_constraint(const Q& q) const requires(Base::object_constraints > 0) {
    return base.object_constraint(std::get<1>(q));
  }
  /// Time runs forward, on the discretisation's own branch.
  bool admissible(const Arrow<double>& g) const {
    if constexpr (HasBranch<Base>) {
      if (!base.admissible(std::get<1>(g))) return false;
    }
    return step(std::get<0>(g)) > 0;
  }

 protected:
  template <class S, class A> auto base_constraint(const std::tuple<PairArrow<S, 1>, A>& g) const {
    const auto& [time, arrow] = g;
    return Vector<S, Base::arrow_constraints>(constraint_over(base, arrow, S(time.source(0) + origin), step(time)));
  }
};

}  // namespace detail

/// Free time ([G] Example 6.1): the step is an unknown like the arrow, and the equation of the time factor is that of
/// the energy. With E_d = -d(L + <lambda, phi>)/dh its momentum is p_t = -E_d, so that a step keeps E_d where L does
/// not depend on time. (The energy equation as printed in the paper lacks the term <lambda, d phi / dh>.)
template <Timed Base> struct FreeTime : detail::OnTimeExtended<FreeTime<Base>, Base, 0> {
  using detail::OnTimeExtended<FreeTime, Base, 0>::OnTimeExtended;

  template <class S, class A>
  auto constraint(const std::tuple<PairArrow<S, 1>, A>& g) const requires(Base::arrow_constraints > 0) {
    return this->base_constraint(g);
  }
};

/// A prescribed step ([G] Example 6.2 and after): one more constraint, t1 - t0 = h(g), last. `StepSize` gives h(g) as
/// `S operator()(const Base&, const Arrow<S>& g) const`; the equations of motion then contain its derivatives. The
/// method is symmetric when h(g^{-1}) = h(g) and `base` is, and symplectic on the extended phase space always.
template <Timed Base, class StepSize>
struct PrescribedStep : detail::OnTimeExtended<PrescribedStep<Base, StepSize>, Base, 1> {
  StepSize step_size;

  explicit PrescribedStep(Base system, StepSize h)
      : detail::OnTimeExtended<PrescribedStep, Base, 1>(std::move(system)), step_size(std::move(h)) {}

  /// That of `base`, over the step that h(g) gives for it; the multiplier of the step starts from zero.
  Step<PrescribedStep> first_guess(const State<typename PrescribedStep::GroupoidType>& s) const {
    Step<PrescribedStep> guess;
    auto& [time, arrow] = guess.arrow;
    guess.multipliers.setZero();
    const auto& [t, q] = s.object;
    arrow = this->base.groupoid.unit(q);
    if constexpr (HasFirstGuess<Base>) {
      const auto of_base = this->base.first_guess({q, s.momentum.template tail<Base::dimension>()});
      arrow = of_base.arrow;
      guess.multipliers.template head<Base::arrow_constraints>() =
          of_base.multipliers.template head<Base::arrow_constraints>();
      guess.multipliers.template tail<Base::object_constraints>() =
          of_base.multipliers.template tail<Base::object_constraints>();
    }
    time = {t, t + Vector<double, 1>(step_size(this->base, arrow))};
    return guess;
  }

  template <class S, class A> auto constraint(const std::tuple<PairArrow<S, 1>, A>& g) const {
    Vector<S, Base::arrow_constraints + 1> c;
    if constexpr (Base::arrow_constraints > 0) c.template head<Base::arrow_constraints>() = this->base_constraint(g);
    const auto& [time, arrow] = g;
    c(Base::arrow_constraints) = this->step(time) - step_size(this->base, arrow);
    return c;
  }
};

/// h(g) = h.
struct ConstantStep {
  double h;
  template <class Base, class A> double operator()(const Base&, const A&) const { return h; }
};

/// h(g) = epsilon sigma(g), of a system with a `time_scale` of its arrows (HasTimeScaleOfArrows).
struct TimeScaleStep {
  double epsilon = 0;
  template <class Base, class A> auto operator()(const Base& base, const A& g) const {
    return base.time_scale(g) * epsilon;
  }
};

/// Fixed step ([G] Example 6.2). Its constraint does not depend on g, so the equations on G decouple and are those of
/// `base` at the times t_k = t_0 + k h: nothing but the multiplier, the change of p_t in a step, is gained by solving
/// the extended system. The integrator solves the other.
template <Timed Base> using FixedStep = PrescribedStep<Base, ConstantStep>;

/// The boundary arrow of `FixedStep` and its like for a boundary value of `base`: `boundary` from the time `start` on,
/// in so many steps of size h. So boundary values of systems that depend on time are stated and solved.
template <Timed Base>
ArrowOf<TimeExtended<typename Base::GroupoidType>> timed_boundary(const ArrowOf<typename Base::GroupoidType>& boundary,
                                                                  double start, double h, std::size_t steps) {
  using Time = Vector<double, 1>;
  return {PairArrow<double, 1>{Time(start), Time(start + h * double(steps))}, boundary};
}

}  // namespace lagroid
