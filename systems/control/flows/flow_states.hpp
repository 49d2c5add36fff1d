#pragma once
/// States of controlled systems as their users write them, one number after another, and the arrows between them: a
/// point of R^n for Pair<n>, (x, y, angle, velocities) for SE(2) x Pair<n>, (rotation vector, velocities) for
/// SO(3) x Pair<n>.
///
///     const auto g = FlowStates<Pair<2>>::arrow(Vector<double, 2>(0, 0), Vector<double, 2>(1, 0));
///     const auto end = FlowStates<Pair<2>>::reached(Vector<double, 2>(0, 0), g);
///
/// Returns the arrow from one state to another, and the state that an arrow leads to. Nothing throws.

#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/groupoids/rotated.hpp>

#include <cmath>

namespace lagroid {

template <class G> struct FlowStates;

template <int N> struct FlowStates<Pair<N>> {
  static constexpr int size = N;
  using State = Vector<double, N>;
  static PairArrow<double, N> arrow(const State& from, const State& to) { return {from, to}; }
  static State reached(const State&, const PairArrow<double, N>& g) { return g.target; }
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
  static State reached(const State& from, const Matrix<double, 3, 3>& g) {
    const Matrix<double, 3, 3> q = SE2::multiply(pose(from), g);
    return {q(0, 2), q(1, 2), std::atan2(q(1, 0), q(0, 0))};
  }
};

template <int N> struct FlowStates<Product<SE2, Pair<N>>> {
  static constexpr int size = 3 + N;
  using State = Vector<double, size>;
  using Arrow = ArrowOf<Product<SE2, Pair<N>>>;
  static Arrow arrow(const State& from, const State& to) {
    return {FlowStates<SE2>::arrow(from.template head<3>(), to.template head<3>()),
            {from.template tail<N>(), to.template tail<N>()}};
  }
  static State reached(const State& from, const Arrow& g) {
    State out;
    out << FlowStates<SE2>::reached(from.template head<3>(), std::get<0>(g)), std::get<1>(g).target;
    return out;
  }
};

template <int N, int M> struct FlowStates<Product<Pair<N>, Pair<M>>> {
  static constexpr int size = N + M;
  using State = Vector<double, size>;
  using Arrow = ArrowOf<Product<Pair<N>, Pair<M>>>;
  static Arrow arrow(const State& from, const State& to) {
    return {{from.template head<N>(), to.template head<N>()}, {from.template tail<M>(), to.template tail<M>()}};
  }
  static State reached(const State&, const Arrow& g) {
    State out;
    out << std::get<0>(g).target, std::get<1>(g).target;
    return out;
  }
};

/// The attitude exp(rotation vector).
template <int N> struct FlowStates<Product<SO3, Pair<N>>> {
  static constexpr int size = 3 + N;
  using State = Vector<double, size>;
  using Arrow = ArrowOf<Product<SO3, Pair<N>>>;
  static Arrow arrow(const State& from, const State& to) {
    const Matrix<double, 3, 3> start = SO3::exp(Vector<double, 3>(from.template head<3>()));
    const Matrix<double, 3, 3> end = SO3::exp(Vector<double, 3>(to.template head<3>()));
    return {start.transpose() * end, {from.template tail<N>(), to.template tail<N>()}};
  }
  static State reached(const State& from, const Arrow& g) {
    const Matrix<double, 3, 3> start = SO3::exp(Vector<double, 3>(from.template head<3>()));
    State out;
    out << SO3::log(Matrix<double, 3, 3>(start * std::get<0>(g))), std::get<1>(g).target;
    return out;
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
    return {{start.transpose() * end, start.transpose() * direction}, {from.template tail<N>(), to.template tail<N>()}};
  }
  static State reached(const State& from, const Arrow& g) {
    const Matrix<double, 3, 3> start = SO3::exp(Vector<double, 3>(from.template head<3>()));
    State out;
    out << SO3::log(Matrix<double, 3, 3>(start * std::get<0>(g).element)), std::get<1>(g).target;
    return out;
  }
};

}  // namespace lagroid
