#pragma once
/// A plate-ball boundary-value problem for the framework and its peers: same ends, same start.

#include <lagroid/solvers/boundary/boundary_newton.hpp>
#include <lagroid/systems/control/plate_ball.hpp>

#include "../kernels/plate_ball/plate_ball_boundary.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace bench {

using namespace lagroid;

/// A case of the plate-ball boundary-value problem: N steps in unit time, in the trace form.
struct BoundaryCase {
  BoundaryProblem<PlateBall> problem;
  Path<PlateBall> start;
};

/// Starts from the minimum of 20 steps in the exponential form, its nodes displaced by a sine wave of the given size.
inline BoundaryCase boundary_case(bool rotating, std::size_t count, double size = 0.1) {
  constexpr long coarse = 20;
  PlateBall system;
  system.h = 1.0 / coarse;
  system.rotation = RotationForm::exponential;
  if (rotating) {
    system.plate_rate = 1;
    system.spin = 0.5;
  }
  const Eigen::Vector2d from = rotating ? Eigen::Vector2d(0.2, -0.1) : Eigen::Vector2d(0, 0);
  const ArrowOf<PlateBall::GroupoidType> ends{PairArrow<double, 2>{from, Eigen::Vector2d(1, 0.5)},
                                              SO3::exp(Eigen::Vector3d(0.6, -0.3, 0.9))};
  Path<PlateBall> path;
  for (auto& arrow : system.path(ends, coarse, Eigen::Matrix2Xd::Zero(2, 0))) path.push_back({arrow, {0, 0, 0}});
  BoundaryProblem<PlateBall> problem{system, ends};
  const auto solution = BoundaryNewton<PlateBall>().solve(problem, std::move(path), false);
  if (!solution.converged()) throw std::runtime_error("the coarse problem was not solved");
  problem.system.h = 1.0 / double(count);
  problem.system.rotation = RotationForm::trace;
  Variation<PlateBall> wave(count);
  for (std::size_t k = 0; k < count; ++k)
    wave.nodes[k] =
        size * std::sin(2 * std::numbers::pi * double(k + 1) / double(count)) * Vector<double, 5>(1, -1, 1, 1, -1);
  return {problem, displaced(problem, resampled(problem, solution.path, count), wave, 1.0)};
}

/// The path in the terms of the peers.
inline kernels::PlateBallPath nodes(const Path<PlateBall>& path) {
  kernels::PlateBallPath out;
  out.position.push_back(std::get<0>(path.front().arrow).source);
  out.attitude.push_back(Eigen::Matrix3d::Identity());
  for (const auto& [arrow, lambda] : path) {
    out.position.push_back(std::get<0>(arrow).target);
    out.attitude.push_back(SO3::project((out.attitude.back() * std::get<1>(arrow)).eval()));
    out.multipliers.push_back(lambda);
  }
  return out;
}

inline kernels::PlateBallParameters parameters(const PlateBall& s) { return {s.h, s.radius, s.plate_rate, s.spin}; }

}  // namespace bench
