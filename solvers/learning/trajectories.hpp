#pragma once
/// Data to learn from: N trajectories of M points z = (q_1, p_1, ..., q_k, p_k) each on (T*S^2)^k, at equal intervals.
///
///     std::vector<learning::Observation> rows;
///     const Eigen::VectorXd hanging{{0, 0, -1, 0, 0, 0}};
///     for (int j = 0; j < 3; ++j) rows.push_back({.row = j, .trajectory = 0, .time = 0.1 * j, .z = hanging});
///     const learning::Trajectories data = learning::assemble(rows);
///
/// Rows of one trajectory stand together, in the order of time. `assemble` checks everything and throws DataRefused,
/// with the row, what is wrong, and what to do.

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
  Eigen::VectorXd z;  ///< 6k numbers: q_1, p_1, q_2, p_2, ...
  double weight = 1;  ///< of its squared error
};

/// N trajectories of M points each, at equal intervals of time.
struct Trajectories {
  int bodies = 0;           ///< k
  int points = 0;           ///< M, the first included
  double interval = 0;      ///< between points
  Eigen::MatrixXd starts;   ///< 6k x N, brought onto (T*S^2)^k
  Eigen::MatrixXd ends;     ///< 6k (M - 1) x N: the later points, one after the other
  Eigen::MatrixXd weights;  ///< (M - 1) x N; `assemble` makes their mean one

  Eigen::Index count() const { return starts.cols(); }
  Eigen::Index width() const { return starts.rows(); }
  /// How many numbers there are, each counted by its weight: errors are divided by it.
  double total_weight() const { return weights.sum() * double(width()); }
  /// 4k for each later point of positive weight: so much a point of (T*S^2)^k can tell.
  Eigen::Index free_numbers() const { return 4 * bodies * (weights.array() > 0).count(); }
  /// Those from `first` on, `number` of them.
  Trajectories part(Eigen::Index first, Eigen::Index number) const;
  /// In an order that belongs to the seed, the same on every machine.
  Trajectories shuffled(unsigned seed) const;
};

/// Puts observations together. `noise` is the size of the errors in each number, zero where they are rounding: rows may
/// be off the spheres, and momenta off the tangent planes, by six times as much (and 1e-6, what a text file with seven
/// digits leaves). The first point of a trajectory is brought onto (T*S^2)^k and then taken for exact: its noise is not
/// modelled, and adds to the error of all points that follow.
///
/// Throws DataRefused, naming the row: no rows, unequal numbers of columns, a number that is not finite or above 1e100,
/// q_i off the sphere, p_i not tangent, a negative weight, times that do not rise, are not equally spaced (to 1e-6 of
/// the interval, and round-off) or differ between trajectories, trajectories of unequal length or of one point, or one
/// that is not in one piece.
Trajectories assemble(std::span<const Observation> rows, double noise = 0);

/// z brought onto (T*S^2)^k.
void put_on_spheres(Eigen::Ref<Eigen::VectorXd> z);

}  // namespace lagroid::learning
