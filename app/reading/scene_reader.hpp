#pragma once
/// Reading scenes: TOML, with every mistake reported by file, line and key.
///
/// Every key that is read is remembered, so that one that nothing has read, such as a misspelt one, is refused.
///
///     const Section scene = read_scene("kepler.toml", {"time.steps=10"});
///     const double step = scene.section("time", "step and steps").number("step", positive);
///     scene.finish();  // refuses what was not read
///
/// Errors: SceneError, one line with file, line, key, what is wrong and what to do.

#include <lagroid/core/parameter.hpp>

#include <toml++/toml.h>

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lagroid::app {

/// A mistake in a scene. The message is one line: where, which key, what is wrong, what to do.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(const std::string& message) : SceneError(message, message) {}
  SceneError(const std::string& message, const std::string& problem);
  /// The message without the place in the file: key and what is wrong with it.
  const std::string& problem() const { return problem_; }

 private:
  std::string problem_;
};

/// Numbers that take the place of others in a scene: at a dotted path, one or an array of them.
struct Change {
  std::string path;
  std::vector<double> values;
};

/// One table of a scene. Every key that is read is remembered; `finish` refuses those that were not.
class Section {
 public:
  bool has(std::string_view key) const;

  double number(std::string_view key, const NumberRule& rule = any_number) const;
  double number_or(std::string_view key, double fallback, const NumberRule& rule = any_number) const;
  long integer(std::string_view key, long least, long most) const;
  long integer_or(std::string_view key, long fallback, long least, long most) const;
  /// One of the given words.
  std::string choice(std::string_view key, const std::vector<std::string>& words) const;
  std::string choice_or(std::string_view key, const std::string& fallback, const std::vector<std::string>& words) const;
  /// Any string; `what` is its meaning, for messages.
  std::string text(std::string_view key, std::string_view what) const;
  bool is_number(std::string_view key) const;
  bool is_table(std::string_view key) const;
  /// An array of strings; empty where the key is missing.
  std::vector<std::string> texts_or_none(std::string_view key, std::string_view what) const;
  bool flag_or(std::string_view key, bool fallback) const;
  /// An array of exactly `size` finite numbers; `meaning` names its entries in messages.
  std::vector<double> numbers(std::string_view key, std::size_t size, std::string_view meaning) const;
  /// An array of one or more finite numbers.
  std::vector<double> list(std::string_view key, std::string_view meaning) const;
  /// A rotation as a unit quaternion (w, x, y, z) or a rotation vector: four or three numbers. Returns a unit
  /// quaternion.
  std::array<double, 4> attitude(std::string_view key) const;

  /// A table that must be there (`purpose` is what it holds, for messages), or one that may be missing (then empty).
  Section section(std::string_view key, std::string_view purpose) const;
  Section section_or_empty(std::string_view key) const;
  /// The tables [[key]], in order; named key.0, key.1, ... in messages and by --set. None where the key is missing.
  std::vector<Section> tables(std::string_view key) const;
  /// Arrays of `size` numbers each, `count` of them.
  std::vector<std::vector<double>> points(std::string_view key, std::size_t count, std::size_t size,
                                          std::string_view meaning) const;

  /// Of a whole scene: the finite numbers at a dotted path, one or an array of them; none if something else is there.
  /// In a path a number counts in an array, from 0.
  std::vector<double> numbers_at(std::string_view path) const;
  /// A copy of a whole scene with other numbers at such a path, to be read like any scene.
  Section with(std::string_view path, const std::vector<double>& values) const;
  /// The same at several paths. Whole numbers are whole there, but in place of one that is not.
  Section with(const std::vector<Change>& changes) const;
  /// The same with numbers between two that a user wrote. What must lie on a sphere or have unit norm is then brought
  /// there instead of refused.
  Section between(std::string_view path, const std::vector<double>& values) const;
  /// The file it was read from.
  const std::string& file() const { return source_->file; }
  /// The whole scene with its overrides, as TOML.
  std::string whole() const;
  bool interpolated() const { return source_->interpolated; }
  /// A copy of a whole scene with overrides "key.subkey=value".
  Section set(const std::vector<std::string>& overrides) const;

  /// A copy of a whole scene without the key at such a path.
  Section without(std::string_view path) const;

  /// What stands in this table and below, as overrides "path=value" of a scene; all of it counts as read.
  std::vector<std::string> as_overrides() const;

  /// Refuses every key that was not read, in this table and the tables below it.
  void finish() const;

  /// A SceneError at a key of this table (or at the table itself when key is empty).
  [[noreturn]] void fail(std::string_view key, const std::string& problem) const;

 private:
  friend Section parse_scene(std::string_view, const std::string&, const std::vector<std::string>&, const std::string&);

  struct Source {
    std::string file;
    std::set<std::string, std::less<>> overridden;  ///< keys given by --set
    toml::table root;
    std::set<std::string, std::less<>> known;  ///< every key that was looked for
    bool interpolated = false;
    std::string overrider;  ///< what stands in messages before the keys that were overridden
  };

  /// A copy of the whole scene that shares nothing with it.
  Section copied() const;
  /// What stands at a key of this table, as a table; empty where it is none.
  Section below(std::string_view key, const toml::node& node) const;
  /// Refuses keys and texts, in this table and below it, that `key_problem` and `text_problem` do.
  void require_plain() const;
  void require_plain(std::string_view key, const toml::node& node) const;
  const toml::node* find(std::string_view key) const;
  const toml::node& require(std::string_view key, std::string_view what) const;
  double checked(std::string_view key, const toml::node& node, const NumberRule& rule) const;
  std::string full(std::string_view key) const;

  std::shared_ptr<Source> source_;
  std::string path_;
  const toml::table* table_ = nullptr;
  int line_ = 0;
};

/// Reads a scene file and applies overrides "key.subkey=value", which messages call by `overrider` and the key. Keys
/// and texts are plain afterwards (text.hpp). Throws SceneError.
Section read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                   const std::string& overrider = "--set ");
/// The same of a text; `file` is what messages call it.
Section parse_scene(std::string_view text, const std::string& file, const std::vector<std::string>& overrides,
                    const std::string& overrider = "--set ");

}  // namespace lagroid::app
