#pragma once
/// A gauge (Atiyah) groupoid (Q x Q)/G, split by a discrete connection: pairs of points of the shape space, each with
/// an element of the adjoint bundle over the first.
///
///     g = gamma hor(b)  <->  (b, gamma),    b in S x S,  gamma in G (in the isotropy group of the source of b)
///     (b, gamma)(b', gamma') = (b b', gamma (hor(b) gamma' hor(b)^{-1}) hor(b) hor(b') hor(b b')^{-1})
///
/// The product carries gamma' back along b and adds the holonomy of the triangle: that is the curvature. Where the
/// group is not Abelian a connection is a Morphism to the groupoid of the base which supplies
///
///     using Group = SO3                                     the structure group G
///     auto element(const Arrow& g) const                    gamma; element(k g) = k element(g) along the fibre
///     auto attach(const Arrow'& b, const E& gamma) const    gamma hor(b); units of the base have horizontal units
///
/// and the Abelian ones of connections.hpp are taken as they are, G = R^k. In the bases of the retraction
/// tau_s(v, x) = (tau_s(v), tau(x)) momenta have a horizontal and a vertical part, so that the equations of a discrete
/// Lagrangian are those of Lagrange and Poincare (core/reduction/lagrange_poincare.hpp).
///
///     const Unsplit<Transport> joined(connection);
///     const PulledBack split(system, joined);               // the system in (s0, s1, gamma)
///
/// (Leok, Marsden & Weinstein, A Discrete Theory of Connections on Principal Bundles, arXiv:math/0508338; Fernandez,
/// Tori & Zuccalli, Lagrangian reduction of nonholonomic discrete mechanical systems, J. Geom. Mech. 2 (2010).)
/// Required: arrows near enough to units for the connection. Nothing throws.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/morphism.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/trivial.hpp>

#include <string>
#include <type_traits>
#include <utility>

namespace lagroid {

/// An arrow of the base and an element of the structure group at its source.
template <class Base, class Element> struct SplitArrow {
  Base base;
  Element element;
};

namespace detail {

template <class Connection> struct StructureGroupOf { using type = VectorGroup<Connection::angles>; };
template <class Connection>
requires requires { typename Connection::Group; }
struct StructureGroupOf<Connection> {
  using type = typename Connection::Group;
};

}  // namespace detail

/// The structure group of a connection.
template <class Connection> using StructureGroup = typename detail::StructureGroupOf<Connection>::type;

/// The gauge groupoid Connection::Domain in split arrows. Algebroid: horizontal directions, those of the base, and then
/// the fibre's. Memory: the base's arrow, then the element.
template <class Connection> struct SplitGauge : LieGroupoid<SplitGauge<Connection>, Connection::Domain::dimension> {
  using ConnectionType = Connection;
  using Base = typename Connection::Codomain;
  using Group = StructureGroup<Connection>;
  static constexpr int base_rank = Base::dimension;
  static constexpr int fibre_rank = Group::dimension;
  static constexpr int rank = base_rank + fibre_rank;
  static_assert(rank == Connection::Domain::dimension,
                "a connection splits arrows in those of the base and elements of the group");
  static constexpr int object_dimension = object_dimension_of<Base>();
  static constexpr int base_size = Base::arrow_coordinate_count();
  static constexpr int arrow_size = base_size + Group::arrow_coordinate_count();
  static constexpr int object_size = Base::object_coordinate_count();
  template <class S> using Object = typename Base::template Object<S>;
  template <class S> using Arrow = SplitArrow<ArrowOf<Base, S>, ArrowOf<Group, S>>;

  [[no_unique_address]] Connection connection;
  [[no_unique_address]] Group group;

  const Base& base() const { return connection.to; }

  /// gamma hor(b), and what it is of an arrow.
  template <class B, class E> auto join(const SplitArrow<B, E>& g) const {
    return connection.attach(g.base, g.element);
  }
  template <class A> auto split(const A& g) const {
    auto b = connection(g);
    auto gamma = [&] {
      if constexpr (requires { connection.element(g); }) {
        return connection.element(g);
      } else {
        return connection.angle(g);
      }
    }();
    return SplitArrow<decltype(b), decltype(gamma)>{std::move(b), std::move(gamma)};
  }
  /// The horizontal arrow over b, and gamma at the point s, as arrows of the gauge groupoid.
  template <class B> auto horizontal(const B& b) const { return connection.attach(b, unit_element(scalar(b))); }
  template <class Q, class E> auto vertical(const Q& s, const E& gamma) const {
    return connection.attach(base().unit(s), gamma);
  }

  template <class B, class E> auto source(const SplitArrow<B, E>& g) const { return base().source(g.base); }
  template <class B, class E> auto target(const SplitArrow<B, E>& g) const { return base().target(g.base); }
  template <class Q> auto unit(const Q& s) const {
    auto b = base().unit(s);
    const auto e = unit_element(scalar(b));
    return SplitArrow<decltype(b), std::remove_const_t<decltype(e)>>{std::move(b), e};
  }
  template <class B, class E> SplitArrow<B, E> inverse(const SplitArrow<B, E>& g) const {
    return split(connection.from.inverse(join(g)));
  }
  template <class B, class E> SplitArrow<B, E> multiply(const SplitArrow<B, E>& g, const SplitArrow<B, E>& h) const {
    return split(connection.from.multiply(join(g), join(h)));
  }
  template <class Q, class S> Arrow<S> tau(const Q& s, const Vector<S, rank>& v) const {
    return {base().tau(s, part<0, base_rank>(v)), group.tau(Point<S>(), part<base_rank, fibre_rank>(v))};
  }
  template <class B, class E> auto tau_inverse(const SplitArrow<B, E>& g) const {
    const auto v = base().tau_inverse(g.base);
    using S = typename decltype(v)::Scalar;
    return joined<S, base_rank, fibre_rank>(v, group.tau_inverse(g.element));
  }
  template <class B, class E> SplitArrow<B, E> project(const SplitArrow<B, E>& g) const {
    return {base().project(g.base), group.project(g.element)};
  }
  template <class Q, class U> auto displace_object(const Q& s, const U& u) const {
    return base().displace_object(s, u);
  }
  template <class Q> auto object_displacement(const Q& s, const Q& r) const { return base().object_displacement(s, r); }

  template <class B, class E> auto coordinates(const SplitArrow<B, E>& g) const {
    const auto x = base().coordinates_of_arrow(g.base);
    using S = typename decltype(x)::Scalar;
    return joined<S, base_size, arrow_size - base_size>(x, group.coordinates_of_arrow(g.element));
  }
  template <class S, class V> Arrow<S> arrow(const V& x) const {
    const Vector<S, arrow_size> numbers = x;
    return {base().template arrow_at<S>(part<0, base_size>(numbers)),
            group.template arrow_at<S>(part<base_size, arrow_size - base_size>(numbers))};
  }
  template <class Q> auto object_coordinates(const Q& s) const { return base().coordinates_of_object(s); }
  template <class S, class V> Object<S> object(const V& x) const { return base().template object_at<S>(x); }

  static std::string name() { return "split " + Connection::Domain::name(); }

 private:
  /// The group's single object.
  template <class S> using Point = ObjectOf<Group, S>;
  template <class B> auto scalar(const B& b) const {
    return typename decltype(base().coordinates_of_arrow(b))::Scalar(0.0);
  }
  template <class S> ArrowOf<Group, S> unit_element(const S&) const { return group.unit(Point<S>()); }
};

/// From the split arrows to those of the gauge groupoid: an isomorphism.
template <class Connection>
struct Unsplit : Morphism<Unsplit<Connection>, SplitGauge<Connection>, typename Connection::Domain> {
  Unsplit() = default;
  explicit Unsplit(const Connection& connection) {
    this->from.connection = connection;
    this->to = connection.from;
  }
  template <class B, class E> auto operator()(const SplitArrow<B, E>& g) const { return this->from.join(g); }
  template <class A> auto representative(const A& g) const { return this->from.split(g); }
  template <class Q, class A> auto lift(const Q&, const A& g) const { return this->from.split(g); }
};

/// A connection of the trivial bundle R^n x H by what it carries bodies along: transport(s0, s1), an element of H, the
/// unit where s0 = s1.
template <class Transport, int N, class H>
struct TransportConnection : Morphism<TransportConnection<Transport, N, H>, Trivial<N, H>, Pair<N>> {
  using Group = H;
  [[no_unique_address]] Transport transport;

  TransportConnection() = default;
  explicit TransportConnection(Transport by) : transport(std::move(by)) {}
  template <class S, class E> PairArrow<S, N> operator()(const std::tuple<PairArrow<S, N>, E>& g) const {
    return std::get<0>(g);
  }
  template <class S, class E> E element(const std::tuple<PairArrow<S, N>, E>& g) const {
    const auto& [b, turn] = g;
    return H{}.multiply(turn, H{}.inverse(E(transport(b.source, b.target))));
  }
  template <class S, class E> std::tuple<PairArrow<S, N>, E> attach(const PairArrow<S, N>& b, const E& gamma) const {
    return {b, H{}.multiply(gamma, E(transport(b.source, b.target)))};
  }
};

}  // namespace lagroid
