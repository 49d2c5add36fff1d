#include <lagroid/run/formula/formula_lagrangian.hpp>

#include <fmt/format.h>

namespace lagroid {

FormulaLagrangian::FormulaLagrangian(const FormulaTexts& texts, const std::string& lagrangian,
                                     const std::vector<std::string>& force)
    : SizedLagrangian({int(texts.coordinates.size()), int(texts.constraints.size()), !force.empty()}),
      FormulaSystem(texts, {}, true) {
  const std::size_t n = size();
  const Node l = read("l", lagrangian);
  depends_on_time_ = depends(l, time());
  lagrangian_ = FormulaProgram(graph_, with_derivatives(l, 2 * n));
  if (!force.empty() && force.size() != n)
    throw FormulaError("force", fmt::format("has {} components, and there are {} coordinates", force.size(), n));
  std::vector<Node> components, wanted;
  for (const std::string& text : force) {
    components.push_back(read("force", text));
    depends_on_time_ = depends_on_time_ || depends(components.back(), time());
    wanted.push_back(components.back());
    for (std::size_t i = 0; i < 2 * n; ++i) wanted.push_back(graph_.derivative(components.back(), i));
  }
  force_ = FormulaProgram(graph_, wanted);
  finish(texts, l, components);
  require_parameters_read(texts, {&lagrangian_, &force_});
}

void FormulaLagrangian::lagrangian(double t, const double* q, const double* v, double* out) const {
  lagrangian_.evaluate(at(t, q, v), out, scratch_);
}
void FormulaLagrangian::force(double t, const double* q, const double* v, double* out) const {
  force_.evaluate(at(t, q, v), out, scratch_);
}

}  // namespace lagroid
