#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/files/program_scene.hpp>
#include <lagroid/run/study/methods.hpp>
#include <lagroid/run/study/study.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
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

void require_study(const StudyRequest& request, double step, long steps) {
  const auto require = [](bool holds, const char* what, const char* rule, double got) {
    if (!holds) throw std::invalid_argument(fmt::format("{}: must be {}, got {}", what, rule, got));
  };
  const auto positive = [&](const char* what, double x) {
    require(std::isfinite(x) && x > 0, what, "positive and finite", x);
  };
  positive("the system's step h", step);
  require(steps >= 1, "StudyOptions::steps", "at least 1", double(steps));
  for (const double size : request.steps.sizes) positive("StudyOptions::step_sizes", size);
  positive("StudyOptions::longest", request.steps.longest);
  positive("StudyOptions::target", request.target);
  positive("StudyOptions::budget", request.budget);
  require(request.repetitions >= 1, "StudyOptions::repetitions", "at least 1", request.repetitions);
}

std::string studied(const std::string& name, double step, long steps, const std::vector<NamedVector>& start) {
  require_name_and_start("StudyOptions::name", name, "a study", start);
  std::string out = fmt::format("{}, {} steps of {:.17g}", name, steps, step);
  for (const NamedVector& each : start) out += fmt::format("\n{} {:.17g}", each.name, fmt::join(each.values, " "));
  return out;
}

}  // namespace lagroid::detail
