#include "rigid_body.hpp"

#include "../libraries/libraries.hpp"
#include "../ours/ours.hpp"
#include "../ours/rotation.hpp"
#include "reference.hpp"

#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

namespace peers {

Problem rigid_body() {
  using namespace lagroid;
  const RigidBodyProblem problem;
  Problem out = posed(problem, "rigid-body", "Free rigid body near its middle axis", {100, 1e4});
  const auto& m = problem.momentum;
  const State<SO3> start{{}, {m[0], m[1], m[2]}};
  const Matrix<double, 3, 3> attitude = Matrix<double, 3, 3>::Identity();
  const RigidBody body;
  out.methods = integrators(problem, body, start, attitude, [](const TrajectoryPoint<RigidBody>& point) {
    return rotation_coordinates(point.configuration, point.state.momentum);
  });
  for (int order = 2; order <= 10; order += 2)
    out.methods.push_back(integrated<MoserVeselov>(
        problem, fmt::format("Moser-Veselov, order {}", order), order, problem.unit(),
        [=](double h) {
          return make_integrator(MoserVeselov::preprocessed(body.inertia, start.momentum, h, order), start, attitude,
                                 {});
        },
        [](const TrajectoryPoint<MoserVeselov>& point) {
          return rotation_coordinates(point.configuration, point.state.momentum);
        }));
  add(out.methods, peer_methods(problem));
  out.remarks =
      "Moments 1, 2, 3, M = (0.2, 1.98, 0.1). Peers integrate quaternion and body momentum, seven unknowns. Error: "
      "|M - M\\*| + |A - A\\*|, the latter over all nine components. Invariants: energy and A M.";
  return out;
}

}  // namespace peers
