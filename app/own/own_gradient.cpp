#include "own_gradient.hpp"

#include "../command/command.hpp"
#include "../poisson/bracket_gradient.hpp"

#include <utility>

namespace lagroid::app {

int own_gradient_program(int argc, char** argv, OwnSystems systems, std::vector<AskGradient> subjects) {
  if (const std::string why = refusal_of(systems); !why.empty())
    return refuse(asks_for_json(argc, argv), exit_internal_error, "invalid_program", why);
  const PoissonFamily brackets(systems.brackets);
  // First: systems on groupoids refuse scenes of other kinds.
  subjects.insert(subjects.begin(), [&](const Section& scene) -> std::optional<GradientSubject> {
    const PoissonEntry* entry = brackets.entry_of(scene);
    if (entry == nullptr) return std::nullopt;
    return bracket_gradient(*entry, scene);
  });
  return gradient_program(argc, argv, {{&systems_family(), &brackets}, std::move(systems.systems), {}}, subjects);
}

}  // namespace lagroid::app
