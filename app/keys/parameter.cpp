#include "parameter.hpp"

#include <algorithm>
#include <cmath>

namespace lagroid::app::reading {

void read_number(const Section& parameters, std::string_view name, const NumberRule& rule, bool required,
                 double& value) {
  value = required ? parameters.number(name, rule) : parameters.number_or(name, value, rule);
}

void read_vector(const Section& parameters, std::string_view name, std::string_view meaning, const NumberRule& rule,
                 bool required, bool direction, double* values, std::size_t size) {
  if (!required && !parameters.has(name)) return;
  const std::vector<double> given = parameters.numbers(name, size, meaning);
  for (const double x : given)
    if (!rule.holds(x)) parameters.fail(name, fmt::format("{} must be {}, got {}", meaning, rule.words, x));
  double norm = 1;
  if (direction) {
    norm = 0;
    for (const double x : given) norm = std::hypot(norm, x);
    if (norm == 0) parameters.fail(name, "is no direction: not all of its numbers may be 0");
  }
  std::transform(given.begin(), given.end(), values, [&](double x) { return x / norm; });
}

std::size_t read_word(const Section& parameters, std::string_view name, std::span<const std::string_view> words,
                      std::size_t fallback) {
  const std::vector<std::string> all(words.begin(), words.end());
  const std::string word = parameters.choice_or(name, all[fallback], all);
  return std::size_t(std::find(all.begin(), all.end(), word) - all.begin());
}

void blame(const Section& parameters, const Refusal& refusal) {
  const auto given = std::find_if(refusal.parameters.begin(), refusal.parameters.end(),
                                  [&](std::string_view name) { return parameters.has(name); });
  parameters.fail(given == refusal.parameters.end() ? "" : *given, refusal.why);
}

}  // namespace lagroid::app::reading
