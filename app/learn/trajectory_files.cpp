#include "trajectory_files.hpp"

#include "../reading/csv_table.hpp"

#include <lagroid/run/files/hdf5_file.hpp>
#include <lagroid/run/files/output_folder.hpp>

#include <fmt/format.h>

#include <array>
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

/// The name of the i-th number of a state on spheres.
std::string component(std::size_t i) { return fmt::format("{}{}{}", i % 6 < 3 ? 'q' : 'p', i / 6 + 1, "xyz"[i % 3]); }

using Columns = std::map<std::string, std::size_t, std::less<>>;

/// The names of a state's numbers, in their order: of (q, p) in R^2n where there is a q1, else on spheres.
std::vector<std::string> state_names(const Columns& at, bool on_spheres) {
  std::vector<std::string> out;
  if (on_spheres) {
    for (std::size_t i = 0; i == 0 || i % 6 != 0 || at.contains(component(i)); ++i) out.push_back(component(i));
  } else {
    for (int i = 1; at.contains(fmt::format("q{}", i)); ++i) out.push_back(fmt::format("q{}", i));
    for (std::size_t n = out.size(), i = 1; i <= n; ++i) out.push_back(fmt::format("p{}", i));
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
  out.on_spheres = !at.contains("q1");
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
  const std::vector<std::string> names = state_names(at, out.on_spheres);
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
  if (!fs::is_regular_file(file, ignored)) throw DataError(fmt::format("{}: there is no such file", file.string()));
  if (!std::ifstream(file)) throw DataError(fmt::format("{}: cannot be read", file.string()));
  require_trajectory_file(file);
  return file.extension() == ".csv" ? read_csv(file) : read_hdf5(file);
}

learning::Trajectories read_trajectories(const fs::path& file, double noise, int points) {
  ObservedStates observed = read_observations(file);
  try {
    if (points > 0) observed.rows = learning::pieces_of(observed.rows, points);
    if (observed.on_spheres || observed.rows.empty()) return learning::assemble(observed.rows, noise);
    return learning::assemble(observed.rows, learning::phase_space(int(observed.rows.front().z.size() / 2)), noise);
  } catch (const learning::DataRefused& refused) {
    throw DataError(fmt::format("{}: {}", file.string(), refused.what()));
  }
}

void write_observations(std::span<const Observation> rows, const fs::path& file) {
  if (file.extension() == ".csv") {
    write_csv(rows, file);
  } else {
    write_to_hdf5(rows, file);
  }
}

}  // namespace lagroid::app
