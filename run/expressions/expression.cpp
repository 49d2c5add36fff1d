#include <lagroid/run/expressions/expression.hpp>

#include <algorithm>
#include <locale>
#include <optional>
#include <sstream>
#include <string_view>

namespace lagroid {

namespace {

/// A number that is read, and one that is added to it.
class Shifted final : public Expression {
 public:
  Shifted(std::size_t name, const double* value, double shift) : name_(name), value_(value), shift_(shift) {}
  double value() const override { return *value_ + shift_; }
  std::vector<std::size_t> used() const override { return {name_}; }
  double differentiate(double* by) override {
    *by = 1;
    return value();
  }

 private:
  std::size_t name_;
  const double* value_;
  double shift_;
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// The number that "", "- 0.5" or "+ 2" adds.
std::optional<double> shift_of(std::string_view rest) {
  if (rest.empty()) return 0;
  if (rest.front() != '-' && rest.front() != '+') return std::nullopt;
  const double sign = rest.front() == '-' ? -1 : 1;
  const std::string_view digits = trimmed(rest.substr(1));
  constexpr std::string_view begins_a_number = "0123456789.";
  if (digits.empty() || begins_a_number.find(digits.front()) == std::string_view::npos) return std::nullopt;
  std::istringstream in{std::string(digits)};
  in.imbue(std::locale::classic());
  double number = 0;
  in >> number;
  return !in.fail() && in.peek() == std::istringstream::traits_type::eof() ? std::optional(sign * number)
                                                                           : std::nullopt;
}

}  // namespace

std::unique_ptr<Expression> parse_expression(const std::string& text, const std::vector<std::string>& names,
                                             const double* values) {
  const std::string_view expression = trimmed(text);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (expression.starts_with(names[i]))
      if (const auto shift = shift_of(trimmed(expression.substr(names[i].size()))))
        return std::make_unique<Shifted>(i, values + i, *shift);
  return detail::parse_any_expression(text, names, values);
}

}  // namespace lagroid
