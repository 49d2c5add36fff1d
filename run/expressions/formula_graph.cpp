#include <lagroid/run/expressions/formula_graph.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lagroid {

namespace {

using enum FormulaOperation;
constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

bool takes_two(FormulaOperation kind) {
  return kind == add || kind == subtract || kind == multiply || kind == divide || kind == power || kind == atan2;
}

bool is_leaf(FormulaOperation kind) { return kind == constant || kind == variable; }

double value_of(FormulaOperation kind, double a, double b) {
  switch (kind) {
    case add:
      return a + b;
    case subtract:
      return a - b;
    case multiply:
      return a * b;
    case divide:
      return a / b;
    case power:
      return std::pow(a, b);
    case negate:
      return -a;
    case sin:
      return std::sin(a);
    case cos:
      return std::cos(a);
    case tan:
      return std::tan(a);
    case asin:
      return std::asin(a);
    case acos:
      return std::acos(a);
    case atan:
      return std::atan(a);
    case sinh:
      return std::sinh(a);
    case cosh:
      return std::cosh(a);
    case tanh:
      return std::tanh(a);
    case asinh:
      return std::asinh(a);
    case acosh:
      return std::acosh(a);
    case atanh:
      return std::atanh(a);
    case exp:
      return std::exp(a);
    case log:
      return std::log(a);
    case sqrt:
      return std::sqrt(a);
    case abs:
      return std::abs(a);
    case atan2:
      return std::atan2(a, b);
    case constant:
    case variable:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

FormulaGraph::Node FormulaGraph::kept(const Operation& operation) {
  const auto [at, is_new] =
      places_.try_emplace({operation.kind, operation.a, operation.b, operation.value}, operations_.size());
  if (is_new) operations_.push_back(operation);
  return at->second;
}

FormulaGraph::Node FormulaGraph::constant(double value) {
  return kept({FormulaOperation::constant, 0, 0, value == 0 ? 0 : value});  // one zero
}

FormulaGraph::Node FormulaGraph::variable(std::size_t index) { return kept({FormulaOperation::variable, index, 0, 0}); }

FormulaGraph::Node FormulaGraph::apply(FormulaOperation kind, Node a, Node b) {
  const bool two = takes_two(kind);
  if (!two) b = 0;
  if (is_constant(a) && (!two || is_constant(b))) {
    const double value = value_of(kind, operations_[a].value, two ? operations_[b].value : 0);
    if (std::isfinite(value)) return constant(value);
    if (reading_) throw std::invalid_argument("a part of it is no finite number");
    return kept({kind, a, b, 0});  // of a derivative, which is none there
  }
  const Node simple = simplified(kind, a, b);
  return simple != nowhere ? simple : kept({kind, a, b, 0});
}

FormulaGraph::Node FormulaGraph::simplified(FormulaOperation kind, Node a, Node b) {
  switch (kind) {
    case add:
      if (is(a, 0)) return b;
      if (is(b, 0)) return a;
      break;
    case subtract:
      if (is(b, 0)) return a;
      if (is(a, 0)) return apply(negate, b);
      if (a == b) return constant(0);
      break;
    case multiply:
      if (is(a, 0) || is(b, 0)) return constant(0);
      if (is(a, 1)) return b;
      if (is(b, 1)) return a;
      if (is(a, -1)) return apply(negate, b);
      if (is(b, -1)) return apply(negate, a);
      break;
    case divide:
      if (is(a, 0) && !is(b, 0)) return constant(0);
      if (is(b, 1)) return a;
      break;
    case power:
      if (is(b, 0)) return constant(1);
      if (is(b, 1)) return a;
      if (is(b, 2)) return apply(multiply, a, a);
      if (is(b, 3)) return apply(multiply, apply(multiply, a, a), a);
      if (is(b, 4)) return apply(power, apply(multiply, a, a), constant(2));
      if (is(b, -1)) return apply(divide, constant(1), a);
      if (is(b, 0.5)) return apply(sqrt, a);
      break;
    case negate:
      if (operations_[a].kind == negate) return operations_[a].a;
      break;
    default:
      break;
  }
  return nowhere;
}

FormulaGraph::Node FormulaGraph::derivative(Node f, std::size_t by) {
  if (const auto known = derivatives_.find({f, by}); known != derivatives_.end()) return known->second;
  const Operation of = operations_[f];
  const Node a = of.a, b = of.b;
  const auto d = [&](Node g) { return derivative(g, by); };
  const auto number = [&](double value) { return constant(value); };
  const auto times = [&](Node g, Node h) { return apply(multiply, g, h); };
  const auto over = [&](Node g, Node h) { return apply(divide, g, h); };
  const auto plus = [&](Node g, Node h) { return apply(add, g, h); };
  const auto minus = [&](Node g, Node h) { return apply(subtract, g, h); };
  const auto square = [&](Node g) { return apply(multiply, g, g); };
  const auto root = [&](Node g) { return apply(sqrt, g); };
  const auto one = number(1);
  Node out = number(0);
  if (!is_leaf(of.kind) && is_zero(d(a)) && (!takes_two(of.kind) || is_zero(d(b)))) return derivatives_[{f, by}] = out;
  switch (of.kind) {
    case FormulaOperation::constant:
      break;
    case FormulaOperation::variable:
      if (a == by) out = one;
      break;
    case add:
      out = plus(d(a), d(b));
      break;
    case subtract:
      out = minus(d(a), d(b));
      break;
    case multiply:
      out = plus(times(d(a), b), times(a, d(b)));
      break;
    case divide:
      out = minus(over(d(a), b), times(over(f, b), d(b)));
      break;
    case power:
      // Where nothing varies in the exponent the base may be negative.
      out = times(times(b, apply(power, a, minus(b, one))), d(a));
      if (!is_zero(d(b))) out = plus(out, times(times(f, apply(log, a)), d(b)));
      break;
    case negate:
      out = apply(negate, d(a));
      break;
    case sin:
      out = times(apply(cos, a), d(a));
      break;
    case cos:
      out = apply(negate, times(apply(sin, a), d(a)));
      break;
    case tan:
      out = times(plus(one, square(f)), d(a));
      break;
    case asin:
      out = over(d(a), root(times(minus(one, a), plus(one, a))));
      break;
    case acos:
      out = apply(negate, over(d(a), root(times(minus(one, a), plus(one, a)))));
      break;
    case atan:
      out = over(d(a), plus(one, square(a)));
      break;
    case sinh:
      out = times(apply(cosh, a), d(a));
      break;
    case cosh:
      out = times(apply(sinh, a), d(a));
      break;
    case tanh:
      out = times(times(minus(one, f), plus(one, f)), d(a));
      break;
    case asinh:
      out = over(d(a), root(plus(one, square(a))));
      break;
    case acosh:
      out = over(d(a), root(times(minus(a, one), plus(a, one))));
      break;
    case atanh:
      out = over(d(a), times(minus(one, a), plus(one, a)));
      break;
    case exp:
      out = times(f, d(a));
      break;
    case log:
      out = over(d(a), a);
      break;
    case sqrt:
      out = over(d(a), plus(f, f));
      break;
    case abs:
      out = times(over(a, f), d(a));
      break;
    case atan2: {
      const Node all = plus(square(a), square(b));
      out = over(minus(times(b, d(a)), times(a, d(b))), all);
      break;
    }
  }
  derivatives_[{f, by}] = out;
  return out;
}

FormulaProgram::FormulaProgram(const FormulaGraph& graph, const std::vector<FormulaGraph::Node>& formulas) {
  // Operands stand before what is made of them: in the order of the graph, as far as it is needed.
  std::vector<bool> needed(graph.count());
  for (const std::size_t f : formulas) needed[f] = true;
  for (std::size_t f = graph.count(); f-- > 0;) {
    const FormulaGraph::Operation& of = graph.operation(f);
    if (!needed[f] || is_leaf(of.kind)) continue;
    needed[of.a] = true;
    if (takes_two(of.kind)) needed[of.b] = true;
  }
  std::vector<std::size_t> place(graph.count());
  for (std::size_t f = 0; f < graph.count(); ++f) {
    if (!needed[f]) continue;
    place[f] = instructions_.size();
    const FormulaGraph::Operation& of = graph.operation(f);
    instructions_.push_back(
        {of.kind, is_leaf(of.kind) ? of.a : place[of.a], takes_two(of.kind) ? place[of.b] : 0, of.value});
  }
  for (const std::size_t f : formulas) outputs_.push_back(place[f]);
}

bool FormulaProgram::reads(std::size_t variable) const {
  return std::any_of(instructions_.begin(), instructions_.end(), [&](const Instruction& each) {
    return each.kind == FormulaOperation::variable && each.a == variable;
  });
}

void FormulaProgram::evaluate(const double* variables, double* out, std::vector<double>& scratch) const {
  scratch.resize(instructions_.size());
  for (std::size_t i = 0; i < instructions_.size(); ++i) {
    const Instruction& each = instructions_[i];
    double& result = scratch[i];
    switch (each.kind) {
      case FormulaOperation::constant:
        result = each.value;
        break;
      case FormulaOperation::variable:
        result = variables[each.a];
        break;
      case add:
        result = scratch[each.a] + scratch[each.b];
        break;
      case subtract:
        result = scratch[each.a] - scratch[each.b];
        break;
      case multiply:
        result = scratch[each.a] * scratch[each.b];
        break;
      case divide:
        result = scratch[each.a] / scratch[each.b];
        break;
      default:
        result = value_of(each.kind, scratch[each.a], scratch[each.b]);
        break;
    }
  }
  for (std::size_t i = 0; i < outputs_.size(); ++i) out[i] = scratch[outputs_[i]];
}

}  // namespace lagroid
