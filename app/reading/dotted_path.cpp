#include "dotted_path.hpp"

#include "messages.hpp"
#include "scene_reader.hpp"

#include <lagroid/run/files/nesting.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <sstream>

namespace lagroid::app {

namespace {

/// The steps of a dotted path; none where one of them is empty, or where they go deeper than a scene can.
std::vector<std::string> steps_of(const std::string& path) {
  std::vector<std::string> names;
  boost::split(names, path, [](char c) { return c == '.'; });
  if (names.size() > most_nested || std::count(names.begin(), names.end(), "") > 0) return {};
  return names;
}

/// The place in an array that a step of a path names, if it is one.
std::optional<std::size_t> place_in(const toml::array& array, const std::string& name) {
  std::size_t index = 0;
  const char* end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data(), end, index);
  const bool one_way_to_write_it = name == "0" || !name.starts_with('0');
  if (error != std::errc{} || rest != end || index >= array.size() || !one_way_to_write_it) return std::nullopt;
  return index;
}

void list_leaves(const toml::table& table, const std::string& prefix, std::vector<std::string>& out) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table(); inner != nullptr && !inner->empty()) {
      list_leaves(*inner, path + ".", out);
      continue;
    }
    std::ostringstream text;
    text << toml::toml_formatter(node);
    out.push_back(path + "=" + text.str());
  }
}

}  // namespace

const toml::node* node_at(const toml::table& root, const std::string& path) {
  const std::vector<std::string> names = steps_of(path);
  const toml::node* at = names.empty() ? nullptr : &root;
  for (const std::string& name : names) {
    if (const toml::table* table = at->as_table()) {
      at = table->get(name);
    } else if (const toml::array* array = at->as_array()) {
      const auto index = place_in(*array, name);
      at = index ? array->get(*index) : nullptr;
    } else {
      at = nullptr;
    }
    if (at == nullptr) return nullptr;
  }
  return at;
}

void override_at(toml::table& root, const std::string& path, const toml::node& value, const std::string& overrider) {
  toml::node* at = &root;
  const std::vector<std::string> names = steps_of(path);
  if (names.empty())
    throw SceneError(fmt::format("{}{}: no key; write one as in time.steps, of at most {} parts", overrider,
                                 shortened(path), most_nested));
  for (const std::string& name : names)
    if (const std::string problem = key_problem(name); !problem.empty())
      throw SceneError(fmt::format("{}{}: {}", overrider, shortened(path), problem));
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool last = i + 1 == names.size();
    if (toml::table* table = at->as_table()) {
      if (last) {
        table->insert_or_assign(names[i], value);
        return;
      }
      table->insert(names[i], toml::table{});
      at = table->get(names[i]);
      continue;
    }
    toml::array* array = at->as_array();
    if (array == nullptr) throw SceneError(fmt::format("{}{}: \"{}\" is not a table", overrider, path, names[i - 1]));
    const auto index = place_in(*array, names[i]);
    if (!index)
      throw SceneError(fmt::format("{}{}: \"{}\" is no place in the array \"{}\" of {}, counted from 0", overrider,
                                   path, names[i], names[i - 1], array->size()));
    if (last) {
      array->replace(array->cbegin() + std::ptrdiff_t(*index), value);
      return;
    }
    at = array->get(*index);
  }
}

std::vector<std::string> leaves_of(const toml::table& table) {
  std::vector<std::string> out;
  list_leaves(table, "", out);
  return out;
}

}  // namespace lagroid::app
