#pragma once
/// The keys of [horizon] and [solver] that every optimal control problem has, and how bounds are written.

#include "../keys/key.hpp"

#include <lagroid/solvers/control/control_search.hpp>
#include <lagroid/solvers/control/ipopt/has_ipopt.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/solvers/missing_library.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

inline const NumberRule a_tolerance{"from 1e-13 to 1e-2", [](double x) { return x >= 1e-13 && x <= 1e-2; }};
inline const KeyOf<Number> duration_key{"duration", {positive}, "s", "T; where it is free, the first guess of it"};
inline const KeyOf<Flag> free_key{"free", {}, "", "true: the duration is an unknown", false};
inline const KeyOf<Whole> stages_key{"stages", {2, 1'000'000}, "", "N, arrows between the ends", 100L};
inline const KeyOf<Whole> starts_key{
    "starts",
    {1, 100'000},
    "",
    "trajectories to start from: straight, drifting, then with jumping controls or wound and bent",
    10L};
inline const KeyOf<Whole> seed_key{"seed", {0, 4294967295}, "", "of the starts", 1L};
inline const KeyOf<Number> tolerance_key{
    "tolerance", {a_tolerance}, "", "on every part of the KKT residual", ControlOptions().tolerance};
inline const KeyOf<Whole> iterations_key{
    "iterations", {1, 1'000'000}, "", "of each start, at most", long(ControlOptions().max_iterations)};
inline const KeyOf<Number> patience_key{
    "patience",
    {nonnegative},
    "",
    "a start is given up after so many times the iterations of the slowest that has "
    "converged, at least 100; 0: none is",
    ControlSearchOptions().patience};

enum class ControlMethod { interior_point, ipopt };
/// [solver] method; the first is the default.
inline constexpr std::array<Word<ControlMethod>, 2> control_words{
    {{"interior_point", ControlMethod::interior_point}, {"ipopt", ControlMethod::ipopt}}};
inline KeyOf<OneOf> method_key() {
  const auto words = words_of(control_words);
  return {
      "method", {words}, "", "on the manifold of trajectories; by IPOPT in a chart of it, as a check", words.front()};
}

/// Least and largest value: both as an array, or one of them, or both, by name.
inline KeyOf<Either> range_key(const std::string& name, const std::string& unit, const std::string& meaning,
                               const NumberRule& rule = any_number) {
  const Table one_side{{KeyOf<Number>{"min", {rule}, unit, "least value", {}, "none"},
                        KeyOf<Number>{"max", {rule}, unit, "largest value", {}, "none"}}};
  return {name, {{{NumberArray{2, rule}}, {one_side}}}, unit, meaning, {}, "none"};
}
/// What stands there; a side that is left out is that of `otherwise`. Throws SceneError.
inline std::pair<double, double> read_range(const Section& at, const std::string& name, const NumberRule& rule,
                                            std::pair<double, double> otherwise) {
  if (!at.has(name)) return otherwise;
  if (!at.is_table(name)) {
    const std::vector<double> both = read_key(at, KeyOf<NumberArray>{name, {2, rule}, "", "least and largest value"});
    return {both[0], both[1]};
  }
  const Section sides = at.section(name, "min or max");
  if (!sides.has("min") && !sides.has("max")) at.fail(name, "give min, max or both");
  const std::pair<double, double> out{sides.number_or("min", otherwise.first, rule),
                                      sides.number_or("max", otherwise.second, rule)};
  sides.finish();
  return out;
}

inline std::vector<Key> search_keys() {
  return {method_key(), starts_key, seed_key, tolerance_key, iterations_key, patience_key};
}

/// Throws SceneError for IPOPT in a build without it.
inline ControlMethod read_method(const Section& solver) {
  const ControlMethod method = choice_of(control_words, read_key(solver, method_key()));
  if (method == ControlMethod::ipopt && !has_ipopt())
    solver.fail("method", MissingLibrary("\"ipopt\"", "IPOPT", "coinor-libipopt-dev").what());
  return method;
}

/// Of a search of any problem.
template <class Options> void read_search(const Section& solver, Options& out) {
  out.starts = int(read_key(solver, starts_key));
  out.seed = std::uint64_t(read_key(solver, seed_key));
  out.solver.tolerance = read_key(solver, tolerance_key);
  out.patience = read_key(solver, patience_key);
  out.solver.max_iterations = int(read_key(solver, iterations_key));
}

}  // namespace lagroid::app
