#include "registry.hpp"

namespace lagroid::app {

RunResult run_scene(const Section& scene, const RunContext& context) {
  return with_system_of(scene, [&](const auto& entry) { return entry.read(scene, context).run(nullptr); });
}

std::vector<SystemSummary> list_systems() {
  std::vector<SystemSummary> out;
  for_each_system([&]<class Sys>(const Entry<Sys>& entry) {
    SystemSummary s{
        std::string(entry.name), std::string(entry.summary), Sys::GroupoidType::name(), entry.parameters, {}, {}};
    const Sys system;
    if constexpr (requires { system.symmetries(); })
      for (const auto& symmetry : system.symmetries()) s.symmetries.push_back(symmetry.name);
    for (const auto& quantity : system.quantities())
      if (quantity.promise == Promise::conserved) s.conserved.push_back(quantity.name);
    out.push_back(std::move(s));
  });
  return out;
}

}  // namespace lagroid::app
