#include <lagroid/core/parameter.hpp>

#include <cmath>
#include <cstdio>
#include <utility>

namespace lagroid {

std::optional<Refusal> refuse_lost_digits(std::vector<std::string_view> parameters, const std::string& product,
                                          double value) {
  if (std::isnormal(value)) return std::nullopt;
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%g", value);
  return Refusal{std::move(parameters), "makes " + product + " = " + number.data() + ", too " +
                                            (value < 1 ? "small" : "large") +
                                            " to keep its digits; choose other units"};
}

}  // namespace lagroid
