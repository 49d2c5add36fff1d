#pragma once
/// The symplectic groupoid T*G => A*G as a test suite that any groupoid runs by naming itself. (That T*G is a groupoid
/// is asked by groupoid_laws<CotangentGroupoid<MyGroupoid>>.)

#include <lagroid/core/symplectic.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>

#include <Eigen/LU>

namespace lagroid::laws {

namespace detail {

inline double matrix_defect(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y) { return relative_defect(x, y); }

}  // namespace detail

/// [G] Theorem A.1, Def. 2.11 and what is said after it: the graph of the product is Lagrangian, the source is
/// anti-Poisson, the target Poisson, their fibres orthogonal, the units Lagrangian. `Cotangent` is CotangentGroupoid<G>
/// or, to see the suite fail, a subclass with other operations.
template <Groupoid G, class DrawObject, class Cotangent = CotangentGroupoid<G>>
LawReport cotangent_laws(const G& groupoid, const DrawObject& draw_object, const GroupoidLawOptions& options = {},
                         const Cotangent& cotangent = Cotangent(G{})) {
  constexpr int n = G::dimension;
  constexpr int d = object_dimension_of<G>();
  constexpr int size = n + d;
  using A = ArrowOf<G>;
  using V = Vector<double, n>;
  using W = Vector<double, size>;
  using J = Jet<double, 2 * size>;
  using detail::matrix_defect;
  using detail::relative_defect;

  const auto fibre = [&] { return V(draw_vector<n>(options.large)); };
  const auto arrow_from = [&](const ObjectOf<G>& q) -> A {
    const A g = groupoid.tau(q, fibre());
    return groupoid.project(groupoid.multiply(g, groupoid.tau(groupoid.target(g), fibre())));
  };
  const auto arrow = [&] { return arrow_from(draw_object()); };
  const auto variable = [](auto jet, int offset, auto length, const auto& value) {
    using S = decltype(jet);
    Vector<S, decltype(length)::value> x;
    for (int i = 0; i < x.size(); ++i) x(i) = S::variable(value(i), offset + i);
    return x;
  };
  const auto whole = std::integral_constant<int, size>{};
  const Eigen::MatrixXd canonical = canonical_tensor<size>();

  LawReport report{Cotangent::name() + ", symplectic", {}};
  const auto law = [&](const char* name, const auto& defect) {
    report.laws.push_back(check_law(name, options.derivative, defect));
  };

  law("tangent of the product (A.1)", [&] {
    using D = Dual<double>;
    const A g1 = arrow();
    const A g2 = arrow_from(groupoid.target(g1));
    const auto infinitesimal = [&](const auto& x) { return x.unaryExpr([](double c) { return D(0.0, c); }).eval(); };
    const auto derivative = [&](const auto& k) {
      return groupoid.coordinates_of_arrow(k).unaryExpr([](const D& c) { return c.derivative; }).eval();
    };
    const auto b = [&](const A& g, const auto& q) { return groupoid.bisection(groupoid.template cast<D>(g), q); };
    const Vector<D, d> u = infinitesimal(Vector<double, d>(draw_vector<d>(options.large)));
    const auto from = groupoid.displace_object(groupoid.source(groupoid.template cast<D>(g1)), u);
    const auto along = b(g1, from);
    const auto k1 = groupoid.multiply(along, groupoid.tau(groupoid.target(along), infinitesimal(fibre()).eval()));
    const auto q = groupoid.target(k1);
    const auto k2 = groupoid.multiply(b(g2, q), groupoid.tau(groupoid.target(b(g2, q)), infinitesimal(fibre()).eval()));
    const auto b1 = [&](const auto& r) { return groupoid.inverse(b(groupoid.inverse(g1), r)); };
    return relative_defect(derivative(groupoid.multiply(k1, k2)),
                           (derivative(groupoid.multiply(k1, b(g2, q))) + derivative(groupoid.multiply(b1(q), k2)) -
                            derivative(groupoid.multiply(b1(q), b(g2, q))))
                               .eval());
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
    const auto p =
        chart.template covector<J>(variable(J{}, 0, whole, W(W::Zero())), variable(J{}, size, whole, values));
    const Eigen::MatrixXd c = jacobian(chart.template canonical<J>(p)).inverse();
    const typename Cotangent::template Arrow<double> at{g, values};
    return Point{c * canonical * c.transpose(), jacobian(cotangent.coordinates_of_object(cotangent.source(p))),
                 jacobian(cotangent.coordinates_of_object(cotangent.target(p))), cotangent.source(at),
                 cotangent.target(at)};
  };
  const auto poisson = [&](const auto& z) { return poisson_tensor(groupoid, z.object, z.momentum); };
  law("source is anti-Poisson", [&] {
    const Point p = point();
    return matrix_defect(p.source * p.tensor * p.source.transpose(), -poisson(p.from));
  });
  law("target is Poisson", [&] {
    const Point p = point();
    return matrix_defect(p.target * p.tensor * p.target.transpose(), poisson(p.to));
  });
  law("fibres of source and target are orthogonal", [&] {
    const Point p = point();
    const Eigen::MatrixXd product = p.source * p.tensor * p.target.transpose();
    return matrix_defect(product, Eigen::MatrixXd::Zero(product.rows(), product.cols()));
  });
  law("units are Lagrangian", [&] {
    using U = Jet<double, size>;
    const auto q = draw_object();
    const V mu = fibre();
    const typename Cotangent::template Object<U> z =
        cotangent.displace_object(cotangent.template cast_object<U>(typename Cotangent::template Object<double>{q, mu}),
                                  variable(U{}, 0, whole, W(W::Zero())));
    const Eigen::MatrixXd c =
        jacobian(CotangentChart<G>(cotangent, groupoid.unit(q)).template canonical<U>(cotangent.unit(z)));
    const Eigen::MatrixXd form = c.transpose() * canonical * c;
    return matrix_defect(form, Eigen::MatrixXd::Zero(size, size));
  });
  law("graph of the product is Lagrangian", [&] {
    // Composable pairs: p1 anywhere; the arrow of p2 starts where p1 ends; its values on the target are free.
    using T = Jet<double, 3 * size>;
    const A g1 = arrow();
    const A g2 = arrow_from(groupoid.target(g1));
    const CotangentChart<G> chart1(cotangent, g1);
    const CotangentChart<G> chart2(cotangent, g2);
    const CotangentChart<G> chart3(cotangent, groupoid.multiply(g1, g2));
    const auto p1 = chart1.template covector<T>(variable(T{}, 0, whole, W(W::Zero())),
                                                variable(T{}, size, whole, W(draw_vector<size>(options.large))));
    const auto z = cotangent.target(p1);
    const auto along = groupoid.bisection(groupoid.template cast<T>(g2), z.object);
    const auto arrow2 = groupoid.multiply(
        along,
        groupoid.tau(groupoid.target(along), variable(T{}, 2 * size, std::integral_constant<int, n>{}, V(V::Zero()))));
    const auto p2 = cotangent.with_source(arrow2, z.momentum,
                                          variable(T{}, 2 * size + n, std::integral_constant<int, d>{},
                                                   Vector<double, d>(draw_vector<d>(options.large))));
    const auto form = [&](const CotangentChart<G>& chart, const auto& p) {
      const Eigen::MatrixXd c = jacobian(chart.template canonical<T>(p));
      return Eigen::MatrixXd(c.transpose() * canonical * c);
    };
    return matrix_defect(form(chart1, p1) + form(chart2, p2), form(chart3, cotangent.multiply(p1, p2)));
  });
  return report;
}

/// The same for groupoids whose objects are vectors of R^n (or tuples of such), drawn at random.
template <Groupoid G> LawReport cotangent_laws(const G& groupoid = {}, const GroupoidLawOptions& options = {}) {
  constexpr int size = G::object_coordinate_count();
  return cotangent_laws(
      groupoid, [&] { return ObjectOf<G>(groupoid.template object_at<double>(draw_vector<size>(options.large))); },
      options, CotangentGroupoid<G>(groupoid));
}

}  // namespace lagroid::laws
