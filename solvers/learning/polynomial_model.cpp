#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/potentials/polynomial_potential.hpp>

#include <fmt/format.h>

namespace lagroid::learning {

extern template class ParametricModel<PolynomialPotential, 1>;
extern template class ParametricModel<PolynomialPotential, 2>;
extern template class ParametricModel<PolynomialPotential, Eigen::Dynamic>;

std::unique_ptr<Model> polynomial_model(int bodies, int degree) {
  const std::string name = fmt::format("polynomial:{}", degree);
  PolynomialPotential potential(bodies, degree);
  if (bodies == 1) return std::make_unique<ParametricModel<PolynomialPotential, 1>>(name, std::move(potential));
  if (bodies == 2) return std::make_unique<ParametricModel<PolynomialPotential, 2>>(name, std::move(potential));
  return std::make_unique<ParametricModel<PolynomialPotential, Eigen::Dynamic>>(name, std::move(potential), bodies);
}

}  // namespace lagroid::learning
