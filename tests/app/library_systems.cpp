// Tests that read scenes in their own process know what the whole program knows.
#include <program.hpp>
#include <whole_program.hpp>

namespace app_library_systems_tests {
namespace {

const bool known = [] {
  lagroid::app::ProgramParts parts = lagroid::app::whole_program();
  lagroid::app::use_families(parts.families);
  lagroid::app::use_systems(parts.systems);
  return true;
}();

}  // namespace
}  // namespace app_library_systems_tests
