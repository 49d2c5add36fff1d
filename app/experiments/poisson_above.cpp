#include "poisson_above.hpp"

#include <lagroid/systems/poisson/from_above.hpp>

#include <fmt/format.h>

namespace lagroid::app {

std::vector<AboveRow> run_from_above(long steps) {
  std::vector<AboveRow> out;
  for (const FromAbove& each : reductions_from_above(steps))
    out.push_back({each.above, each.bracket, each.largest, each.microseconds_above, each.microseconds_bracket});
  return out;
}

std::string above_table(const std::vector<AboveRow>& rows, long steps) {
  std::string out = fmt::format(
      "\n## Reduction from above\n\nThe discrete Lagrangian above, reduced after each step, beside steps of the "
      "reduced "
      "bracket: the largest difference over {} steps, relative to the state, and microseconds a step.\n\n"
      "| above | bracket | difference | us above | us of the bracket |\n|---|---|---|---|---|\n",
      steps);
  for (const AboveRow& row : rows)
    out += fmt::format("| {} | {} | {:.1e} | {:.2g} | {:.2g} |\n", row.above, row.bracket, row.largest,
                       row.microseconds_above, row.microseconds_bracket);
  return out;
}

std::string above_csv(const std::vector<AboveRow>& rows) {
  std::string out = "above,bracket,difference,microseconds_above,microseconds_bracket\n";
  for (const AboveRow& row : rows)
    out += fmt::format("\"{}\",\"{}\",{},{},{}\n", row.above, row.bracket, row.largest, row.microseconds_above,
                       row.microseconds_bracket);
  return out;
}

}  // namespace lagroid::app
