#include <lagroid/run/formula/formula_lagrangian.hpp>

#include <lagroid/core/derivatives/second_order.hpp>
#include <lagroid/core/matrices/decompositions.hpp>

#include <fmt/format.h>

namespace lagroid {

FormulaLagrangian::FormulaLagrangian(const FormulaTexts& texts, const std::string& lagrangian,
                                     const std::vector<std::string>& force)
    : SizedLagrangian(
          {int(texts.coordinates.size()), int(texts.constraints.size()), !force.empty(), int(texts.parameters.size())}),
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
  wanted.clear();
  for (std::size_t a = 0; a < texts.parameters.size(); ++a) {
    wanted.push_back(graph_.derivative(l, variable_of_parameter(a)));
    for (std::size_t i = 0; i < 2 * n; ++i)
      wanted.push_back(graph_.derivative(graph_.derivative(l, i), variable_of_parameter(a)));
    for (const Node component : components) wanted.push_back(graph_.derivative(component, variable_of_parameter(a)));
  }
  by_parameters_ = FormulaProgram(graph_, wanted);
  read_constraints_and_symmetries(texts, l, components);
  require_parameters_read(texts, {&lagrangian_, &force_});
}

void FormulaLagrangian::lagrangian(double t, const double* q, const double* v, double* out) const {
  lagrangian_.evaluate(at(t, q, v), out, scratch_);
}
void FormulaLagrangian::force(double t, const double* q, const double* v, double* out) const {
  force_.evaluate(at(t, q, v), out, scratch_);
}

void FormulaLagrangian::by_parameters(double t, const double* q, const double* v, double* out) const {
  by_parameters_.evaluate(at(t, q, v), out, scratch_);
}

// E(q, p) = ext_v <p, v> - l(q, v): at the velocity its derivatives are those at fixed v.
void FormulaLagrangian::energy_slope(double t, const double* q, const double*, const double* v, double* out) const {
  const std::size_t n = size(), each = 1 + 2 * n + (sizes().forced ? n : 0);
  std::vector<double> numbers(lagrangian_numbers()), varied(parameter_numbers());
  lagrangian(t, q, v, numbers.data());
  by_parameters(t, q, v, varied.data());
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = -numbers[1 + i];
    out[n + i] = v[i];
  }
  for (std::size_t a = 0; a < parameters().size(); ++a) out[2 * n + a] = -varied[a * each];
}

Eigen::MatrixXd FormulaLagrangian::momentum_slope(double t, const double* q, const double* v) const {
  const int n = int(size()), each = 1 + 2 * n + (sizes().forced ? n : 0);
  std::vector<double> numbers(lagrangian_numbers()), varied(parameter_numbers());
  lagrangian(t, q, v, numbers.data());
  by_parameters(t, q, v, varied.data());
  const SecondOrder l{numbers.data(), 2 * n};
  Eigen::MatrixXd out(n, 2 * n + int(parameters().size()));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < 2 * n; ++j) out(i, j) = l.second(n + i, j);
    for (int a = 0; a < int(parameters().size()); ++a) out(i, 2 * n + a) = varied[std::size_t(a * each + 1 + n + i)];
  }
  return out;
}

// p = l_v(q, v): l_vv dv = dp - l_vq dq - l_va da.
Eigen::MatrixXd FormulaLagrangian::velocity_slope(double t, const double* q, const double*, const double* v) const {
  const Eigen::Index n = Eigen::Index(size());
  Eigen::MatrixXd out = -momentum_slope(t, q, v);
  const Eigen::MatrixXd by_velocity = -out.middleCols(n, n);
  out.middleCols(n, n).setIdentity();
  return solve_regular(by_velocity, out);
}

}  // namespace lagroid
