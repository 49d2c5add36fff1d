// In the place of ipopt_control.cpp in a build without IPOPT.
#include <lagroid/solvers/control/ipopt/ipopt_control.hpp>
#include <lagroid/solvers/missing_library.hpp>

namespace lagroid {

bool has_ipopt() { return false; }

IpoptSolution solve_by_ipopt(TrajectoryChart&, const ControlOptions&) {
  throw MissingLibrary("the solver \"ipopt\" of an optimal control problem", "IPOPT", "coinor-libipopt-dev");
}

}  // namespace lagroid
