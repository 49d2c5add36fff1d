#pragma once
/// By which of the declared methods a system can be integrated: its capabilities, as the type of the system shows them.
///
///     const Capabilities able = capabilities_of(Kepler{});
///     const std::string why = why_not({.mode = TimeMode::controlled}, able);  // empty: it can
///     const std::vector<NamedMethod> methods = named_methods(able);

#include <lagroid/core/capabilities/rates.hpp>
#include <lagroid/core/capabilities/split_system.hpp>
#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/capabilities/time_scale_of_arrows.hpp>
#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/solvers/integrators/step_control.hpp>
#include <lagroid/solvers/integrators/transformed.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

namespace lagroid {

/// What `Sys` has for methods to use; which splittings suit it depends on `system`.
template <class Sys> Capabilities capabilities_of(const Sys& system) {
  Capabilities able{.variational = Variational<Sys>,
                    .has_step = HasTimeStep<Sys>,
                    .timed = Timed<Sys>,
                    .time_scale = Timed<Sys> && HasTimeScale<Sys>,
                    .time_scale_of_arrows = HasTimeScaleOfArrows<Sys>,
                    .rates = HasRates<Sys>,
                    .attractive = AttractiveSystem<Sys>};
  if constexpr (SplitSystem<Sys>) {
    for (const Composition& each : compositions_of(OtherOrders::composed_flows))
      if (splits_by(system, each)) able.splittings.push_back(each);
  }
  return able;
}

}  // namespace lagroid
