#pragma once
/// Ensembles of some of the library's systems (Pendulum, PlateBall, RigidBody), compiled once; include it in place of
/// solvers/ensemble/ensemble.hpp.
///
///     const std::vector<State<Pair<1>>> initial(1000, {Vector<double, 1>(0.5), Vector<double, 1>(0.0)});
///     Ensemble<Pendulum> pendulums(Pendulum{}, initial);
///     const bool all_steps = pendulums.advance_to(2000);

#include <lagroid/solvers/ensemble/ensemble.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#define LAGROID_ENSEMBLE(prefix, Sys)              \
  prefix class BatchNewton<Sys, widest_batch>;     \
  prefix class BatchIntegrator<Sys, widest_batch>; \
  prefix class Ensemble<Sys, widest_batch>

namespace lagroid {

LAGROID_ENSEMBLE(extern template, Pendulum);
LAGROID_ENSEMBLE(extern template, PlateBall);
LAGROID_ENSEMBLE(extern template, RigidBody);

/// Calls visit.template operator()<Sys>() for each of them.
template <class Visit> void for_each_ensemble_system(const Visit& visit) {
  visit.template operator()<Pendulum>();
  visit.template operator()<PlateBall>();
  visit.template operator()<RigidBody>();
}

}  // namespace lagroid
