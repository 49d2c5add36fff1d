// The values in a table of a scene, each checked as it is read.
#include "messages.hpp"
#include "scene_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lagroid::app {

namespace {

/// Whether a key, in full, is one of bounds, which need not be there: a part of it is called so.
bool is_of_bounds(const std::string& key) { return ("." + key + ".").find(".bounds.") != std::string::npos; }

}  // namespace

bool Section::has(std::string_view key) const { return find(key) != nullptr; }

double Section::checked(std::string_view key, const toml::node& node, const NumberRule& rule) const {
  const auto value = node.is_integer() ? std::optional(double(**node.as_integer())) : node.value<double>();
  if (!node.is_number() || !value) fail(key, fmt::format("expected a number, got {}", type_name(node)));
  if (!std::isfinite(*value)) {
    const bool is_no_bound = std::isinf(*value) && is_of_bounds(full(key));
    fail(key,
         fmt::format("must be finite, got {}{}", *value,
                     is_no_bound ? "; for no bound leave it out: { min = ... } or { max = ... } bounds one side" : ""));
  }
  if (!rule.holds(*value)) fail(key, fmt::format("must be {}, got {}", rule.words, *value));
  return *value;
}

double Section::number(std::string_view key, const NumberRule& rule) const {
  return checked(key, require(key, fmt::format("a number ({})", rule.words)), rule);
}

double Section::number_or(std::string_view key, double fallback, const NumberRule& rule) const {
  const toml::node* node = find(key);
  return node ? checked(key, *node, rule) : fallback;
}

long Section::integer(std::string_view key, long least, long most) const {
  const toml::node& node = require(key, fmt::format("a whole number from {} to {}", least, most));
  if (!node.is_integer())
    fail(key, fmt::format("expected a whole number written without a point, got {}", type_name(node)));
  const long value = long(*node.value<std::int64_t>());
  if (value < least || value > most) fail(key, fmt::format("must be from {} to {}, got {}", least, most, value));
  return value;
}

long Section::integer_or(std::string_view key, long fallback, long least, long most) const {
  return find(key) ? integer(key, least, most) : fallback;
}

std::string Section::choice(std::string_view key, const std::vector<std::string>& words) const {
  const toml::node& node = require(key, fmt::format("one of {}", fmt::join(words, ", ")));
  const auto value = node.value<std::string>();
  if (!node.is_string()) fail(key, fmt::format("expected one of {}, got {}", fmt::join(words, ", "), type_name(node)));
  if (std::find(words.begin(), words.end(), *value) == words.end()) {
    const std::string guess = nearest(*value, words);
    fail(key, fmt::format("\"{}\" is none of {}{}", *value, fmt::join(words, ", "),
                          guess.empty() ? "" : fmt::format("; did you mean \"{}\"?", guess)));
  }
  return *value;
}

std::string Section::choice_or(std::string_view key, const std::string& fallback,
                               const std::vector<std::string>& words) const {
  return find(key) ? choice(key, words) : fallback;
}

std::string Section::text(std::string_view key, std::string_view what) const {
  const toml::node& node = require(key, what);
  if (!node.is_string()) fail(key, fmt::format("expected {}, got {}", what, type_name(node)));
  return *node.value<std::string>();
}

std::vector<std::string> Section::texts_or_none(std::string_view key, std::string_view what) const {
  const toml::node* node = find(key);
  std::vector<std::string> out;
  if (node == nullptr) return out;
  const toml::array* array = node->as_array();
  if (array == nullptr) fail(key, fmt::format("expected an array of {}, got {}", what, type_name(*node)));
  for (const auto& entry : *array) {
    if (!entry.is_string()) fail(key, fmt::format("expected an array of {}, with {} in it", what, type_name(entry)));
    out.push_back(*entry.value<std::string>());
  }
  return out;
}

bool Section::flag_or(std::string_view key, bool fallback) const {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) fail(key, fmt::format("expected true or false, got {}", type_name(*node)));
  return *node->value<bool>();
}

bool Section::is_number(std::string_view key) const {
  const toml::node* node = find(key);
  return node != nullptr && node->is_number();
}

bool Section::is_table(std::string_view key) const {
  const toml::node* node = find(key);
  return node != nullptr && node->is_table();
}

std::vector<double> Section::numbers(std::string_view key, std::size_t size, std::string_view meaning) const {
  const toml::node& node = require(key, fmt::format("{} numbers: {}", size, meaning));
  const toml::array* array = node.as_array();
  if (array == nullptr)
    fail(key, fmt::format("expected an array of {} numbers ({}), got {}", size, meaning, type_name(node)));
  if (array->size() != size) fail(key, fmt::format("expected {} numbers ({}), got {}", size, meaning, array->size()));
  std::vector<double> out;
  for (const auto& entry : *array) out.push_back(checked(key, entry, any_number));
  return out;
}

std::vector<double> Section::list(std::string_view key, std::string_view meaning) const {
  const toml::node& node = require(key, meaning);
  const toml::array* array = node.as_array();
  if (array == nullptr || array->empty())
    fail(key, fmt::format("expected an array of numbers ({}), got {}", meaning, array ? "none" : type_name(node)));
  return numbers(key, array->size(), meaning);
}

std::vector<std::vector<double>> Section::points(std::string_view key, std::size_t count, std::size_t size,
                                                 std::string_view meaning) const {
  const toml::node& node = require(key, fmt::format("{} arrays of {} numbers: {}", count, size, meaning));
  const toml::array* array = node.as_array();
  const auto refuse = [&](const std::string& got) {
    fail(key, fmt::format("expected {} arrays of {} numbers ({}), got {}", count, size, meaning, got));
  };
  if (array == nullptr) refuse(type_name(node));
  if (array->size() != count) refuse(fmt::format("{}", array->size()));
  std::vector<std::vector<double>> out;
  for (const auto& entry : *array) {
    const toml::array* inner = entry.as_array();
    if (inner == nullptr) refuse(fmt::format("{} among them", type_name(entry)));
    if (inner->size() != size) refuse(fmt::format("one of {} numbers", inner->size()));
    out.emplace_back();
    for (const auto& number : *inner) out.back().push_back(checked(key, number, any_number));
  }
  return out;
}

std::array<double, 4> Section::attitude(std::string_view key) const {
  constexpr std::string_view meaning = "a unit quaternion w, x, y, z or a rotation vector";
  const toml::node& node = require(key, meaning);
  const toml::array* array = node.as_array();
  if (array == nullptr || (array->size() != 4 && array->size() != 3))
    fail(key, fmt::format("expected {} (four or three numbers), got {}", meaning,
                          array ? fmt::format("{} numbers", array->size()) : type_name(node)));
  const auto v = numbers(key, array->size(), meaning);
  if (v.size() == 3) {
    const double angle = std::hypot(v[0], v[1], v[2]);
    const double scale = angle > 0 ? std::sin(angle / 2) / angle : 0.5;
    return {std::cos(angle / 2), scale * v[0], scale * v[1], scale * v[2]};
  }
  const double norm = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
  if (norm == 0 || (std::abs(norm - 1) > 1e-6 && !interpolated()))
    fail(key, norm > 0
                  ? fmt::format("not a unit quaternion (norm {:.8g}); divide by its norm: [{:.10g}, {:.10g}, {:.10g}, "
                                "{:.10g}], or give a rotation vector of three numbers",
                                norm, v[0] / norm, v[1] / norm, v[2] / norm, v[3] / norm)
                  : std::string("not a unit quaternion (norm 0); the identity is [1, 0, 0, 0]"));
  return {v[0] / norm, v[1] / norm, v[2] / norm, v[3] / norm};
}

}  // namespace lagroid::app
