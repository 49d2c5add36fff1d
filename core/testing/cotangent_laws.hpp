#pragma once
/// The symplectic groupoid T*G => A*G as a test suite that any groupoid runs by naming itself: source anti-Poisson,
/// target Poisson, their fibres orthogonal, units and the graph of the product Lagrangian.
///
/// That steps of a discrete Lagrangian system are Poisson maps rests on these statements.
///
///     EXPECT_TRUE(lagroid::laws::cotangent_laws<MyGroupoid>().holds());
///
/// Requires RapidCheck and, where objects are not vectors of R^n, a `draw_object`. (That T*G is a groupoid is tested by
/// groupoid_laws<CotangentGroupoid<MyGroupoid>>.) Returns a LawReport.
///
/// Source: [G] Theorem A.1, Def. 2.11.

#include <lagroid/core/bisection.hpp>
#include <lagroid/core/hamiltonian/symplectic.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>

namespace lagroid::laws {

/// [G] Theorem A.1, Def. 2.11 and the remarks after it: the graph of the product is Lagrangian, the source is
/// anti-Poisson, the target Poisson, their fibres orthogonal, the units Lagrangian. `Cotangent` is CotangentGroupoid<G>
/// or, to see the suite fail, a subclass with other operations.
template <Groupoid G, class DrawObject, class Cotangent>
LawReport cotangent_laws(const G& groupoid, const DrawObject& draw_object, const GroupoidLawOptions& options,
                         const Cotangent& cotangent) {
  constexpr int n = G::dimension;
  constexpr int d = object_dimension_of<G>();
  constexpr int size = n + d;
  using A = ArrowOf<G>;
  using V = Vector<double, n>;
  using W = Vector<double, size>;
  using detail::relative_defect;

  const auto fibre = [&] { return V(draw_vector<n>(options.large)); };
  const auto arrow_from = [&](const ObjectOf<G>& q) -> A {
    const A g = groupoid.tau(q, fibre());
    return groupoid.project(groupoid.multiply(g, groupoid.tau(groupoid.target(g), fibre())));
  };
  const auto arrow = [&] { return arrow_from(draw_object()); };
  const Eigen::MatrixXd canonical = canonical_tensor<size>();

  LawReport report{Cotangent::name() + ", symplectic", {}};
  const auto law = [&](const char* name, const auto& defect) {
    report.laws.push_back(check_law(name, options.derivative, defect));
  };

  law("tangent of the product (A.1)", [&] {
    using D = Dual<double>;
    const A g1 = arrow();
    const A g2 = arrow_from(groupoid.target(g1));
    const auto b1 = bisection_through(groupoid, g1);
    const auto b2 = bisection_through(groupoid, g2);
    const auto derivative = [&](const auto& k) { return derivative_of(groupoid.coordinates_of_arrow(k)); };
    // The velocity of k, moved along its fibre, at g.
    const auto curve = [&](const A& g, const auto& k) {
      const auto moved = groupoid.multiply(k, groupoid.tau(groupoid.target(k), infinitesimal(fibre())));
      return groupoid.with_tangent(g, derivative(moved));
    };
    const Vector<D, d> u = infinitesimal(Vector<double, d>(draw_vector<d>(options.large)));
    const auto k1 = curve(g1, b1(groupoid.displace_object(groupoid.source(groupoid.template cast<D>(g1)), u)));
    const auto q = groupoid.target(k1);
    const auto k2 = curve(g2, b2(q));
    return relative_defect(
        derivative(groupoid.multiply(k1, k2)),
        (derivative(b2.right(k1)) + derivative(b1.left(k2)) - derivative(b1.left(b2.right(groupoid.unit(q))))).eval());
  });

  // The derivatives, at a random covector, of its canonical coordinates, its source and its target.
  struct Point {
    Eigen::MatrixXd tensor;  // of T*G, in the coordinates of `covector`
    Eigen::MatrixXd source, target;
    typename Cotangent::template Object<double> from, to;
  };
  const auto point = [&] {
    const A g = arrow();
    const W values = draw_vector<size>(options.large);
    const CotangentChart<G> chart(cotangent, g);
    const auto derivative = [&](const auto& f) {
      Vector<double, 2 * size> x;
      x << W::Zero(), values;
      return jacobian(x, [&](const auto& y) {
        return f(chart.covector(y.template head<size>().eval(), y.template tail<size>().eval()));
      });
    };
    const Eigen::MatrixXd c = inverse_of(derivative([&](const auto& p) { return chart.canonical(p); }));
    const typename Cotangent::template Arrow<double> at{g, values};
    return Point{c * canonical * c.transpose(),
                 derivative([&](const auto& p) { return cotangent.coordinates_of_object(cotangent.source(p)); }),
                 derivative([&](const auto& p) { return cotangent.coordinates_of_object(cotangent.target(p)); }),
                 cotangent.source(at), cotangent.target(at)};
  };
  const auto poisson = [&](const auto& z) { return poisson_tensor(groupoid, z.object, z.momentum); };
  law("source is anti-Poisson", [&] {
    const Point p = point();
    return relative_defect(p.source * p.tensor * p.source.transpose(), -poisson(p.from));
  });
  law("target is Poisson", [&] {
    const Point p = point();
    return relative_defect(p.target * p.tensor * p.target.transpose(), poisson(p.to));
  });
  law("fibres of source and target are orthogonal", [&] {
    const Point p = point();
    const Eigen::MatrixXd product = p.source * p.tensor * p.target.transpose();
    return relative_defect(product, Eigen::MatrixXd::Zero(product.rows(), product.cols()));
  });
  law("units are Lagrangian", [&] {
    const typename Cotangent::template Object<double> z{draw_object(), fibre()};
    const CotangentChart<G> chart(cotangent, groupoid.unit(z.object));
    const Eigen::MatrixXd c = jacobian(W(W::Zero()), [&](const auto& u) {
      using S = typename std::remove_cvref_t<decltype(u)>::Scalar;
      return chart.canonical(cotangent.unit(cotangent.displace_object(cotangent.template cast_object<S>(z), u)));
    });
    const Eigen::MatrixXd form = c.transpose() * canonical * c;
    return relative_defect(form, Eigen::MatrixXd::Zero(size, size));
  });
  law("graph of the product is Lagrangian", [&] {
    // Composable pairs: p1 anywhere; the arrow of p2 starts where p1 ends; its values on the target are free.
    using U = Vector<double, 3 * size>;
    const A g1 = arrow();
    const A g2 = arrow_from(groupoid.target(g1));
    const CotangentChart<G> chart1(cotangent, g1);
    const CotangentChart<G> chart2(cotangent, g2);
    const CotangentChart<G> chart3(cotangent, groupoid.multiply(g1, g2));
    const U x =
        (U() << W::Zero(), draw_vector<size>(options.large), V::Zero(), draw_vector<d>(options.large)).finished();
    const auto first = [&](const auto& y) {
      return chart1.covector(y.template head<size>().eval(), y.template segment<size>(size).eval());
    };
    const auto second = [&](const auto& y) {
      using S = typename std::remove_cvref_t<decltype(y)>::Scalar;
      const auto z = cotangent.target(first(y));
      const auto along = groupoid.bisection(groupoid.template cast<S>(g2), z.object);
      const auto arrow2 =
          groupoid.multiply(along, groupoid.tau(groupoid.target(along), y.template segment<n>(2 * size).eval()));
      return cotangent.with_source(arrow2, z.momentum, y.template tail<d>().eval());
    };
    const auto form = [&](const CotangentChart<G>& chart, const auto& p) {
      const Eigen::MatrixXd c = jacobian(x, [&](const auto& y) { return chart.canonical(p(y)); });
      return Eigen::MatrixXd(c.transpose() * canonical * c);
    };
    return relative_defect(form(chart1, first) + form(chart2, second),
                           form(chart3, [&](const auto& y) { return cotangent.multiply(first(y), second(y)); }));
  });
  return report;
}

template <Groupoid G, class DrawObject>
LawReport cotangent_laws(const G& groupoid, const DrawObject& draw_object, const GroupoidLawOptions& options = {}) {
  return cotangent_laws(groupoid, draw_object, options, CotangentGroupoid<G>(groupoid));
}

/// The same for groupoids whose objects are vectors of R^n (or tuples of such), drawn at random.
template <Groupoid G> LawReport cotangent_laws(const G& groupoid = {}, const GroupoidLawOptions& options = {}) {
  constexpr int size = G::object_coordinate_count();
  return cotangent_laws(
      groupoid, [&] { return ObjectOf<G>(groupoid.template object_at<double>(draw_vector<size>(options.large))); },
      options, CotangentGroupoid<G>(groupoid));
}

}  // namespace lagroid::laws
