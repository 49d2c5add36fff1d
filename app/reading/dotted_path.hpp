#pragma once
/// Dotted paths in a scene, as in bodies.0.mass: a name is a key of a table, a number counts in an array from 0.

#include <toml++/toml.h>

#include <string>
#include <vector>

namespace lagroid::app {

/// What stands at a dotted path, or null.
const toml::node* node_at(const toml::table& root, const std::string& path);

/// Puts a value at a dotted path; what is missing on the way becomes a table, a number counts in an array. Messages
/// call it by `overrider` and the path.
void override_at(toml::table& root, const std::string& path, const toml::node& value, const std::string& overrider);

/// All that stands in a table and below it, as "path=value".
std::vector<std::string> leaves_of(const toml::table& table);

}  // namespace lagroid::app
