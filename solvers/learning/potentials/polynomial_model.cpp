#include <lagroid/solvers/learning/functions/compiled_sizes.hpp>
#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/potentials/polynomial_potential.hpp>

#include <fmt/format.h>

namespace lagroid::learning {

extern template class FieldModel<PotentialFields<PolynomialPotential, 1>>;
extern template class ParametricModel<PolynomialPotential, 1>;
extern template class FieldModel<PotentialFields<PolynomialPotential, 2>>;
extern template class ParametricModel<PolynomialPotential, 2>;
extern template class FieldModel<PotentialFields<PolynomialPotential, Eigen::Dynamic>>;
extern template class ParametricModel<PolynomialPotential, Eigen::Dynamic>;

std::unique_ptr<Model> polynomial_model(int bodies, int degree, Dissipation dissipation) {
  const std::string name = fmt::format("polynomial:{}", degree);
  PolynomialPotential potential(bodies, degree);
  return of_compiled_size(bodies, [&]<int K>() -> std::unique_ptr<Model> {
    return std::make_unique<ParametricModel<PolynomialPotential, K>>(name, std::move(potential), bodies, dissipation);
  });
}

}  // namespace lagroid::learning
