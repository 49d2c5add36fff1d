#pragma once
/// Checks at compile time that the optional members of a system (rates, flows, time scale, step arguments, loops,
/// traits) have the signatures that methods look for. A member that does not fit would not be found, and its method
/// silently not offered; with this check it does not compile, and the message names the right signature.

#include <lagroid/core/capabilities/loops.hpp>
#include <lagroid/core/capabilities/rates.hpp>
#include <lagroid/core/capabilities/split_system.hpp>
#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/capabilities/time_scale.hpp>
#include <lagroid/solvers/methods/method.hpp>

namespace lagroid {

namespace detail {
LAGROID_MEMBER_NAME(NamesNudge, nudge);
}  // namespace detail

/// What a method looks for by its name and does not find in the form that it needs would be passed over without a word,
/// and the method not offered. Does not compile where there is such a member. Checked where a system meets a method:
/// wherever implicit steps are made (StepPredictor), and where a solver of boundary values is (make_boundary_solver).
/// Each header of core that names an optional member describes what fits it; what a ledger looks for is checked by
/// `quantities_of`.
template <class Sys> constexpr void require_optional_members_to_fit() {
  static_assert(rates_fit<Sys>,
                "rates(z) is there but does not fit: a const function of a State<G> that returns Rates<G>, of a system "
                "with a step h (see HasRates)");
  static_assert(flows_fit<Sys>,
                "parts or flow<I>(t, q, mu) is there but does not fit: `static constexpr int parts` counts them, and "
                "each is a const template on I and the scalar that returns FlowOf<G, S>, of a system with a step h "
                "(see SplitSystem)");
  static_assert(attraction_fits<Sys>,
                "attractive is declared, but the system has not two flows, kinetic_energy(mu) and potential_energy(q) "
                "(see AttractiveSystem)");
  static_assert(time_scale_fits<Sys>,
                "time_scale_rate(z) is there but does not fit: a const function of a State<G> that returns a double "
                "(see HasTimeScale)");
  static_assert(step_arguments_fit<Sys>,
                "lagrangian or constraint takes the step as its argument but does not fit: const templates "
                "lagrangian(g, step) and, if there are arrow constraints, constraint(g, step), for steps that are "
                "double or of the arrow's scalar, of a system with a step h (see StepDependent)");
  static_assert(start_arguments_fit<Sys>,
                "lagrangian or constraint takes start and step as its arguments but does not fit: const templates "
                "lagrangian(g, start, step) and, if there are arrow constraints, constraint(g, start, step), for times "
                "that are double or of the arrow's scalar, of a system with a step h and a member time (see "
                "TimeDependent)");
  static_assert(loops_fit<Sys>,
                "loops or loop(q, axis, turns) is there but does not fit: `static constexpr int loops` counts the "
                "numbers of turns, and a const or static loop returns an arrow from q (see Winding)");
  static_assert(
      !detail::NamesNudge<typename Sys::GroupoidType>,
      "the groupoid's nudge(arrow, w) is called correct(arrow, w) since version 0.3: it would be passed over");
  static_assert(traits_fit<Sys>,
                "traits() is there but does not fit: a const or static function that returns MethodTraits");
}

}  // namespace lagroid
