#pragma once
/// Local bisections B of a groupoid: sections b of alpha, b(q) an arrow from q, for which q -> B.q = beta(b(q)) is a
/// local diffeomorphism of the objects.
///
/// On a groupoid, arrows alone do not translate arrows, since sources and targets must match; bisections do, and the
/// product of the cotangent groupoid needs them.
///
///     const auto b = bisection_through(groupoid, g);
///     const auto from_q = b(q);                     // the arrow of B from q; g itself where q = alpha(g)
///     const auto back = b.inverse()(b.image(q));    // its inverse
///
/// Requires q near the centre, where b is defined. Returns arrows over the scalar of q.
///
/// Errors: `preimage`, `left` and `inverse` solve B.q = r by Newton's method and throw OutsideBisection where it does
/// not converge.
///
/// Source: [G] A.1.

#include <lagroid/core/algebroid.hpp>
#include <lagroid/core/matrices/decompositions.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace lagroid {

/// Thrown where Newton's method finds no arrow of a local bisection that ends at a given object.
class OutsideBisection : public std::domain_error {
  using std::domain_error::domain_error;
};

/// A local bisection B by its section b of alpha: b(q) is an arrow from q, and q -> B.q = beta(b(q)) a local
/// diffeomorphism of the objects around `centre`. `Section` takes an object over any scalar.
///
///     product       (b1 b2)(q) = b1(q) b2(B1.q)            inverse   b^{-1}(B.q) = b(q)^{-1}
///     translations  l_B(g) = b(q) g where B.q = alpha(g)             r_B(g) = g b(beta(g))
template <Groupoid G, class Section> class Bisection {
 public:
  Bisection(const G& groupoid, ObjectOf<G> centre, Section section)
      : groupoid_(groupoid), centre_(std::move(centre)), section_(std::move(section)) {}

  /// b(q), the arrow from q.
  template <class Q> auto operator()(const Q& q) const { return section_(q); }
  /// B.q, the object where it ends.
  template <class Q> auto image(const Q& q) const { return groupoid_.target(section_(q)); }

  /// The derivative of q -> B.q, in the charts of the objects around q and B.q.
  Eigen::MatrixXd slope(const ObjectOf<G>& q) const {
    const auto qd = groupoid_.template cast_object<Dual<double>>(q);
    const auto end = image(qd);
    Eigen::MatrixXd out(size, size);
    for (int j = 0; j < size; ++j) {
      const auto u = infinitesimal(Vector<double, size>(Vector<double, size>::Unit(j)));
      out.col(j) = derivative_of(groupoid_.object_displacement(end, image(groupoid_.displace_object(qd, u))));
    }
    return out;
  }

  /// The object q with B.q = r, by Newton's method from the centre. Throws OutsideBisection.
  ///
  /// Where r has derivatives, a few more iterations give those of q: each is right in one order more.
  template <class Q> Q preimage(const Q& r) const {
    using S = ObjectScalar<G, Q>;
    constexpr int iterations = 20;
    constexpr int orders = 4;
    const double scale = 1 + groupoid_.coordinates_of_object(without_derivatives(r)).norm();
    auto q = groupoid_.template cast_object<S>(centre_);
    int settled = 0;
    for (int k = 0; k < iterations; ++k) {
      const Vector<S, size> gap = groupoid_.object_displacement(image(q), r);
      const Matrix<double, size, size> inverse = inverse_of(slope(without_derivatives(q)));
      q = groupoid_.displace_object(q, Vector<S, size>(inverse.template cast<S>() * gap));
      bool small = true;
      for (int i = 0; i < size; ++i) small = small && std::abs(double(value_of(gap(i)))) < 1e-9 * scale;
      if (small && ++settled == orders) return q;
    }
    throw OutsideBisection(G::name() + ": no arrow of the bisection found that ends at the object");
  }

  /// l_B(g) and r_B(g).
  template <class A> A left(const A& g) const { return groupoid_.multiply(section_(preimage(groupoid_.source(g))), g); }
  template <class A> A right(const A& g) const { return groupoid_.multiply(g, section_(groupoid_.target(g))); }

  auto inverse() const {
    return make(image(centre_), [b = *this](const auto& r) { return b.groupoid_.inverse(b(b.preimage(r))); });
  }
  template <class Other> auto operator*(const Bisection<G, Other>& next) const {
    return make(centre_, [b = *this, next](const auto& q) {
      const auto g = b(q);
      return b.groupoid_.multiply(g, next(b.groupoid_.target(g)));
    });
  }

 private:
  static constexpr int size = object_dimension_of<G>();

  template <class B> auto make(const ObjectOf<G>& centre, const B& section) const {
    return Bisection<G, B>(groupoid_, centre, section);
  }
  template <class Q> ObjectOf<G> without_derivatives(const Q& q) const {
    const auto x = groupoid_.coordinates_of_object(q);
    return groupoid_.template object_at<double>(x.unaryExpr([](const auto& y) { return value_of(y); }).eval());
  }

  [[no_unique_address]] G groupoid_;
  ObjectOf<G> centre_;
  Section section_;
};

/// The bisection through g that the groupoid supplies.
template <Groupoid G> auto bisection_through(const G& groupoid, const ArrowOf<G>& g) {
  return Bisection(groupoid, groupoid.source(g), [groupoid, g](const auto& q) {
    using S = ObjectScalar<G, std::remove_cvref_t<decltype(q)>>;
    return groupoid.bisection(groupoid.template cast<S>(g), q);
  });
}

/// The units around q.
template <Groupoid G> auto unit_bisection(const G& groupoid, const ObjectOf<G>& q) {
  return Bisection(groupoid, q, [groupoid](const auto& r) { return groupoid.unit(r); });
}

}  // namespace lagroid
