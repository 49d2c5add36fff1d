#pragma once
/// The laws of a symplectic groupoid over a Poisson manifold, beside those that any groupoid has (groupoid_laws): in
/// canonical coordinates of its arrows the source is Poisson, the target anti-Poisson, their fibres are orthogonal, and
/// the graph of the product is Lagrangian.
///
/// That a step by a Lagrangian bisection is a Poisson map rests on these statements.
///
///     const SymplecticGroupoid<CayleyChart<EulerTop>> groupoid;
///     EXPECT_TRUE(symplectic_groupoid_laws(groupoid, draw_point).holds());
///
/// Requires RapidCheck, a groupoid with `darboux` and `bivector` (SymplecticGroupoid) and objects from `draw_object`. A
/// truncated chart is asked by `symplectic_chart_laws`, with the defect that it may have. Returns a LawReport.

#include <lagroid/core/hamiltonian/symplectic.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>

#include <string>

namespace lagroid::laws {

/// Of a chart whose arrows have coordinates y, 2n of them: `subject` has source(y), target(y), darboux(y) and
/// bivector(x), `draw` returns a y.
template <int N, class Subject, class Draw>
LawReport symplectic_chart_laws(const std::string& name, const Subject& subject, const Draw& draw, double tolerance) {
  LawReport report{name, {}};
  const auto law = [&](const char* which, const auto& defect) {
    report.laws.push_back(check_law(which, tolerance, defect));
  };
  struct Point {
    Eigen::MatrixXd tensor, source, target;
    Vector<double, N> from, to;
  };
  const auto point = [&] {
    const Vector<double, 2 * N> y = draw();
    const Eigen::MatrixXd c = inverse_of(jacobian(y, [&](const auto& z) { return subject.darboux(z); }));
    return Point{c * canonical_tensor<N>() * c.transpose(),
                 jacobian(y, [&](const auto& z) { return subject.source(z); }),
                 jacobian(y, [&](const auto& z) { return subject.target(z); }), subject.source(y), subject.target(y)};
  };
  law("the source is Poisson", [&] {
    const Point p = point();
    return detail::relative_defect(p.source * p.tensor * p.source.transpose(), subject.bivector(p.from));
  });
  law("the target is anti-Poisson", [&] {
    const Point p = point();
    return detail::relative_defect(p.target * p.tensor * p.target.transpose(), -subject.bivector(p.to));
  });
  law("source and target commute", [&] {
    const Point p = point();
    const Eigen::MatrixXd product = p.source * p.tensor * p.target.transpose();
    return detail::relative_defect(product, Eigen::MatrixXd::Zero(N, N));
  });
  return report;
}

template <class G, class DrawObject>
LawReport symplectic_groupoid_laws(const G& groupoid, const DrawObject& draw_object,
                                   const GroupoidLawOptions& options = {}) {
  constexpr int n = G::dimension;
  using V = Vector<double, n>;
  const auto vector = [&] { return V(draw_vector<n>(options.large)); };
  LawReport report = symplectic_chart_laws<n>(
      G::name() + ", symplectic", groupoid, [&] { return groupoid.tau(V(draw_object()), vector()); },
      options.derivative);
  const auto law = [&](const char* which, const auto& defect) {
    report.laws.push_back(check_law(which, options.derivative, defect));
  };
  law("the product's graph is Lagrangian", [&] {
    // Composable pairs (x, u), (beta(x, u), v).
    Vector<double, 3 * n> y;
    y << V(draw_object()), vector(), vector();
    const auto first = [&](const auto& z) { return groupoid.tau(part<0, n>(z), part<n, n>(z)); };
    const auto second = [&](const auto& z) { return groupoid.tau(groupoid.target(first(z)), part<2 * n, n>(z)); };
    const auto form = [&](const auto& arrow) {
      const Eigen::MatrixXd c = jacobian(y, [&](const auto& z) { return groupoid.darboux(arrow(z)); });
      return Eigen::MatrixXd(c.transpose() * canonical_tensor<n>() * c);
    };
    return detail::relative_defect(form(first) + form(second),
                                   form([&](const auto& z) { return groupoid.multiply(first(z), second(z)); }));
  });
  return report;
}

}  // namespace lagroid::laws
