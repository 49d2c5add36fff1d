#pragma once
/// States of controlled systems as their users write them, one number after another, and the arrows between them: a
/// point of R^n for Pair<n>, (x, y, angle) for SE(2), a rotation vector for SO(3), one after another for products.
///
///     const auto g = FlowStates<Pair<2>>::arrow(Vector<double, 2>(0, 0), Vector<double, 2>(1, 0));
///     const auto end = FlowStates<Pair<2>>::reached(Vector<double, 2>(0, 0), g);
///
/// Returns the arrow from one state to another, the state that an arrow leads to, and how far that is off another,
/// number by number: of an angle the part less than half a turn, of an attitude the rotation vector from the other.
/// Both serve scalars with derivatives. Nothing throws.

#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/groupoids/rotated.hpp>

#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace lagroid {

template <class G> struct FlowStates;

template <int N> struct FlowStates<Pair<N>> {
  static constexpr int size = N;
  using State = Vector<double, N>;
  static PairArrow<double, N> arrow(const State& from, const State& to) { return {from, to}; }
  template <class S> static Vector<S, N> reached(const State&, const PairArrow<S, N>& g) { return g.target; }
  template <class S> static Vector<S, N> offset(const State&, const PairArrow<S, N>& g, const State& to) {
    return g.target - to.template cast<S>();
  }
  /// Whether number i is one of a rotation vector.
  static constexpr bool is_attitude(int) { return false; }
};

template <> struct FlowStates<SE2> {
  static constexpr int size = 3;
  using State = Vector<double, 3>;
  /// [R(angle) (x, y); 0 1].
  static Matrix<double, 3, 3> pose(const State& q) {
    Matrix<double, 3, 3> g;
    g << std::cos(q(2)), -std::sin(q(2)), q(0), std::sin(q(2)), std::cos(q(2)), q(1), 0, 0, 1;
    return g;
  }
  static Matrix<double, 3, 3> arrow(const State& from, const State& to) {
    return SE2::multiply(SE2::inverse(pose(from)), pose(to));
  }
  template <class S> static Vector<S, 3> reached(const State& from, const Matrix<S, 3, 3>& g) {
    using std::atan2;
    const Matrix<S, 3, 3> q = SE2::multiply(Matrix<S, 3, 3>(pose(from).template cast<S>()), g);
    return {q(0, 2), q(1, 2), atan2(q(1, 0), q(0, 0))};
  }
  template <class S> static Vector<S, 3> offset(const State& from, const Matrix<S, 3, 3>& g, const State& to) {
    Vector<S, 3> off = reached(from, g) - to.template cast<S>();
    const double turn = 2 * std::numbers::pi;
    off(2) = off(2) - turn * std::round(value_of(off(2)) / turn);
    return off;
  }
  static constexpr bool is_attitude(int) { return false; }
};

/// The attitude exp(rotation vector).
template <> struct FlowStates<SO3> {
  static constexpr int size = 3;
  using State = Vector<double, 3>;
  static Matrix<double, 3, 3> arrow(const State& from, const State& to) {
    return SO3::multiply(SO3::inverse(SO3::exp(from)), SO3::exp(to));
  }
  template <class S> static Vector<S, 3> reached(const State& from, const Matrix<S, 3, 3>& g) {
    return SO3::log(SO3::multiply(SO3::exp(from).template cast<S>().eval(), g));
  }
  template <class S> static Vector<S, 3> offset(const State& from, const Matrix<S, 3, 3>& g, const State& to) {
    const Matrix<double, 3, 3> between = SO3::multiply(SO3::inverse(SO3::exp(to)), SO3::exp(from));
    return SO3::log(SO3::multiply(between.template cast<S>().eval(), g));
  }
  static constexpr bool is_attitude(int) { return true; }
};

template <class... Gs> struct FlowStates<Product<Gs...>> {
  static constexpr int size = (FlowStates<Gs>::size + ...);
  using State = Vector<double, size>;
  using Arrow = ArrowOf<Product<Gs...>>;
  static Arrow arrow(const State& from, const State& to) {
    return of_factors([&]<class G, std::size_t I, int At>() {
      constexpr int n = FlowStates<G>::size;
      return FlowStates<G>::arrow(from.template segment<n>(At), to.template segment<n>(At));
    });
  }
  template <class... As> static auto reached(const State& from, const std::tuple<As...>& g) {
    return joined(of_factors([&]<class G, std::size_t I, int At>() {
      constexpr int n = FlowStates<G>::size;
      return FlowStates<G>::reached(from.template segment<n>(At), std::get<I>(g));
    }));
  }
  template <class... As> static auto offset(const State& from, const std::tuple<As...>& g, const State& to) {
    return joined(of_factors([&]<class G, std::size_t I, int At>() {
      constexpr int n = FlowStates<G>::size;
      return FlowStates<G>::offset(from.template segment<n>(At), std::get<I>(g), to.template segment<n>(At));
    }));
  }
  static constexpr bool is_attitude(int i) {
    int begin = 0;
    bool out = false;
    ((out = out || (i >= begin && i < begin + FlowStates<Gs>::size && FlowStates<Gs>::is_attitude(i - begin)),
      begin += FlowStates<Gs>::size),
     ...);
    return out;
  }

 private:
  template <class First, class... Rest> static auto joined(const std::tuple<First, Rest...>& parts) {
    Vector<typename First::Scalar, size> out;
    int at = 0;
    const auto place = [&](const auto& part) {
      for (int i = 0; i < part.size(); ++i) out(at++) = part(i);
    };
    std::apply([&](const auto&... part) { (place(part), ...); }, parts);
    return out;
  }
  /// Where the numbers of factor I begin.
  static constexpr int begin_of(std::size_t i) {
    const int sizes[] = {FlowStates<Gs>::size...};
    int at = 0;
    for (std::size_t k = 0; k < i; ++k) at += sizes[k];
    return at;
  }
  template <class Each> static auto of_factors(const Each& each) {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      return std::tuple{each.template operator()<Gs, I, begin_of(I)>()...};
    }
    (std::index_sequence_for<Gs...>());
  }
};

/// The attitude exp(rotation vector), of a body that sees directions fixed in space.
template <int N> struct FlowStates<Product<Action<SO3, RotatedDirections>, Pair<N>>> {
  static constexpr int size = 3 + N;
  using State = Vector<double, size>;
  using Arrow = ArrowOf<Product<Action<SO3, RotatedDirections>, Pair<N>>>;
  /// `direction` is fixed in space.
  static Arrow arrow(const State& from, const State& to, const Vector<double, 3>& direction) {
    const Matrix<double, 3, 3> start = SO3::exp(Vector<double, 3>(from.template head<3>()));
    const Matrix<double, 3, 3> end = SO3::exp(Vector<double, 3>(to.template head<3>()));
    return {{SO3::multiply(SO3::inverse(start), end), start.transpose() * direction},
            {from.template tail<N>(), to.template tail<N>()}};
  }
  template <class A, class P> static auto reached(const State& from, const std::tuple<A, P>& g) {
    return Body::reached(from, std::tuple(std::get<0>(g).element, std::get<1>(g)));
  }
  template <class A, class P> static auto offset(const State& from, const std::tuple<A, P>& g, const State& to) {
    return Body::offset(from, std::tuple(std::get<0>(g).element, std::get<1>(g)), to);
  }
  static constexpr bool is_attitude(int i) { return Body::is_attitude(i); }

 private:
  using Body = FlowStates<Product<SO3, Pair<N>>>;
};

}  // namespace lagroid
