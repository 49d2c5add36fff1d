#pragma once
/// Boundary values whose cheapest paths wind.

#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/systems/control/unicycle.hpp>

#include <vector>

namespace lagroid {

inline Matrix<double, 3, 3> pose(double x, double y, double heading) {
  return SE2::homogeneous<double>(SO2::exp(Vector<double, 1>(heading)), Vector<double, 2>(x, y));
}

/// At unit speed from the origin in 6 s, 60 steps.
inline BoundaryStage<Unicycle> unicycle_to(double x, double y, double heading) {
  Unicycle system;
  system.h = 0.1;
  return {{system, pose(x, y, heading)}, 60};
}

/// An end of the unicycle's whose cheapest path winds once, and what that costs: the best found by any number of
/// starts (1000 among them: `boundary_ends`, nightly).
struct WoundEnd {
  BoundaryStage<Unicycle> stage;
  double cost;
};
inline std::vector<WoundEnd> wound_ends() {
  return {{unicycle_to(0, 0, 0), 3.289868134},
          {unicycle_to(-1, 0.2, 0), 3.484372326},
          {unicycle_to(-2, 0, 0), 4.090355662},
          {unicycle_to(1, 1, -1), 2.846635008},
          {unicycle_to(-1, -1, 0.5), 2.956143767}};
}

}  // namespace lagroid
