#include <lagroid/run/files/checkpoint.hpp>
#include <lagroid/run/run.hpp>

#include <fmt/format.h>

#include <stdexcept>

namespace lagroid {

namespace detail {

std::vector<std::string> numbered(std::string_view head, std::size_t count) {
  if (count == 1) return {std::string(head)};
  std::vector<std::string> out;
  for (std::size_t i = 1; i <= count; ++i) out.push_back(fmt::format("{}{}", head, i));
  return out;
}

void require_counts(long steps, long every) {
  if (steps < 0) throw std::invalid_argument(fmt::format("RunOptions::steps: must not be negative, got {}", steps));
  if (every < 1) throw std::invalid_argument(fmt::format("RunOptions::every: must be at least 1, got {}", every));
}

void run_with_files(RunResult& result, const std::filesystem::path& folder, bool resume, const std::string& scene,
                    const std::function<void(const RunContext&)>& go) {
  if (folder.empty()) {
    if (resume) throw RunError("RunOptions::resume: give the folder of the run to go on with");
    go({.record = true});
    return;
  }
  const OutputFolder held = resume ? folder_of_run(folder) : folder_for_run(folder, scene);
  if (resume) {
    if (Checkpoint::text_of(folder) != scene)
      throw RunError(fmt::format(
          "{}: holds a run of another system, parameter, start, step, method or RunOptions::every; give another "
          "folder, or run anew",
          folder.string()));
    Checkpoint::require_this_build(folder, false);
  }
  go({.record = true, .folder = folder, .resume = resume});
  write_outputs_if_possible(result, folder);
}

}  // namespace detail

}  // namespace lagroid
