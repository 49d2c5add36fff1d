// Tests that read scenes in their own process know the library's systems, as the program does.
#include <systems/library_systems.hpp>

namespace {

const bool known = [] {
  lagroid::app::use_systems(lagroid::app::library_systems());
  return true;
}();

}  // namespace
