#include "spherical_pendulum.hpp"

#include "../libraries/libraries.hpp"
#include "../ours/mechanical.hpp"
#include "reference.hpp"

#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

namespace peers {

Problem spherical_pendulum() {
  const SphericalPendulumProblem problem;
  Problem out = posed(problem, "spherical-pendulum", "Spherical pendulum", {100, 1e4});
  out.methods = mechanical_integrators(problem, lagroid::SphericalPendulum{});
  add(out.methods, peer_methods(problem));
  out.remarks =
      "Unit mass, length and gravity, from q = (0.8, 0, -0.6), p = (0, 0.7, 0). Peers integrate the equations in R^3 x "
      "R^3 with the rod's force eliminated. Error: |(q, p) - (q\\*, p\\*)|. Invariants: energy, vertical angular "
      "momentum, "
      "|q|, q.p.";
  return out;
}

}  // namespace peers
