#pragma once
/// A folder of output files, each there whole or not at all.

#include <filesystem>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// Something that a command puts out cannot be written.
class OutputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A folder that holds no run, or one that cannot be shown or taken up. The message is one line with the remedy.
class RunError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws OutputError, with the remedy, unless `folder` can be created and `files` be written there. Leaves nothing
/// behind.
void require_writable(const std::filesystem::path& folder, std::span<const char* const> files);

/// `make` writes files into the folder it is given and returns their names; they are then renamed into `folder`, so
/// that each is there whole or not at all. Those of `files`, all that the command can make, that were not made this
/// time are removed, and what killed runs left half-written. Returns the files written.
std::vector<std::filesystem::path> write_whole(
    const std::filesystem::path& folder, std::span<const char* const> files,
    const std::function<std::vector<std::string>(const std::filesystem::path&)>& make);

/// Throws OutputError where the disk is full.
void write_text(std::string_view text, const std::filesystem::path& file);

/// Runs gnuplot on `script` in `folder`. Empty, or the reason why one of the pictures is missing.
std::string run_gnuplot(const std::filesystem::path& folder, const std::string& script,
                        const std::vector<std::string>& pictures);

}  // namespace lagroid::app
