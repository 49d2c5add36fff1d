#include <lagroid/systems/pendulums/driven_pendulum.hpp>
#include <lagroid/systems/reference.hpp>

namespace lagroid {

State<Pair<1>> DrivenPendulum::reference(const State<Pair<1>>& start, double t) const {
  using V = Vector<double, 1>;
  const auto force = [&](const V& q, const V&, double at) {
    return V(-potential(Dual<double>(q(0), 1.0), at).derivative);
  };
  return reference_motion(mass(), force, start, t, time);
}

}  // namespace lagroid
