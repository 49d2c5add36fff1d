#include "equation_names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lagroid::app {

namespace {

bool is_none(const std::string& unit) { return unit.empty() || unit == "1"; }
/// In brackets where it is more than one word.
std::string factor(const std::string& unit) {
  return unit.find_first_of(" /^") == std::string::npos ? unit : fmt::format("({})", unit);
}

}  // namespace

std::string per(const std::string& cost, const std::string& unit) {
  return is_none(unit) ? cost : fmt::format("{}/{}", cost, factor(unit));
}

std::string effort_unit(std::span<const std::string_view> of_controls) {
  const std::string first(of_controls.front());
  if (std::any_of(of_controls.begin(), of_controls.end(), [&](std::string_view each) { return each != first; }))
    return "cost";
  return is_none(first) ? "s" : fmt::format("{}^2 s", factor(first));
}

void add_momentum_equations(const std::vector<std::string>& momenta, const std::vector<std::string>& units,
                            std::vector<EquationName>& out) {
  for (const char* end : {"source", "target"})
    for (std::size_t i = 0; i < momenta.size(); ++i) {
      // A body's name stands before its numbers: fore.px has the costate fore.ppx_source.
      const std::size_t name = momenta[i].rfind('.') == std::string::npos ? 0 : momenta[i].rfind('.') + 1;
      out.push_back({fmt::format("{} at its {}", momenta[i], end),
                     fmt::format("{}p{}_{}", momenta[i].substr(0, name), momenta[i].substr(name), end), units[i]});
    }
}

}  // namespace lagroid::app
