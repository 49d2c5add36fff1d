#include <lagroid/solvers/optimisation/sensitivity/parametric_objective.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>

namespace lagroid::optimisation {

namespace {

/// What stands between the dots after the name of a table, as places in it; none where that is no number.
std::optional<std::vector<Eigen::Index>> places_in(const std::string& words) {
  std::vector<Eigen::Index> out;
  if (words.ends_with('.')) return std::nullopt;
  for (std::size_t from = 0; from < words.size();) {
    const std::size_t dot = std::min(words.find('.', from), words.size());
    Eigen::Index place = -1;
    const auto [end, error] = std::from_chars(words.data() + from, words.data() + dot, place);
    if (error != std::errc() || end != words.data() + dot || place < 0) return std::nullopt;
    out.push_back(place);
    from = dot + 1;
  }
  return out;
}

/// The entries of a table at such a row and column; -1: at all of them.
std::vector<ParameterEntry> entries_at(const ParameterTable& table, std::size_t index, Eigen::Index row,
                                       Eigen::Index column) {
  std::vector<ParameterEntry> out;
  if (row >= table.rows || column >= table.columns) return out;
  if (table.is_symmetric && row >= 0 && column >= 0) return {{index, std::min(row, column), std::max(row, column)}};
  for (Eigen::Index i = 0; i < table.rows; ++i)
    for (Eigen::Index j = table.is_symmetric ? i : 0; j < table.columns; ++j) {
      const bool in_row = row < 0 || i == row || (table.is_symmetric && j == row);
      if (in_row && (column < 0 || j == column)) out.push_back({index, i, j});
    }
  return out;
}

/// Which tables there are, for messages.
std::string listed_tables(const std::vector<ParameterTable>& tables) {
  std::string out;
  for (const ParameterTable& table : tables)
    out += fmt::format(
        "{}{} ({})", out.empty() ? "" : ", ", table.name,
        table.columns == 1 ? fmt::format("{}", table.rows) : fmt::format("{} x {}", table.rows, table.columns));
  return out.empty() ? "none" : out;
}

}  // namespace

std::string name_of(const ParameterTable& table, Eigen::Index row, Eigen::Index column) {
  if (table.rows == 1 && table.columns == 1) return table.name;
  if (table.columns == 1) return fmt::format("{}.{}", table.name, row);
  return fmt::format("{}.{}.{}", table.name, row, column);
}

std::string name_of(const std::vector<ParameterTable>& tables, const ParameterEntry& which) {
  return name_of(tables.at(which.table), which.row, which.column);
}

std::vector<ParameterEntry> entries_named(const std::vector<ParameterTable>& tables, const std::string& name) {
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const ParameterTable& table = tables[t];
    if (name == table.name) return entries_at(table, t, -1, -1);
    if (!name.starts_with(table.name + ".")) continue;
    const auto places = places_in(name.substr(table.name.size() + 1));
    if (!places || places->empty() || places->size() > (table.columns == 1 ? 1U : 2U)) continue;
    auto found = entries_at(table, t, places->front(), places->size() == 2 ? places->back() : -1);
    if (!found.empty()) return found;
  }
  throw std::invalid_argument(
      fmt::format("{}: no number of that name, places count from 0; there are {}", name, listed_tables(tables)));
}

}  // namespace lagroid::optimisation
