#include <lagroid/solvers/learning/functions/compiled_sizes.hpp>
#include <lagroid/solvers/learning/functions/polynomial.hpp>
#include <lagroid/solvers/learning/hamiltonians/hamiltonian_model.hpp>

#include <fmt/format.h>

namespace lagroid::learning {

extern template class FieldModel<HamiltonianFields<Polynomial, 1>>;
extern template class FieldModel<HamiltonianFields<Polynomial, 2>>;
extern template class FieldModel<HamiltonianFields<Polynomial, Eigen::Dynamic>>;

std::unique_ptr<Model> polynomial_hamiltonian(int coordinates, int degree, Dissipation dissipation) {
  const std::string name = fmt::format("polynomial:{}", degree);
  Polynomial h(2 * coordinates, degree);
  return of_compiled_size(coordinates, [&]<int N>() -> std::unique_ptr<Model> {
    return std::make_unique<HamiltonianModel<Polynomial, N>>(name, std::move(h), coordinates, dissipation);
  });
}

}  // namespace lagroid::learning
