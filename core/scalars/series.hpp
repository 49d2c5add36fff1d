#pragma once
/// Truncated power series x_0 + x_1 t + ... + x_{K-1} t^{K-1}: the scalar that turns a formula into the Taylor
/// coefficients of its values.
///
/// The solution of an ordinary differential equation follows from its right side alone, to any order.
///
///     const auto decay = [](const auto& z) { return (-z).eval(); };
///     const auto z = taylor_solution<4>(decay, Vector<double, 1>(1.0));
///     const double at_tenth = z(0).at(0.1);  // 1 - t + t^2/2 - t^3/6
///
/// Requires functions that are smooth at the constant terms. Comparisons are those of the constant terms. Nothing
/// throws.
///
/// Source: Griewank and Walther, *Evaluating Derivatives*, 2008, chapter 13.

#include <lagroid/core/scalars/special_functions.hpp>
#include <lagroid/core/types.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <ostream>
#include <type_traits>
#include <utility>

namespace lagroid {

/// x_0 + x_1 t + ... + x_{K-1} t^{K-1} modulo t^K, with coefficients of any scalar T. A product, a quotient
/// or an elementary function costs O(K^2) operations of T, by the recurrence that its differential equation gives.
template <class T, int K> class Series {
  static_assert(K >= 1);

 public:
  static constexpr int terms = K;

  /// Zero.
  Series() : Series(0.0) {}
  /// A constant. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> Series(A x) { fill(T(double(x))); }  // NOLINT(google-explicit-constructor)
  /// A constant of an inner scalar, however deep.
  template <class A>
  requires(!std::is_arithmetic_v<A> && !std::same_as<A, Series> &&
           std::constructible_from<T, const A&>) explicit Series(const A& x) {
    fill(T(x));
  }

  /// The coefficient of t^k.
  const T& operator[](int k) const { return coefficients_[std::size_t(k)]; }
  T& operator[](int k) { return coefficients_[std::size_t(k)]; }

  /// The value at t of its first `count` terms.
  template <class Time> T at(const Time& t, int count = K) const {
    T sum(0.0);
    for (int k = count; k-- > 0;) sum = sum * t + (*this)[k];
    return sum;
  }

  Series& operator+=(const Series& b) { return *this = *this + b; }
  Series& operator-=(const Series& b) { return *this = *this - b; }
  Series& operator*=(const Series& b) { return *this = *this * b; }
  Series& operator/=(const Series& b) { return *this = *this / b; }

  friend Series operator+(const Series& a) { return a; }
  friend Series operator-(const Series& a) {
    return each([&](int k) -> T { return -a[k]; });
  }
  friend Series operator+(const Series& a, const Series& b) {
    return each([&](int k) -> T { return a[k] + b[k]; });
  }
  friend Series operator-(const Series& a, const Series& b) {
    return each([&](int k) -> T { return a[k] - b[k]; });
  }
  // Out of line: these are long loops over long sums, and formulas have many of them to compile.
  [[gnu::noinline]] friend Series operator*(const Series& a, const Series& b) {
    return each([&](int k) {
      T sum = a[0] * b[k];
      for (int j = 1; j <= k; ++j) sum += a[j] * b[k - j];
      return sum;
    });
  }
  [[gnu::noinline]] friend Series operator/(const Series& a, const Series& b) {
    Series out;
    for (int k = 0; k < K; ++k) {
      T sum = a[k];
      for (int j = 1; j <= k; ++j) sum -= b[j] * out[k - j];
      out[k] = sum / b[0];
    }
    return out;
  }

  friend Series operator+(const Series& a, double b) {
    Series out = a;
    out[0] += T(b);
    return out;
  }
  friend Series operator*(const Series& a, double b) {
    return each([&](int k) -> T { return a[k] * b; });
  }
  friend Series operator+(double a, const Series& b) { return b + a; }
  friend Series operator-(const Series& a, double b) { return a + (-b); }
  friend Series operator-(double a, const Series& b) { return -b + a; }
  friend Series operator*(double a, const Series& b) { return b * a; }
  friend Series operator/(const Series& a, double b) { return a * (1 / b); }
  friend Series operator/(double a, const Series& b) { return Series(a) / b; }

  friend bool operator==(const Series& a, const Series& b) { return a[0] == b[0]; }
  friend auto operator<=>(const Series& a, const Series& b) { return a[0] <=> b[0]; }
  friend std::ostream& operator<<(std::ostream& out, const Series& a) { return out << a[0]; }

 private:
  void fill(const T& constant) {
    coefficients_.fill(T(0.0));
    coefficients_[0] = constant;
  }
  template <class F> static Series each(const F& coefficient) {
    Series out;
    for (int k = 0; k < K; ++k) out[k] = coefficient(k);
    return out;
  }

  std::array<T, std::size_t(K)> coefficients_;
};

template <class T, int K> constexpr auto value_of(const Series<T, K>& x) { return value_of(x[0]); }

namespace detail {

/// dx/dt; its last term, which x does not know, is zero.
template <class T, int K> Series<T, K> derivative(const Series<T, K>& x) {
  Series<T, K> out;
  for (int k = 1; k < K; ++k) out[k - 1] = x[k] * double(k);
  return out;
}
/// The series of derivative y that begins with x; the last term of y does not matter.
template <class T, int K> Series<T, K> integral(const T& x, const Series<T, K>& y) {
  Series<T, K> out(x);
  for (int k = 1; k < K; ++k) out[k] = y[k - 1] / double(k);
  return out;
}
/// The next coefficient, k, of a series y with y' = f x', of which f_0 ... f_{k-1} are known.
template <class T, int K> T next(const Series<T, K>& x, const Series<T, K>& f, int k) {
  T sum = x[k] * f[0] * double(k);
  for (int j = 1; j < k; ++j) sum += x[j] * f[k - j] * double(j);
  return sum / double(k);
}

}  // namespace detail

template <class T, int K> Series<T, K> sqrt(const Series<T, K>& x) {
  using std::sqrt;
  Series<T, K> y(sqrt(x[0]));
  for (int k = 1; k < K; ++k) {
    T sum = x[k];
    for (int j = 1; j < k; ++j) sum -= y[j] * y[k - j];
    y[k] = sum / (y[0] * 2.0);
  }
  return y;
}
template <class T, int K> Series<T, K> exp(const Series<T, K>& x) {
  using std::exp;
  Series<T, K> y(exp(x[0]));
  for (int k = 1; k < K; ++k) y[k] = detail::next(x, y, k);
  return y;
}
template <class T, int K> Series<T, K> log(const Series<T, K>& x) {
  using std::log;
  return detail::integral(T(log(x[0])), detail::derivative(x) / x);
}
/// Requires x_0 nonzero, unless p is a natural number.
template <class T, int K> Series<T, K> pow(const Series<T, K>& x, double p) {
  using std::pow;
  if (p >= 0 && p <= 64 && p == std::floor(p)) {
    Series<T, K> y(1.0);
    for (int i = 0; i < int(p); ++i) y = y * x;
    return y;
  }
  Series<T, K> y(T(pow(x[0], p)));
  for (int k = 1; k < K; ++k) {  // x y' = p x' y
    T sum = x[k] * y[0] * (p * k);
    for (int j = 1; j < k; ++j) sum += x[j] * y[k - j] * (p * j - double(k - j));
    y[k] = sum / (x[0] * double(k));
  }
  return y;
}

namespace detail {

/// The pair y' = z x', z' = sign y x', from its constant terms: (sin, cos) for -1, (sinh, cosh) for 1.
template <class T, int K> struct Rotation {
  Series<T, K> y;
  Series<T, K> z;
  Rotation(const Series<T, K>& x, const T& y0, const T& z0, double sign) : y(y0), z(z0) {
    for (int k = 1; k < K; ++k) {
      const T next_y = next(x, z, k);
      z[k] = next(x, y, k) * sign;
      y[k] = next_y;
    }
  }
};

template <class T, int K> Rotation<T, K> circular(const Series<T, K>& x) {
  using std::cos, std::sin;
  return {x, sin(x[0]), cos(x[0]), -1};
}
template <class T, int K> Rotation<T, K> hyperbolic(const Series<T, K>& x) {
  using std::cosh, std::sinh;
  return {x, sinh(x[0]), cosh(x[0]), 1};
}

}  // namespace detail

template <class T, int K> Series<T, K> sin(const Series<T, K>& x) { return detail::circular(x).y; }
template <class T, int K> Series<T, K> cos(const Series<T, K>& x) { return detail::circular(x).z; }
template <class T, int K> Series<T, K> tan(const Series<T, K>& x) {
  const auto r = detail::circular(x);
  return r.y / r.z;
}
template <class T, int K> Series<T, K> sinh(const Series<T, K>& x) { return detail::hyperbolic(x).y; }
template <class T, int K> Series<T, K> cosh(const Series<T, K>& x) { return detail::hyperbolic(x).z; }
template <class T, int K> Series<T, K> tanh(const Series<T, K>& x) {
  const auto r = detail::hyperbolic(x);
  return r.y / r.z;
}
template <class T, int K> Series<T, K> asin(const Series<T, K>& x) {
  using std::asin;
  return detail::integral(T(asin(x[0])), detail::derivative(x) / sqrt((1.0 - x) * (1.0 + x)));
}
template <class T, int K> Series<T, K> acos(const Series<T, K>& x) {
  using std::acos;
  return detail::integral(T(acos(x[0])), -detail::derivative(x) / sqrt((1.0 - x) * (1.0 + x)));
}
template <class T, int K> Series<T, K> atan(const Series<T, K>& x) {
  using std::atan;
  return detail::integral(T(atan(x[0])), detail::derivative(x) / (1.0 + x * x));
}
template <class T, int K> Series<T, K> atan2(const Series<T, K>& y, const Series<T, K>& x) {
  using std::atan2;
  return detail::integral(T(atan2(y[0], x[0])),
                          (x * detail::derivative(y) - y * detail::derivative(x)) / (x * x + y * y));
}
/// By the Taylor coefficients a_{m, j} of c_m at x_0: a_{m, j} = -(a_{m+1, j-1} - m a_{m+2, j-1}) / (2 j).
template <int M, class T, int K> Series<T, K> stumpff(const Series<T, K>& x) {
  constexpr std::size_t needed = std::size_t(2 * K - 1);
  std::array<T, needed> a = [&]<std::size_t... I>(std::index_sequence<I...>) {
    return std::array<T, needed>{stumpff<M + int(I)>(x[0])...};
  }
  (std::make_index_sequence<needed>());
  const Series<T, K> away = x - Series<T, K>(x[0]);
  Series<T, K> sum(a[0]), power(1.0);
  for (int j = 1; j < K; ++j) {
    for (std::size_t m = 0; m + 2 < needed - 2 * std::size_t(j - 1); ++m)
      a[m] = (a[m + 2] * double(M + int(m)) - a[m + 1]) * (0.5 / double(j));
    power *= away;
    for (int k = j; k < K; ++k) sum[k] += power[k] * a[0];
  }
  return sum;
}
template <class T, int K> Series<T, K> abs(const Series<T, K>& x) { return value_of(x) < 0 ? -x : x; }

/// The Taylor coefficients up to t^{K-1} of the solution of z' = f(z), z(0) = start, by Picard's iteration, each of
/// which gains one. f maps Vector<Series<S, K>, M> to itself.
template <int K, class S, int M, class F>
Vector<Series<S, K>, M> taylor_solution(const F& f, const Vector<S, M>& start) {
  Vector<Series<S, K>, M> z;
  for (int i = 0; i < M; ++i) z(i) = Series<S, K>(start(i));
  for (int k = 1; k < K; ++k) {
    const Vector<Series<S, K>, M> rate = f(z);
    for (int i = 0; i < M; ++i) z(i)[k] = rate(i)[k - 1] / double(k);
  }
  return z;
}

}  // namespace lagroid

template <class T, int K> struct Eigen::NumTraits<lagroid::Series<T, K>> : Eigen::NumTraits<double> {
  using Real = lagroid::Series<T, K>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = double;
  enum { IsComplex = 0, RequireInitialization = 1, ReadCost = K, AddCost = K, MulCost = K * K };
};

template <class T, int K, class Operation>
struct Eigen::ScalarBinaryOpTraits<lagroid::Series<T, K>, double, Operation> {
  using ReturnType = lagroid::Series<T, K>;
};
template <class T, int K, class Operation>
struct Eigen::ScalarBinaryOpTraits<double, lagroid::Series<T, K>, Operation> {
  using ReturnType = lagroid::Series<T, K>;
};

/// Arrays are aligned like T, which may need more than Eigen's own limit.
template <class T, int K, int Size>
requires(Size != Eigen::Dynamic) struct Eigen::internal::compute_default_alignment<lagroid::Series<T, K>, Size> {
  enum { value = 0 };
};
