#pragma once
/// What the midpoint rule takes from one factor of an arrow g, with exact derivatives along displacements (a, b) of
/// both ends: v = tau^{-1}(g), and, where it is read, the object q half way, beta(tau(alpha(g), v / 2)).
///
///     const DisplacedFactor<SO3, /*is_read*/ false> turn(SO3(), g);
///     const Vector<double, 3> v = turn.v();
///     const Matrix<double, 3, 6> dv = turn.dv();                  // by (a, b)
///     const Matrix<double, 6, 6> second = turn.curvature(of_v, {});  // of <of_v, v>
///
/// Along few directions: those of the factor alone, of its arrow's frame where v is all that is asked for, and none
/// where v and q are linear. Nothing throws.

#include <lagroid/core/derivatives/arrow_frame.hpp>
#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/groupoids/action.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/control/displaced_jet.hpp>
#include <lagroid/systems/control/flow_midpoint.hpp>

namespace lagroid {

/// In general: over jets along both ends.
template <class G, bool IsRead> class DisplacedFactor {
 public:
  static constexpr int n = G::dimension;
  static constexpr int objects = IsRead ? G::object_coordinate_count() : 0;
  static constexpr bool is_flat = false;

  DisplacedFactor(const G& groupoid, const ArrowOf<G>& g) {
    const auto moved = displaced_jet<J>(groupoid, g, 0, n);
    v_ = groupoid.tau_inverse(moved);
    if constexpr (objects > 0) {
      Vector<J, n> half;
      for (int i = 0; i < n; ++i) half(i) = v_(i) * 0.5;
      q_ = groupoid.coordinates_of_object(detail::moved_object(groupoid, groupoid.source(moved), half));
    }
  }
  Vector<double, n> v() const { return values(v_); }
  Vector<double, objects> q() const { return values(q_); }
  Matrix<double, n, 2 * n> dv() const { return gradients(v_); }
  Matrix<double, objects, 2 * n> dq() const { return gradients(q_); }
  /// The Hessian of <of_v, v> + <of_q, q>.
  Matrix<double, 2 * n, 2 * n> curvature(const double* of_v, const double* of_q) const {
    J sum = v_(0) * of_v[0];
    for (int i = 1; i < n; ++i) sum += v_(i) * of_v[i];
    for (int i = 0; i < objects; ++i) sum += q_(i) * of_q[i];
    return sum.hessian();
  }

 private:
  using J = SecondJet<double, 2 * n>;
  template <int Count> static Vector<double, Count> values(const Vector<J, Count>& of) {
    Vector<double, Count> out;
    for (int i = 0; i < Count; ++i) out(i) = of(i).value;
    return out;
  }
  template <int Count> static Matrix<double, Count, 2 * n> gradients(const Vector<J, Count>& of) {
    Matrix<double, Count, 2 * n> out;
    for (int i = 0; i < Count; ++i)
      for (int j = 0; j < 2 * n; ++j) out(i, j) = of(i).gradient(j);
    return out;
  }

  Vector<J, n> v_;
  Vector<J, objects> q_;
};

/// Where there is a frame and no object to be read: along the frame, pushed to both ends (arrow_frame.hpp).
template <class G, bool IsRead>
requires(HasArrowFrame<G> && (!IsRead || G::object_coordinate_count() == 0)) class DisplacedFactor<G, IsRead> {
 public:
  static constexpr int n = G::dimension;
  static constexpr int objects = 0;
  static constexpr bool is_flat = false;

  DisplacedFactor(const G& groupoid, const ArrowOf<G>& g)
      : groupoid_(groupoid), g_(g), v_(groupoid.tau_inverse(groupoid.template frame_jet<J>(g))) {}
  Vector<double, n> v() const {
    Vector<double, n> out;
    for (int i = 0; i < n; ++i) out(i) = v_(i).value;
    return out;
  }
  Vector<double, 0> q() const { return {}; }
  Matrix<double, n, 2 * n> dv() const {
    Matrix<double, f, n> along;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < f; ++j) along(j, i) = v_(i).gradient(j);
    const Matrix<double, n, n> source = groupoid_.template frame_to_end<End::source>(g_, along);
    const Matrix<double, n, n> target = groupoid_.template frame_to_end<End::target>(g_, along);
    Matrix<double, n, 2 * n> out;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        out(i, j) = source(j, i);
        out(i, n + j) = target(j, i);
      }
    return out;
  }
  Matrix<double, 0, 2 * n> dq() const { return {}; }
  Matrix<double, 2 * n, 2 * n> curvature(const double* of_v, const double*) const {
    J sum = v_(0) * of_v[0];
    for (int i = 1; i < n; ++i) sum += v_(i) * of_v[i];
    Matrix<double, 2 * n, 2 * n> out;
    const auto place = [&]<End First, End Second>(const Matrix<double, f, f>& form) {
      const Matrix<double, n, f> rows = groupoid_.template frame_to_end<First>(g_, form);
      const Matrix<double, f, n> columns = rows.transpose();
      const Matrix<double, n, n> transposed = groupoid_.template frame_to_end<Second>(g_, columns);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const int row = (First == End::source ? 0 : n) + i;
          const int column = (Second == End::source ? 0 : n) + j;
          out(row, column) = out(column, row) = transposed(j, i);
        }
    };
    const Matrix<double, f, f> hessian = sum.hessian();
    place.template operator()<End::source, End::source>(hessian);
    place.template operator()<End::target, End::target>(hessian);
    place.template operator()<End::source, End::target>(hessian + 0.5 * groupoid_.frame_bracket(sum.gradient()));
    return out;
  }

 private:
  static constexpr int f = arrow_dimension_of<G>();
  using J = SecondJet<double, f>;
  const G& groupoid_;
  const ArrowOf<G>& g_;
  Vector<J, n> v_;
};

/// An action's retraction is the group's.
template <class Group, class Space>
class DisplacedFactor<Action<Group, Space>, false> : public DisplacedFactor<Group, false> {
 public:
  DisplacedFactor(const Action<Group, Space>& groupoid, const ArrowOf<Action<Group, Space>>& g)
      : DisplacedFactor<Group, false>(groupoid.group, g.element) {}
};

/// Of points of R^n: v = target - source, q their mean.
template <int N, bool IsRead> class DisplacedFactor<Pair<N>, IsRead> {
 public:
  static constexpr int n = N;
  static constexpr int objects = IsRead ? N : 0;
  static constexpr bool is_flat = true;

  DisplacedFactor(const Pair<N>&, const PairArrow<double, N>& g) : g_(g) {}
  Vector<double, N> v() const { return g_.target - g_.source; }
  Vector<double, objects> q() const {
    Vector<double, objects> out;
    for (int i = 0; i < objects; ++i) out(i) = g_.source(i) + 0.5 * (g_.target(i) - g_.source(i));
    return out;
  }
  Matrix<double, N, 2 * N> dv() const { return along_ends<N>(-1, 1); }
  Matrix<double, objects, 2 * N> dq() const { return along_ends<objects>(0.5, 0.5); }

 private:
  template <int Rows> static Matrix<double, Rows, 2 * N> along_ends(double source, double target) {
    Matrix<double, Rows, 2 * N> out = Matrix<double, Rows, 2 * N>::Zero();
    for (int i = 0; i < Rows; ++i) {
      out(i, i) = source;
      out(i, N + i) = target;
    }
    return out;
  }
  const PairArrow<double, N>& g_;
};

}  // namespace lagroid
