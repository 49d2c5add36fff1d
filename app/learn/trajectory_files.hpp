#pragma once
/// Trajectories on (T*S^2)^k and in R^2n in files (docs/learning.md).

#include "../reading/data_set.hpp"

#include <lagroid/solvers/learning/trajectories.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace lagroid::app {

/// Rows of a file, and where their states are.
struct ObservedStates {
  std::vector<learning::Observation> rows;
  bool on_spheres = true;  ///< else in R^2n
};

/// Reads a .csv file with a header (trajectory, t, q1x, q1y, q1z, p1x, p1y, p1z, q2x, ..., on spheres, or trajectory,
/// t, q1, ..., qn, p1, ..., pn; and weight, if wanted), an .h5 file with data sets of the same names, states on spheres
/// in one, z; or the trajectory.h5 of a run in R^n: time, position, momentum. Rows are numbered as lines of the file,
/// or from 1 in HDF5. Throws DataError.
ObservedStates read_observations(const std::filesystem::path& file);

/// Trajectories of a file.
struct ReadTrajectories {
  learning::Trajectories trajectories;
  long left_out = 0;  ///< points at the ends of trajectories that make no whole piece
};

/// The same, put together (learning::assemble), in pieces of so many points (learning::pieces_of) unless that is zero.
/// Throws DataError, which names file and row.
ReadTrajectories read_trajectories(const std::filesystem::path& file, double noise, int points = 0);

/// Where trajectories of a file are: on spheres, or in R^2n.
learning::StateSpace space_of(const learning::Trajectories& data);

/// Throws DataError unless the name ends in .csv or .h5.
void require_trajectory_file(const std::filesystem::path& file);

/// Writes them as `read_observations` reads them, every bit kept. Throws OutputError.
void write_observations(std::span<const learning::Observation> rows, const std::filesystem::path& file);

}  // namespace lagroid::app
