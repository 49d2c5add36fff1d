#include "key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <type_traits>
#include <utility>

namespace lagroid::app {

KeyOf<Table> optional_table(std::string name, Table table, std::string meaning) {
  return {std::move(name), std::move(table), "", std::move(meaning), {}, "what its keys are by default"};
}

std::string meaning_of(const Key& key) {
  const auto* choice = std::get_if<OneOf>(&key.value.is);
  if (choice == nullptr || choice->words.size() < 2) return key.meaning;
  const auto last = choice->words.end() - 1;
  return fmt::format("{}: {} or {}", key.meaning, fmt::join(choice->words.begin(), last, ", "), *last);
}

std::string fallback_of(const Key& key) {
  if (!key.otherwise.empty()) return key.otherwise;
  return std::visit(
      [](const auto& value) -> std::string {
        using V = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<V, std::monostate>) {
          return "";
        } else if constexpr (std::is_same_v<V, double>) {
          return fmt::format("{:g}", value);
        } else if constexpr (std::is_same_v<V, std::vector<double>> || std::is_same_v<V, std::array<double, 4>>) {
          return fmt::format("{:g}", fmt::join(value, ", "));
        } else {
          return fmt::format("{}", value);
        }
      },
      key.fallback);
}

std::string listed(const Key& key) {
  const std::string fallback = fallback_of(key);
  return fmt::format("{}{}{}", meaning_of(key), key.unit.empty() ? "" : fmt::format(" [{}]", key.unit),
                     fallback.empty() ? "" : fmt::format(", default {}", fallback));
}

namespace reading {

namespace {

std::vector<double> checked(const Section& at, std::string_view name, const std::vector<double>& numbers,
                            const NumberRule& rule) {
  for (const double x : numbers)
    if (!rule.holds(x)) at.fail(name, fmt::format("must be {}, got {}", rule.words, x));
  return numbers;
}

}  // namespace

double given(const Section& at, std::string_view name, const std::string&, const Number& value) {
  return at.number(name, value.rule);
}
long given(const Section& at, std::string_view name, const std::string&, const Whole& value) {
  return at.integer(name, value.least, value.most);
}
std::string given(const Section& at, std::string_view name, const std::string&, const OneOf& value) {
  return at.choice(name, value.words);
}
std::string given(const Section& at, std::string_view name, const std::string& what, const Text&) {
  return at.text(name, what);
}
std::vector<std::string> given(const Section& at, std::string_view name, const std::string& what, const Texts&) {
  return at.texts_or_none(name, what);
}
bool given(const Section& at, std::string_view name, const std::string&, const Flag&) {
  return at.flag_or(name, false);
}
std::vector<double> given(const Section& at, std::string_view name, const std::string& what, const NumberArray& value) {
  return checked(at, name, at.numbers(name, value.size, what), value.rule);
}
std::vector<double> given(const Section& at, std::string_view name, const std::string& what, const NumberList& value) {
  return checked(at, name, at.list(name, what), value.rule);
}
std::array<double, 4> given(const Section& at, std::string_view name, const std::string&, const AnyAttitude&) {
  return at.attitude(name);
}

}  // namespace reading

}  // namespace lagroid::app
