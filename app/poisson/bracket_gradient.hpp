#pragma once
/// The subject of `lagroid gradient`, of a scene of a Poisson system.
///
///     if (const PoissonEntry* entry = family.entry_of(scene)) return bracket_gradient(*entry, scene);
///
/// Errors: SceneError for a mistake in the scene, and for events.

#include "../gradient/gradient_subject.hpp"
#include "poisson_family.hpp"

namespace lagroid::app {

GradientSubject bracket_gradient(const PoissonEntry& entry, const Section& scene);

}  // namespace lagroid::app
