#include "trajectory_files.hpp"

#include "../reading/csv_table.hpp"

#include <lagroid/run/files/hdf5_file.hpp>
#include <lagroid/run/files/output_folder.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using learning::Observation;

/// What `lagroid run` leaves of a motion.
constexpr const char* run_file_name = "trajectory.h5";

/// The name of the i-th number of a state on spheres.
std::string component(std::size_t i) { return fmt::format("{}{}{}", i % 6 < 3 ? 'q' : 'p', i / 6 + 1, "xyz"[i % 3]); }

using Columns = std::map<std::string, std::size_t, std::less<>>;

/// n, in R^2n: the largest number of a column q1, q2, ... or p1, p2, ...; zero on spheres.
std::size_t coordinates_of(const Columns& at) {
  std::size_t n = 0;
  for (const auto& [name, column] : at) {
    if (name.size() < 2 || (name[0] != 'q' && name[0] != 'p')) continue;
    std::size_t i = 0;
    const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), i);
    if (error == std::errc() && end == name.data() + name.size()) n = std::max(n, i);
  }
  return std::min(n, at.size());  // of so many one is missing anyway
}

/// The names of a state's numbers, in their order: of (q, p) in R^2n, else on spheres.
std::vector<std::string> state_names(const Columns& at, std::size_t coordinates) {
  std::vector<std::string> out;
  if (coordinates == 0) {
    for (std::size_t i = 0; i == 0 || i % 6 != 0 || at.contains(component(i)); ++i) out.push_back(component(i));
  } else {
    for (const char which : {'q', 'p'})
      for (std::size_t i = 1; i <= coordinates; ++i) out.push_back(fmt::format("{}{}", which, i));
  }
  return out;
}

/// Where the columns stand.
struct Header {
  std::size_t trajectory = 0;
  std::size_t time = 0;
  std::vector<std::size_t> state;
  bool on_spheres = true;
  std::size_t weight = std::string::npos;
};

Header header_of(const CsvTable& table, const std::string& file) {
  Columns at;
  for (const std::string& name : table.names) at.emplace(name, at.size());
  Header out;
  const std::size_t coordinates = coordinates_of(at);
  out.on_spheres = coordinates == 0;
  const auto take = [&](const std::string& name) {
    const auto found = at.find(name);
    if (found == at.end())
      throw DataError(
          fmt::format("{}: no column {} in the header; it names trajectory, t, and q1x, q1y, q1z, p1x, p1y, p1z, "
                      "q2x, ... or q1, ..., qn, p1, ..., pn",
                      file, name));
    const std::size_t column = found->second;
    at.erase(found);
    return column;
  };
  out.trajectory = take("trajectory");
  out.time = take("t");
  const std::vector<std::string> names = state_names(at, coordinates);
  for (const std::string& name : names) out.state.push_back(take(name));
  if (at.contains("weight")) out.weight = take("weight");
  if (!at.empty())
    throw DataError(fmt::format("{}: nobody knows the column {}; it names trajectory, t, {}, ..., {} and weight", file,
                                at.begin()->first, names.front(), names.back()));
  return out;
}

long label(double x, const std::string& file, long row) {
  if (x != std::floor(x) || std::abs(x) > 1e15)
    throw DataError(fmt::format("{}: row {}: trajectory {} is no whole number", file, row, x));
  return long(x);
}

ObservedStates read_csv(const fs::path& path) {
  const std::string file = path.string();
  const CsvTable table = read_csv_table(path, "trajectory, t, q1x, q1y, q1z, p1x, ...", Gaps::refused);
  const bool has_labels = std::find(table.names.begin(), table.names.end(), "trajectory") != table.names.end();
  if (const fs::path of_run = path.parent_path() / run_file_name; !has_labels && fs::exists(of_run))
    throw DataError(fmt::format("{}: the table of a run is not read; give {}", file, of_run.string()));
  const Header header = header_of(table, file);
  std::vector<Observation> out;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const std::vector<double>& numbers = table.rows[k];
    Observation row;
    row.row = table.lines[k];
    row.trajectory = label(numbers[header.trajectory], file, row.row);
    row.time = numbers[header.time];
    row.z.resize(Eigen::Index(header.state.size()));
    for (std::size_t i = 0; i < header.state.size(); ++i) row.z(Eigen::Index(i)) = numbers[header.state[i]];
    if (header.weight != std::string::npos) row.weight = numbers[header.weight];
    out.push_back(std::move(row));
  }
  return {std::move(out), header.on_spheres};
}

Eigen::MatrixXd dataset(const fs::path& file, const std::string& name) { return read_hdf5(file, "/" + name); }

void require_column(const Eigen::MatrixXd& column, const char* name, Eigen::Index rows, const std::string& file) {
  if (column.cols() != 1) throw DataError(fmt::format("{}: {} has {} columns; give it one", file, name, column.cols()));
  if (column.rows() != rows)
    throw DataError(fmt::format("{}: {} has {} rows, z {}; make them equal", file, name, column.rows(), rows));
}

/// Throws unless a run made equal steps.
void require_equal_steps(const Eigen::MatrixXd& time, const std::string& file) {
  constexpr double even = 1e-6;
  if (time.size() < 2) return;
  const double h = (time(time.size() - 1) - time(0)) / double(time.size() - 1);
  for (Eigen::Index i = 0; i < time.size(); ++i)
    if (!(std::abs(time(i) - time(0) - double(i) * h) <= even * std::abs(h) + 1e-15 * std::abs(time(i))))
      throw DataError(fmt::format(
          "{}: the steps of the run differ, adaptive ones or cut by events; give a run with equal steps", file));
}

/// What lagroid run left of a motion in R^n.
ObservedStates read_run(const fs::path& path, const std::set<std::string>& sets) {
  const std::string file = path.string();
  for (const char* foreign : {"attitude", "direction", "constraint_residual"})
    if (sets.contains(foreign))
      throw DataError(
          fmt::format("{}: a run with /{} is not one of coordinates alone; learn from runs in R^n without constraints, "
                      "or give the states as columns",
                      file, foreign));
  const auto q = dataset(path, "position");
  const auto p = dataset(path, "momentum");
  const auto time = dataset(path, "time");
  if (q.cols() != p.cols() || q.rows() != p.rows() || time.rows() != q.rows())
    throw DataError(fmt::format("{}: /time, /position and /momentum are not of one size; give a run in R^n", file));
  require_equal_steps(time, file);
  std::vector<Observation> out;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    Eigen::VectorXd z(2 * q.cols());
    z << q.row(i).transpose(), p.row(i).transpose();
    out.push_back({long(i) + 1, 1, time(i), std::move(z), 1});
  }
  return {std::move(out), false};
}

ObservedStates read_hdf5(const fs::path& path) {
  const std::string file = path.string();
  std::set<std::string> sets;
  H5::Exception::dontPrint();
  try {
    const H5::H5File in(file, H5F_ACC_RDONLY);
    for (hsize_t i = 0; i < in.getNumObjs(); ++i) sets.insert(in.getObjnameByIdx(i));
  } catch (const H5::Exception&) {
    throw DataError(fmt::format("{}: HDF5 cannot read it; give an HDF5 file, or one that ends in .csv", file));
  }
  if (!sets.contains("z") && sets.contains("position") && sets.contains("momentum")) return read_run(path, sets);
  if (!sets.contains("z") && sets.contains("time"))
    throw DataError(fmt::format(
        "{}: a run without /position and /momentum cannot be learned from; give a run in R^n, or its states "
        "as columns of a .csv file (docs/learning.md)",
        file));
  const auto z = dataset(path, "z");
  const auto trajectory = dataset(path, "trajectory");
  const auto time = dataset(path, "t");
  const Eigen::MatrixXd weight = sets.contains("weight") ? dataset(path, "weight") : Eigen::MatrixXd::Ones(z.rows(), 1);
  require_column(trajectory, "trajectory", z.rows(), file);
  require_column(time, "t", z.rows(), file);
  require_column(weight, "weight", z.rows(), file);
  std::vector<Observation> out;
  for (Eigen::Index i = 0; i < z.rows(); ++i)
    out.push_back({long(i) + 1, label(trajectory(i), file, long(i) + 1), time(i), z.row(i).transpose(), weight(i)});
  return {std::move(out), true};
}

void write_csv(std::span<const Observation> rows, const fs::path& file) {
  std::string out = "trajectory,t";
  for (Eigen::Index i = 0; i < rows.front().z.size(); ++i) out += "," + component(std::size_t(i));
  out += "\n";
  for (const Observation& row : rows) {
    fmt::format_to(std::back_inserter(out), "{},{}", row.trajectory, row.time);
    for (const double x : row.z) fmt::format_to(std::back_inserter(out), ",{}", x);
    out += "\n";
  }
  write_text(out, file);
}

void write_to_hdf5(std::span<const Observation> rows, const fs::path& file) {
  std::vector<double> trajectory;
  std::vector<double> time;
  std::vector<double> z;
  for (const Observation& row : rows) {
    trajectory.push_back(double(row.trajectory));
    time.push_back(row.time);
    z.insert(z.end(), row.z.begin(), row.z.end());
  }
  write_hdf5(file, [&](const H5::H5File& out) {
    set_attribute(out, "generator", "lagroid");
    set_attribute(add_dataset(out, "trajectory", trajectory, 1), "meaning", "which trajectory the row belongs to");
    set_attribute(add_dataset(out, "t", time, 1), "unit", "s");
    set_attribute(add_dataset(out, "z", z, std::size_t(rows.front().z.size())), "meaning",
                  "q_1, p_1, q_2, p_2, ..., three numbers each");
  });
}

}  // namespace

void require_trajectory_file(const fs::path& file) {
  if (file.extension() != ".csv" && file.extension() != ".h5")
    throw DataError(fmt::format("{}: trajectories are in .csv and .h5 (HDF5) files", file.string()));
}

ObservedStates read_observations(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_regular_file(file / run_file_name, ignored))
    throw DataError(fmt::format("{}: a run's folder; give {}", file.string(), (file / run_file_name).string()));
  if (!fs::is_regular_file(file, ignored)) throw DataError(fmt::format("{}: there is no such file", file.string()));
  if (!std::ifstream(file)) throw DataError(fmt::format("{}: cannot be read", file.string()));
  require_trajectory_file(file);
  return file.extension() == ".csv" ? read_csv(file) : read_hdf5(file);
}

ReadTrajectories read_trajectories(const fs::path& file, double noise, int points) {
  const ObservedStates observed = read_observations(file);
  const std::vector<Observation>& rows = observed.rows;
  const auto assembled = [&](std::span<const Observation> of) {
    if (observed.on_spheres || of.empty()) return learning::assemble(of, noise);
    return learning::assemble(of, learning::phase_space(int(of.front().z.size() / 2)), noise);
  };
  try {
    if (points == 0) return {assembled(rows)};
    const std::vector<Observation> pieces = learning::pieces_of(rows, points);
    // A piece begins at the last point of the one before, but for the first of a trajectory.
    long used = long(pieces.size()) / points * (points - 1);
    for (std::size_t r = 0; r < rows.size(); ++r) used += r == 0 || rows[r].trajectory != rows[r - 1].trajectory;
    return {assembled(pieces), long(rows.size()) - used};
  } catch (const learning::DataRefused& refused) {
    throw DataError(fmt::format("{}: {}", file.string(), refused.what()));
  }
}

learning::StateSpace space_of(const learning::Trajectories& data) {
  return data.bodies > 0 ? learning::cotangent_spheres(data.bodies) : learning::phase_space(int(data.width() / 2));
}

void write_observations(std::span<const Observation> rows, const fs::path& file) {
  if (file.extension() == ".csv") {
    write_csv(rows, file);
  } else {
    write_to_hdf5(rows, file);
  }
}

}  // namespace lagroid::app
