#pragma once
/// Numbers with shapes, as Python sees them.

#include <lagroid/run/motion/observables.hpp>

#include <cstddef>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::python {

/// Of every system: object, momentum, configuration, arrow, multipliers and step_size.
inline constexpr std::size_t count_of_fields = 6;

/// How many numbers there are in a vector or a matrix.
inline std::size_t width_of(const std::vector<std::size_t>& shape) {
  return std::accumulate(shape.begin(), shape.end(), std::size_t(1), std::multiplies<>());
}

/// A field of vectors or, columns first in memory, matrices. Its numbers have no labels.
inline Field field_of(std::string name, std::vector<std::size_t> shape, bool on_arrows = false) {
  const std::vector<std::string> labels(width_of(shape));
  return {.columns = {std::move(name), labels, "", "", on_arrows, {}}, .shape = std::move(shape)};
}

/// Rows of numbers of one field, for nodes or arrows. There are as many where a row has no numbers.
struct Rows {
  explicit Rows(Field of) : field(std::move(of)) {}

  Field field;
  std::size_t count = 0;
  std::vector<double> values;

  /// Room for one more.
  double* add() {
    const std::size_t at = values.size();
    values.resize(at + field.columns.width());
    ++count;
    return values.data() + at;
  }
};

/// A stationary path between two ends: what Python's BoundarySolution shows of the one in C++.
struct BoundaryPath {
  double cost = 0;  ///< sum of the Lagrangian over the arrows
  int starts = 0;   ///< that led to it
  bool is_minimum = false;
  bool isolated = true;
  bool normal = true;
  long negative_directions = 0;
  std::vector<Rows> rows;  ///< objects and momenta at the nodes, arrows and multipliers
};

}  // namespace lagroid::python
