#pragma once
/// The pair groupoid M x M => M of a space of points with a chart, such as the sphere.
///
///     (m0, m1)(m1, m2) = (m0, m2),    tau_m(u) = (m, displace(m, u)),    A = TM
///
/// What Pair<n> is for R^n: systems on a sphere in as many variables as it has dimensions, without a constraint, and
/// the base of a gauge groupoid over it (connections.hpp).
///
///     struct Pendulum : System<Pendulum, PairOfPoints<RotatedDirections>> { ... };
///
/// Required: Space has a chart (see Action): `dimension`, `displace(m, u)`, `displacement(m, r)`, `project(m)`. Its
/// basis at m may jump from one m to the next, since momenta are written at each m in the basis there.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/groupoids/pair.hpp>

#include <string>

namespace lagroid {

/// Memory: source, then target.
template <class Space> struct PairOfPoints : LieGroupoid<PairOfPoints<Space>, Space::dimension> {
  static constexpr int rank = Space::dimension;
  static constexpr int object_dimension = rank;
  static constexpr int size = Space::template Point<double>::SizeAtCompileTime;
  static constexpr int arrow_size = 2 * size;
  template <class S> using Object = typename Space::template Point<S>;
  template <class S> using Arrow = PairArrow<S, size>;

  template <class S> static Object<S> source(const PairArrow<S, size>& g) { return g.source; }
  template <class S> static Object<S> target(const PairArrow<S, size>& g) { return g.target; }
  template <class S> static Arrow<S> unit(const Vector<S, size>& m) { return {m, m}; }
  template <class S> static Arrow<S> inverse(const PairArrow<S, size>& g) { return {g.target, g.source}; }
  template <class S> static Arrow<S> multiply(const PairArrow<S, size>& g, const PairArrow<S, size>& h) {
    return {g.source, h.target};
  }
  template <class S> static Arrow<S> tau(const Vector<S, size>& m, const Vector<S, rank>& u) {
    return {m, Space::displace(m, u)};
  }
  template <class S> static Vector<S, rank> tau_inverse(const PairArrow<S, size>& g) {
    return Space::displacement(g.source, g.target);
  }
  template <class S> static Object<S> displace_object(const Vector<S, size>& m, const Vector<S, rank>& u) {
    return Space::displace(m, u);
  }
  template <class S> static Vector<S, rank> object_displacement(const Vector<S, size>& m, const Vector<S, size>& r) {
    return Space::displacement(m, r);
  }
  static Arrow<double> project(const PairArrow<double, size>& g) {
    return {Space::project(g.source), Space::project(g.target)};
  }

  template <class S> static Vector<S, arrow_size> coordinates(const PairArrow<S, size>& g) {
    return joined(g.source, g.target);
  }
  template <class S, class V> static Arrow<S> arrow(const V& x) {
    const Vector<S, arrow_size> numbers = x;
    return {part<0, size>(numbers), part<size, size>(numbers)};
  }

  static std::string name() { return "Pair(" + Space::name() + ")"; }
};

}  // namespace lagroid
