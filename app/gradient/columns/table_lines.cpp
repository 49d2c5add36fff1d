#include "table_lines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace lagroid::app {

std::string words_of_growth(const GradientTable& table) {
  std::string out = "\n";
  if (!table.of_boundary_value)
    out += fmt::format(
        "  errors grow {:.3g} times on the way: of {} {:.1f} are left\n", table.growth,
        table.digits_left < digits_left_by(table.growth) ? "the digits of the tolerance" : "sixteen digits of values",
        table.digits_left);
  if (table.steps_solved > 0) {
    out += fmt::format("  {} steps were solved", table.steps_solved);
    out +=
        table.states_kept > 1 ? fmt::format(", with up to {} states kept on the way back\n", table.states_kept) : "\n";
  }
  for (const std::string& note : table.notes) out += fmt::format("  note: {}\n", note);
  return out;
}

/// The first few of many.
static std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t few = 5;
  const std::vector<std::string> first(names.begin(), names.begin() + std::ptrdiff_t(std::min(few, names.size())));
  const std::size_t more = names.size() - first.size();
  return fmt::format("{}{}", fmt::join(first, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

std::string words_of_differences(const GradientTable& table, const std::string& what) {
  std::string out;
  const std::size_t all = table.rows.size() * table.columns.size();
  if (table.untold.size() < all)
    out += table.within_rounding
               ? fmt::format(
                     "  extrapolated differences of {} agree as far as they tell: their rounding leaves {:.1f} "
                     "digits\n",
                     what, table.digits_agreed)
               : fmt::format("  extrapolated differences of {} agree to {:.1f} digits\n", what, table.digits_agreed);
  if (!table.contradicted.empty())
    out += fmt::format("  they contradict {} of {} derivatives: {}\n", table.contradicted.size(), all,
                       some_of(table.contradicted));
  if (!table.untold.empty())
    out += fmt::format("  differences of {0} cannot tell, by their rounding or where {0} are far apart: {1}\n", what,
                       some_of(table.untold));
  return out;
}

/// Of one function by many numbers, a line for each of these.
static std::string lines_of_row(const GradientTable& table) {
  std::size_t first = 0;
  for (const std::string& column : table.columns) first = std::max(first, column.size() + 3);
  std::string out = fmt::format("  {:{}}  {:>18}\n", "", first, table.rows.front());
  out += fmt::format("  {:{}}  {:18.10g}\n", "value", first, table.values(0));
  for (std::size_t j = 0; j < table.columns.size(); ++j)
    out += fmt::format("  {:{}}  {:18.10g}\n", "by " + table.columns[j], first, table.derivatives(0, Eigen::Index(j)));
  return out;
}

static std::string lines_of_rows(const GradientTable& table) {
  std::size_t first = 0;
  for (const std::string& row : table.rows) first = std::max(first, row.size());
  std::string out = fmt::format("  {:{}}  {:>18}", "", first, "value");
  std::vector<std::size_t> widths;
  for (const std::string& column : table.columns) {
    widths.push_back(std::max<std::size_t>(18, column.size() + 3));
    out += fmt::format("  {:>{}}", "by " + column, widths.back());
  }
  out += "\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto row = Eigen::Index(i);
    out += fmt::format("  {:{}}  {:18.10g}", table.rows[i], first, table.values(row));
    for (std::size_t j = 0; j < widths.size(); ++j)
      out += fmt::format("  {:{}.10g}", table.derivatives(row, Eigen::Index(j)), widths[j]);
    out += "\n";
  }
  return out;
}

std::string lines_of(const GradientTable& table) {
  constexpr std::size_t many = 6;
  return table.rows.size() == 1 && table.columns.size() > many ? lines_of_row(table) : lines_of_rows(table);
}

std::string text_of(const GradientTable& table) {
  std::string out = fmt::format("{}: exact derivatives of {} {} steps\n\n", table.system,
                                table.of_boundary_value ? "the cost of a path of" : "a run of", table.steps);
  out += lines_of(table);
  out += words_of_growth(table);
  if (table.checked) out += words_of_differences(table, "runs");
  return out;
}

/// Of a matrix, row by row.
static nlohmann::ordered_json json_rows(const Eigen::MatrixXd& a) {
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson rows = OrderedJson::array();
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    OrderedJson row = OrderedJson::array();
    for (Eigen::Index j = 0; j < a.cols(); ++j) row.push_back(a(i, j));
    rows.push_back(row);
  }
  return rows;
}

void add_derivatives(const GradientTable& table, nlohmann::ordered_json& out) {
  out["values"] = std::vector<double>(table.values.data(), table.values.data() + table.values.size());
  out["derivatives"] = json_rows(table.derivatives);
}

void add_notes_and_check(const GradientTable& table, nlohmann::ordered_json& out) {
  if (!table.notes.empty()) out["notes"] = table.notes;
  if (!table.checked) return;
  out["differences"] = json_rows(table.differences);
  out["digits_agreed"] = table.digits_agreed;
  out["within_rounding"] = table.within_rounding;
  out["contradicted"] = table.contradicted;
  out["untold"] = table.untold;
}

std::string json_of(const GradientTable& table) {
  nlohmann::ordered_json out = {
      {"system", table.system},   {"steps", table.steps}, {"status", table.failure.empty() ? "converged" : "failed"},
      {"message", table.failure}, {"of", table.rows},     {"by", table.columns}};
  if (table.failure.empty()) {
    add_derivatives(table, out);
    out["growth"] = table.growth;
    out["digits_left"] = table.digits_left;
    out["steps_solved"] = table.steps_solved;
    out["states_kept"] = table.states_kept;
    add_notes_and_check(table, out);
  }
  return out.dump(2);
}

}  // namespace lagroid::app
