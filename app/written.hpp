#pragma once
/// What a command says of the files that it wrote.

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

/// Adds the files, and why there are no pictures where `note` is not empty, to the text and to the JSON object's
/// "files" and "notes".
void tell_written(const std::vector<std::filesystem::path>& files, const std::string& note, std::string& text,
                  nlohmann::ordered_json& json);

}  // namespace lagroid::app
