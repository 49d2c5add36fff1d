#include "kepler.hpp"

#include "../libraries/libraries.hpp"
#include "../ours/mechanical.hpp"
#include "reference.hpp"

#include <lagroid/systems/kepler.hpp>

namespace peers {

Problem kepler() {
  const KeplerProblem problem;
  Problem out = posed(problem, "kepler", "Kepler, e = 0.6", {100, 1e4});
  out.methods = mechanical_integrators(problem, lagroid::Kepler{});
  add(out.methods, peer_methods(problem));
  out.remarks =
      "Unit mass and strength, from the pericentre, period 2 pi. Error: |(q, p) - (q\\*, p\\*)|. Invariants: energy, "
      "angular "
      "momentum, eccentricity vector. The reference is exact, by Kepler's equation in long double.";
  return out;
}

}  // namespace peers
