#include <lagroid/solvers/methods.hpp>

namespace lagroid {

std::string composed_name(const std::string& step, const Composition& composition) {
  return composition.stages() > 1 ? step + "/" + std::string(composition.name) : step;
}

std::vector<NamedMethod> named_methods(const Abilities& able) {
  std::vector<NamedMethod> all;
  const auto add = [&](const std::string& step, const MarchOptions& options, bool equal_steps,
                       std::span<const Composition> composed_by) {
    for (const Composition& composition : composed_by) {
      MarchOptions composed = options;
      composed.composition = composition;
      all.push_back({composed_name(step, composition), composition.order, composition.stages(), equal_steps, composed});
    }
  };
  add("variational", {}, true, steps_composed(able.variational));
  add("splitting", {.fixed = StepKind::splitting}, true, able.splittings);
  if (able.rates) all.push_back({"runge-kutta", 4, 4, true, {.fixed = StepKind::runge_kutta}, true});
  if (able.timed) all.push_back({"adaptive", 2, 1, false, {.mode = TimeMode::adaptive}});
  if (able.time_scale) all.push_back({"controlled", 2, 1, false, {.mode = TimeMode::controlled}});
  if (able.attractive) add("transformed", {.mode = TimeMode::transformed}, false, compositions::all);
  return all;
}

}  // namespace lagroid
