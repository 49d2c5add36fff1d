#pragma once
/// The boundary-value problem of the plate-ball system in the trace form, handed to IPOPT.

#include "plate_ball_boundary.hpp"

namespace kernels {

struct IpoptSolution {
  bool solved = false;
  int iterations = 0;
  double cost = 0;
  PlateBallPath path;
};

/// The problem as one writes it for a solver of nonlinear programs. Variables: contact point and quaternion of each of
/// the N - 1 inner nodes. Minimise sum_k |q_k - q_{k-1}|^2 / (2 h) subject to the three rolling constraints of each
/// step, with w = 2 s0 (s1, s2, s3), s = conj(Q_{k-1}) Q_k, and |Q_k|^2 = 1. All polynomial: sparse Jacobian and
/// Hessian are exact. Linear solver MUMPS, everything else IPOPT's default.
IpoptSolution solve_with_ipopt(const PlateBallParameters& parameters, const PlateBallPath& start, double tolerance);

}  // namespace kernels
