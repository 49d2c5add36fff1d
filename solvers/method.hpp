#pragma once
/// What a one-step method declares of itself; tests hold it to its order (laws::order_laws).

#include <string>

namespace lagroid {

/// The traits of a one-step map z -> Phi_h(z) of A*G.
struct MethodTraits {
  std::string name;
  int order;        ///< the error after a fixed time is O(h^order)
  bool symmetric;   ///< Phi_{-h} o Phi_h is the identity
  bool symplectic;  ///< Phi_h is a Poisson map of A*G; symplectic where that is a cotangent bundle
  bool explicit_;   ///< explicit: no equations are solved
  int stages = 0;  ///< evaluations of a step in closed form (Strang steps, rates); 0 where the solver counts iterations
};

}  // namespace lagroid
