#pragma once
/// The methods for Poisson systems, each declared once: what scenes, studies and citations know of it.
///
///     const DeclaredMethod* method = poisson_methods::named("hamilton-jacobi-4");  // null where there is none
///
/// Nothing throws.

#include <lagroid/solvers/methods/declared_methods.hpp>

#include <array>
#include <string_view>

namespace lagroid::poisson_methods {

inline constexpr Source groupoid_source{"cosserat2024", "Poisson integrators from local symplectic groupoids"};

/// The step by the chart that costs least: in closed form where the bracket has one.
inline constexpr DeclaredMethod groupoid{
    .name = "symplectic-groupoid", .other_orders = OtherOrders::composed_steps, .source = groupoid_source};
/// By Karasev's chart, where that is another one.
inline constexpr DeclaredMethod karasev{
    .name = "karasev", .other_orders = OtherOrders::composed_steps, .source = groupoid_source};
inline constexpr DeclaredMethod hamilton_jacobi_4{
    .name = "hamilton-jacobi-4", .order = 4, .stages = 2, .source = groupoid_source};
inline constexpr DeclaredMethod hamilton_jacobi_6{
    .name = "hamilton-jacobi-6", .order = 6, .stages = 6, .source = groupoid_source};
/// Where the energy is a sum of functions of linear forms.
inline constexpr DeclaredMethod splitting{.name = "splitting", .other_orders = OtherOrders::composed_steps};
/// By trees of up to three orders: Poisson up to h^5 in a step.
inline constexpr DeclaredMethod truncated{.name = "truncated-groupoid",
                                          .other_orders = OtherOrders::composed_steps,
                                          .source = groupoid_source,
                                          .to_compare = true};
inline constexpr DeclaredMethod midpoint{
    .name = "midpoint", .other_orders = OtherOrders::composed_steps, .to_compare = true};
/// The same, and then back to the old values of the Casimirs.
inline constexpr DeclaredMethod projected{.name = "projected-midpoint", .to_compare = true};
inline constexpr DeclaredMethod runge_kutta{.name = "runge-kutta", .order = 4, .stages = 4, .to_compare = true};

/// Explicit, projected to energy and Casimirs, by a tolerance.
inline constexpr DeclaredMethod extrapolation = extrapolation_method;

inline constexpr std::array all{groupoid,      karasev,   hamilton_jacobi_4, hamilton_jacobi_6, splitting,
                                extrapolation, truncated, midpoint,          projected,         runge_kutta};

constexpr bool by_tolerance(const DeclaredMethod& method) { return method.name == extrapolation.name; }

/// Whether its steps may be driven by noise, whatever system it is of.
constexpr bool takes_noise(const DeclaredMethod& method) {
  return method.name == groupoid.name || method.name == karasev.name || method.name == midpoint.name;
}
/// That of steps with noise.
inline constexpr Source noise_source{"milstein2002", "structure-preserving steps of stochastic Hamiltonian systems"};
inline constexpr Source thermostat_source{"arnaudon2018", "the friction of the thermostat"};

/// Null where there is none of the name.
constexpr const DeclaredMethod* named(std::string_view name) {
  for (const DeclaredMethod& each : all)
    if (each.name == name) return &each;
  return nullptr;
}

}  // namespace lagroid::poisson_methods
