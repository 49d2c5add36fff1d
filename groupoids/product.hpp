#pragma once
/// The product of two or more groupoids: arrows (g1, g2, ...), with source, target, product and retraction factor by
/// factor.
///
/// A system of several parts, as a cart and a rotor, has the product of their groupoids.
///
///     const Product<Pair<1>, SO2> groupoid;
///     const auto g = groupoid.unit(std::tuple(Vector<double, 1>(2.0), Vector<double, 0>()));
///     const auto& [cart, rotor] = g;
///
/// Requires factors of any kind, two at least. Returns std::tuples. Errors are those of the factors.

#include <lagroid/core/algebroid.hpp>
#include <lagroid/core/capabilities/loops.hpp>
#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/derivatives/arrow_frame.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <utility>

namespace lagroid {

/// Arrows: tuples of arrows, with source, target, product, ... factor by factor; unpack them with
/// `const auto& [g1, g2] = g;`. Algebroid: the direct sum, in the order of the factors. Memory: the factors in order.
template <class... Gs> struct Product : LieGroupoid<Product<Gs...>, (Gs::dimension + ...)> {
  static_assert(sizeof...(Gs) >= 2);
  template <class S> using Arrow = std::tuple<typename Gs::template Arrow<S>...>;
  template <class S> using Object = std::tuple<typename Gs::template Object<S>...>;
  static constexpr int arrow_size = (Gs::arrow_coordinate_count() + ...);
  static constexpr int object_size = (Gs::object_coordinate_count() + ...);
  static constexpr std::size_t factors = sizeof...(Gs);
  static constexpr int rank = (Gs::dimension + ...);

  static constexpr RetractionKind retraction_kind = std::min({retraction_kind_of<Gs>()...});

  [[no_unique_address]] std::tuple<Gs...> factor;

  template <class... As> auto source(const std::tuple<As...>& g) const {
    return map([](const auto& f, const auto& gi) { return f.source(gi); }, g);
  }
  template <class... As> auto target(const std::tuple<As...>& g) const {
    return map([](const auto& f, const auto& gi) { return f.target(gi); }, g);
  }
  template <class... Qs> auto unit(const std::tuple<Qs...>& q) const {
    return map([](const auto& f, const auto& qi) { return f.unit(qi); }, q);
  }
  template <class... As> auto inverse(const std::tuple<As...>& g) const {
    return map([](const auto& f, const auto& gi) { return f.inverse(gi); }, g);
  }
  template <class... As> auto multiply(const std::tuple<As...>& g, const std::tuple<As...>& h) const {
    return map([](const auto& f, const auto& gi, const auto& hi) { return f.multiply(gi, hi); }, g, h);
  }
  template <class S, class... Qs> auto tau(const std::tuple<Qs...>& q, const Vector<S, rank>& v) const {
    return indexed([&]<std::size_t I>() { return std::get<I>(factor).tau(std::get<I>(q), segment<dimensions, I>(v)); });
  }
  template <class... As> auto tau_inverse(const std::tuple<As...>& g) const {
    return concatenate<rank>(map([](const auto& f, const auto& gi) { return f.tau_inverse(gi); }, g));
  }
  template <class... As> auto project(const std::tuple<As...>& g) const {
    return map([](const auto& f, const auto& gi) { return f.project(gi); }, g);
  }
  template <class... As, class V> auto extend(const std::tuple<As...>& g, const V& w) const {
    return indexed(
        [&]<std::size_t I>() { return std::get<I>(factor).extend(std::get<I>(g), segment<dimensions, I>(w)); });
  }
  template <class... As, class V> V correct(std::tuple<As...>& g, const V& w) const {
    return concatenate<rank>(indexed(
        [&]<std::size_t I>() { return std::get<I>(factor).correct(std::get<I>(g), segment<dimensions, I>(w)); }));
  }
  template <class... As, class V>
  V momentum_change(const std::tuple<As...>& g, const V& source_gradient, const V& target_gradient) const {
    return concatenate<rank>(indexed([&]<std::size_t I>() {
      return std::get<I>(factor).momentum_change(std::get<I>(g), segment<dimensions, I>(source_gradient),
                                                 segment<dimensions, I>(target_gradient));
    }));
  }
  template <class... As> auto chart(const std::tuple<As...>& g) const {
    return concatenate<rank>(map([](const auto& f, const auto& gi) { return f.chart(gi); }, g));
  }
  template <class... Qs, class V> auto arrow_in_chart(const std::tuple<Qs...>& q, const V& v) const {
    return indexed(
        [&]<std::size_t I>() { return std::get<I>(factor).arrow_in_chart(std::get<I>(q), segment<dimensions, I>(v)); });
  }

  template <class S, class... Qs>
  requires(HasAnalyticBracket<Gs>&&...) auto bracket(const std::tuple<Qs...>& q, const Vector<S, rank>& x,
                                                     const Vector<S, rank>& y) const {
    return concatenate<rank>(indexed([&]<std::size_t I>() {
      return std::get<I>(factor).bracket(std::get<I>(q), segment<dimensions, I>(x), segment<dimensions, I>(y));
    }));
  }
  template <class... As, class... Qs> auto bisection(const std::tuple<As...>& g, const std::tuple<Qs...>& q) const {
    return map([](const auto& f, const auto& gi, const auto& qi) { return f.bisection(gi, qi); }, g, q);
  }
  /// Those of the factors, in order.
  static constexpr int loops = (loops_of<Gs>() + ...);
  Arrow<double> loop(const Object<double>& q, const Vector<double, rank>& axis,
                     const Vector<double, loops>& turns) const requires(loops > 0) {
    return indexed([&]<std::size_t I>() -> std::tuple_element_t<I, Arrow<double>> {
      const auto& f = std::get<I>(factor);
      if constexpr (loop_counts[I] > 0) {
        return f.loop(std::get<I>(q), segment<dimensions, I>(axis), segment<loop_counts, I>(turns));
      } else {
        return f.unit(std::get<I>(q));
      }
    });
  }

  /// The objects' chart: those of the factors, side by side.
  static constexpr int object_dimension = (object_dimension_of<Gs>() + ...);
  template <class... Qs, class U> auto displace_object(const std::tuple<Qs...>& q, const U& u) const {
    return indexed([&]<std::size_t I>() {
      return std::get<I>(factor).displace_object(std::get<I>(q), segment<object_dimensions, I>(u));
    });
  }
  template <class... Qs> auto object_displacement(const std::tuple<Qs...>& q, const std::tuple<Qs...>& r) const {
    return concatenate<object_dimension>(
        map([](const auto& f, const auto& qi, const auto& ri) { return f.object_displacement(qi, ri); }, q, r));
  }

  template <class... As> auto coordinate_scale(const std::tuple<As...>& g) const {
    return concatenate<rank>(map([](const auto& f, const auto& gi) { return f.coordinate_scale(gi); }, g));
  }

  template <class... As> auto coordinates(const std::tuple<As...>& g) const {
    return concatenate<arrow_size>(map([](const auto& f, const auto& gi) { return f.coordinates_of_arrow(gi); }, g));
  }
  template <class S, class V> Arrow<S> arrow(const V& x) const {
    return indexed(
        [&]<std::size_t I>() { return std::get<I>(factor).template arrow_at<S>(segment<arrow_sizes, I>(x)); });
  }
  template <class... Qs> auto object_coordinates(const std::tuple<Qs...>& q) const {
    return concatenate<object_size>(map([](const auto& f, const auto& qi) { return f.coordinates_of_object(qi); }, q));
  }
  template <class S, class V> Object<S> object(const V& x) const {
    return indexed(
        [&]<std::size_t I>() { return std::get<I>(factor).template object_at<S>(segment<object_sizes, I>(x)); });
  }

  template <class M, End First, End Second, int LeftOffset = 0, int RightOffset = LeftOffset, class... As>
  LAGROID_INLINE Arrow<M> seed(const std::tuple<As...>& g) const {
    return [&]<std::size_t... I>(std::index_sequence<I...>)->Arrow<M> {
      return {
          std::get<I>(factor)
              .template seed<M, First, Second, LeftOffset + start(dimensions, I), RightOffset + start(dimensions, I)>(
                  std::get<I>(g))...};
    }
    (std::make_index_sequence<factors>{});
  }

  /// The arrow frame: those of the factors, side by side, if all have one.
  static constexpr int arrow_dimension = ((arrow_dimension_of<Gs>() > 0) && ...) ? (arrow_dimension_of<Gs>() + ...) : 0;
  template <class J, int Offset = 0, class... As> LAGROID_INLINE Arrow<J> frame_jet(const std::tuple<As...>& g) const {
    return [&]<std::size_t... I>(std::index_sequence<I...>)->Arrow<J> {
      return {std::get<I>(factor).template frame_jet<J, Offset + start(frames, I)>(std::get<I>(g))...};
    }
    (std::make_index_sequence<factors>{});
  }
  template <End Which, class... As, class T, int K>
  Matrix<T, rank, K> frame_to_end(const std::tuple<As...>& g, const Matrix<T, arrow_dimension, K>& rows) const {
    Matrix<T, rank, K> out;
    each([&]<std::size_t I>() {
      Matrix<T, frames[I], K> part;
      for (int k = 0; k < K; ++k)
        for (int i = 0; i < frames[I]; ++i) part(i, k) = rows(start(frames, I) + i, k);
      const Matrix<T, dimensions[I], K> there = std::get<I>(factor).template frame_to_end<Which>(std::get<I>(g), part);
      for (int k = 0; k < K; ++k)
        for (int i = 0; i < dimensions[I]; ++i) out(start(dimensions, I) + i, k) = there(i, k);
    });
    return out;
  }
  template <class T>
  Matrix<T, arrow_dimension, arrow_dimension> frame_bracket(const Vector<T, arrow_dimension>& p) const {
    Matrix<T, arrow_dimension, arrow_dimension> out = Matrix<T, arrow_dimension, arrow_dimension>::Zero();
    each([&]<std::size_t I>() {
      constexpr int at = start(frames, I);
      const Matrix<T, frames[I], frames[I]> block = std::get<I>(factor).frame_bracket(segment<frames, I>(p));
      for (int k = 0; k < frames[I]; ++k)
        for (int i = 0; i < frames[I]; ++i) out(at + i, at + k) = block(i, k);
    });
    return out;
  }

  static std::string name() {
    std::string out;
    ((out += (out.empty() ? "" : " x ") + Gs::name()), ...);
    return out;
  }

 private:
  static constexpr std::array<int, factors> dimensions{Gs::dimension...};
  static constexpr std::array<int, factors> loop_counts{loops_of<Gs>()...};
  static constexpr std::array<int, factors> frames{arrow_dimension_of<Gs>()...};
  static constexpr std::array<int, factors> object_dimensions{object_dimension_of<Gs>()...};
  static constexpr std::array<int, factors> arrow_sizes{Gs::arrow_coordinate_count()...};
  static constexpr std::array<int, factors> object_sizes{Gs::object_coordinate_count()...};

  static constexpr int start(const std::array<int, factors>& sizes, std::size_t index) {
    int sum = 0;
    for (std::size_t i = 0; i < index; ++i) sum += sizes[i];
    return sum;
  }
  template <const std::array<int, factors>& Sizes, std::size_t I, class V> static auto segment(const V& x) {
    Vector<typename V::Scalar, Sizes[I]> out;
    unrolled<Sizes[I]>([&]<int J>() { out(J) = x(start(Sizes, I) + J); });
    return out;
  }

  template <class F> static auto indexed(const F& f) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) { return std::make_tuple(f.template operator()<I>()...); }
    (std::make_index_sequence<factors>{});
  }
  template <class F> static void each(const F& f) {
    [&]<std::size_t... I>(std::index_sequence<I...>) { (f.template operator()<I>(), ...); }
    (std::make_index_sequence<factors>{});
  }
  template <class F, class... Tuples> auto map(const F& f, const Tuples&... tuples) const {
    return indexed([&]<std::size_t I>() { return f(std::get<I>(factor), std::get<I>(tuples)...); });
  }
  template <int Size, class Tuple> static auto concatenate(const Tuple& parts) {
    using S = typename std::tuple_element_t<0, Tuple>::Scalar;
    Vector<S, Size> out;
    const auto put = [&]<int At, int I>(const auto& self) {
      const auto& part = std::get<I>(parts);
      constexpr int length = std::decay_t<decltype(part)>::SizeAtCompileTime;
      unrolled<length>([&]<int J>() { out(At + J) = part(J); });
      if constexpr (I + 1 < int(factors)) self.template operator()<At + length, I + 1>(self);
    };
    put.template operator()<0, 0>(put);
    return out;
  }
};

}  // namespace lagroid
