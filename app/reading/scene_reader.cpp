#include "scene_reader.hpp"

#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/nesting.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>

namespace lagroid::app {

namespace {

/// Edit distance, for suggestions.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

template <class Words> std::string nearest(std::string_view word, const Words& words) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const auto& candidate : words)
    if (const auto d = distance(word, candidate); d < least) {
      least = d;
      best = candidate;
    }
  return best;
}

std::string type_name(const toml::node& node) {
  if (node.is_string()) return "a string";
  if (node.is_boolean()) return "a boolean";
  if (node.is_number()) return "a number";
  if (node.is_array()) return "an array";
  if (node.is_table()) return "a table";
  return "a date or time";
}

/// The beginning of a text that may be very long.
std::string shortened(const std::string& text) {
  constexpr std::size_t enough = 60;
  return text.size() <= enough ? text : text.substr(0, enough) + "...";
}

/// Throws SceneError where it is too deep to be read, and toml::parse_error.
toml::table parsed(std::string_view text, const std::string& what) {
  if (toml_nests_too_deep(text))
    throw SceneError(
        fmt::format("{}: tables and arrays are nested more than {} deep; no scene needs that", what, most_nested));
  return toml::parse(text, what);
}

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

/// What stands at a dotted path, or null.
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

/// Puts a value at a dotted path; what is missing on the way becomes a table, a number counts in an array. Messages
/// call it by `overrider` and the path.
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

SceneError::SceneError(const std::string& message, const std::string& problem)
    : std::runtime_error(visible(message)), problem_(visible(problem)) {}

std::string Section::full(std::string_view key) const {
  if (path_.empty()) return std::string(key);
  return key.empty() ? path_ : fmt::format("{}.{}", path_, key);
}

void Section::fail(std::string_view key, const std::string& problem) const {
  const std::string name = full(key);
  // An override answers for everything below it.
  std::string origin = name;
  while (!origin.empty() && !source_->overridden.contains(origin)) {
    const auto dot = origin.rfind('.');
    origin = dot == std::string::npos ? "" : origin.substr(0, dot);
  }
  const std::string said = name.empty() ? problem : fmt::format("{}: {}", name, problem);
  if (!origin.empty() && origin != name)
    throw SceneError(fmt::format("{}{}: {}", source_->overrider, origin, said), said);
  if (!origin.empty()) throw SceneError(fmt::format("{}{}", source_->overrider, said), said);
  const toml::node* node = table_ && !key.empty() ? table_->get(key) : nullptr;
  const int line = node ? int(node->source().begin.line) : line_;
  const std::string where = line > 0 ? fmt::format("{}:{}", source_->file, line) : source_->file;
  throw SceneError(fmt::format("{}: {}", where, said), said);
}

const toml::node* Section::find(std::string_view key) const {
  source_->known.insert(full(key));
  return table_ ? table_->get(key) : nullptr;
}

const toml::node& Section::require(std::string_view key, std::string_view what) const {
  const toml::node* node = find(key);
  if (node == nullptr) {
    std::vector<std::string> unread;
    if (table_)
      for (const auto& [present, unused] : *table_)
        if (!source_->known.contains(full(present.str()))) unread.emplace_back(present.str());
    const std::string typo = nearest(key, unread);
    if (!typo.empty()) fail(typo, fmt::format("unknown key; did you mean \"{}\"?", key));
    fail("", fmt::format("missing key \"{}\": give {}", key, what));
  }
  return *node;
}

bool Section::has(std::string_view key) const { return find(key) != nullptr; }

double Section::checked(std::string_view key, const toml::node& node, const NumberRule& rule) const {
  const auto value = node.is_integer() ? std::optional(double(**node.as_integer())) : node.value<double>();
  if (!node.is_number() || !value) fail(key, fmt::format("expected a number, got {}", type_name(node)));
  if (!std::isfinite(*value)) fail(key, fmt::format("must be finite, got {}", *value));
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

bool Section::is_number(std::string_view key) const {
  const toml::node* node = find(key);
  return node != nullptr && node->is_number();
}

bool Section::is_table(std::string_view key) const {
  const toml::node* node = find(key);
  return node != nullptr && node->is_table();
}

std::vector<double> Section::numbers_at(std::string_view path) const {
  std::vector<double> out;
  const toml::node* node = node_at(source_->root, std::string(path));
  if (node == nullptr) return out;
  const auto take = [&](const toml::node& entry) {
    const auto value = entry.value<double>();
    if (entry.is_number() && value && std::isfinite(*value)) out.push_back(*value);
  };
  take(*node);
  if (const toml::array* array = node->as_array()) {
    for (const auto& entry : *array) take(entry);
    if (out.size() != array->size()) out.clear();
  }
  return out;
}

Section Section::copied() const {
  Section copy = *this;
  copy.source_ = std::make_shared<Source>(*source_);
  copy.table_ = &copy.source_->root;
  return copy;
}

Section Section::below(std::string_view key, const toml::node& node) const {
  Section out;
  out.source_ = source_;
  out.path_ = full(key);
  out.table_ = node.as_table();
  out.line_ = int(node.source().begin.line);
  return out;
}

void Section::require_plain(std::string_view key, const toml::node& node) const {
  if (const auto* text = node.as_string())
    if (const std::string problem = text_problem(text->get()); !problem.empty()) fail(key, problem);
  if (node.is_table()) below(key, node).require_plain();
  if (const toml::array* array = node.as_array())
    for (std::size_t i = 0; i < array->size(); ++i) {
      const toml::node& entry = (*array)[i];
      if (entry.is_table())
        below(fmt::format("{}.{}", key, i), entry).require_plain();
      else
        require_plain(key, entry);
    }
}

void Section::require_plain() const {
  for (const auto& [key, node] : *table_) {
    if (const std::string problem = key_problem(key.str()); !problem.empty())
      below("", node).fail("", fmt::format("\"{}\": {}", shortened(std::string(key.str())), problem));
    require_plain(key.str(), node);
  }
}

Section Section::with(std::string_view path, const std::vector<double>& values) const {
  Section out = copied();
  const toml::node* before = node_at(source_->root, std::string(path));
  toml::array array;
  for (const double x : values) array.push_back(x);
  if (before != nullptr && before->is_array())
    override_at(out.source_->root, std::string(path), array, source_->overrider);
  else
    override_at(out.source_->root, std::string(path), toml::value<double>(values.front()), source_->overrider);
  return out;
}

Section Section::with(const std::vector<Change>& changes) const {
  Section out = copied();
  toml::table& root = out.source_->root;
  for (const auto& [path, values] : changes) {
    const toml::node* before = node_at(source_->root, path);
    if (before != nullptr && before->is_array()) {
      toml::array array;
      for (const double x : values) array.push_back(x);
      override_at(root, path, array, source_->overrider);
      continue;
    }
    const double x = values.front();
    constexpr double largest_whole = 9007199254740992;  // of a double
    const bool may_be_whole = before == nullptr || before->is_integer();
    if (may_be_whole && x == std::floor(x) && std::abs(x) <= largest_whole)
      override_at(root, path, toml::value<std::int64_t>(std::int64_t(x)), source_->overrider);
    else
      override_at(root, path, toml::value<double>(x), source_->overrider);
  }
  return out;
}

Section Section::without(std::string_view path) const {
  Section out = copied();
  const auto dot = path.rfind('.');
  toml::table& root = out.source_->root;
  toml::table* table = dot == std::string_view::npos ? &root : root.at_path(path.substr(0, dot)).as_table();
  if (table != nullptr) table->erase(dot == std::string_view::npos ? path : path.substr(dot + 1));
  return out;
}

Section Section::between(std::string_view path, const std::vector<double>& values) const {
  Section out = with(path, values);
  out.source_->interpolated = true;
  return out;
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

Section Section::section(std::string_view key, std::string_view purpose) const {
  if (find(key) == nullptr) require(key, fmt::format("the table [{}]: {}", full(key), purpose));
  return section_or_empty(key);
}

Section Section::section_or_empty(std::string_view key) const {
  if (const toml::node* node = find(key)) {
    if (!node->is_table()) fail(key, fmt::format("expected a table, got {}", type_name(*node)));
    return below(key, *node);
  }
  Section out;
  out.source_ = source_;
  out.path_ = full(key);
  return out;
}

std::vector<Section> Section::tables(std::string_view key) const {
  std::vector<Section> out;
  const toml::node* node = find(key);
  if (node == nullptr) return out;
  const toml::array* array = node->as_array();
  if (array == nullptr)
    fail(key, fmt::format("expected tables [[{}]] in double brackets, got {}", full(key), type_name(*node)));
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::node& entry = (*array)[i];
    if (!entry.is_table())
      fail(key, fmt::format("expected tables [[{}]] in double brackets, got {}", full(key), type_name(entry)));
    out.push_back(below(fmt::format("{}.{}", key, i), entry));
  }
  return out;
}

void Section::finish() const {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    const std::string name = full(key.str());
    if (!source_->known.contains(name)) {
      std::vector<std::string> siblings;
      for (const std::string& k : source_->known) {
        const std::string prefix = path_.empty() ? "" : path_ + ".";
        if (k.starts_with(prefix) && k.find('.', prefix.size()) == std::string::npos)
          siblings.push_back(k.substr(prefix.size()));
      }
      const std::string guess = nearest(key.str(), siblings);
      fail(key.str(), guess.empty() ? fmt::format("unknown key; known here: {}", fmt::join(siblings, ", "))
                                    : fmt::format("unknown key; did you mean \"{}\"?", guess));
    }
    if (node.is_table()) section_or_empty(key.str()).finish();
    if (node.is_array_of_tables())
      for (const Section& table : tables(key.str())) table.finish();
  }
}

std::vector<std::string> Section::as_overrides() const {
  std::vector<std::string> out;
  if (table_ == nullptr) return out;
  list_leaves(*table_, "", out);
  for (const auto& [key, node] : *table_) {
    source_->known.insert(full(key.str()));
    if (node.is_table()) section_or_empty(key.str()).as_overrides();
    if (node.is_array_of_tables())
      for (const Section& table : tables(key.str())) table.as_overrides();
  }
  return out;
}

std::string Section::whole() const {
  std::ostringstream out;
  out << source_->root << "\n";
  return out.str();
}

Section Section::set(const std::vector<std::string>& overrides) const {
  return parse_scene(whole(), source_->file, overrides);
}

Section read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                   const std::string& overrider) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw SceneError(fmt::format("{}: no such scene file; examples are in examples/", file.string()));
  const auto text = contents(file);
  if (!text) throw SceneError(fmt::format("{}: cannot be read", file.string()));
  return parse_scene(*text, file.string(), overrides, overrider);
}

Section parse_scene(std::string_view text, const std::string& file, const std::vector<std::string>& overrides,
                    const std::string& overrider) {
  Section scene;
  scene.source_ = std::make_shared<Section::Source>();
  scene.source_->file = file;
  scene.source_->overrider = overrider;
  try {
    scene.source_->root = parsed(text, file);
  } catch (const toml::parse_error& e) {
    throw SceneError(
        fmt::format("{}:{}: not valid TOML: {}", file, e.source().begin.line, std::string(e.description())));
  }
  for (const std::string& given : overrides) {
    const auto equals = given.find('=');
    if (equals == std::string::npos || equals == 0)
      throw SceneError(fmt::format("--set {}: expected key=value, as in --set time.steps=100", shortened(given)));
    const std::string key = given.substr(0, equals);
    toml::table held;
    try {
      held = parsed("value = " + given.substr(equals + 1), overrider + shortened(key));
    } catch (const toml::parse_error&) {
      // A bare word is taken as a string, so that quotes need not survive the shell.
      held.insert("value", given.substr(equals + 1));
    }
    if (held.size() != 1) throw SceneError(fmt::format("{}{}: expected one value", overrider, shortened(key)));
    override_at(scene.source_->root, key, *held.get("value"), overrider);
    scene.source_->overridden.insert(key);
  }
  scene.table_ = &scene.source_->root;
  scene.require_plain();
  return scene;
}

}  // namespace lagroid::app
