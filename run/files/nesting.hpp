#pragma once
/// How deep files nest: their readers are recursive, so that one that nests deeply enough would overflow the stack. The
/// depth is checked before.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string_view>

namespace lagroid {

/// Tables and arrays inside each other.
inline constexpr std::size_t most_nested = 100;

/// Whether a value of the TOML text lies deeper than `most_nested`; each part of a dotted key is a table.
bool toml_nests_too_deep(std::string_view text);

/// What the text holds; none where it is no JSON, or nests deeper than `most_nested`.
std::optional<nlohmann::ordered_json> read_json(std::string_view text);
/// The same of CBOR.
std::optional<nlohmann::json> parse_cbor(std::string_view bytes);

}  // namespace lagroid
