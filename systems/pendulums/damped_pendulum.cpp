#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/reference.hpp>

namespace lagroid {

State<Pair<1>> DampedPendulum::reference(const State<Pair<1>>& start, double t) const {
  using V = Vector<double, 1>;
  return reference_motion(
      mass(), [&](const V& q, const V& velocity, double) { return V(force(q) - damping * velocity); }, start, t);
}

}  // namespace lagroid
