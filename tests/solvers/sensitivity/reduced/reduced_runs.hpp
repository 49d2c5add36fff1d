#pragma once
/// Reduced runs with their derivatives: those of the full steps at the solutions that reduction finds.

#include "../differences.hpp"

#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/solvers/integrators/reduced_integrator.hpp>

#include <cstddef>
#include <memory>
#include <tuple>
#include <type_traits>

namespace lagroid {

inline constexpr long steps_of_reduced = 25;

/// By the reduction that the system declares at that place.
template <std::size_t Place> auto reduced_by(const Composition& composition = compositions::single) {
  return [&composition]<class Sys>(const RunFrom<Sys>& from) {
    const auto declared = std::get<Place>(Sys::reductions());
    using Declared = std::remove_cvref_t<decltype(declared)>;
    const Reconstruction<Sys, Declared> down(declared, from.system, from.start, from.configuration);
    IntegratorOptions options;
    options.composition = composition;
    return std::make_unique<LinearisedMotionOf<Sys>>(
        from.system, std::make_unique<ReducedIntegrator<Sys, Declared>>(down, options), from.names, EndOfRun());
  };
}

}  // namespace lagroid
