#include <lagroid/run/program_scene.hpp>
#include <lagroid/run/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <stdexcept>

namespace lagroid {

namespace {

constexpr std::string_view of_a_program = "# a run of a program of one's own";

}  // namespace

bool is_of_a_program(std::string_view scene) { return scene.starts_with(of_a_program); }

std::string scene_of_program(const std::string& name, const std::string& method, double step,
                             std::span<const double> object, std::span<const double> momentum,
                             std::span<const double> configuration) {
  if (const std::string problem = text_problem(name); !problem.empty())
    throw std::invalid_argument(fmt::format("RunOptions::name: {}", problem));
  return fmt::format(
      "{}\nname = {}\nmethod = {}\nstep = {:.17g}\nobject = [{:.17g}]\nmomentum = [{:.17g}]\nconfiguration = "
      "[{:.17g}]\n",
      of_a_program, nlohmann::json(name).dump(), nlohmann::json(method).dump(), step, fmt::join(object, ", "),
      fmt::join(momentum, ", "), fmt::join(configuration, ", "));
}

}  // namespace lagroid
