// A boundary value from C++: Lambert's problem, the orbit of least action from one point to another in a given time.
//
// Run it: build/release/bin/boundary_value
#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/systems/kepler.hpp>

#include <fmt/format.h>

using namespace lagroid;

int main() {
  Kepler system;
  system.h = 0.02;
  const BoundaryProblem<Kepler> problem{system, {{1, 0}, {-0.3, 0.8}}};  // an arrow of R^2 x R^2: from, to
  const auto solver = make_boundary_solver<Kepler>(BoundaryMethod::newton);
  const auto found = solve_boundary(*solver, problem, /*steps=*/100);
  if (found.solutions.empty()) {
    fmt::print("no orbit found: {}, residual {:.1e}\n", to_string(found.best_failure.status),
               found.best_failure.residual);
    return 1;
  }
  const auto& orbit = found.solutions.front();  // of least action
  const auto p = initial_momentum(system, orbit.path);
  fmt::print("action {:.9f}, initial momentum ({:.6f}, {:.6f}), {}\n", orbit.cost, p(0), p(1),
             orbit.kind.is_minimum ? "a minimum" : "no minimum");
  return 0;
}
