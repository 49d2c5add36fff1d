#include <lagroid/solvers/learning/functions/compiled_sizes.hpp>
#include <lagroid/solvers/learning/functions/network.hpp>
#include <lagroid/solvers/learning/hamiltonians/hamiltonian_model.hpp>

#include <fmt/ranges.h>

namespace lagroid::learning {

extern template class FieldModel<HamiltonianFields<Network, 1>>;
extern template class FieldModel<HamiltonianFields<Network, 2>>;
extern template class FieldModel<HamiltonianFields<Network, Eigen::Dynamic>>;

std::unique_ptr<Model> network_hamiltonian(int coordinates, std::vector<int> hidden, Dissipation dissipation) {
  const std::string name = hidden.empty() ? "network" : fmt::format("network:{}", fmt::join(hidden, ","));
  Network h(2 * coordinates, std::move(hidden));
  return of_compiled_size(coordinates, [&]<int N>() -> std::unique_ptr<Model> {
    return std::make_unique<HamiltonianModel<Network, N>>(name, std::move(h), coordinates, dissipation);
  });
}

}  // namespace lagroid::learning
