#include "row_words.hpp"

#include "acting.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

namespace lagroid::app {

namespace {

/// What a row of phi is called; at which stage is said elsewhere.
std::string equality_name(const ControlResult& found, long stage, int row) {
  if (row < int(found.equations.size())) return fmt::format("equation of {}", found.equations[std::size_t(row)].of);
  return found.conditions[std::size_t(stage)][std::size_t(row) - found.equations.size()];
}

/// What a condition at another stage is called; empty where there is none.
std::string_view condition_at(const ControlResult& found, long stage, std::size_t i) {
  if (stage < 0 || stage >= std::ssize(found.conditions)) return "";
  const std::vector<std::string>& there = found.conditions[std::size_t(stage)];
  return i < there.size() ? std::string_view(there[i]) : "";
}
/// Conditions of one node have said where.
std::string at_stages(const ControlResult& found, long stage, long count, int row, bool is_equality) {
  if (const int i = row - int(found.equations.size()); is_equality && i >= 0) {
    const std::string_view here = condition_at(found, stage, std::size_t(i));
    if (here != condition_at(found, stage - 1, std::size_t(i)) &&
        here != condition_at(found, stage + 1, std::size_t(i)))
      return "";
  }
  return count == 1 ? fmt::format(" in stage {}", stage + 1)
                    : fmt::format(" in stages {} to {}", stage + 1, stage + count);
}

}  // namespace

std::string in_words(const ControlResult& found, const ConstraintViolation& each) {
  return fmt::format(
      "{}{} by {:.2g}",
      each.is_equality ? equality_name(found, each.stage, each.row) : found.inequalities[std::size_t(each.row)],
      at_stages(found, each.stage, 1, each.row, each.is_equality), each.amount);
}

std::vector<std::string> repeated_in_words(const ControlResult& found) {
  std::vector<std::string> out;
  for (const RepeatedConstraint& each : found.report.repeated) {
    const std::string what = equality_name(found, each.stage, each.row) +
                             at_stages(found, each.stage, each.stages, each.row, /*is_equality=*/true);
    std::vector<std::string> of;
    for (const int row : each.of) of.push_back(equality_name(found, each.stage, row));
    out.push_back(of.empty() ? fmt::format("{} holds whatever the motion does: leave it out", what)
                             : fmt::format("{} repeats {}: leave one of them out, unless they only touch there", what,
                                           fmt::join(of, " and ")));
  }
  return out;
}

std::vector<ActingInequality> acting_inequalities(const ControlResult& found) {
  std::vector<ActingInequality> out;
  for (const std::string& name : found.inequalities) {
    if (std::any_of(out.begin(), out.end(), [&](const ActingInequality& other) { return other.name == name; }))
      continue;
    ActingInequality each{name, {}};
    for (const StageRange& range : where_it_acts(found, name))
      each.stages.push_back({long(range.first) + 1, long(range.end)});
    if (!each.stages.empty()) out.push_back(std::move(each));
  }
  return out;
}

std::vector<CostateColumn> costate_columns(const ControlResult& found) {
  std::vector<CostateColumn> out;
  if (found.costate_rows.empty()) return out;
  for (const EquationName& each : found.equations)
    out.push_back({each.costate, per(found.cost_unit, each.unit), "equation of " + each.of});
  for (std::size_t i = out.size(); i < found.costate_rows.front().size(); ++i)
    out.push_back({fmt::format("condition_{}", i - found.equations.size() + 1),
                   found.cost_unit + " per unit of the condition", "condition on the node where the stage ends"});
  return out;
}

std::vector<NodeConditions> node_conditions(const ControlResult& found) {
  std::vector<NodeConditions> out;
  for (long k = 0; k < std::ssize(found.conditions); ++k)
    for (std::size_t i = 0; i < found.conditions[std::size_t(k)].size(); ++i) {
      const std::string& name = found.conditions[std::size_t(k)][i];
      const auto before = std::find_if(out.begin(), out.end(), [&](const NodeConditions& other) {
        return other.column == i && other.name == name && other.stages[1] == k;
      });
      if (before != out.end()) before->stages[1] = k + 1;
      if (before == out.end()) out.push_back({name, i, {k + 1, k + 1}});
    }
  return out;
}

}  // namespace lagroid::app
