#include "formula_methods.hpp"

#include "../scenes/scene_keys.hpp"
#include "../scenes/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace lagroid::app {

namespace {

/// How steps along curves are called, with the lowest and the highest of their orders.
struct CurveWord {
  std::string_view word;
  CurveQuadrature points;
  int least;
  int most;
  bool composed;     ///< other orders by composition; else by the degree of the curve
  bool constraints;  ///< whether it takes them
  Source source;
};
constexpr Source curves{"marsden2001", "discrete Lagrangians by curves and quadratures"};
constexpr Source pair_source{"jay1996", "the pair Lobatto IIIA-IIIB with constraints"};
constexpr std::array<CurveWord, 5> curve_words{
    {{"midpoint", CurveQuadrature::gauss, 2, 8, true, false, curves},
     {"trapezoidal", CurveQuadrature::lobatto, 2, 8, true, true, curves},
     {"gauss", CurveQuadrature::gauss, 4, 10, false, false, curves},
     {"lobatto", CurveQuadrature::lobatto, 4, 10, false, false, curves},
     {"lobatto-pair", CurveQuadrature::lobatto_pair, 2, 8, false, true, pair_source}}};

KeyOf<OneOf> curve_key() {
  std::vector<std::string> words;
  for (const CurveWord& each : curve_words) words.emplace_back(each.word);
  KeyOf<OneOf> key = time_keys::method(std::move(words));
  key.fallback.reset();
  key.otherwise = "midpoint; trapezoidal where there are constraints";
  return key;
}
KeyOf<Whole> curve_order_key() {
  KeyOf<Whole> key = time_keys::order(2, 10);
  key.fallback.reset();
  key.otherwise = "2; 4 of gauss, lobatto and lobatto-pair";
  return key;
}

constexpr std::array<std::string_view, 3> type_words{"symmetrised", "type-2", "type-3"};
KeyOf<OneOf> type_key() { return time_keys::method({type_words.begin(), type_words.end()}); }
const KeyOf<Whole> taylor_key{
    "taylor", {0, 4}, "", "r: the order of Taylor's method inside of the generating function", 1};
KeyOf<OneOf> quadrature_key() {
  std::vector<std::string> names;
  for (const QuadratureRule& each : quadrature_rules::all) names.emplace_back(each.name);
  return {"quadrature",
          {std::move(names)},
          "",
          "of the action inside of the generating function",
          std::string(quadrature_rules::trapezoid.name)};
}
const QuadratureRule& quadrature_named(std::string_view name) {
  return *std::find_if(quadrature_rules::all.begin(), quadrature_rules::all.end(),
                       [&](const QuadratureRule& each) { return each.name == name; });
}

/// Of the map that is made of a map of that order and its adjoint.
int symmetrised_order(const TaylorChoice& taylor, bool constrained) {
  const int order = taylor.step_order(constrained);
  return order + order % 2;
}

std::unique_ptr<SizedStep> composed(std::unique_ptr<SizedStep> step, const Composition& composition) {
  if (composition.stages() == 1) return step;
  std::vector<std::unique_ptr<SizedStep>> methods;
  methods.push_back(std::move(step));
  return std::make_unique<ComposedSizedStep>(
      std::move(methods), std::vector<double>(composition.coefficients.begin(), composition.coefficients.end()));
}

}  // namespace

FormulaMethod CurveMethod::begun(const FormulaLagrangian& lagrangian) const {
  FormulaMethod out{composed(std::make_unique<CurveStep>(lagrangian, curve), composition), traits};
  out.traits.symplectic = !lagrangian.sizes().forced;
  return out;
}

CurveMethod read_curve_method(const Section& time, bool constrained) {
  const std::string word = time.has("method") ? read_key(time, curve_key()) : constrained ? "trapezoidal" : "midpoint";
  const CurveWord& named =
      *std::find_if(curve_words.begin(), curve_words.end(), [&](const CurveWord& each) { return each.word == word; });
  if (constrained && !named.constraints)
    time.fail("method",
              fmt::format("\"{}\" keeps no constraints between nodes; take trapezoidal or lobatto-pair", word));
  CurveMethod method{{word, 2, true, true, false}, {named.points, 1}, compositions::single, named.source};
  if (named.composed) {
    method.composition = read_composition(time, compositions::all);
    method.traits.order = method.composition.order;
    if (method.composition.stages() > 1) method.traits.name = composed_name(word, method.composition);
    return method;
  }
  if (time.has("composition"))
    time.fail("composition", fmt::format("goes with steps that are composed, which \"{}\" ones are not", word));
  const long order = read_key_or(time, curve_order_key(), 4);
  if (order % 2 != 0 || order < named.least || order > named.most)
    time.fail("order", fmt::format("of \"{}\" is even, {} to {}", word, named.least, named.most));
  method.curve.degree = int(order / 2) + (named.points == CurveQuadrature::lobatto_pair ? 1 : 0);
  method.traits.order = int(order);
  method.traits.name = fmt::format("{}-{}", word, order);
  return method;
}

std::vector<Method> curve_methods(bool constrained) {
  std::vector<Method> all;
  for (const CurveWord& each : curve_words) {
    if (constrained && !each.constraints) continue;
    if (each.composed) {
      for (Method& method : composed_methods(each.word, compositions::all)) all.push_back(std::move(method));
      continue;
    }
    for (int order = each.least; order <= each.most; order += 2)
      all.push_back({fmt::format("{}-{}", each.word, order),
                     order,
                     order,
                     true,
                     {fmt::format("time.method={}", each.word), fmt::format("time.order={}", order)}});
  }
  return all;
}

std::vector<Key> curve_method_keys() {
  return {time_keys::start, curve_key(), curve_order_key(), time_keys::composition(compositions::all)};
}

FormulaMethod GeneratingMethod::begun(const FormulaHamiltonian& hamiltonian) const {
  if (types == Types::both)
    return {composed(std::make_unique<SymmetrisedGeneratingStep>(hamiltonian), composition), traits};
  return {
      std::make_unique<GeneratingStep>(hamiltonian, types == Types::two ? GeneratingType::two : GeneratingType::three),
      traits};
}

GeneratingMethod read_generating_method(const Section& time, bool constrained) {
  const std::string word = read_key(time, type_key());
  GeneratingMethod method{{word, 0, word == type_words[0], true, false},
                          {int(read_key(time, taylor_key)), quadrature_named(read_key(time, quadrature_key()))},
                          word == type_words[0]   ? GeneratingMethod::Types::both
                          : word == type_words[1] ? GeneratingMethod::Types::two
                                                  : GeneratingMethod::Types::three,
                          compositions::single};
  const bool both = method.types == GeneratingMethod::Types::both;
  const int own = both ? symmetrised_order(method.taylor, constrained) : method.taylor.step_order(constrained);
  method.traits.order = own;
  if (both && (time.has("order") || time.has("composition"))) {
    if (own != 2 && read_key(time, time_keys::order()) != own)
      time.fail("order",
                fmt::format("of these steps is {}; compositions are of steps of order two, as by taylor = 1", own));
    if (own == 2) {
      method.composition = read_composition(time, compositions::all);
      method.traits.order = method.composition.order;
      if (method.composition.stages() > 1) method.traits.name = composed_name(word, method.composition);
    }
  } else if (time.has("composition")) {
    time.fail("composition", "is of symmetric steps: take method = \"symmetrised\"");
  } else if (time.has("order") && read_key(time, time_keys::order()) != own) {
    time.fail("order", fmt::format("follows taylor and quadrature, and is {}", own));
  }
  return method;
}

std::vector<Method> generating_methods(bool constrained) {
  std::vector<Method> all = composed_methods(type_words[0], compositions::all);
  for (Method& each : all) each.settings.insert(each.settings.end(), {"time.taylor=1", "time.quadrature=trapezoid"});
  const auto add = [&](std::string_view word, int taylor, std::string_view quadrature) {
    const TaylorChoice choice{taylor, quadrature_named(quadrature)};
    const bool both = word == type_words[0];
    all.push_back({fmt::format("{}/taylor-{}", word, taylor),
                   both ? symmetrised_order(choice, constrained) : choice.step_order(constrained),
                   (both ? 2 : 1) * (taylor + 1),
                   true,
                   {fmt::format("time.method={}", word), fmt::format("time.taylor={}", taylor),
                    fmt::format("time.quadrature={}", quadrature)}});
  };
  for (const std::string_view word : {type_words[1], type_words[2]}) {
    add(word, 0, "rectangle");
    add(word, 1, "trapezoid");
    if (!constrained) add(word, 3, "gauss-2");
  }
  if (!constrained) add(type_words[0], 3, "gauss-2");
  return all;
}

std::vector<Key> generating_method_keys() {
  return {time_keys::start, type_key(),         taylor_key,
          quadrature_key(), time_keys::order(), time_keys::composition(compositions::all)};
}

}  // namespace lagroid::app
