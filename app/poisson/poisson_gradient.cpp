#include "../gradient/system_gradients.hpp"
#include "bracket_gradient.hpp"

namespace lagroid::app {

std::optional<GradientSubject> poisson_gradient(const Section& scene) {
  const PoissonEntry* entry = library_brackets().entry_of(scene);
  if (entry == nullptr) return std::nullopt;
  return bracket_gradient(*entry, scene);
}

}  // namespace lagroid::app
