#include "system_module.hpp"

namespace lagroid::app {

namespace {

std::vector<const SystemModule*>& known_modules() {
  static std::vector<const SystemModule*> modules;
  return modules;
}

}  // namespace

std::span<const SystemModule* const> system_modules() { return known_modules(); }
void use_systems(std::vector<const SystemModule*> modules) { known_modules() = std::move(modules); }

}  // namespace lagroid::app
