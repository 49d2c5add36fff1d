#include "objective_numbers.hpp"

#include "../gradient_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lagroid::app {

namespace {

using optimisation::Manifold, optimisation::ParameterEntry, optimisation::ParameterTable,
    optimisation::ParametricObjective, optimisation::entries_named;

}  // namespace

ObjectiveNumbers::ObjectiveNumbers(const std::string& problem, const ParametricObjective& objective,
                                   const Manifold& manifold)
    : objective_(objective) {
  const std::vector<ParameterTable> tables = objective.parameters();
  const auto add = [&](ParameterTable table, const auto& entries) { tables_.push_back({std::move(table), entries}); };
  for (std::size_t t = 0; t < tables.size(); ++t) {
    ParameterTable table = tables[t];
    if (table.name == "weights" && problem == "brockett") {
      table.name = "parameters.weights";
      add(table, [t](Eigen::Index i, Eigen::Index j) { return std::vector<ParameterEntry>{{t, i, j}}; });
    } else if (table.name == "points" && problem == "hyperbolic-mean") {
      // A point a line, by its space part: the time part follows.
      add({"data.points", table.rows, table.columns - 1}, [t](Eigen::Index i, Eigen::Index j) {
        return std::vector<ParameterEntry>{{t, i, j + 1}};
      });
    } else if (table.name == "points" && problem == "positive-definite-mean") {
      // Symmetric matrices, one below the other.
      const auto n = Eigen::Index(std::lround(std::sqrt(double(manifold.size()))));
      add({"data.matrices", table.rows * n, n}, [t, n](Eigen::Index i, Eigen::Index j) {
        const Eigen::Index matrix = i / n, row = i % n;
        if (row == j) return std::vector<ParameterEntry>{{t, matrix, row + j * n}};
        if (row > j) return std::vector<ParameterEntry>{};
        return std::vector<ParameterEntry>{{t, matrix, row + j * n}, {t, matrix, j + row * n}};
      });
    } else if (table.name == "A" || table.name == "B") {
      table.name = "data." + table.name;
      add(table, [t](Eigen::Index i, Eigen::Index j) { return std::vector<ParameterEntry>{{t, i, j}}; });
    }
  }
}

ObjectiveNumber ObjectiveNumbers::number(const Table& table, Eigen::Index row, Eigen::Index column) const {
  ObjectiveNumber out;
  auto entries = table.entries(row, column);
  if (entries.empty()) {
    // The one across the diagonal of its matrix.
    const Eigen::Index first = row - row % table.of_scene.columns;
    std::swap(row, column);
    column -= first;
    row += first;
    entries = table.entries(row, column);
  }
  out.name = name_of(table.of_scene, row, column);
  out.value = objective_.parameter(entries.front());
  out.size = out.value != 0 ? std::abs(out.value) : 1e-2 * largest_in_row(table, row);
  out.entries = std::move(entries);
  return out;
}

double ObjectiveNumbers::largest_in_row(const Table& table, Eigen::Index row) const {
  double out = 0;
  for (Eigen::Index column = 0; column < table.of_scene.columns; ++column)
    if (const auto entries = table.entries(row, column); !entries.empty())
      out = std::max(out, std::abs(objective_.parameter(entries.front())));
  return out;
}

std::vector<ObjectiveNumber> ObjectiveNumbers::of_table(const Table& table) const {
  std::vector<ObjectiveNumber> out;
  for (const ParameterEntry& each : entries_named({table.of_scene}, table.of_scene.name))
    if (!table.entries(each.row, each.column).empty()) out.push_back(number(table, each.row, each.column));
  return out;
}

std::vector<ObjectiveNumber> ObjectiveNumbers::named(const std::string& word) const {
  std::vector<ObjectiveNumber> out;
  std::vector<ParameterTable> of_scene;
  for (const Table& table : tables_) {
    of_scene.push_back(table.of_scene);
    if (!table.of_scene.name.starts_with(word + ".")) continue;
    const auto more = of_table(table);
    out.insert(out.end(), more.begin(), more.end());
  }
  if (!out.empty()) return out;
  try {
    for (const ParameterEntry& each : entries_named(of_scene, word)) {
      const Table& table = tables_[each.table];
      ObjectiveNumber found = number(table, each.row, each.column);
      const auto is_same = [&](const ObjectiveNumber& other) { return other.name == found.name; };
      if (std::none_of(out.begin(), out.end(), is_same)) out.push_back(std::move(found));
    }
  } catch (const std::invalid_argument& error) {
    throw GradientRefused(error.what());
  }
  return out;
}

std::vector<ObjectiveNumber> ObjectiveNumbers::few(Eigen::Index most, std::vector<std::string>& notes) const {
  std::vector<ObjectiveNumber> out;
  for (const Table& table : tables_) {
    const ParameterTable& of_scene = table.of_scene;
    if (of_scene.count() > most && of_scene.name.starts_with("data.")) {
      notes.push_back(fmt::format("the {} numbers of {} are left out: ask for them by name, as {}", of_scene.count(),
                                  of_scene.name, name_of(of_scene, 0, 0)));
      continue;
    }
    const auto more = of_table(table);
    out.insert(out.end(), more.begin(), more.end());
  }
  if (out.empty())
    throw GradientRefused(notes.empty() ? "this problem has no numbers by which its minimum has a derivative"
                                        : fmt::format("--wrt: {}", fmt::join(notes, "; ")));
  return out;
}

std::unique_ptr<ParametricObjective> ObjectiveNumbers::changed(const ParametricObjective& objective,
                                                               const ObjectiveNumber& number, double by) {
  std::unique_ptr<ParametricObjective> out;
  for (const ParameterEntry& each : number.entries) out = (out ? *out : objective).changed(each, by);
  return out;
}

}  // namespace lagroid::app
