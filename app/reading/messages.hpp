#pragma once
/// What messages about a scene say of what stands in it.

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// The word that was probably meant, by edit distance; empty where none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& words);

/// "a string", "a table", ...
std::string type_name(const toml::node& node);

/// The beginning of a text that may be very long.
std::string shortened(const std::string& text);

}  // namespace lagroid::app
