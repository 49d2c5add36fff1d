#pragma once
/// Potentials that are small networks,
///
///     V = w . a_L,    a_l = tanh(W_l a_{l-1} + b_l),    a_0 = (q_1, ..., q_k).
///
/// For potentials of no known form.
///
///     const learning::NetworkPotential potential(2, {8});  // bodies, units of the hidden layers
///
/// No bodies, no layers, layers without units or more than `most` parameters throw std::invalid_argument.

#include <lagroid/solvers/learning/functions/network.hpp>
#include <lagroid/solvers/learning/potentials/potential.hpp>

#include <utility>
#include <vector>

namespace lagroid::learning {

/// V = w . a_L, a_l = tanh(W_l a_{l-1} + b_l), a_0 = (q_1, ..., q_k).
class NetworkPotential : public Network {
 public:
  /// Throws std::invalid_argument unless there are bodies and layers, all with units, and `most` parameters or fewer.
  NetworkPotential(int bodies, std::vector<int> hidden) : Network(3 * bodies, std::move(hidden)) {}
};

}  // namespace lagroid::learning
