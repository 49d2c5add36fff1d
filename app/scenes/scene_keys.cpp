#include "scene_keys.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace lagroid::app {

namespace time_keys {

KeyOf<Whole> order(int first_of, int most) {
  return {"order", {2, most}, "", "of equal steps, which are composed where it is above the method's own", first_of};
}

KeyOf<OneOf> composition(std::span<const Composition> offered, std::string_view usual) {
  std::vector<std::string> names;
  for (const auto& each : offered) names.emplace_back(each.name);
  return {"composition",      {std::move(names)},          "", "how a step is composed of others",
          std::string(usual), "the usual one of the order"};
}

KeyOf<OneOf> mode(std::vector<std::string> words) {
  std::string first = words.front();
  return {
      "mode",
      {std::move(words)},
      "",
      "equal steps; steps that keep the discrete energy; steps in proportion to the system's time scale; steps that "
      "are a function of the arrow; explicit ones of a time that follows the attraction",
      std::move(first)};
}

KeyOf<OneOf> boundary_mode(std::vector<std::string> words) {
  KeyOf<OneOf> key = mode(std::move(words));
  key.meaning =
      "equal steps; steps that are part of the path, the end time given; steps by a time scale of the "
      "arrows, which until 0.4 are \"controlled\" as well";
  return key;
}

KeyOf<OneOf> method(std::vector<std::string> names) {
  std::string first = names.front();
  return {"method", {std::move(names)}, "", "by which equal steps are made", std::move(first)};
}

KeyOf<OneOf> without_root() {
  const auto words = words_of(without_root_words);
  return {"without_root",
          {words},
          "",
          "what becomes of an adaptive step where no size keeps the energy; the report counts them",
          words.front()};
}

}  // namespace time_keys

KeyOf<OneOf> reduce_key(std::vector<std::string> names) {
  return {std::string(reduce_word),
          {std::move(names)},
          "",
          "what the system is reduced by: steps are those of the reduced system, recorded is the full motion",
          {},
          "the system as it is"};
}

namespace solver_keys {

KeyOf<OneOf> method() {
  const auto words = words_of(solver_words);
  return {"method", {words}, "", "who solves the implicit equations", words.front()};
}

}  // namespace solver_keys

std::vector<Key> grid_keys() { return {time_keys::steps, time_keys::step, time_keys::duration}; }

Table time_table(bool depends_on_time) {
  Table table{grid_keys()};
  table.keys.insert(
      table.keys.end(),
      {time_keys::accuracy, time_keys::mode(), time_keys::without_root(), time_keys::method(method_words()),
       time_keys::order(), time_keys::composition(compositions_of(OtherOrders::composed_flows)), time_keys::tolerance});
  if (depends_on_time) table.keys.push_back(time_keys::start);
  return table;
}

Table own_time_table(const DeclaredMethod& own) {
  Table table{grid_keys()};
  KeyOf<OneOf> method = time_keys::method({std::string(own.name)});
  method.fallback.reset();
  KeyOf<Whole> order = time_keys::order(own.order, own.order);
  order.meaning = "of the method";
  table.keys.insert(table.keys.end(), {method, order});
  return table;
}

KeyOf<Tables> event_key() {
  using namespace event_keys;
  return {
      "event", {{{name, when, at, direction, then, count, tolerance, kick, body, set, switch_on, switch_off, plot}}},
      "",      "what may happen",
      {},      "none"};
}

Table output_table() { return {{output_keys::every, output_keys::checkpoint}}; }

Table step_solver_table() { return {{solver_keys::method(), solver_keys::max_iterations, solver_keys::tolerance}}; }

namespace accuracy_keys {

const KeyOf<Number> target{"target",
                           {{"between 1e-14 and 0.5", [](double x) { return x >= 1e-14 && x <= 0.5; }}},
                           "",
                           "error of the state at the end, relative"};
const KeyOf<Number> pilot{"pilot",
                          {{"between 0.01 and 100000", [](double x) { return x >= 0.01 && x <= 1e5; }}},
                          "s",
                          "that the choice may take, about",
                          2.0};
const KeyOf<Text> methods{
    "methods", {}, "", "patterns of names, as lagroid study takes them, \"splitting*,moser-veselov*\"", {}, "all"};

}  // namespace accuracy_keys

std::vector<Table> initial_values(const std::vector<Key>& keys, const Table& time) {
  Table stepped{keys};
  stepped.keys.push_back(event_key());
  stepped.keys.push_back(KeyOf<Table>{"time", time, "", "steps, and by which method"});
  Table aimed{keys};
  aimed.keys.push_back(event_key());
  Table span;
  const std::array spans{time_keys::steps.name, time_keys::step.name, time_keys::duration.name, time_keys::start.name};
  for (Key key : time.keys) {
    if (std::find(spans.begin(), spans.end(), key.name) == spans.end()) continue;
    if (key.required()) key.otherwise = "none, with `duration`";
    span.keys.push_back(std::move(key));
  }
  aimed.keys.push_back(KeyOf<Table>{"time", span, "", "how long: `duration`, or `step` and `steps`"});
  aimed.keys.push_back(KeyOf<Table>{"accuracy",
                                    {{accuracy_keys::target, accuracy_keys::pilot, accuracy_keys::methods}},
                                    "",
                                    "chooses method and step"});
  return {stepped, aimed};
}

}  // namespace lagroid::app
