#include "pendulum.hpp"

#include "../libraries/libraries.hpp"
#include "../ours/mechanical.hpp"
#include "reference.hpp"

#include <lagroid/systems/pendulums/pendulum.hpp>

namespace peers {

Problem pendulum() {
  const PendulumProblem problem;
  Problem out = posed(problem, "pendulum", "Planar pendulum", {100, 1e4});
  out.methods = mechanical_integrators(problem, lagroid::Pendulum{});
  add(out.methods, peer_methods(problem));
  out.remarks =
      "Unit mass, length and gravity, let go at two radians; period 8.35. Error: |(q, p) - (q\\*, p\\*)|. Invariant: "
      "energy.";
  return out;
}

}  // namespace peers
