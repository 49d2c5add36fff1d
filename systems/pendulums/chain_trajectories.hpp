#pragma once
/// Trajectories of pendulum chains, to learn from: starts drawn as in [H], motions followed to round-off, and noise
/// added if wanted.
///
///     const PendulumChain<Eigen::Dynamic> chain(Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1));
///     const std::vector<learning::Observation> rows = draw_trajectories(chain, {.count = 100, .seed = 1});
///     const learning::Trajectories data = learning::assemble(rows);
///
/// Throws std::invalid_argument for numbers out of range, and std::runtime_error where the motion cannot be followed.
/// [H]

#include <lagroid/solvers/learning/trajectories.hpp>
#include <lagroid/systems/pendulums/pendulum_chain.hpp>

#include <functional>
#include <vector>

namespace lagroid {

/// Which trajectories.
struct ChainTrajectories {
  int count = 500;        ///< N
  int points = 5;         ///< M, the start included
  double duration = 0.1;  ///< from the first point to the last, s
  /// Uniform errors in [-noise, noise] are added to every number of all points but the first, as in [H].
  double noise = 0;
  unsigned seed = 0;
  std::function<bool()> stop = nullptr;  ///< called before each inner step; true ends the drawing
};

/// Starts are drawn as in [H]: q_i uniform on the sphere, p_i = q_i x s with s uniform in [0, 1]^3. The motion is
/// followed to a tolerance of 1e-13 in the algebra. Equal seeds give equal bits. Throws std::invalid_argument for
/// numbers that ask for nothing, and std::runtime_error where the motion cannot be followed, takes a million inner
/// steps from one point to the next, or was stopped.
std::vector<learning::Observation> draw_trajectories(const PendulumChain<Eigen::Dynamic>& chain,
                                                     const ChainTrajectories& which);

}  // namespace lagroid
