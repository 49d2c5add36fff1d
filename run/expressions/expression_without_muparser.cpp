#include <lagroid/run/expressions/expression.hpp>
#include <lagroid/run/expressions/formula_graph.hpp>

#include <stdexcept>

namespace lagroid::detail {

std::unique_ptr<Expression> parse_any_expression(const std::string&, const std::vector<std::string>&, const double*) {
  throw std::invalid_argument(
      "this build has no muparser (libmuparser-dev): it reads a column, or a column and a number, as x - 0.5");
}

}  // namespace lagroid::detail

namespace lagroid {

FormulaGraph::Node FormulaGraph::read(const std::string&, const std::vector<std::string>&) {
  throw std::invalid_argument("this build has no muparser (libmuparser-dev), which reads formulas");
}

}  // namespace lagroid
