#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

namespace lagroid {

State<Pair<3>> SphericalPendulum::reference(const State<Pair<3>>& start, double t) const {
  using V = Vector<double, 3>;
  const auto force = [&](const V& q, const V& velocity, double) { return rates({q, velocity * bob_mass}).momentum; };
  return reference_motion(bob_mass, force, start, t);
}

}  // namespace lagroid
