#include "system_module.hpp"

namespace lagroid::app {

namespace {

std::vector<const SystemModule*>& known() {
  static std::vector<const SystemModule*> modules;
  return modules;
}

}  // namespace

std::span<const SystemModule* const> system_modules() { return known(); }
void use_systems(std::vector<const SystemModule*> modules) { known() = std::move(modules); }

}  // namespace lagroid::app
