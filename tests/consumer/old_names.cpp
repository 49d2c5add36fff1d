// Paths and names of version 0.2, which compat/ still has.
#include <lagroid/core/tape.hpp>
#include <lagroid/solvers/march.hpp>
#include <lagroid/systems/rigid_body.hpp>

#include <memory>

using namespace lagroid;

int main() {
  RigidBody body;
  body.inertia = {1, 2, 3};
  const State<RigidBody::GroupoidType> start{{}, {0.1, 1, 0.1}};
  const std::unique_ptr<March<RigidBody>> march =
      make_march(body, start, body.groupoid.unit(start.object), MarchOptions{});
  Tape tape;
  return march->advance().converged() && tape.numbers().empty() ? 0 : 1;
}
