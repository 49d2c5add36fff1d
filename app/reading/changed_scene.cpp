// Copies of a whole scene with something changed in them, and what a scene is as text.
#include "dotted_path.hpp"
#include "scene_reader.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <sstream>

namespace lagroid::app {

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

std::vector<std::string> Section::as_overrides() const {
  if (table_ == nullptr) return {};
  for (const auto& [key, node] : *table_) {
    source_->known.insert(full(key.str()));
    if (node.is_table()) section_or_empty(key.str()).as_overrides();
    if (node.is_array_of_tables())
      for (const Section& table : tables(key.str())) table.as_overrides();
  }
  return leaves_of(*table_);
}

std::string Section::whole() const {
  std::ostringstream out;
  out << source_->root << "\n";
  return out.str();
}

Section Section::set(const std::vector<std::string>& overrides) const {
  return parse_scene(whole(), source_->file, overrides);
}

}  // namespace lagroid::app
