#include <lagroid/run/output_folder.hpp>
#include <lagroid/run/study/methods.hpp>
#include <lagroid/run/study/study.hpp>
#include <lagroid/run/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace lagroid::detail {

Findings study_with_files(Experiment experiment, StudyRequest request, const std::string& methods,
                          const std::filesystem::path& folder, const std::string& of, bool progress) {
  request.methods = matching(methods, experiment.methods);
  std::sort(request.steps.sizes.rbegin(), request.steps.sizes.rend());
  std::optional<OutputFolder> held;
  if (!folder.empty())
    held.emplace(folder_for_study(folder, of, methods, request.steps.sizes, "", request.repetitions));
  Findings findings = study_until_interrupted(std::move(experiment), request, progress);
  findings.scene = "a program of its own";
  findings.command = "study(...)";
  std::string without_pictures;
  if (held) write_study(findings, folder, without_pictures);
  return findings;
}

std::string studied(const std::string& name, double step, long steps, const std::vector<NamedVector>& start) {
  if (const std::string problem = text_problem(name); !problem.empty())
    throw std::invalid_argument(fmt::format("StudyOptions::name: {}", problem));
  if (steps < 1) throw std::invalid_argument(fmt::format("StudyOptions::steps: must be at least 1, got {}", steps));
  std::string out = fmt::format("{}, {} steps of {:.17g}", name, steps, step);
  for (const NamedVector& each : start) out += fmt::format("\n{} {:.17g}", each.name, fmt::join(each.values, " "));
  return out;
}

}  // namespace lagroid::detail
