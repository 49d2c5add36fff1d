#pragma once
/// Trajectories on (T*S^2)^k in files (docs/learning.md).

#include "../reading/data_set.hpp"

#include <lagroid/solvers/learning/trajectories.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace lagroid::app {

/// Reads a .csv file with a header (trajectory, t, q1x, q1y, q1z, p1x, p1y, p1z, q2x, ..., and weight, if wanted) or an
/// .h5 file with data sets of the same names, the states in one, z. Rows are numbered as lines of the file, or from 1
/// in HDF5. Throws DataError.
std::vector<learning::Observation> read_observations(const std::filesystem::path& file);

/// The same, put together (learning::assemble). Throws DataError, which names file and row.
learning::Trajectories read_trajectories(const std::filesystem::path& file, double noise);

/// Throws DataError unless the name ends in .csv or .h5.
void require_trajectory_file(const std::filesystem::path& file);

/// Writes them as `read_observations` reads them, every bit kept. Throws OutputError.
void write_observations(std::span<const learning::Observation> rows, const std::filesystem::path& file);

}  // namespace lagroid::app
