#include <lagroid/solvers/learning/functions/compiled_sizes.hpp>
#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/potentials/network_potential.hpp>

#include <fmt/ranges.h>

#include <string>

namespace lagroid::learning {

extern template class FieldModel<PotentialFields<NetworkPotential, 1>>;
extern template class ParametricModel<NetworkPotential, 1>;
extern template class FieldModel<PotentialFields<NetworkPotential, 2>>;
extern template class ParametricModel<NetworkPotential, 2>;
extern template class FieldModel<PotentialFields<NetworkPotential, Eigen::Dynamic>>;
extern template class ParametricModel<NetworkPotential, Eigen::Dynamic>;

std::unique_ptr<Model> network_model(int bodies, std::vector<int> hidden, Dissipation dissipation) {
  const std::string name = hidden.empty() ? "network" : fmt::format("network:{}", fmt::join(hidden, ","));
  NetworkPotential potential(bodies, std::move(hidden));
  return of_compiled_size(bodies, [&]<int K>() -> std::unique_ptr<Model> {
    return std::make_unique<ParametricModel<NetworkPotential, K>>(name, std::move(potential), bodies, dissipation);
  });
}

}  // namespace lagroid::learning
