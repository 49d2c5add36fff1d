#include "scene_reader.hpp"

#include "dotted_path.hpp"
#include "messages.hpp"

#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/nesting.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <memory>
#include <system_error>

namespace lagroid::app {

namespace {

/// Throws SceneError where it is too deep to be read, and toml::parse_error.
toml::table parsed(std::string_view text, const std::string& what) {
  if (toml_nests_too_deep(text))
    throw SceneError(
        fmt::format("{}: tables and arrays are nested more than {} deep; no scene needs that", what, most_nested));
  return toml::parse(text, what);
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
