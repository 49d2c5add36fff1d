#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/potentials/network_potential.hpp>

#include <fmt/ranges.h>

#include <string>

namespace lagroid::learning {

extern template class ParametricModel<NetworkPotential, 1>;
extern template class ParametricModel<NetworkPotential, 2>;
extern template class ParametricModel<NetworkPotential, Eigen::Dynamic>;

std::unique_ptr<Model> network_model(int bodies, std::vector<int> hidden) {
  const std::string name = hidden.empty() ? "network" : fmt::format("network:{}", fmt::join(hidden, ","));
  NetworkPotential potential(bodies, std::move(hidden));
  if (bodies == 1) return std::make_unique<ParametricModel<NetworkPotential, 1>>(name, std::move(potential));
  if (bodies == 2) return std::make_unique<ParametricModel<NetworkPotential, 2>>(name, std::move(potential));
  return std::make_unique<ParametricModel<NetworkPotential, Eigen::Dynamic>>(name, std::move(potential), bodies);
}

}  // namespace lagroid::learning
