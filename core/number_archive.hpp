#pragma once
/// A list of numbers from which a computation goes on with the same bits: `object.serialize(archive)` visits its
/// numbers in a fixed order, and writes them or reads them.
///
/// One function does both, so that what is written and what is read cannot differ.
///
///     NumberArchive written;
///     written(time, velocity);
///     NumberArchive read(written.numbers());
///     read(time, velocity);
///
/// Requires fields that are numbers, flags, Eigen matrices and arrays of fixed size, or that have a `serialize`; whole
/// numbers are kept as doubles, exact up to 2^53.
///
/// Errors: std::out_of_range where an archive is read beyond its end.

#include <lagroid/core/groupoid.hpp>

#include <array>
#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

/// Written to when it is made empty, read from when it is made of numbers.
class NumberArchive {
 public:
  /// To be written.
  NumberArchive() = default;
  /// To be read.
  explicit NumberArchive(std::vector<double> numbers) : numbers_(std::move(numbers)), reading_(true) {}

  bool reading() const { return reading_; }
  const std::vector<double>& numbers() const { return numbers_; }
  /// Whether all that was written has been read.
  bool at_end() const { return at_ == numbers_.size(); }

  /// Visits numbers, flags, matrices and arrays of fixed size, and whatever visits its own fields. Throws
  /// std::out_of_range where the archive is read beyond its end: it was written by another computation.
  template <class... Fields> void operator()(Fields&... fields) { (visit(fields), ...); }
  template <class G> void arrow(const G& groupoid, ArrowOf<G>& g) {
    auto x = groupoid.coordinates_of_arrow(g);
    visit(x);
    if (reading_) g = groupoid.template arrow_at<double>(x);
  }
  template <class G> void object(const G& groupoid, ObjectOf<G>& q) {
    auto x = groupoid.coordinates_of_object(q);
    visit(x);
    if (reading_) q = groupoid.template object_at<double>(x);
  }

 private:
  void number(double& x) {
    if (!reading_) {
      numbers_.push_back(x);
    } else if (at_ < numbers_.size()) {
      x = numbers_[at_++];
    } else {
      throw std::out_of_range("an archive of another computation");
    }
  }

  template <class T> void visit(T& field) {
    if constexpr (std::is_arithmetic_v<T>) {
      auto x = double(field);
      number(x);
      if (reading_) field = T(x);
    } else if constexpr (requires { field.serialize(*this); }) {
      field.serialize(*this);
    } else if constexpr (requires { T::SizeAtCompileTime; }) {
      static_assert(T::SizeAtCompileTime != Eigen::Dynamic);
      for (Eigen::Index i = 0; i < field.size(); ++i) visit(field.data()[i]);
    } else {
      for (auto& each : field) visit(each);
    }
  }

  std::vector<double> numbers_;
  std::size_t at_ = 0;
  bool reading_ = false;
};

}  // namespace lagroid
