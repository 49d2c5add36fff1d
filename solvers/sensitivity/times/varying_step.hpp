#pragma once
/// A system whose step size, and start if it depends on time, carry derivatives as its parameters do: L(g, t, h) over
/// numbers that are varied along h and t.
///
///     VaryingStep<Kepler> kepler{Kepler()};
///     const std::vector<const double*> members{&kepler.h};
///     linearise_step(kepler, step, members, linear);
///
/// Requires a system that takes its step as an argument. Forces that do not may read it as a plain number, which is for
/// who differentiates to find out. Nothing throws.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/scalars/varied.hpp>

#include <type_traits>

namespace lagroid {

/// A system whose step size and start are varied as its parameters are.
template <DiscreteSystem Sys> struct VaryingStep : Sys {
  explicit VaryingStep(const Sys& system) : Sys(system) {}
  /// It hides the functions that take the step: what looks for them has to look there.
  Sys& plain() { return *this; }
  const Sys& plain() const { return *this; }

  template <class A> auto lagrangian(const A& g) const {
    using S = std::remove_cvref_t<decltype(plain().lagrangian(g))>;
    return S(over_step<S>([&](const auto&... times) { return plain().lagrangian(g, times...); }));
  }
  template <class A> auto constraint(const A& g) const requires(Sys::arrow_constraints > 0) {
    using S = std::remove_cvref_t<decltype(plain().constraint(g)(0))>;
    return Vector<S, Sys::arrow_constraints>(
        over_step<S>([&](const auto&... times) { return plain().constraint(g, times...); }));
  }
  template <class A> auto forces(const A& g) const requires Forced<Sys> {
    using S = std::remove_cvref_t<decltype(plain().forces(g).source(0))>;
    if constexpr (
        requires { plain().forces(g, this->h); } || requires { plain().forces(g, this->h, this->h); }) {
      return over_step<S>([&](const auto&... times) { return plain().forces(g, times...); });
    } else {
      return plain().forces(g);  // which may read the step: it is compared
    }
  }

 private:
  /// f(h), or f(t, h) of a system that depends on time.
  template <class S, class F> auto over_step(const F& f) const {
    const S step = constant<S>(varied<S>(this->h));
    if constexpr (TimeDependent<Sys>) {
      return f(constant<S>(varied<S>(this->time)), step);
    } else {
      return f(step);
    }
  }
};

}  // namespace lagroid
