#pragma once
/// Files that what is broken off goes on from: each there whole, on the disk, or not at all.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace lagroid {

/// Writes the file as a whole, or leaves the one that was there before. Throws OutputError.
void replace_file(const std::filesystem::path& file, std::string_view bytes);

/// The bytes of a file; none where there is no such file, or it cannot be read.
std::optional<std::string> contents(const std::filesystem::path& file);

/// What bytes amount to: enough to notice that they are others.
std::size_t sum_of(std::string_view bytes);

/// As CBOR after the sum of its bytes. Throws OutputError.
void replace_by_cbor(const std::filesystem::path& file, const nlohmann::json& json);

/// What `replace_by_cbor` wrote; none where that is missing or damaged.
std::optional<nlohmann::json> read_cbor(const std::filesystem::path& file);

}  // namespace lagroid
