#pragma once
/// What scenes say of the map tau from the Lie algebra to the group.

#include "../reading/scene_reader.hpp"

#include <lagroid/groupoids/matrix_group.hpp>

#include <string_view>

namespace lagroid::app {

/// exp, which is the default, or cayley.
inline Retraction read_group_map(const Section& parameters, std::string_view key) {
  return parameters.choice_or(key, "exp", {"exp", "cayley"}) == "exp" ? Retraction::exponential : Retraction::cayley;
}

}  // namespace lagroid::app
