#pragma once
/// The keys of scenes, each declared once: what may stand there, of which unit, what it means, what holds without it.
/// Readers read by the declaration, so that what they refuse is what it says; listings, the JSON Schema for editors
/// (../schema) and the tables of docs/scenes.md are written from it.
///
///     const KeyOf<Number> length{"length", {positive}, "m", "of the rod", {}, "that at the start"};
///     const double l = read_key_or(table, length, apart);

#include "../reading/scene_reader.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace lagroid::app {

/// What may stand at a key; `Read` is what it is read as.
struct Number {
  using Read = double;
  NumberRule rule = any_number;
};
/// Written without a point.
struct Whole {
  using Read = long;
  long least;
  long most;
};
struct OneOf {
  using Read = std::string;
  std::vector<std::string> words;
};
struct Text {
  using Read = std::string;
};
struct Texts {
  using Read = std::vector<std::string>;
};
struct Flag {
  using Read = bool;
};
/// So many numbers.
struct NumberArray {
  using Read = std::vector<double>;
  std::size_t size;
  NumberRule rule = any_number;
};
/// One number or more.
struct NumberList {
  using Read = std::vector<double>;
  NumberRule rule = any_number;
};
/// A unit quaternion w, x, y, z or a rotation vector; read as the former.
struct AnyAttitude {
  using Read = std::array<double, 4>;
};
/// Points of space, so many or, where no number is given, one or more.
struct SpacePoints {
  using Read = std::monostate;
  std::optional<std::size_t> count = {};
};
struct Key;
/// These keys and no others; where there are kinds, those of one of them too.
struct Table {
  using Read = std::monostate;
  std::vector<Key> keys;
  std::vector<Table> kinds = {};
  std::string about = {};
};
/// Tables in double brackets.
struct Tables {
  using Read = std::monostate;
  Table each;
};
/// Keys that something else declares, as a sweep holds those of any scene.
struct AnyTable {
  using Read = std::monostate;
};
struct Value;
/// One of these; its reader asks which.
struct Either {
  using Read = std::monostate;
  std::vector<Value> values;
};
struct Value {
  std::variant<Number, Whole, OneOf, Text, Texts, Flag, NumberArray, NumberList, AnyAttitude, SpacePoints, Table,
               Tables, AnyTable, Either>
      is;
};

/// A key of which the type says how it is read.
template <class V> struct KeyOf {
  std::string name;
  V value = {};
  std::string unit = {};
  std::string meaning = {};
  std::optional<typename V::Read> fallback = {};  ///< what holds without the key
  std::string otherwise = {};                     ///< the same in words, where it depends on others
};

/// Any key, as it is listed.
struct Key {
  using Fallback = std::variant<std::monostate, double, long, bool, std::string, std::vector<double>,
                                std::vector<std::string>, std::array<double, 4>>;
  std::string name;
  Value value;
  std::string unit;
  std::string meaning;
  Fallback fallback;
  std::string otherwise;

  template <class V>
  Key(const KeyOf<V>& key)  // NOLINT(google-explicit-constructor): lists of keys of many types
      : name(key.name), value{key.value}, unit(key.unit), meaning(key.meaning), otherwise(key.otherwise) {
    if (key.fallback) fallback = *key.fallback;
  }

  bool required() const { return fallback.index() == 0 && otherwise.empty(); }
};

/// A table that need not be there.
KeyOf<Table> optional_table(std::string name, Table table, std::string meaning);

/// What it means, with the words that it chooses from.
std::string meaning_of(const Key& key);
/// What holds without it; empty where it must be given.
std::string fallback_of(const Key& key);
/// "MEANING [UNIT], default FALLBACK".
std::string listed(const Key& key);

namespace reading {

double given(const Section& at, std::string_view name, const std::string& what, const Number& value);
long given(const Section& at, std::string_view name, const std::string& what, const Whole& value);
std::string given(const Section& at, std::string_view name, const std::string& what, const OneOf& value);
std::string given(const Section& at, std::string_view name, const std::string& what, const Text& value);
std::vector<std::string> given(const Section& at, std::string_view name, const std::string& what, const Texts& value);
bool given(const Section& at, std::string_view name, const std::string& what, const Flag& value);
std::vector<double> given(const Section& at, std::string_view name, const std::string& what, const NumberArray& value);
std::vector<double> given(const Section& at, std::string_view name, const std::string& what, const NumberList& value);
std::array<double, 4> given(const Section& at, std::string_view name, const std::string& what,
                            const AnyAttitude& value);

}  // namespace reading

/// What the table has there, or `fallback`. Throws SceneError.
template <class V> typename V::Read read_key_or(const Section& at, const KeyOf<V>& key, typename V::Read fallback) {
  if (!at.has(key.name)) return fallback;
  return reading::given(at, key.name, key.unit.empty() ? key.meaning : key.meaning + ", " + key.unit, key.value);
}
/// What the table has there, or what holds without it. Throws SceneError.
template <class V> typename V::Read read_key(const Section& at, const KeyOf<V>& key) {
  if (key.fallback) return read_key_or(at, key, *key.fallback);
  return reading::given(at, key.name, key.unit.empty() ? key.meaning : key.meaning + ", " + key.unit, key.value);
}

}  // namespace lagroid::app
