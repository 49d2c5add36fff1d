#pragma once
/// Pages that are written by a program, from a template with marks.

#include <filesystem>
#include <string>

namespace bench {

std::string file_contents(const std::string& path);
/// Replaces the mark. Throws std::runtime_error where there is none.
void put(std::string& page, const std::string& mark, const std::string& text);
/// Processor, compiler, instruction set, versions, date.
std::string machine();
/// Replaces the file by the text, or leaves it as it is and throws.
void write_whole(const std::filesystem::path& file, const std::string& text);

}  // namespace bench
