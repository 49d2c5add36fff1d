#pragma once
/// Named fields of a state, kept and restored by one function: `archive("name", field)` writes the field, or reads it.
///
/// What is written and what is read then cannot differ, and a field keeps its name in the file.
///
///     Archive kept;
///     kept("time", time);
///     Archive restored(kept.fields());
///     restored("time", time);
///
/// Returns the same bits. Errors: nlohmann::json::exception where a field is missing or of another kind,
/// std::out_of_range where a list has another length.

#include <lagroid/core/number_archive.hpp>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// Visits the fields of a state: `archive("name", field)` stores the field when the state is kept, and sets it when it
/// is restored (bit by bit, as CBOR). Restoring throws nlohmann::json::exception where the field is missing or of
/// another kind.
class Archive {
 public:
  /// To keep.
  Archive() : fields_(nlohmann::json::object()), restoring_(false) {}
  /// To restore.
  explicit Archive(nlohmann::json fields) : fields_(std::move(fields)), restoring_(true) {}

  bool restoring() const { return restoring_; }
  const nlohmann::json& fields() const { return fields_; }

  /// Numbers, strings, vectors of numbers; vectors of Eigen's vectors; whatever visits its own fields (`serialize`).
  template <class T> void operator()(const std::string& name, T& field) {
    if constexpr (requires { field.serialize(*this); }) {
      Archive inner = restoring_ ? Archive(fields_.at(name)) : Archive();
      field.serialize(inner);
      if (!restoring_) fields_[name] = inner.fields_;
    } else if constexpr (requires { typename T::value_type::Scalar; }) {
      constexpr auto width = std::size_t(T::value_type::SizeAtCompileTime);
      std::vector<double> flat;
      for (const auto& v : field) flat.insert(flat.end(), v.data(), v.data() + width);
      (*this)(name, flat);
      if (!restoring_) return;
      if (flat.size() % width != 0) throw std::out_of_range(name + ": a list of another computation");
      field.resize(flat.size() / width);
      for (std::size_t i = 0; i < flat.size(); ++i) field[i / width].data()[i % width] = flat[i];
    } else if (restoring_) {
      field = fields_.at(name).get<T>();
    } else {
      fields_[name] = field;
    }
  }

  /// The same of a list whose length is known. Throws std::out_of_range where it was kept with another.
  template <class T> void list(const std::string& name, std::vector<T>& field) {
    const std::size_t length = field.size();
    (*this)(name, field);
    if (field.size() != length) throw std::out_of_range(name + ": a list of another computation");
  }

  /// What is visited as a list of bare numbers. Throws std::out_of_range where it was written by another computation.
  template <class Visit> void numbers(const std::string& name, const Visit& visit) {
    NumberArchive numbers = restoring_ ? NumberArchive(fields_.at(name).get<std::vector<double>>()) : NumberArchive();
    visit(numbers);
    if (!restoring_) {
      fields_[name] = numbers.numbers();
    } else if (!numbers.at_end()) {
      throw std::out_of_range("numbers of another computation");
    }
  }

 private:
  nlohmann::json fields_;
  bool restoring_;
};

}  // namespace lagroid
