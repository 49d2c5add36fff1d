#pragma once
/// Systems known for every step size, L(g, h), and systems that depend on time, L(g, t, h).
///
/// Steps of varying size, composition methods, free time and driven motions need the step, or its start, as an
/// argument.
///
///     template <class S, class T> S lagrangian(const Arrow<S>& g, const T& step) const {
///       return (g.target - g.source).squaredNorm() * 0.5 / step;
///     }
///     template <class S> S lagrangian(const Arrow<S>& g) const { return lagrangian(g, h); }
///
/// Requires T = double and T = S, negative steps too, and a member `h` (and `time`, for a system that depends on it).
/// Such functions of another form fail `step_arguments_fit` or `start_arguments_fit`. Nothing throws.

#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/core/system.hpp>

namespace lagroid {

/// A system that also writes, with the step size as an argument of any scalar,
///
///     S lagrangian(const Arrow<S>& g, const T& step) const
///     Vector<S, ArrowConstraints> constraint(const Arrow<S>& g, const T& step) const      if there are any
///
/// equal to lagrangian(g) and constraint(g) at step = h. `T` is double or S. Negative steps run backwards; a
/// discretisation is *self-adjoint*, hence of even order, when L(g^{-1}, -h) = -L(g, h) and phi(g^{-1}, -h) =
/// -phi(g, h) up to the sign of each component.
template <class Sys>
concept StepDependent = HasTimeStep<Sys> &&
    requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g, double step) {
  { system.lagrangian(g, step) } -> std::convertible_to<double>;
  requires Sys::arrow_constraints == 0 || requires {
    { system.constraint(g, step) } -> ColumnOf<Sys::arrow_constraints>;
  };
};

/// A system whose Lagrangian depends on the time at which an arrow starts: a driven motion. It writes
///
///     S lagrangian(const Arrow<S>& g, const T& start, const T& step) const
///     Vector<S, ArrowConstraints> constraint(const Arrow<S>& g, const T& start, const T& step) const
///
/// and holds the start of the next arrow in a member `double time`, at which lagrangian(g) and constraint(g) are taken.
template <class Sys>
concept TimeDependent = HasTimeStep<Sys> &&
    requires(Sys& system, const ArrowOf<typename Sys::GroupoidType>& g, double start, double step) {
  { system.lagrangian(g, start, step) } -> std::convertible_to<double>;
  requires Sys::arrow_constraints == 0 || requires {
    { system.constraint(g, start, step) } -> ColumnOf<Sys::arrow_constraints>;
  };
  system.time = 1.0;
};

namespace detail {

/// Members that can be called with these arguments at all, const or not, whatever comes of it.
template <class Sys>
concept SpeaksOfStep = requires(Sys& system, const ArrowOf<typename Sys::GroupoidType>& g, double step) {
  system.lagrangian(g, step);
}
|| requires(Sys& system, const ArrowOf<typename Sys::GroupoidType>& g, double step) { system.constraint(g, step); };
template <class Sys>
concept SpeaksOfStart = requires(Sys& system, const ArrowOf<typename Sys::GroupoidType>& g, double start, double step) {
  system.lagrangian(g, start, step);
}
|| requires(Sys& system, const ArrowOf<typename Sys::GroupoidType>& g, double start, double step) {
  system.constraint(g, start, step);
};

/// Whether these functions take a step (and a start) with derivatives, beside arrows that have them.
using SteppedScalar = Jet<double, 1>;
template <class Sys, class... Times>
concept TakesTimes = requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType, SteppedScalar>& g,
                              const Times&... times) {
  { system.lagrangian(g, times...) } -> std::convertible_to<SteppedScalar>;
  requires Sys::arrow_constraints == 0 || requires { system.constraint(g, times...); };
};
template <class Sys>
concept BearsStep = TakesTimes<Sys, double> && TakesTimes<Sys, SteppedScalar>;
template <class Sys>
concept BearsStart = TakesTimes<Sys, double, double> && TakesTimes<Sys, SteppedScalar, SteppedScalar>;

}  // namespace detail

/// Whether functions that take the step, or start and step, are those of a system of that kind, where there are any.
template <class Sys>
inline constexpr bool step_arguments_fit = StepDependent<Sys> ? detail::BearsStep<Sys> : !detail::SpeaksOfStep<Sys>;
template <class Sys>
inline constexpr bool start_arguments_fit = TimeDependent<Sys> ? detail::BearsStart<Sys> : !detail::SpeaksOfStart<Sys>;

/// The time at which a system's next arrow starts: zero where it depends on none.
template <class Sys> double start_time(const Sys& system) {
  if constexpr (TimeDependent<Sys>) {
    return system.time;
  } else {
    return 0;
  }
}
template <class Sys> void set_time(Sys& system, double time) {
  if constexpr (TimeDependent<Sys>) system.time = time;
}

/// What can be extended by time: a variational system of either kind.
template <class Sys>
concept Timed = DiscreteSystem<Sys> && Variational<Sys> &&(StepDependent<Sys> || TimeDependent<Sys>);

/// L over a step, and phi, of a system of either kind.
template <Timed Sys, class A, class T>
auto lagrangian_over(const Sys& system, const A& g, const T& start, const T& step) {
  if constexpr (TimeDependent<Sys>) {
    return system.lagrangian(g, start, step);
  } else {
    return system.lagrangian(g, step);
  }
}
template <Timed Sys, class A, class T>
auto constraint_over(const Sys& system, const A& g, const T& start, const T& step) {
  if constexpr (TimeDependent<Sys>) {
    return system.constraint(g, start, step);
  } else {
    return system.constraint(g, step);
  }
}

}  // namespace lagroid
