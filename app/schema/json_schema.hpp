#pragma once
/// Declared keys as a JSON Schema, draft 2020-12.

#include "../keys/key.hpp"

#include <nlohmann/json.hpp>

namespace lagroid::app {

/// What the table may hold. Nothing is referred to, so that any part of it stands by itself.
nlohmann::ordered_json json_schema(const Table& table);

}  // namespace lagroid::app
