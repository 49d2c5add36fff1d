#pragma once
/// The identities of a Lie algebroid, as a test suite that any groupoid runs by naming itself: bracket bilinear,
/// antisymmetric, Jacobi, Leibniz with the anchor, the anchor a homomorphism; and the local bisections of the groupoid.
///
/// The Poisson structure of A*G is made of them.
///
///     EXPECT_TRUE(lagroid::laws::algebroid_laws<MyGroupoid>().holds());
///
/// Requires RapidCheck and, where objects are not vectors of R^n, a `draw_object`. Returns a LawReport; an exception of
/// the groupoid is recorded in it as a failure.
///
/// Source: [G] Def. 2.7, 2.9, Remarks 2.8, 2.10, and A.1.

#include <lagroid/core/algebroid.hpp>
#include <lagroid/core/bisection.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>

namespace lagroid::laws {

namespace detail {

/// A random section, of second degree in z, the object coordinates over their size: a + (1 + w.z) B z.
template <Groupoid G> struct RandomSection {
  static constexpr int size = G::object_coordinate_count();
  const G* groupoid;
  Vector<double, G::dimension> constant;
  Matrix<double, G::dimension, size> linear;
  Vector<double, size> weight;
  double length;

  template <class Q> auto operator()(const Q& q) const {
    auto z = groupoid->coordinates_of_object(q);
    using S = typename std::decay_t<decltype(z)>::Scalar;
    for (int i = 0; i < size; ++i) z(i) = z(i) * (1 / length);
    S factor(1.0);
    for (int j = 0; j < size; ++j) factor += weight(j) * z(j);
    Vector<S, G::dimension> out;
    for (int i = 0; i < G::dimension; ++i) {
      S slope(0.0);
      for (int j = 0; j < size; ++j) slope += linear(i, j) * z(j);
      out(i) = constant(i) + slope * factor;
    }
    return out;
  }

  /// For objects of the size of q.
  static RandomSection draw(const G& groupoid, const ObjectOf<G>& q, double large) {
    RandomSection s{&groupoid, draw_vector<G::dimension>(large), {}, {}, 1};
    if constexpr (size > 0) s.length = std::max(1.0, groupoid.coordinates_of_object(q).cwiseAbs().maxCoeff());
    for (int i = 0; i < s.linear.size(); ++i) s.linear(i) = draw_uniform();
    for (int i = 0; i < size; ++i) s.weight(i) = draw_uniform();
    return s;
  }
};

}  // namespace detail

/// The laws of [G] Def. 2.7, 2.9 and Remarks 2.8, 2.10, for sections with random coefficients of second degree, and
/// those of the groupoid's geometry: its chart of the objects and its local bisections, which multiply, are
/// inverted and translate arrows ([G] A.1).
template <Groupoid G, class DrawObject>
LawReport algebroid_laws(const G& groupoid, const DrawObject& draw_object, const GroupoidLawOptions& options = {}) {
  constexpr int n = G::dimension;
  using Q = ObjectOf<G>;
  using V = Vector<double, n>;
  using Section = detail::RandomSection<G>;
  using detail::relative_defect;
  const LieAlgebroid<G> algebroid(groupoid);
  const auto section = [&] { return Section::draw(groupoid, draw_object(), options.large); };
  const auto arrow_from = [&](const Q& q) -> ArrowOf<G> {
    const ArrowOf<G> g = groupoid.tau(q, V(draw_vector<n>(options.large)));
    return groupoid.project(groupoid.multiply(g, groupoid.tau(groupoid.target(g), V(draw_vector<n>(options.large)))));
  };
  const auto arrow = [&] { return arrow_from(draw_object()); };
  const auto near = [&](const Q& q) -> Q {
    constexpr int d = object_dimension_of<G>();
    return groupoid.displace_object(q, Vector<double, d>(0.1 * draw_vector<d>(options.local)));
  };
  const auto arrows = [&](const ArrowOf<G>& x, const ArrowOf<G>& y) {
    return relative_defect(groupoid.coordinates_of_arrow(x), groupoid.coordinates_of_arrow(y));
  };
  const auto objects = [&](const Q& x, const Q& y) {
    return relative_defect(groupoid.coordinates_of_object(x), groupoid.coordinates_of_object(y));
  };
  const auto bracket_of = [&](const auto& x, const auto& y) {
    return [&algebroid, x, y](const auto& q) { return algebroid.bracket(q, x, y); };
  };
  // A random function on Q, as a vector of one component.
  const auto function = [&] {
    Vector<double, Section::size> w;
    for (int i = 0; i < Section::size; ++i) w(i) = draw_uniform();
    return [&groupoid, w](const auto& q) {
      const auto z = groupoid.coordinates_of_object(q);
      using S = typename std::decay_t<decltype(z)>::Scalar;
      S f(1.0);
      for (int i = 0; i < Section::size; ++i) f += z(i) * (S(w(i)) + z(i) * S(0.5));
      return Vector<S, 1>(f);
    };
  };

  LawReport report{G::name() + ", algebroid", {}};
  const auto law = [&](const char* name, const auto& defect) {
    report.laws.push_back(check_law(name, options.derivative, defect));
  };
  law("chart of the objects", [&] {
    using U = Vector<double, object_dimension_of<G>()>;
    const Q q = draw_object();
    const U u = draw_vector<object_dimension_of<G>()>(options.local);
    const Q r = groupoid.displace_object(q, u);
    return worst({detail::displacement_defect(groupoid.object_displacement(q, r), u, groupoid.coordinates_of_object(r)),
                  relative_defect(groupoid.coordinates_of_object(groupoid.displace_object(q, U(U::Zero()))),
                                  groupoid.coordinates_of_object(q))});
  });
  law("bisections", [&] {
    // Through g, over their objects, from units to units, and with beta o b a local diffeomorphism.
    const auto g = arrow();
    const Q q = draw_object();
    const auto b = bisection_through(groupoid, g);
    const auto units = bisection_through(groupoid, groupoid.unit(groupoid.source(g)));
    return worst({arrows(b(groupoid.source(g)), g), objects(groupoid.source(b(q)), q),
                  arrows(units(q), groupoid.unit(q)),
                  std::abs(determinant_of(b.slope(groupoid.source(g)))) > 1e-9 ? 0.0 : 1.0});
  });
  law("products of bisections", [&] {
    const auto g = arrow();
    const auto h = arrow_from(groupoid.target(g));
    const auto b = bisection_through(groupoid, g);
    const auto c = bisection_through(groupoid, h);
    const auto d = bisection_through(groupoid, arrow_from(groupoid.target(h)));
    const Q q = near(groupoid.source(g));
    return worst({arrows((b * c)(groupoid.source(g)), groupoid.multiply(g, h)),
                  objects((b * c).image(q), c.image(b.image(q))), arrows(((b * c) * d)(q), (b * (c * d))(q)),
                  arrows((unit_bisection(groupoid, q) * b)(q), b(q)),
                  arrows((b * unit_bisection(groupoid, b.image(q)))(q), b(q))});
  });
  law("inverses of bisections", [&] {
    const auto g = arrow();
    const auto b = bisection_through(groupoid, g);
    const auto back = b.inverse();
    const Q q = near(groupoid.source(g));
    const Q r = near(groupoid.target(g));
    return worst({arrows(back(groupoid.target(g)), groupoid.inverse(g)), arrows((b * back)(q), groupoid.unit(q)),
                  arrows((back * b)(r), groupoid.unit(r))});
  });
  law("translations by bisections", [&] {
    const auto g = arrow();
    const auto h = arrow_from(groupoid.target(g));
    const auto k = arrow_from(near(groupoid.target(h)));
    const auto b = bisection_through(groupoid, g);
    const auto c = bisection_through(groupoid, h);
    const auto d = bisection_through(groupoid, arrow_from(groupoid.target(k)));
    return worst({arrows(c.left(groupoid.unit(c.image(groupoid.source(h)))), h),
                  arrows((b * c).left(k), b.left(c.left(k))), arrows(c.left(d.right(k)), d.right(c.left(k))),
                  arrows(c.inverse().left(c.left(k)), k)});
  });
  law("bracket is bilinear", [&] {
    const Q q = draw_object();
    const auto x = section();
    const auto y = section();
    const auto z = section();
    const double a = draw_uniform();
    const auto sum = [&](const auto& r) { return (a * x(r) + y(r)).eval(); };
    return worst(
        {relative_defect(algebroid.bracket(q, sum, z), V(a * algebroid.bracket(q, x, z) + algebroid.bracket(q, y, z))),
         relative_defect(algebroid.bracket(q, z, sum),
                         V(a * algebroid.bracket(q, z, x) + algebroid.bracket(q, z, y)))});
  });
  law("bracket is antisymmetric", [&] {
    const Q q = draw_object();
    const auto x = section();
    const auto y = section();
    return relative_defect(algebroid.bracket(q, x, y), V(-algebroid.bracket(q, y, x)));
  });
  law("Jacobi identity", [&] {
    const Q q = draw_object();
    const auto x = section();
    const auto y = section();
    const auto z = section();
    const V first = algebroid.bracket(q, x, bracket_of(y, z));
    return relative_defect(V(algebroid.bracket(q, y, bracket_of(z, x)) + algebroid.bracket(q, z, bracket_of(x, y))),
                           V(-first));
  });
  law("Leibniz rule with the anchor", [&] {
    const Q q = draw_object();
    const auto x = section();
    const auto y = section();
    const auto f = function();
    const auto fy = [&](const auto& r) { return (y(r) * f(r)(0)).eval(); };
    // rho(X)[f] through the anchor in object coordinates.
    using D = Dual<double>;
    const auto z = groupoid.coordinates_of_object(q);
    const auto direction = algebroid.anchor(q, x(q));
    Vector<D, Section::size> zd;
    for (int i = 0; i < Section::size; ++i) zd(i) = D(z(i), direction(i));
    const double slope = f(groupoid.template object_at<D>(zd))(0).derivative;
    return relative_defect(algebroid.fields_bracket(q, x, fy),
                           V(f(q)(0) * algebroid.fields_bracket(q, x, y) + slope * y(q)));
  });
  law("anchor is a homomorphism", [&] {
    const Q q = draw_object();
    const auto x = section();
    const auto y = section();
    const auto field = [&](const auto& s) {
      return [&algebroid, s](const auto& r) { return algebroid.anchor(r, algebroid.value(s, r)); };
    };
    const auto bracket = (algebroid.along_anchor(q, x(q), field(y)) - algebroid.along_anchor(q, y(q), field(x))).eval();
    return relative_defect(algebroid.anchor(q, algebroid.bracket(q, x, y)), bracket);
  });
  law("bracket is that of left-invariant fields", [&] {
    const auto g = arrow();
    const auto x = section();
    const auto y = section();
    return relative_defect(algebroid.left_fields_bracket(g, x, y),
                           groupoid.left_invariant(g, algebroid.bracket(groupoid.target(g), x, y)));
  });
  law("bracket is minus that of right-invariant fields", [&] {
    const auto g = arrow();
    const auto x = section();
    const auto y = section();
    return relative_defect(algebroid.right_fields_bracket(g, x, y),
                           (-groupoid.right_invariant(g, algebroid.bracket(groupoid.source(g), x, y))).eval());
  });
  return report;
}

/// The same for groupoids whose objects are vectors of R^n (or tuples of such), drawn at random.
template <Groupoid G> LawReport algebroid_laws(const G& groupoid = {}, const GroupoidLawOptions& options = {}) {
  constexpr int size = G::object_coordinate_count();
  return algebroid_laws(
      groupoid, [&] { return ObjectOf<G>(groupoid.template object_at<double>(draw_vector<size>(options.large))); },
      options);
}

}  // namespace lagroid::laws
