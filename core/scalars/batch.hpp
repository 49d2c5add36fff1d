#pragma once
/// A few independent numbers side by side, one in each lane of a vector register: the scalar of ensembles.
///
/// A formula written once for any scalar, evaluated on batches, is evaluated for as many members of an ensemble at once
/// as a register has lanes.
///
///     const Batch<2> x = Batch<2>::load(numbers);  // two numbers
///     const Batch<2> y = select(x > 0.0, sqrt(x), Batch<2>(0.0));
///     y.store(numbers);
///
/// Requires formulas without branches on values (`select` in their place) and a width that the machine has registers
/// for. **What a lane holds depends on nothing but what that lane held before**: no operation here takes one path or
/// another by what its neighbours are, except where both paths give each lane the same bits. (The trigonometric
/// functions of xsimd itself reduce their arguments by the largest of them, so they are not used.) Nothing throws.

#include <lagroid/core/scalars/elementary.hpp>

#include <xsimd/xsimd.hpp>

#include <array>
#include <cmath>
#include <concepts>
#include <numbers>
#include <ostream>
#include <type_traits>

namespace lagroid {

/// Lanes of the machine's widest register.
inline constexpr int widest_batch = int(xsimd::batch<double>::size);

/// `Width` numbers, with lanewise operations. Like a double, indeterminate until given a value. Comparisons yield a
/// `Mask`, which is no bool: a formula that branches on a value is written with `select` (core/types.hpp), whose
/// branches are both evaluated. Widths are those of the machine's registers: 8, 4 and 2 where it has AVX-512.
template <int Width = widest_batch> class Batch {
  using Native = xsimd::make_sized_batch_t<double, std::size_t(Width)>;

 public:
  using Register = typename Native::register_type;
  using Mask = typename Native::batch_bool_type;
  static constexpr int lanes = Width;

  Batch() = default;
  // Register by register: a copy in other pieces would wait for the stores before it.
  LAGROID_INLINE Batch(const Batch& a) : lanes_(a.lanes_) {}
  LAGROID_INLINE Batch& operator=(const Batch& a) {
    lanes_ = a.lanes_;
    return *this;
  }
  /// The same number in every lane. Implicit, so that formulas may contain plain numbers.
  template <class A>
  requires std::is_arithmetic_v<A> LAGROID_INLINE Batch(A x)
      : lanes_(Native(double(x)).data) {}                    // NOLINT(google-explicit-constructor)
  LAGROID_INLINE Batch(const Native& x) : lanes_(x.data) {}  // NOLINT(google-explicit-constructor)

  LAGROID_INLINE Native native() const { return Native(lanes_); }
  LAGROID_INLINE static Batch load(const double* x) { return Native::load_unaligned(x); }
  LAGROID_INLINE void store(double* x) const { native().store_unaligned(x); }

  /// Lane by lane, for what is rare.
  double operator[](int lane) const { return lanes_[lane]; }
  void set(int lane, double x) { lanes_[lane] = x; }
  std::array<double, std::size_t(Width)> to_array() const {
    std::array<double, std::size_t(Width)> out;
    store(out.data());
    return out;
  }
  /// f of each lane of one batch or of two.
  template <class F> static Batch by_lane(const F& f, const Batch& a) {
    auto x = a.to_array();
    for (double& lane : x) lane = f(lane);
    return load(x.data());
  }
  template <class F> static Batch by_lane(const F& f, const Batch& a, const Batch& b) {
    auto x = a.to_array();
    const auto y = b.to_array();
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = f(x[i], y[i]);
    return load(x.data());
  }

  // The compiler's own vector arithmetic, which it optimises as it does that of numbers.
  LAGROID_INLINE friend Batch operator+(const Batch& a, const Batch& b) { return made(a.lanes_ + b.lanes_); }
  LAGROID_INLINE friend Batch operator-(const Batch& a, const Batch& b) { return made(a.lanes_ - b.lanes_); }
  LAGROID_INLINE friend Batch operator*(const Batch& a, const Batch& b) { return made(a.lanes_ * b.lanes_); }
  LAGROID_INLINE friend Batch operator/(const Batch& a, const Batch& b) { return made(a.lanes_ / b.lanes_); }
  LAGROID_INLINE friend Batch operator-(const Batch& a) { return made(-a.lanes_); }
  LAGROID_INLINE friend Batch operator+(const Batch& a) { return a; }
  LAGROID_INLINE Batch& operator+=(const Batch& b) { return *this = *this + b; }
  LAGROID_INLINE Batch& operator-=(const Batch& b) { return *this = *this - b; }
  LAGROID_INLINE Batch& operator*=(const Batch& b) { return *this = *this * b; }
  LAGROID_INLINE Batch& operator/=(const Batch& b) { return *this = *this / b; }

  LAGROID_INLINE friend Mask operator<(const Batch& a, const Batch& b) { return a.native() < b.native(); }
  LAGROID_INLINE friend Mask operator<=(const Batch& a, const Batch& b) { return a.native() <= b.native(); }
  LAGROID_INLINE friend Mask operator>(const Batch& a, const Batch& b) { return a.native() > b.native(); }
  LAGROID_INLINE friend Mask operator>=(const Batch& a, const Batch& b) { return a.native() >= b.native(); }
  LAGROID_INLINE friend Mask operator==(const Batch& a, const Batch& b) { return a.native() == b.native(); }
  LAGROID_INLINE friend Mask operator!=(const Batch& a, const Batch& b) { return a.native() != b.native(); }

  /// a where the mask is set, b elsewhere.
  LAGROID_INLINE friend Batch select(const Mask& condition, const Batch& a, const Batch& b) {
    return xsimd::select(condition, a.native(), b.native());
  }
  /// Of numbers; what they make of NaN depends on the machine.
  LAGROID_INLINE friend Batch max(const Batch& a, const Batch& b) { return xsimd::max(a.native(), b.native()); }
  LAGROID_INLINE friend Batch min(const Batch& a, const Batch& b) { return xsimd::min(a.native(), b.native()); }
  LAGROID_INLINE friend Batch abs(const Batch& a) { return xsimd::abs(a.native()); }
  LAGROID_INLINE friend Batch sqrt(const Batch& a) { return xsimd::sqrt(a.native()); }

  friend std::ostream& operator<<(std::ostream& out, const Batch& a) {
    for (const double x : a.to_array()) out << x << ' ';
    return out;
  }

 private:
  LAGROID_INLINE static Batch made(const Register& numbers) {
    Batch out;
    out.lanes_ = numbers;
    return out;
  }

  Register lanes_;
};

template <int W> const Batch<W>& value_of(const Batch<W>& x) { return x; }
template <int W> constexpr int lanes_in(const Batch<W>&) { return W; }
template <int W> double in_lane(const Batch<W>& x, int lane) { return x[lane]; }

template <class S> struct IsBatch : std::false_type {};
template <int W> struct IsBatch<Batch<W>> : std::true_type {};
/// A batch, not a batch with derivatives.
template <class S>
concept BatchScalar = IsBatch<S>::value;

// ---- sine and cosine

namespace detail {

/// x = (n + y) pi/2 with |y| <= 1/2 up to round-off, as y + tail in radians; for |x| below `largest_reduced`.
template <class B> struct Reduced {
  B quadrant;  ///< n modulo 4
  B angle;
  B tail;
};
inline constexpr double largest_reduced = 1e6;

/// By Cody and Waite: pi/2 in three pieces, of which n times the first two are exact.
template <class B> LAGROID_INLINE inline Reduced<B> reduced(const B& x) {
  constexpr double first = 0x1.921fb544p+0;
  constexpr double second = 0x1.0b4611a6p-34;
  constexpr double third = 0x1.3198a2e037073p-69;
  constexpr double shift = 0x1.8p52;  // adding it rounds to a whole number
  const B n = (x * (2 * std::numbers::inv_pi) + shift) - shift;
  const B a = x - n * first;
  const B b = n * second;
  const B y = a - b;
  const B lost = (a - y) - b;
  const B tail = lost - n * third;
  const B angle = y + tail;
  const B quarter = n * 0.25;
  return {n - 4.0 * (((quarter - 0.375) + shift) - shift), angle, (y - angle) + tail};
}

/// sin(y + tail) and cos(y + tail) for |y| <= pi/4: the polynomials of fdlibm (Sun Microsystems, 1993), whose error is
/// below one unit in the last place.
template <class B> LAGROID_INLINE inline B kernel_sine(const B& y, const B& tail) {
  const B z = y * y;
  const B v = z * y;
  const B r =
      8.33333333332248946124e-03 +
      z * (-1.98412698298579493134e-04 +
           z * (2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  return y - ((z * (0.5 * tail - v * r) - tail) - v * -1.66666666666666324348e-01);
}
template <class B> LAGROID_INLINE inline B kernel_cosine(const B& y, const B& tail) {
  const B z = y * y;
  const B r = z * (4.16666666666666019037e-02 +
                   z * (-1.38888888888741095749e-03 +
                        z * (2.48015872894767294178e-05 +
                             z * (-2.75573143513906633035e-07 +
                                  z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const B half = 0.5 * z;
  const B w = 1.0 - half;
  return w + (((1.0 - w) - half) + (z * r - y * tail));
}

/// The sine of x plus `quarters` quarter turns.
template <int W> LAGROID_INLINE inline Batch<W> sine(const Batch<W>& x, int quarters) {
  using B = Batch<W>;
  const auto reduced_x = reduced(x);
  const B s = kernel_sine(reduced_x.angle, reduced_x.tail);
  const B c = kernel_cosine(reduced_x.angle, reduced_x.tail);
  B n = reduced_x.quadrant + double(quarters);
  n = select(n >= 4.0, n - 4.0, n);
  const B size = select((n == 1.0) || (n == 3.0), c, s);
  const B out = select(n >= 2.0, -size, size);
  const auto far = !(abs(x) <= largest_reduced);
  if (!xsimd::any(far)) return out;
  return select(far, B::by_lane([&](double lane) { return quarters == 0 ? std::sin(lane) : std::cos(lane); }, x), out);
}

}  // namespace detail

template <int W> LAGROID_INLINE inline Batch<W> sin(const Batch<W>& x) { return detail::sine(x, 0); }
template <int W> LAGROID_INLINE inline Batch<W> cos(const Batch<W>& x) { return detail::sine(x, 1); }

// ---- the others, lane by lane as the standard library has them

#define LAGROID_BY_LANE(name)                                                 \
  template <int W> [[gnu::noinline]] Batch<W> name(const Batch<W>& x) {       \
    return Batch<W>::by_lane([](double lane) { return std::name(lane); }, x); \
  }
LAGROID_BY_LANE(exp)
LAGROID_BY_LANE(log)
LAGROID_BY_LANE(tan)
LAGROID_BY_LANE(asin)
LAGROID_BY_LANE(acos)
LAGROID_BY_LANE(atan)
LAGROID_BY_LANE(sinh)
LAGROID_BY_LANE(cosh)
LAGROID_BY_LANE(tanh)
#undef LAGROID_BY_LANE
template <int W> [[gnu::noinline]] Batch<W> atan2(const Batch<W>& y, const Batch<W>& x) {
  return Batch<W>::by_lane([](double a, double b) { return std::atan2(a, b); }, y, x);
}
template <int W> [[gnu::noinline]] Batch<W> pow(const Batch<W>& x, const std::type_identity_t<Batch<W>>& p) {
  return Batch<W>::by_lane([](double a, double b) { return std::pow(a, b); }, x, p);
}

// ---- special functions

namespace detail {

/// Horner's scheme with as many terms as each lane needs, of which Terms is the largest number: a lane beyond `wide`
/// needs them all, beyond `narrow` the first Middle, else the first Few. Terms that no lane needs are not evaluated.
template <int Few, int Middle, std::size_t Terms, int W>
LAGROID_INLINE inline Batch<W> horner_by_need(const std::array<double, Terms>& c, double narrow, double wide,
                                              const Batch<W>& x) {
  using B = Batch<W>;
  B sum = 0.0;
  const auto through = [&](int from, int to) {
    for (int i = from - 1; i >= to; --i) sum = c[std::size_t(i)] + x * sum;
  };
  if (const auto all = x >= wide; xsimd::any(all)) {
    through(int(Terms), Middle);
    sum = select(all, sum, B(0.0));
  }
  if (const auto middle = x >= narrow; xsimd::any(middle)) {
    through(Middle, Few);
    sum = select(middle, sum, B(0.0));
  }
  through(Few, 0);
  return sum;
}

}  // namespace detail

/// stumpff<K> of each lane (core/scalars/special_functions.hpp).
template <int K, int W> LAGROID_INLINE inline Batch<W> stumpff(const Batch<W>& x) {
  using B = Batch<W>;
  const B series = detail::horner_by_need<5, 8>(detail::stumpff_coefficients<K, double, 15>, 0.01, 0.25, x);
  const auto far = !(x < 4.0);
  if (!xsimd::any(far)) return series;
  return select(far, B::by_lane([](double lane) { return stumpff<K>(lane); }, x), series);
}
/// angle_ratio<Order> of each lane.
template <int Order, int W> LAGROID_INLINE inline Batch<W> angle_ratio(const Batch<W>& w) {
  using B = Batch<W>;
  const B series =
      detail::horner_by_need<7, 10>(detail::angle_ratio_coefficients<Order, double, 22>, 1e-3, 1e-2, B(1.0 - w));
  const auto far = !(1.0 - w < 0.1);
  if (!xsimd::any(far)) return series;
  return select(far, B::by_lane([](double lane) { return angle_ratio<Order>(lane); }, w), series);
}

}  // namespace lagroid

template <int W> struct Eigen::NumTraits<lagroid::Batch<W>> : Eigen::NumTraits<double> {
  using Real = lagroid::Batch<W>;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = double;
  enum { IsComplex = 0, RequireInitialization = 0, ReadCost = 1, AddCost = 1, MulCost = 1 };
};
template <int W, class Operation> struct Eigen::ScalarBinaryOpTraits<lagroid::Batch<W>, double, Operation> {
  using ReturnType = lagroid::Batch<W>;
};
template <int W, class Operation> struct Eigen::ScalarBinaryOpTraits<double, lagroid::Batch<W>, Operation> {
  using ReturnType = lagroid::Batch<W>;
};
/// Arrays of batches are aligned like their registers, which may need more than Eigen's own limit.
template <int W, int Size>
requires(Size != Eigen::Dynamic) struct Eigen::internal::compute_default_alignment<lagroid::Batch<W>, Size> {
  enum { value = 0 };
};
/// They are copied register by register: the compiler makes calls of memcpy of loops, and these wait for the stores.
template <int W, int Size, int Options>
requires(Size > 0) struct Eigen::internal::plain_array<lagroid::Batch<W>, Size, Options, 0> {
  lagroid::Batch<W> array[Size];

  plain_array() = default;
  explicit plain_array(constructor_without_unaligned_array_assert) {}
  LAGROID_INLINE plain_array(const plain_array& a) { *this = a; }
  LAGROID_INLINE plain_array& operator=(const plain_array& a) {
    lagroid::unrolled<Size>([&]<int I>() { array[I] = a.array[I]; });
    return *this;
  }
};
