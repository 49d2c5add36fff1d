#pragma once
/// N numbers side by side in vector registers, with componentwise operations: the storage of scalars with derivatives.
///
/// The chain rule is a few multiplications of whole gradients; in registers each costs as much as one of a number.
///
///     const Pack<double, 3> a = Pack<double, 3>::load(numbers);
///     const Pack<double, 3> b = 2.0 * a + Pack<double, 3>::unit(0);
///     b.store(numbers);
///
/// Like a double, a pack is indeterminate until given a value. Nothing throws.

#include <lagroid/core/types.hpp>

#include <array>
#include <bit>
#include <concepts>
#include <cstring>
#include <type_traits>

namespace lagroid {

namespace detail {

/// How many numbers of type T one register of the target machine holds. An installed library fixes the registers it was
/// compiled for, so that what it shares with its callers has one layout, whatever their own instruction set.
template <class T> constexpr int register_lanes() {
#if defined(LAGROID_REGISTER_BYTES)
  constexpr int bytes = LAGROID_REGISTER_BYTES;
#elif defined(__AVX512F__)
  constexpr int bytes = 64;
#elif defined(__AVX__)
  constexpr int bytes = 32;
#else
  constexpr int bytes = 16;
#endif
  return std::same_as<T, double> || std::same_as<T, float> ? bytes / int(sizeof(T)) : 1;
}

template <class T, int Width> struct Register { using Type [[gnu::vector_size(Width * sizeof(T))]] = T; };
template <class T> struct Register<T, 1> { using Type = T; };

}  // namespace detail

/// N numbers, padded with zeros to whole registers; a vector space with componentwise operations.
template <class T, int N> class Pack {
  static constexpr int width = std::min(int(std::bit_ceil(unsigned(N))), detail::register_lanes<T>());
  static constexpr int count = (N + width - 1) / width;
  using Register = typename detail::Register<T, width>::Type;

  using Row = std::array<T, width * count>;
  static constexpr std::array<Row, N> units = [] {
    std::array<Row, N> rows{};
    for (int i = 0; i < N; ++i) rows[i][i] = T(1);
    return rows;
  }();

 public:
  Pack() = default;
  // Register by register: a copy in larger pieces would wait for the smaller stores before it.
  LAGROID_INLINE Pack(const Pack& a) {
    unrolled<count>([&]<int K>() { part_[K] = a.part_[K]; });
  }
  LAGROID_INLINE Pack& operator=(const Pack& a) {
    unrolled<count>([&]<int K>() { part_[K] = a.part_[K]; });
    return *this;
  }

  /// The numbers themselves, in order.
  Vector<T, N> vector() const {
    Vector<T, N> out;
    for (int i = 0; i < N; ++i) out(i) = (*this)[i];
    return out;
  }
  LAGROID_INLINE T operator[](int i) const {
    if constexpr (width == 1) {
      return part_[i];
    } else {
      return part_[i / width][i % width];
    }
  }
  LAGROID_INLINE void set(int i, T x) {
    if constexpr (width == 1) {
      part_[i] = x;
    } else {
      part_[i / width][i % width] = x;
    }
  }
  /// The N numbers at `x`.
  LAGROID_INLINE static Pack load(const T* x) {
    Pack out{};
    std::memcpy(&out.part_, x, N * sizeof(T));
    return out;
  }
  LAGROID_INLINE void store(T* x) const { std::memcpy(x, &part_, N * sizeof(T)); }
  /// One in place i, zero elsewhere.
  LAGROID_INLINE static Pack unit(int i) {
    if constexpr (std::is_arithmetic_v<T>) {
      Pack out;
      std::memcpy(&out.part_, &units[i], sizeof out.part_);
      return out;
    } else {
      return along(i, T(1));
    }
  }
  /// x in place i, zero elsewhere: one that adds without a trace.
  LAGROID_INLINE static Pack along(int i, const T& x) {
    if constexpr (std::is_arithmetic_v<T>) {
      return x * unit(i);
    } else {
      Pack out;
      unrolled<count>([&]<int K>() { out.part_[K] = K == i ? x : -T(0); });
      return out;
    }
  }

  LAGROID_INLINE friend Pack operator+(const Pack& a, const Pack& b) {
    return each([&](int k) -> Register { return a.part_[k] + b.part_[k]; });
  }
  LAGROID_INLINE friend Pack operator-(const Pack& a, const Pack& b) {
    return each([&](int k) -> Register { return a.part_[k] - b.part_[k]; });
  }
  LAGROID_INLINE friend Pack operator-(const Pack& a) {
    return each([&](int k) -> Register { return -a.part_[k]; });
  }
  LAGROID_INLINE friend Pack operator*(T s, const Pack& a) {
    return each([&](int k) -> Register { return s * a.part_[k]; });
  }
  LAGROID_INLINE friend Pack select(const MaskOf<T>& condition, const Pack& a, const Pack& b) {
    if constexpr (std::is_arithmetic_v<T>) {
      return condition ? a : b;
    } else {
      return each([&](int k) { return select(condition, a.part_[k], b.part_[k]); });
    }
  }

 private:
  template <class F> LAGROID_INLINE static Pack each(const F& f) {
    Pack out;
    unrolled<count>([&]<int K>() { out.part_[K] = f(K); });
    return out;
  }

  std::array<Register, count> part_;
};

}  // namespace lagroid
