#pragma once
/// The derivatives of a stage of a ControlledFlow, by the chain rule: with v = tau^{-1}(g) and q the object half way,
///
///     l + <lambda, phi> = <lambda, v> + h F(q, u),    F = running cost - <lambda, flow>,
///     D^2 = D^2 (<lambda, v> + h <dF/dq, q>) + h (Dq, Du)^T D^2F (Dq, Du),    h -> h exp(t),
///
/// F over jets of objects and controls alone, v and q factor by factor (displaced_factor.hpp): one function of all
/// displacements, controls and the duration would take jets of as many directions.
///
///     FlowDerivatives<SatelliteTurn>::evaluate(flow, g, u, h, lambda, {gradient, equality, hessian});
///
/// Nothing throws.

#include <lagroid/solvers/control/control_system.hpp>
#include <lagroid/systems/control/displaced_factor.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>

namespace lagroid {

namespace detail {

/// A groupoid as a product of factors, be it of one.
template <class G> struct FactorsOf {
  static constexpr std::size_t count = 1;
  template <std::size_t> using Factor = G;
  template <std::size_t> static const G& factor(const G& groupoid) { return groupoid; }
  template <std::size_t> static const auto& arrow(const ArrowOf<G>& g) { return g; }
  template <class Q> static const Q& object(const std::tuple<Q>& q) { return std::get<0>(q); }
};
template <class... Gs> struct FactorsOf<Product<Gs...>> {
  static constexpr std::size_t count = sizeof...(Gs);
  template <std::size_t I> using Factor = std::tuple_element_t<I, std::tuple<Gs...>>;
  template <std::size_t I> static const auto& factor(const Product<Gs...>& groupoid) {
    return std::get<I>(groupoid.factor);
  }
  template <std::size_t I> static const auto& arrow(const ArrowOf<Product<Gs...>>& g) { return std::get<I>(g); }
  template <class... Qs> static const std::tuple<Qs...>& object(const std::tuple<Qs...>& q) { return q; }
};

}  // namespace detail

template <class Flow> class FlowDerivatives {
 public:
  using G = typename Flow::GroupoidType;
  static constexpr int controls = Flow::controls;

  static void evaluate(const Flow& flow, const ArrowOf<G>& g, const Vector<double, controls>& u, double h,
                       const double* lambda, const StagePlaces& out) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      evaluate_factors<I...>(
          flow, {Displaced<I>(Factors::template factor<I>(flow.groupoid), Factors::template arrow<I>(g))...}, u, h,
          lambda, out);
    }
    (std::make_index_sequence<Factors::count>());
  }

 private:
  using Factors = detail::FactorsOf<G>;
  template <std::size_t I> using Factor = typename Factors::template Factor<I>;
  template <std::size_t I> using Displaced = DisplacedFactor<Factor<I>, Flow::reads(I)>;

  // Where the displacement of a factor begins in that of a node, and its object's coordinates among all that are read.
  template <std::size_t I> static constexpr int begin_of() {
    if constexpr (I == 0) {
      return 0;
    } else {
      return begin_of<I - 1>() + Displaced<I - 1>::n;
    }
  }
  template <std::size_t I> static constexpr int object_begin_of() {
    if constexpr (I == 0) {
      return 0;
    } else {
      return object_begin_of<I - 1>() + Displaced<I - 1>::objects;
    }
  }
  static constexpr int n = G::dimension;
  static constexpr int objects = object_begin_of<Factors::count>();
  static constexpr int at_control = 2 * n;
  static constexpr int at_duration = 2 * n + controls;
  static constexpr int d = at_duration + 1;
  using J = SecondJet<double, objects + controls>;

  /// The place of component i of a factor's displaced ends among the stage's variables.
  template <std::size_t I> static constexpr int place(int i) {
    constexpr int of_factor = Displaced<I>::n;
    return i < of_factor ? begin_of<I>() + i : n + begin_of<I>() + i - of_factor;
  }
  template <std::size_t I> static auto object(const Flow& flow, const Displaced<I>& factor) {
    if constexpr (!Flow::reads(I)) {
      return Unread{};
    } else {
      const auto at = factor.q();
      Vector<J, Displaced<I>::objects> q;
      for (int i = 0; i < q.size(); ++i) q(i) = J::variable(at(i), object_begin_of<I>() + i);
      return Factors::template factor<I>(flow.groupoid).template object_at<J>(q);
    }
  }

  template <std::size_t... I>
  static void evaluate_factors(const Flow& flow, const std::tuple<Displaced<I>...>& factors,
                               const Vector<double, controls>& at, double h, const double* lambda,
                               const StagePlaces& out) {
    Vector<J, controls> u;
    for (int i = 0; i < controls; ++i) u(i) = J::variable(at(i), objects + i);
    const auto objects_half_way = std::tuple{object<I>(flow, std::get<I>(factors))...};
    const auto& q = Factors::object(objects_half_way);
    const J cost = flow.cost_rate(q, u) * h;
    const Vector<J, n> velocity = flow.flow(q, u);
    J sum = cost;  // h F
    for (int i = 0; i < n; ++i) sum += velocity(i) * (-h * lambda[i]);

    std::fill(out.hessian, out.hessian + d * d, 0.0);
    const auto place_row = [&](const J& of, double factor, double* row) {
      std::fill(row, row + 2 * n, 0.0);
      (pull_row<I>(std::get<I>(factors), of, factor, row), ...);
      for (int i = 0; i < controls; ++i) row[at_control + i] = factor * of.gradient(objects + i);
      row[at_duration] = factor * of.value;
    };
    place_row(cost, 1, out.gradient);
    for (int i = 0; i < n; ++i) place_row(velocity(i), -h, out.equality + i * d);
    (add_displacement<I>(std::get<I>(factors), out.equality), ...);

    double* square = out.hessian;
    place_row(sum, 1, square + at_duration * d);
    for (int i = 0; i < at_duration; ++i) square[i * d + at_duration] = square[at_duration * d + i];
    for (int i = 0; i < controls; ++i)
      for (int j = 0; j < controls; ++j)
        square[(at_control + i) * d + at_control + j] = sum.hessian(objects + i, objects + j);
    (add_curvature<I>(std::get<I>(factors), sum, lambda, square), ...);
    const auto pull = [&]<std::size_t First>(std::integral_constant<std::size_t, First>) {
      (pull_square<First, I>(std::get<First>(factors), std::get<I>(factors), sum, square), ...);
    };
    (pull(std::integral_constant<std::size_t, I>()), ...);
  }

  /// row += factor (of's derivatives by the object) Dq.
  template <std::size_t I>
  static void pull_row(const Displaced<I>& displaced, const J& of, double factor, double* row) {
    if constexpr (Displaced<I>::objects > 0) {
      const auto dq = displaced.dq();
      for (int j = 0; j < dq.cols(); ++j) {
        double sum = 0;
        for (int i = 0; i < dq.rows(); ++i) sum += of.gradient(object_begin_of<I>() + i) * dq(i, j);
        row[place<I>(j)] = factor * sum;
      }
    }
  }
  template <std::size_t I> static void add_displacement(const Displaced<I>& displaced, double* equality) {
    const auto dv = displaced.dv();
    for (int i = 0; i < dv.rows(); ++i)
      for (int j = 0; j < dv.cols(); ++j) equality[(begin_of<I>() + i) * d + place<I>(j)] += dv(i, j);
  }
  template <std::size_t I>
  static void add_curvature(const Displaced<I>& displaced, const J& of, const double* lambda, double* square) {
    if constexpr (!Displaced<I>::is_flat) {
      std::array<double, std::size_t(Displaced<I>::objects) + 1> by_object;
      for (int i = 0; i < Displaced<I>::objects; ++i) by_object[std::size_t(i)] = of.gradient(object_begin_of<I>() + i);
      const auto hessian = displaced.curvature(lambda + begin_of<I>(), by_object.data());
      for (int i = 0; i < hessian.rows(); ++i)
        for (int j = 0; j < hessian.cols(); ++j) square[place<I>(i) * d + place<I>(j)] += hessian(i, j);
    }
  }
  /// Dq^T (of's second derivatives by both objects) Dq, and beside it those by object and controls.
  template <std::size_t First, std::size_t Second>
  static void pull_square(const Displaced<First>& first, const Displaced<Second>& second, const J& of, double* square) {
    if constexpr (Displaced<First>::objects > 0 && Displaced<Second>::objects > 0) {
      const auto left = first.dq();
      const auto right = second.dq();
      Matrix<double, Displaced<First>::objects, 2 * Displaced<Second>::n> half;
      for (int i = 0; i < half.rows(); ++i)
        for (int j = 0; j < half.cols(); ++j) {
          half(i, j) = 0;
          for (int k = 0; k < right.rows(); ++k)
            half(i, j) += of.hessian(object_begin_of<First>() + i, object_begin_of<Second>() + k) * right(k, j);
        }
      for (int i = 0; i < left.cols(); ++i)
        for (int j = 0; j < half.cols(); ++j) {
          double sum = 0;
          for (int k = 0; k < half.rows(); ++k) sum += left(k, i) * half(k, j);
          square[place<First>(i) * d + place<Second>(j)] += sum;
        }
      if constexpr (First == Second)
        for (int i = 0; i < left.cols(); ++i)
          for (int j = 0; j < controls; ++j) {
            double sum = 0;
            for (int k = 0; k < left.rows(); ++k)
              sum += left(k, i) * of.hessian(object_begin_of<First>() + k, objects + j);
            square[place<First>(i) * d + at_control + j] = square[(at_control + j) * d + place<First>(i)] = sum;
          }
    }
  }
};

}  // namespace lagroid
