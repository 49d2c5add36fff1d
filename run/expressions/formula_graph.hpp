#pragma once
/// Formulas as graphs of operations on named variables, with their derivatives as further formulas of the same graph:
/// equal parts are there once, so that a function, its slope and its curvature share what they have in common.
///
///     FormulaGraph graph;
///     const auto f = graph.read("m * x^2 / 2 + cos(x)", {"x", "m"});  // variables 0 and 1
///     const auto slope = graph.derivative(f, 0);                     // m x - sin x
///     const FormulaProgram both(graph, {f, slope});
///     std::vector<double> out(2), scratch;
///     both.evaluate(std::vector<double>{0.3, 2.0}.data(), out.data(), scratch);
///
/// Requires smooth formulas: sums, products, quotients, powers, the elementary functions and `atan2`, `pi`; conditions,
/// `min`, `max` and `sign` have no second derivatives and are refused. Derivatives are exact; where there are none, as
/// of abs(x) at zero, they are no numbers.
///
/// A part that is no finite number, as 0/0 or sqrt(-1), is an error of the text too.
///
/// Errors: std::invalid_argument for a text that is no formula of these names, with what is wrong in it, or in a build
/// without muparser, which reads the texts.

#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace lagroid {

enum class FormulaOperation {
  constant,
  variable,
  add,
  subtract,
  multiply,
  divide,
  power,
  negate,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  asinh,
  acosh,
  atanh,
  exp,
  log,
  sqrt,
  abs,
  atan2
};

class FormulaGraph {
 public:
  using Node = std::size_t;

  Node constant(double value);
  Node variable(std::size_t index);
  /// The operation on one or two formulas, simplified where an operand is zero, one or another number.
  Node apply(FormulaOperation operation, Node a, Node b = 0);
  /// The formula of a text, of which names[i] is variable i. Names may hold signs, as x' does.
  Node read(const std::string& text, const std::vector<std::string>& names);
  Node derivative(Node f, std::size_t variable);

  struct Operation {
    FormulaOperation kind;
    Node a;  ///< the index of a variable
    Node b;
    double value;  ///< of a constant
  };
  const Operation& operation(Node f) const { return operations_[f]; }
  std::size_t count() const { return operations_.size(); }
  bool is_constant(Node f) const { return operations_[f].kind == FormulaOperation::constant; }
  bool is_zero(Node f) const { return is_constant(f) && operations_[f].value == 0; }

 private:
  Node kept(const Operation& operation);
  Node simplified(FormulaOperation kind, Node a, Node b);
  bool is(Node f, double value) const { return is_constant(f) && operations_[f].value == value; }

  bool reading_ = false;  ///< a text, of which every part is to be a number
  std::vector<Operation> operations_;
  std::map<std::tuple<FormulaOperation, Node, Node, double>, Node> places_;
  std::map<std::pair<Node, std::size_t>, Node> derivatives_;
};

/// What evaluates some formulas of a graph at once, each of their parts once.
class FormulaProgram {
 public:
  FormulaProgram() = default;
  FormulaProgram(const FormulaGraph& graph, const std::vector<FormulaGraph::Node>& formulas);

  /// Writes the values of the formulas, in their order. `scratch` is sized by the first call.
  void evaluate(const double* variables, double* out, std::vector<double>& scratch) const;
  std::size_t count() const { return outputs_.size(); }
  /// Whether its formulas have that variable.
  bool reads(std::size_t variable) const;

 private:
  struct Instruction {
    FormulaOperation kind;
    std::size_t a;  ///< places of operands, or of a variable
    std::size_t b;
    double value;
  };
  std::vector<Instruction> instructions_;
  std::vector<std::size_t> outputs_;
};

}  // namespace lagroid
