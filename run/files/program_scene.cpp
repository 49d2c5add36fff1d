#include <lagroid/run/files/program_scene.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace lagroid {

namespace {

constexpr std::string_view of_a_program = "# a run of a program of one's own";

}  // namespace

bool is_of_a_program(std::string_view scene) { return scene.starts_with(of_a_program); }

void require_name_and_start(std::string_view option, std::string_view name, std::string_view what,
                            std::span<const NamedVector> start) {
  if (const std::string problem = text_problem(name); !problem.empty())
    throw std::invalid_argument(fmt::format("{}: {}", option, problem));
  for (const NamedVector& each : start)
    if (!std::all_of(each.values.begin(), each.values.end(), [](double x) { return std::isfinite(x); }))
      throw std::invalid_argument(
          fmt::format("the start of {} must be finite, got {} [{}]", what, each.name, fmt::join(each.values, ", ")));
}

std::string scene_of_program(const ProgramRun& run) {
  const auto numbers = [](std::span<const double> of) { return std::vector<double>(of.begin(), of.end()); };
  const std::vector<NamedVector> start{{"object", numbers(run.object)},
                                       {"momentum", numbers(run.momentum)},
                                       {"configuration", numbers(run.configuration)}};
  require_name_and_start("RunOptions::name", run.name, "a run", start);
  return fmt::format(
      "{}\nname = {}\nmethod = {}\nstep = {:.17g}\nevery = {}\nsystem = [{:.17g}]\nobject = [{:.17g}]\nmomentum = "
      "[{:.17g}]\nconfiguration = [{:.17g}]\n",
      of_a_program, nlohmann::json(run.name).dump(), nlohmann::json(run.method).dump(), run.step, run.every,
      fmt::join(run.marks, ", "), fmt::join(run.object, ", "), fmt::join(run.momentum, ", "),
      fmt::join(run.configuration, ", "));
}

}  // namespace lagroid
