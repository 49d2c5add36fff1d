#pragma once
/// Files from which an interrupted computation goes on: each is replaced as a whole, or stays as it was before.
///
/// Whatever moment a process is killed at, the file that is found afterwards is one that was written completely.
///
///     replace_by_cbor("state.cbor", {{"step", 17}});
///     const auto state = read_cbor("state.cbor");  // nothing where the file is missing or damaged
///
/// Errors: OutputError where the file cannot be written.

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

/// A checksum of bytes, to notice that they were changed.
std::size_t sum_of(std::string_view bytes);

/// Replaces the file by the JSON as CBOR, after its checksum. Throws OutputError.
void replace_by_cbor(const std::filesystem::path& file, const nlohmann::json& json);

/// What `replace_by_cbor` wrote; none where that is missing or damaged.
std::optional<nlohmann::json> read_cbor(const std::filesystem::path& file);

}  // namespace lagroid
