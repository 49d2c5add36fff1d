#pragma once
/// The keys of [time], [solver] and [output] that scenes of several families share.

#include "../keys/key.hpp"

#include <lagroid/solvers/methods/declared_methods.hpp>

#include <span>
#include <string>
#include <vector>

namespace lagroid::app {

inline constexpr long most_steps = 2'000'000'000;
inline constexpr long most_apart = 1'000'000'000;  ///< rows, checkpoints

namespace time_keys {

inline const KeyOf<Whole> steps{"steps", {1, most_steps}, "", "how many"};
inline const KeyOf<Number> step{
    "step", {positive}, "s", "the size of a step; of the first, where sizes vary", {}, "`duration` over `steps`"};
inline const KeyOf<Number> duration{
    "duration", {positive},
    "s",        "of all steps, in place of `step`: of equal ones, and of boundary values",
    {},         "`steps` times `step`"};
inline const KeyOf<Number> accuracy{"accuracy",
                                    {positive},
                                    "",
                                    "in place of `step`: the size at which a step and two half ones differ by that "
                                    "much, relative to the motion over it",
                                    {},
                                    "`step` is given"};
inline const KeyOf<Number> start{"start", {}, "s", "when the first step begins", 0.0};

/// `first_of` is the order where it is not given.
KeyOf<Whole> order(int first_of = 2, int most = usual_compositions.back().order);
KeyOf<OneOf> composition(std::span<const Composition> offered, std::string_view usual = usual_compositions[0].name);
KeyOf<OneOf> mode(std::vector<std::string> words = mode_words());
/// Of a boundary value.
KeyOf<OneOf> boundary_mode(std::vector<std::string> words);
/// The first of the names is what there is without the key.
KeyOf<OneOf> method(std::vector<std::string> names);
KeyOf<OneOf> without_root();
inline const KeyOf<Number> tolerance{
    "tolerance",
    {{"between 1e-16 and 1", [](double x) { return x >= 1e-16 && x <= 1; }}},
    "",
    "of a method that estimates its error: inner steps of the size that the estimate asks for "
    "lead from node to node; `step` is then the distance of the nodes",
    {},
    "steps are as long as `step`"};

}  // namespace time_keys

/// Beside `system`: by what it is reduced.
inline constexpr std::string_view reduce_word = "reduce";
/// One of these, by which the system can be reduced.
KeyOf<OneOf> reduce_key(std::vector<std::string> names);

namespace solver_keys {

inline const KeyOf<Whole> max_iterations{"max_iterations",  {1, most_iterations}, "", "of a step", {},
                                         "60; of Ceres 100"};
inline const KeyOf<Number> tolerance{
    "tolerance", {nonnegative}, "", "a step is taken whose scaled residual is this small; 0: down to round-off", 0.0};
KeyOf<OneOf> method();

}  // namespace solver_keys

namespace output_keys {

inline const KeyOf<Whole> every{"every", {1, most_apart}, "", "n: each n-th node is recorded, and the last", 1};
inline const KeyOf<Whole> checkpoint{"checkpoint", {1, most_apart}, "", "steps from one checkpoint to the next",
                                     {},           "ten seconds"};

}  // namespace output_keys

/// Of [time] in every scene: which steps, if they are equal.
std::vector<Key> grid_keys();
/// [[event]]: what may happen in a run.
namespace event_keys {

inline const KeyOf<Text> name{"name", {}, "", "what files and reports call it, unlike the others"};
inline const KeyOf<Text> when{
    "when", {}, "", "the function that is watched: of columns, quantities and `t`, as \"sqrt(x^2 + y^2) - 1\""};
inline const KeyOf<OneOf> at{
    "at", {{"zero", "minimum", "maximum"}}, "", "where it happens: where the function passes zero, or turns", "zero"};
inline const KeyOf<OneOf> direction{
    "direction", {{"both", "rising", "falling"}}, "", "in which it passes zero", "both"};
inline const KeyOf<OneOf> then{
    "then", {{"record", "stop"}}, "", "what follows: a row of the table alone, or the end", "record"};
inline const KeyOf<Whole> count{"count", {1, most_steps}, "", "of `then = \"stop\"`: at which time", 1};
inline const KeyOf<Number> tolerance{"tolerance",
                                     {{"between 0 and 0.1", [](double x) { return x >= 0 && x <= 0.1; }}},
                                     "",
                                     "nearer to zero, relative to its largest value, the function touches it",
                                     1e-10};
inline const KeyOf<Texts> kick{
    "kick", {}, "", "added to the momentum there: an expression as `when` for each of its numbers", {}, "none"};
inline const KeyOf<Text> body{"body", {}, "", "of a scene of bodies, the one that `kick` is of", {}, "none"};
inline const KeyOf<Texts> switch_on{
    "switch_on", {}, "", "of a scene of bodies, names of joints and effects that act from there on", {}, "none"};
inline const KeyOf<Texts> switch_off{
    "switch_off", {}, "", "of a scene of bodies, names of joints and effects that act no more", {}, "none"};
inline const KeyOf<Texts> set{
    "set", {},    "", "parameters that become other numbers there: `name = expression`, as \"gravity = 1.62\"",
    {},    "none"};
inline const KeyOf<Texts> plot{
    "plot", {}, "", "two columns: a picture of the points at which it happened, as a Poincare section", {}, "none"};

}  // namespace event_keys
KeyOf<Tables> event_key();

/// [time] of an initial value, by a method that is declared for every system.
Table time_table(bool depends_on_time);
/// [time] of an initial value, by a method of the system's own, whose highest order is the usual one.
Table own_time_table(const DeclaredMethod& own);
/// [output] of an initial value.
Table output_table();
/// [solver] of an initial value.
Table step_solver_table();

/// [accuracy]: a target in place of method and step.
namespace accuracy_keys {

extern const KeyOf<Number> target;
extern const KeyOf<Number> pilot;
extern const KeyOf<Text> methods;

}  // namespace accuracy_keys

/// Initial values with these keys: by the method and the step that [time] names, and by those that [accuracy] chooses.
std::vector<Table> initial_values(const std::vector<Key>& keys, const Table& time);

}  // namespace lagroid::app
