#include "top.hpp"

#include "../libraries/libraries.hpp"
#include "../ours/ours.hpp"
#include "../ours/rotation.hpp"
#include "reference.hpp"

#include <lagroid/systems/rotations/heavy_top.hpp>

namespace peers {

Problem top() {
  using namespace lagroid;
  const TopProblem problem;
  Problem out = posed(problem, "top", "Lagrange's top", {100, 1e4});
  const auto& m = problem.momentum;
  const HeavyTop system;
  const Matrix<double, 3, 3> attitude = SO3::exp(Vector<double, 3>(problem.tilt, 0, 0));
  const Vector<double, 3> up(0, 0, 1);
  const ArrowOf<HeavyTop::GroupoidType> configuration{attitude, up};
  const State<HeavyTop::GroupoidType> start{system.groupoid.target(configuration), {m[0], m[1], m[2]}};
  out.methods = integrators(problem, system, start, configuration, [](const TrajectoryPoint<HeavyTop>& point) {
    return rotation_coordinates(point.configuration.element, point.state.momentum);
  });
  add(out.methods, peer_methods(problem));
  out.remarks =
      "Moments 1, 1, 1/2, weight times lever 1, M = (0.4, 0.2, 3), axis tilted by 0.6. Peers integrate quaternion and "
      "body "
      "momentum, seven unknowns, and take the vertical from the quaternion. Error: |M - M\\*| + |A - A\\*|. "
      "Invariants: "
      "energy, vertical and axial momentum.";
  return out;
}

}  // namespace peers
