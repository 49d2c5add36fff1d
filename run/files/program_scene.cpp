#include <lagroid/run/files/program_scene.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lagroid {

namespace {

constexpr std::string_view of_a_program = "# a run of a program of one's own";

}  // namespace

bool is_of_a_program(std::string_view scene) { return scene.starts_with(of_a_program); }

std::string scene_of_program(const ProgramRun& run) {
  if (const std::string problem = text_problem(run.name); !problem.empty())
    throw std::invalid_argument(fmt::format("RunOptions::name: {}", problem));
  for (const auto& numbers : {run.object, run.momentum, run.configuration})
    if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }))
      throw std::invalid_argument(
          fmt::format("the start of a run must be finite, got object [{}], momentum [{}], configuration [{}]",
                      fmt::join(run.object, ", "), fmt::join(run.momentum, ", "), fmt::join(run.configuration, ", ")));
  return fmt::format(
      "{}\nname = {}\nmethod = {}\nstep = {:.17g}\nevery = {}\nsystem = [{:.17g}]\nobject = [{:.17g}]\nmomentum = "
      "[{:.17g}]\nconfiguration = [{:.17g}]\n",
      of_a_program, nlohmann::json(run.name).dump(), nlohmann::json(run.method).dump(), run.step, run.every,
      fmt::join(run.marks, ", "), fmt::join(run.object, ", "), fmt::join(run.momentum, ", "),
      fmt::join(run.configuration, ", "));
}

}  // namespace lagroid
