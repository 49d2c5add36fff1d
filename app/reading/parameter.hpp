#pragma once
/// A key of a scene, as listings show it.

#include <string_view>

namespace lagroid::app {

struct Parameter {
  std::string_view name;
  std::string_view unit;
  std::string_view fallback;  ///< empty where the key must be given
  std::string_view meaning;
};

}  // namespace lagroid::app
