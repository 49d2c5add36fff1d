#pragma once
/// Displacements of a node, over any scalar: by what nodes near a given one differ from it, in the numbers that
/// derivatives of steps are taken by.
///
///     const GroupoidChart<Kepler> here(kepler, point);
///     const auto near = here.displaced(x);           // x = (v, mu - mu_0): at g tau(v), with the momentum mu
///     const auto again = here.displacement(near);    // x
///
/// Where steps keep the groupoid, v is along it (GroupoidChart); where they drift off it, the numbers y beside (v, mu)
/// are across it (CoordinateChart). Requires small displacements; those of CoordinateChart are linear. Nothing throws.

#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/quantity.hpp>

namespace lagroid {

/// A state with the configuration that led there.
template <class G, class S> struct NodeOver {
  ObjectOf<G, S> object;
  AlgebroidVector<G, S> momentum;
  ArrowOf<G, S> configuration;
};

template <DiscreteSystem Sys> class GroupoidChart {
 public:
  using G = typename Sys::GroupoidType;
  static constexpr int n = G::dimension;
  static constexpr int states = 2 * n;

  /// Refers to both.
  GroupoidChart(const Sys& system, const TrajectoryPoint<Sys>& point) : groupoid_(system.groupoid), point_(point) {}

  template <class S> NodeOver<G, S> displaced(const Vector<S, states>& x) const {
    const Vector<S, n> v = x.template head<n>();
    const auto moved = groupoid_.tau(groupoid_.template cast_object<S>(point_.state.object), v);
    return {groupoid_.target(moved), point_.state.momentum.template cast<S>() + x.template tail<n>(),
            groupoid_.compose(groupoid_.template cast<S>(point_.configuration), moved)};
  }
  template <class S> Vector<S, states> displacement(const NodeOver<G, S>& node) const {
    const auto back = groupoid_.template cast<S>(groupoid_.inverse(point_.configuration));
    Vector<S, states> x;
    x << groupoid_.tau_inverse(groupoid_.compose(back, node.configuration)),
        node.momentum - point_.state.momentum.template cast<S>();
    return x;
  }

 private:
  const G& groupoid_;
  const TrajectoryPoint<Sys>& point_;
};

/// By the coordinates of the configuration, of which v is along g tau(v) and y across, in an orthonormal basis.
template <DiscreteSystem Sys> class CoordinateChart {
 public:
  using G = typename Sys::GroupoidType;
  static constexpr int n = G::dimension;
  static constexpr int coordinates = G::arrow_coordinate_count();
  static constexpr int states = coordinates + n;

  /// Refers to both.
  CoordinateChart(const Sys& system, const TrajectoryPoint<Sys>& point) : groupoid_(system.groupoid), point_(point) {
    Matrix<double, coordinates, n> along;
    for (int i = 0; i < n; ++i)
      along.col(i) = groupoid_.left_invariant(point.configuration, Vector<double, n>(Vector<double, n>::Unit(i)));
    frame_.template leftCols<n>() = along;
    frame_.template rightCols<coordinates - n>() = orthogonal_factor(along).template rightCols<coordinates - n>();
    inverse_ = inverse_of(frame_);
  }

  template <class S> NodeOver<G, S> displaced(const Vector<S, states>& x) const {
    Vector<S, coordinates> at = groupoid_.coordinates_of_arrow(point_.configuration).template cast<S>();
    for (int j = 0; j < coordinates; ++j) at += frame_.col(j).template cast<S>() * x(j < n ? j : n + j);
    const ArrowOf<G, S> configuration = groupoid_.template arrow_at<S>(at);
    return {groupoid_.target(configuration), point_.state.momentum.template cast<S>() + x.template segment<n>(n),
            configuration};
  }
  template <class S> Vector<S, states> displacement(const NodeOver<G, S>& node) const {
    const Vector<S, coordinates> by = groupoid_.coordinates_of_arrow(node.configuration) -
                                      groupoid_.coordinates_of_arrow(point_.configuration).template cast<S>();
    Vector<S, states> x = Vector<S, states>::Constant(S(0.0));
    x.template segment<n>(n) = node.momentum - point_.state.momentum.template cast<S>();
    for (int i = 0; i < coordinates; ++i)
      for (int j = 0; j < coordinates; ++j) x(i < n ? i : n + i) += by(j) * inverse_(i, j);
    return x;
  }

 private:
  const G& groupoid_;
  const TrajectoryPoint<Sys>& point_;
  Matrix<double, coordinates, coordinates> frame_, inverse_;
};

}  // namespace lagroid
