#pragma once
/// Settings and call that every use of Ceres has in common. Ceres returns its first point where it ends by a failure;
/// here it is always the best one that it came to, and nothing is written on standard error.

#include <ceres/problem.h>
#include <ceres/solver.h>

namespace lagroid::detail {

/// Settings for equations, least squares that can be zero: on, quietly and on one thread, to the limits of double
/// precision. There a step may be worth nothing in Ceres' own reckoning, and is then tried shorter until it ends: it is
/// no failure of a problem that may be solved already.
ceres::Solver::Options to_round_off(int max_iterations);

/// ceres::Solve that leaves the best point it came to, where Ceres leaves the first if it ends by a failure, and that
/// writes nothing on standard error.
ceres::Solver::Summary solve_by_ceres(ceres::Solver::Options options, ceres::Problem& problem);

}  // namespace lagroid::detail
