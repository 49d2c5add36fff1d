#pragma once
/// By which of the declared methods a system can be marched.

#include <lagroid/core/rates.hpp>
#include <lagroid/core/split_system.hpp>
#include <lagroid/core/stepped.hpp>
#include <lagroid/solvers/declared_methods.hpp>
#include <lagroid/solvers/splitting.hpp>
#include <lagroid/solvers/step_control.hpp>
#include <lagroid/solvers/transformed.hpp>

namespace lagroid {

/// What `Sys` has for methods to use; `system` says which splittings suit it.
template <class Sys> Abilities abilities_of(const Sys& system) {
  Abilities able{.variational = Variational<Sys>,
                 .has_step = HasTimeStep<Sys>,
                 .timed = Timed<Sys>,
                 .time_scale = Timed<Sys> && HasTimeScale<Sys>,
                 .rates = HasRates<Sys>,
                 .attractive = AttractiveSystem<Sys>};
  if constexpr (SplitSystem<Sys>) {
    for (const Composition& each : compositions_of(OtherOrders::composed_flows))
      if (splits_by(system, each)) able.splittings.push_back(each);
  }
  return able;
}

}  // namespace lagroid
