#include "bounds.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numeric>

namespace lagroid::app {

namespace {

/// The same bits, by memory: the browser's library has no std::bit_cast.
template <class To, class From> To of_bits(From from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof(to));
  return to;
}

/// The place of a number in the order of all finite ones.
std::int64_t place_of(double x) {
  const auto bits = of_bits<std::int64_t>(x);
  return bits < 0 ? std::numeric_limits<std::int64_t>::min() - bits : bits;
}
double number_at(std::int64_t place) {
  return of_bits<double>(place < 0 ? std::numeric_limits<std::int64_t>::min() - place : place);
}

/// Where the rule changes its mind on the way from a number that it lets pass; nowhere where it lets `end` pass too.
std::optional<Bound> bound(const NumberRule& rule, double inside, double end) {
  if (rule.holds(end)) return std::nullopt;
  std::int64_t last = place_of(inside);
  std::int64_t first_beyond = place_of(end);
  while (std::abs(first_beyond - last) > 1) {
    const std::int64_t middle = std::midpoint(last, first_beyond);
    (rule.holds(number_at(middle)) ? last : first_beyond) = middle;
  }
  // Of two neighbours the bound is the one that is written shorter: 0 is excluded, and 0.5 is not.
  const std::string included = fmt::format("{}", number_at(last));
  const std::string excluded = fmt::format("{}", number_at(first_beyond));
  if (included.size() <= excluded.size()) return Bound{number_at(last), false};
  return Bound{number_at(first_beyond), true};
}

std::optional<double> some_number(const NumberRule& rule) {
  for (int exponent = 0; exponent <= 300; ++exponent)
    for (const double power : {std::pow(10.0, exponent), std::pow(10.0, -exponent)})
      for (int digit = 0; digit <= 9; ++digit)
        for (const double x : {digit * power, -digit * power})
          if (rule.holds(x)) return x;
  return std::nullopt;
}

}  // namespace

Bounds bounds_of(const NumberRule& rule) {
  const auto inside = some_number(rule);
  if (!inside) return {};
  constexpr double largest = std::numeric_limits<double>::max();
  return {bound(rule, *inside, -largest), bound(rule, *inside, largest)};
}

}  // namespace lagroid::app
