#include "boundary_value.hpp"

#include "scene_keys.hpp"

#include <lagroid/solvers/boundary/boundary_words.hpp>

#include <fmt/ranges.h>

#include <limits>

namespace lagroid::app {

namespace {

const KeyOf<Whole> starts{"starts",
                          {1, 100000},
                          "",
                          "guesses of the multistart: the straight line, then straight lines that wind (headings and "
                          "attitudes by whole turns, orbits by revolutions) and are bent by random sine modes",
                          MultistartOptions().starts};
const KeyOf<Whole> seed{"seed",
                        {0, std::numeric_limits<long>::max()},
                        "",
                        "of the random guesses; the result is reproducible",
                        long(MultistartOptions().seed)};
const KeyOf<Number> amplitude{"amplitude",
                              {nonnegative},
                              "",
                              "size of the sine modes, in coordinates of AG, from an eighth of it to twice; 0: the "
                              "distance of the ends, or one where they meet",
                              0.0};
constexpr std::string_view minima = "minima";
const KeyOf<OneOf> stationary_kind{"stationary_kind",
                                   {{std::string(minima), "stationary"}},
                                   "",
                                   "what to look for: a mechanical motion need not be a minimum of its action",
                                   {},
                                   "`minima` of optimal control, else `stationary`"};
/// Its name until 0.3, which goes with 0.4.
constexpr const char* seek = "seek";
const KeyOf<Whole> path_key{
    "path",
    {0, 100000},
    "",
    "which of the stationary paths is the result, counted from the cheapest; 0: the cheapest of "
    "the `stationary_kind`",
    0L};
const KeyOf<Number> boundary_tolerance{
    "tolerance", {positive}, "", "on the scaled residual of the boundary-value equations", BoundaryOptions().tolerance};
const KeyOf<Whole> max_iterations{"max_iterations", {1, 1000000}, "", "of a start", BoundaryOptions().max_iterations};

KeyOf<OneOf> method() {
  const auto words = words_of(boundary_words);
  return {"method", {words}, "", "on the whole path; on the initial momentum; by least squares", words.front()};
}

const KeyOf<Text> parameter{"parameter",
                            {},
                            "",
                            "a number or an array of numbers of [parameters] or [boundary], `time.step` or "
                            "`time.duration`, as in \"parameters.plate_rate\"; between its ends a position is brought "
                            "back to the sphere, a quaternion to unit norm"};
const KeyOf<Either> from{"from", {{{Number{}}, {NumberList{}}}}, "", "number or array to begin with"};
const KeyOf<Whole> steps{"steps", {1, 100000}, "", "to begin with, of equal size", ContinuationChoice().steps};

}  // namespace

std::vector<Key> multistart_keys() { return {starts, seed}; }

Table boundary_table(const Table& end) {
  return {{KeyOf<Table>{"start", end, "", "the configuration at the start"},
           KeyOf<Table>{"end", end, "", "the configuration at the end"}}};
}
Table boundary_time_table(const std::vector<std::string>& modes, bool depends_on_time) {
  Table table{grid_keys()};
  table.keys.push_back(time_keys::boundary_mode(modes));
  if (depends_on_time) table.keys.push_back(time_keys::start);
  return table;
}
Table boundary_solver_table() {
  return {{method(), stationary_kind, path_key, starts, seed, amplitude, boundary_tolerance, max_iterations}};
}
Table continuation_table() { return {{parameter, from, steps}}; }

MultistartOptions read_multistart(const Section& solver) {
  MultistartOptions options;
  options.starts = int(read_key(solver, starts));
  options.seed = std::uint64_t(read_key(solver, seed));
  return options;
}

BoundaryChoice read_boundary_solver(const Section& solver) {
  BoundaryChoice choice;
  choice.method = choice_of(boundary_words, read_key(solver, method()));
  KeyOf<OneOf> kind = stationary_kind;
  if (solver.has(seek)) {
    if (solver.has(kind.name)) solver.fail(seek, "is the old name of " + kind.name + ", which is there too");
    choice.notes.push_back(fmt::format("solver.{} is solver.{} now; the old name goes with 0.4", seek, kind.name));
    kind.name = seek;
  }
  if (solver.has(kind.name))
    choice.stationary_kind = read_key(solver, kind) == minima ? StationaryKind::minima : StationaryKind::stationary;
  choice.path = std::size_t(read_key(solver, path_key));
  choice.multistart = read_multistart(solver);
  choice.multistart.amplitude = read_key(solver, amplitude);
  choice.options.tolerance = read_key(solver, boundary_tolerance);
  choice.options.max_iterations = int(read_key(solver, max_iterations));
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
  choice.parameter = read_key(section, parameter);
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
  choice.from = choice.to.size() == 1 && section.is_number(from.name)
                    ? std::vector{section.number(from.name)}
                    : section.numbers(from.name, choice.to.size(), "as many as the parameter has");
  choice.steps = read_key(section, steps);
  return choice;
}

bool is_boundary_value(const Section& scene, const std::string& initial) {
  const bool boundary = scene.has("boundary");
  if (scene.has("initial") && boundary) scene.fail("boundary", "give [initial] or [boundary], not both");
  if (!scene.has("initial") && !boundary)
    scene.fail("", fmt::format("missing table [initial] ({}) or [boundary] (start, end)", initial));
  if (boundary) refuse_to_reduce(scene, "goes with [initial]: boundary values are those of the full system");
  return boundary;
}

}  // namespace lagroid::app
