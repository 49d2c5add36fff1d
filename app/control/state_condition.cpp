#include "state_condition.hpp"

namespace lagroid::app {

StateFormulas::StateFormulas(const std::vector<std::string>& texts, const std::vector<std::string>& names)
    : texts_(texts) {
  FormulaGraph graph;
  std::vector<FormulaGraph::Node> formulas;
  std::vector<FormulaGraph::Node> slopes;
  for (const std::string& text : texts) {
    formulas.push_back(graph.read(text, names));
    std::vector<FormulaGraph::Node> first;
    for (std::size_t i = 0; i < names.size(); ++i) first.push_back(graph.derivative(formulas.back(), i));
    slopes.insert(slopes.end(), first.begin(), first.end());
    for (const FormulaGraph::Node slope : first)
      for (std::size_t j = 0; j < names.size(); ++j) slopes.push_back(graph.derivative(slope, j));
  }
  values_ = FormulaProgram(graph, formulas);
  derivatives_ = FormulaProgram(graph, slopes);
}

void StateFormulas::values(const double* state, double* out) const { values_.evaluate(state, out, scratch_); }

void StateFormulas::derivatives(const double* state, double* out) const { derivatives_.evaluate(state, out, scratch_); }

}  // namespace lagroid::app
