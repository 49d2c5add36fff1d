#pragma once
/// Data to learn from: N trajectories of M points z each, at equal intervals: on (T*S^2)^k z = (q_1, p_1, ..., q_k,
/// p_k), on any other space z = (q, p).
///
///     std::vector<learning::Observation> rows;
///     const Eigen::VectorXd hanging{{0, 0, -1, 0, 0, 0}};
///     for (int j = 0; j < 3; ++j) rows.push_back({.row = j, .trajectory = 0, .time = 0.1 * j, .z = hanging});
///     const learning::Trajectories data = learning::assemble(rows);
///     const auto of_the_plane = [](std::span<const learning::Observation> states) {
///       return learning::assemble(states, learning::phase_space(1));  // z = (q, p)
///     };
///
/// Rows of one trajectory stand together, in the order of time. `assemble` checks everything and throws DataRefused,
/// with the row, what is wrong, and what to do.

#include <lagroid/solvers/learning/state_space.hpp>

#include <Eigen/Core>

#include <span>
#include <stdexcept>
#include <vector>

namespace lagroid::learning {

/// Data that cannot be learned from. The message is one line: which row or trajectory, what is wrong, what to do.
class DataRefused : public std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// One observed state.
struct Observation {
  long row = 0;         ///< what messages call it
  long trajectory = 0;  ///< which one it belongs to; rows of one stand together, in the order of time
  double time = 0;
  Eigen::VectorXd z;  ///< q_1, p_1, q_2, p_2, ... on (T*S^2)^k, (q, p) elsewhere
  double weight = 1;  ///< of its squared error
};

/// N trajectories of M points each, at equal intervals of time.
struct Trajectories {
  int bodies = 0;              ///< k; zero where they are not on (T*S^2)^k
  int points = 0;              ///< M, the first included
  double interval = 0;         ///< between points
  Eigen::MatrixXd starts;      ///< a column each, brought onto the space
  Eigen::MatrixXd ends;        ///< the later points, one after the other, N columns
  Eigen::MatrixXd weights;     ///< (M - 1) x N; `assemble` makes their mean one
  Eigen::Index dimension = 0;  ///< of the space: 4k on (T*S^2)^k

  Eigen::Index count() const { return starts.cols(); }
  Eigen::Index width() const { return starts.rows(); }
  /// How many numbers there are, each counted by its weight: errors are divided by it.
  double total_weight() const { return weights.sum() * double(width()); }
  /// The space's dimension for each later point of positive weight: so much a point can tell.
  Eigen::Index free_numbers() const { return dimension * (weights.array() > 0).count(); }
  /// Those from `first` on, `number` of them.
  Trajectories part(Eigen::Index first, Eigen::Index number) const;
  /// In an order that belongs to the seed, the same on every machine.
  Trajectories shuffled(unsigned seed) const;
};

/// Puts observations on `space` together. `noise` is the size of the errors in each number, zero where they are
/// rounding: rows may be off the space by six times as much (and 1e-6, what a text file with seven digits leaves), on
/// spheres q_i off them and p_i off the tangent planes. The first point of a trajectory is brought onto the space and
/// then taken for exact: its noise is not modelled, and adds to the error of all points that follow.
///
/// Throws DataRefused, naming the row: no rows, numbers that are not as many as the space has, a number that is not
/// finite or above 1e100, a state off the space, a negative weight, a weight of zero for the first point of a
/// trajectory whose other points have some, times that do not rise, are not equally spaced (to 1e-6 of the interval,
/// and round-off) or differ between trajectories, trajectories of unequal length or of one point, or one that is not in
/// one piece.
Trajectories assemble(std::span<const Observation> rows, const StateSpace& space, double noise = 0);
/// The same on (T*S^2)^k, with k such that the first row fits.
Trajectories assemble(std::span<const Observation> rows, double noise = 0);

/// Long trajectories as pieces of so many points, each of which begins where the one before ends; what is left at the
/// end is dropped. An error then is that of one piece, and no longer grows along all of a motion. Throws DataRefused
/// for pieces of fewer than two points, and for a trajectory that is shorter than one.
std::vector<Observation> pieces_of(std::span<const Observation> rows, int points);

}  // namespace lagroid::learning
