#pragma once
/// The second-order jet: value, gradient and symmetric Hessian of a function of N variables.

#include <lagroid/core/elementary.hpp>
#include <lagroid/core/types.hpp>

#include <array>
#include <ostream>
#include <type_traits>

namespace lagroid {

/// x + g.v + v^T H v / 2 in N infinitesimals v with v v v = 0: a Taylor polynomial. H is symmetric and stored as the
/// rows of its lower triangle, so that a jet has 1 + N + N (N + 1) / 2 numbers where Mixed<T, N, N> has (N + 1)^2.
template <class T, int N> struct SecondJet {
  using Real = T;
  static constexpr int variables = N;
  static constexpr int order = 2;
  static constexpr int parts = N + N * (N + 1) / 2;

  T value;
  std::array<T, std::size_t(parts)> part;  ///< g, then H(0,0), H(1,0), H(1,1), H(2,0), ...

  /// As for a double: `SecondJet x;` is uninitialised, `SecondJet()` is zero.
  SecondJet() = default;
  /// A constant. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> SecondJet(A x) : value(T(x)), part{} {}  // NOLINT(google-explicit-constructor)

  /// The i-th variable, of value x.
  static SecondJet variable(T x, int i) {
    SecondJet out(x);
    out.gradient(i) = 1;
    return out;
  }

  T& gradient(int i) { return part[std::size_t(i)]; }
  T gradient(int i) const { return part[std::size_t(i)]; }
  /// H(i, j), i >= j.
  T& hessian(int i, int j) { return part[std::size_t(row(i) + j)]; }
  T hessian(int i, int j) const { return part[std::size_t(row(i) + j)]; }

  Vector<T, N> gradient() const {
    Vector<T, N> g;
    for (int i = 0; i < N; ++i) g(i) = gradient(i);
    return g;
  }
  Matrix<T, N, N> hessian() const {
    Matrix<T, N, N> h;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j <= i; ++j) h(i, j) = h(j, i) = hessian(i, j);
    return h;
  }

  /// The composition with a function of one variable, given its value and two derivatives at `value`.
  SecondJet chain(T f, T f1, T f2) const {
    SecondJet out;
    out.value = f;
    for (int k = 0; k < parts; ++k) out.part[k] = f1 * part[k];
    for (int i = 0; i < N; ++i) {
      const T slope = f2 * part[i];
      for (int j = 0; j <= i; ++j) out.part[row(i) + j] += slope * part[j];
    }
    return out;
  }
  SecondJet& operator+=(const SecondJet& b) {
    value += b.value;
    for (int k = 0; k < parts; ++k) part[k] += b.part[k];
    return *this;
  }
  SecondJet& operator-=(const SecondJet& b) {
    value -= b.value;
    for (int k = 0; k < parts; ++k) part[k] -= b.part[k];
    return *this;
  }
  SecondJet& operator*=(const SecondJet& b) { return *this = *this * b; }
  SecondJet& operator/=(const SecondJet& b) { return *this = *this / b; }

  friend SecondJet operator+(const SecondJet& a) { return a; }
  friend SecondJet operator-(const SecondJet& a) { return a * T(-1); }
  friend SecondJet operator+(const SecondJet& a, const SecondJet& b) {
    SecondJet out;
    out.value = a.value + b.value;
    for (int k = 0; k < parts; ++k) out.part[k] = a.part[k] + b.part[k];
    return out;
  }
  friend SecondJet operator-(const SecondJet& a, const SecondJet& b) {
    SecondJet out;
    out.value = a.value - b.value;
    for (int k = 0; k < parts; ++k) out.part[k] = a.part[k] - b.part[k];
    return out;
  }
  friend SecondJet operator*(const SecondJet& a, const SecondJet& b) {
    SecondJet out;
    out.value = a.value * b.value;
    for (int k = 0; k < parts; ++k) out.part[k] = a.value * b.part[k] + b.value * a.part[k];
    for (int i = 0; i < N; ++i) {
      const T ai = a.part[i];
      const T bi = b.part[i];
      for (int j = 0; j <= i; ++j) out.part[row(i) + j] += ai * b.part[j] + bi * a.part[j];
    }
    return out;
  }
  friend SecondJet operator/(const SecondJet& a, const SecondJet& b) {
    const T inverse = 1 / b.value;
    SecondJet out;
    out.value = a.value * inverse;
    for (int k = 0; k < parts; ++k) out.part[k] = (a.part[k] - out.value * b.part[k]) * inverse;
    for (int i = 0; i < N; ++i) {
      const T qi = out.part[i] * inverse;
      const T bi = b.part[i] * inverse;
      for (int j = 0; j <= i; ++j) out.part[row(i) + j] -= qi * b.part[j] + bi * out.part[j];
    }
    return out;
  }

  friend SecondJet operator+(SecondJet a, T b) {
    a.value += b;
    return a;
  }
  friend SecondJet operator+(T a, const SecondJet& b) { return b + a; }
  friend SecondJet operator-(SecondJet a, T b) {
    a.value -= b;
    return a;
  }
  friend SecondJet operator-(T a, const SecondJet& b) { return -b + a; }
  friend SecondJet operator*(const SecondJet& a, T b) {
    SecondJet out;
    out.value = a.value * b;
    for (int k = 0; k < parts; ++k) out.part[k] = a.part[k] * b;
    return out;
  }
  friend SecondJet operator*(T a, const SecondJet& b) { return b * a; }
  friend SecondJet operator/(const SecondJet& a, T b) { return a * (1 / b); }
  friend SecondJet operator/(T a, const SecondJet& b) {
    const T inverse = 1 / b.value;
    return b.chain(a * inverse, -a * inverse * inverse, 2 * a * inverse * inverse * inverse);
  }

  friend bool operator==(const SecondJet& a, const SecondJet& b) { return a.value == b.value; }
  friend auto operator<=>(const SecondJet& a, const SecondJet& b) { return a.value <=> b.value; }
  friend std::ostream& operator<<(std::ostream& out, const SecondJet& a) { return out << a.value; }

 private:
  /// Where row i of the lower triangle starts.
  static constexpr int row(int i) { return N + i * (i + 1) / 2; }
};

template <class T, int N> constexpr T value_of(const SecondJet<T, N>& x) { return x.value; }

}  // namespace lagroid

template <class T, int N>
struct Eigen::NumTraits<lagroid::SecondJet<T, N>> : lagroid::detail::DerivativeTraits<lagroid::SecondJet<T, N>> {};

template <class T, int N, class Operation> struct Eigen::ScalarBinaryOpTraits<lagroid::SecondJet<T, N>, T, Operation> {
  using ReturnType = lagroid::SecondJet<T, N>;
};
template <class T, int N, class Operation> struct Eigen::ScalarBinaryOpTraits<T, lagroid::SecondJet<T, N>, Operation> {
  using ReturnType = lagroid::SecondJet<T, N>;
};
