#include "boundary_value.hpp"

#include <lagroid/solvers/boundary/boundary_words.hpp>

#include <fmt/ranges.h>

#include <limits>

namespace lagroid::app {

MultistartOptions read_multistart(const Section& solver) {
  MultistartOptions options;
  options.starts = int(solver.integer_or("starts", options.starts, 1, 100000));
  options.seed = std::uint64_t(solver.integer_or("seed", long(options.seed), 0, std::numeric_limits<long>::max()));
  return options;
}

BoundaryChoice read_boundary_solver(const Section& solver) {
  BoundaryChoice choice;
  const auto words = words_of(boundary_words);
  choice.method = choice_of(boundary_words, solver.choice_or("method", words.front(), words));
  if (solver.has("seek"))
    choice.stationary_kind = solver.choice("seek", {"minima", "stationary"}) == "minima" ? StationaryKind::minima
                                                                                         : StationaryKind::stationary;
  choice.multistart = read_multistart(solver);
  choice.multistart.amplitude = solver.number_or("amplitude", 0, nonnegative);
  choice.options.tolerance = solver.number_or("tolerance", choice.options.tolerance, positive);
  choice.options.max_iterations = int(solver.integer_or("max_iterations", choice.options.max_iterations, 1, 1000000));
  return choice;
}

std::vector<double> ContinuationChoice::at(double s) const {
  std::vector<double> out(to);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = s == 1 ? to[i] : (1 - s) * from[i] + s * to[i];
  return out;
}

std::string ContinuationChoice::value(double s) const {
  const auto v = at(s);
  return v.size() == 1 ? fmt::format("{:.6g}", v[0]) : fmt::format("[{:.6g}]", fmt::join(v, ", "));
}

Section ContinuationChoice::scene_at(const Section& scene, double s) const {
  return s == 0 || s == 1 ? scene.with(parameter, at(s)) : scene.between(parameter, at(s));
}

std::optional<ContinuationChoice> read_continuation(const Section& scene) {
  if (!scene.has("continuation")) return std::nullopt;
  const Section section = scene.section("continuation", "parameter, from and steps");
  ContinuationChoice choice;
  choice.parameter = section.text("parameter", "a key of this scene, as in \"parameters.plate_rate\"");
  const bool continuable = choice.parameter.starts_with("parameters.") || choice.parameter.starts_with("boundary.") ||
                           choice.parameter == "time.step" || choice.parameter == "time.duration";
  if (!continuable)
    section.fail("parameter", fmt::format("\"{}\" cannot be continued; name a key of [parameters] or [boundary], "
                                          "\"time.step\" or \"time.duration\"",
                                          choice.parameter));
  choice.to = scene.numbers_at(choice.parameter);
  if (choice.to.empty())
    section.fail("parameter", fmt::format("\"{}\" is no number or array of numbers in this scene; give it its final "
                                          "value there",
                                          choice.parameter));
  choice.from = choice.to.size() == 1 && section.is_number("from")
                    ? std::vector{section.number("from")}
                    : section.numbers("from", choice.to.size(), "as many as the parameter has");
  choice.steps = section.integer_or("steps", choice.steps, 1, 100000);
  return choice;
}

bool is_boundary_value(const Section& scene, const std::string& initial) {
  const bool boundary = scene.has("boundary");
  if (scene.has("initial") && boundary) scene.fail("boundary", "give [initial] or [boundary], not both");
  if (!scene.has("initial") && !boundary)
    scene.fail("", fmt::format("missing table [initial] ({}) or [boundary] (start, end)", initial));
  return boundary;
}

}  // namespace lagroid::app
