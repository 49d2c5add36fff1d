// Paths and names of version 0.2, which compat/ still has.
#include <lagroid/core/tape.hpp>
#include <lagroid/solvers/march.hpp>
#include <lagroid/solvers/optimisation/accelerated.hpp>
#include <lagroid/solvers/optimisation/manifold.hpp>
#include <lagroid/systems/rigid_body.hpp>

#include <memory>
#include <type_traits>

using namespace lagroid;

static_assert(std::is_base_of_v<optimisation::Method, optimisation::HamiltonianDescent>);
static_assert(std::is_same_v<optimisation::State, optimisation::EvaluatedPoint>);
static_assert(std::is_enum_v<optimisation::Outcome> && std::is_enum_v<optimisation::Retraction>);

int main() {
  RigidBody body;
  body.inertia = {1, 2, 3};
  const State<RigidBody::GroupoidType> start{{}, {0.1, 1, 0.1}};
  const std::unique_ptr<March<RigidBody>> march =
      make_march(body, start, body.groupoid.unit(start.object), MarchOptions{});
  Tape tape;
  return march->advance().converged() && tape.numbers().empty() ? 0 : 1;
}
