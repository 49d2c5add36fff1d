#pragma once
/// What a command reports of the files that it wrote.

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid::app {

/// The exit code of a command that would end with `code`: where a signal came while its files were written or its
/// pictures drawn, that of an interrupt, and one line on standard error that names `what` was being done.
int code_after_writing(int code, const std::string& what);

/// Adds the files, and why there are no pictures where `note` is not empty, to the text and to the JSON object's
/// "files" and "notes".
void tell_written(const std::vector<std::filesystem::path>& files, const std::string& note, std::string& text,
                  nlohmann::ordered_json& json);

}  // namespace lagroid::app
