#pragma once
/// Laws of manifolds and of functions on them, for your own: projections, retractions, logarithm and Hessian at random
/// points; gradients and Hessians of an objective against differences.
///
///     const laws::LawReport report = laws::manifold_laws(optimisation::Sphere(3));
///     std::cout << report;  // report.holds(): all of them
///
/// Requires a manifold whose `nearest` succeeds from random matrices.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>
#include <lagroid/solvers/optimisation/minimise.hpp>
#include <lagroid/solvers/optimisation/objective.hpp>

#include <cmath>
#include <string>

namespace lagroid::laws {

namespace detail {

inline optimisation::Vector draw_ambient(const optimisation::Manifold& manifold) {
  optimisation::Vector v(manifold.size());
  for (double& x : v) x = draw_uniform();
  return v;
}
inline optimisation::Point draw_point(const optimisation::Manifold& manifold) {
  optimisation::Point x = draw_ambient(manifold);
  if (!manifold.nearest(x)) throw NotSampled("no nearest point");
  return x;
}
/// Of length `size`.
inline optimisation::Vector draw_tangent(const optimisation::Manifold& manifold, const optimisation::Point& x,
                                         double size) {
  optimisation::Vector v = draw_ambient(manifold);
  manifold.project(x, v);
  return size / v.norm() * v;
}

}  // namespace detail

/// What a manifold promises (`optimisation::Manifold`), at random points.
inline LawReport manifold_laws(const optimisation::Manifold& manifold) {
  using optimisation::Point, optimisation::Vector, optimisation::ManifoldRetraction;
  using namespace detail;
  LawReport report{manifold.name(), {}};
  const double numbers = double(manifold.size());
  const auto law = [&](const std::string& name, double tolerance, const auto& defect) {
    report.laws.push_back(check_law(name, tolerance, defect));
  };

  law("nearest points lie on it", 1e-15 * numbers, [&] { return manifold.residual(draw_point(manifold)); });
  law("the projection is orthogonal", 1e-13, [&] {
    const Point x = draw_point(manifold);
    const Vector v = draw_ambient(manifold);
    const Vector w = draw_ambient(manifold);
    Vector pv = v;
    Vector pw = w;
    manifold.project(x, pv);
    manifold.project(x, pw);
    Vector again = pv;
    manifold.project(x, again);
    return worst({(again - pv).norm(), std::abs(pv.dot(w) - v.dot(pw))}) / (v.norm() * w.norm());
  });
  law("projected vectors are tangent", 1e-4, [&] {
    constexpr double e = 1e-6;
    const Point x = draw_point(manifold);
    return manifold.residual(x + draw_tangent(manifold, x, e)) / e;
  });
  law("normal vectors are those that the penalty pulls along", 1e-8, [&] {
    const Point x = draw_point(manifold);
    Vector pull = Vector::Zero(manifold.size());
    constexpr double off = 1e-4;
    const Point moved = x + off * draw_ambient(manifold);
    const double penalty = manifold.penalty(moved, 1, pull);
    const Vector v = draw_ambient(manifold);
    constexpr double e = 1e-4;
    Vector unused = Vector::Zero(manifold.size());
    const double slope =
        (manifold.penalty(moved + e * v, 1, unused) - manifold.penalty(moved - e * v, 1, unused)) / (2 * e);
    return worst({-penalty, std::abs(slope - pull.dot(v)) / (1 + v.squaredNorm() * v.norm())});
  });
  for (const ManifoldRetraction retraction :
       {ManifoldRetraction::exponential, ManifoldRetraction::qr, ManifoldRetraction::polar,
        ManifoldRetraction::orthographic, ManifoldRetraction::cayley}) {
    if (!manifold.offers(retraction)) continue;
    const std::string name(to_string(retraction));
    law("retraction " + name + " lands on it", 1e-15 * numbers, [&] {
      const Point x = draw_point(manifold);
      Point to;
      const double size = *rc::gen::element(0.0, 1e-12, 1e-6, 0.1, 0.4);
      if (!manifold.retract(retraction, x, draw_tangent(manifold, x, size), to)) return 1.0;
      return worst({manifold.residual(to), size == 0 ? (to - x).norm() : 0.0});
    });
    law("retraction " + name + " begins along its vector", 1e-8, [&] {
      constexpr double e = 1e-5;
      const Point x = draw_point(manifold);
      const Vector v = draw_tangent(manifold, x, 1);
      Point there;
      Point back;
      if (!manifold.retract(retraction, x, e * v, there) || !manifold.retract(retraction, x, -e * v, back)) return 1.0;
      return ((there - back) / (2 * e) - v).norm();
    });
  }
  law("a step with multipliers differs from its vector by a normal one", 1e-13, [&] {
    const Point x = draw_point(manifold);
    Vector z = draw_tangent(manifold, x, 1);
    const double size = *rc::gen::element(0.0, 1e-8, 0.1, 0.5);
    if (const double reach = manifold.reach(z); reach > 0) z *= size / reach;
    const Vector free = draw_ambient(manifold);
    Vector tangent = free;
    manifold.project(x, tangent);
    z += free - tangent;
    Point to;
    Vector moved;
    if (!manifold.orthographic(x, z, to, moved)) return 1.0;
    Vector normal = to - x - z;
    manifold.project(x, normal);
    return worst({normal.norm(), (to - x - moved).norm()});
  });
  if (manifold.offers(ManifoldRetraction::exponential)) {
    law("the logarithm inverts the exponential", 1e-11, [&] {
      const Point x = draw_point(manifold);
      const Vector v = draw_tangent(manifold, x, 1);
      Point to;
      Vector back;
      if (!manifold.retract(ManifoldRetraction::exponential, x, v, to)) return 1.0;
      if (!manifold.logarithm(x, to, back)) throw NotSampled("the logarithm is not known in closed form");
      return (back - v).norm();
    });
    law("the Hessian is the second derivative along geodesics", 1e-5, [&] {
      const Point x = draw_point(manifold);
      const Vector v = draw_tangent(manifold, x, 1);
      const Vector b = draw_ambient(manifold);
      const Vector d = draw_ambient(manifold);
      const auto f = [&](double t) {
        Point to;
        return manifold.retract(ManifoldRetraction::exponential, x, t * v, to)
                   ? b.dot(to) + 0.5 * to.dot(d.cwiseProduct(to))
                   : std::nan("");
      };
      constexpr double e = 1e-3;
      const double second = (16 * (f(e) + f(-e)) - f(2 * e) - f(-2 * e) - 30 * f(0)) / (12 * e * e);
      Vector h = d.cwiseProduct(v);
      manifold.hessian(x, b + d.cwiseProduct(x), v, h);
      return std::abs(second - v.dot(h)) / (1 + b.norm());
    });
  }
  return report;
}

/// "the gradient is that of the value", "the Hessian is that of the gradient", and where a Lipschitz constant of the
/// Riemannian gradient is declared, "curvatures stay below the Lipschitz constant": at random points of the manifold.
inline LawReport objective_laws(const optimisation::Manifold& manifold, const optimisation::Objective& objective) {
  using optimisation::Problem, optimisation::EvaluatedPoint, optimisation::Vector;
  using namespace detail;
  LawReport report{objective.name(), {}};
  const auto at = [&] {
    EvaluatedPoint state;
    state.x = draw_point(manifold);
    Problem problem(manifold, objective);
    problem.evaluate(state);
    return state;
  };
  report.laws.push_back(check_law("the gradient is that of the value", 1e-7, [&] {
    constexpr double e = 1e-5;
    const EvaluatedPoint state = at();
    const Vector v = draw_ambient(manifold);
    const double slope = (objective.value(state.x + e * v) - objective.value(state.x - e * v)) / (2 * e);
    return std::abs(slope - state.euclidean.dot(v)) / (v.norm() * state.euclidean.norm() + std::abs(state.value));
  }));
  report.laws.push_back(check_law("the Hessian is that of the gradient", 1e-6, [&] {
    constexpr double e = 1e-5;
    const EvaluatedPoint state = at();
    const Vector v = draw_ambient(manifold);
    Vector h(v.size());
    Vector there(v.size());
    Vector back(v.size());
    objective.hessian(state.x, v, h);
    objective.evaluate(state.x + e * v, there);
    objective.evaluate(state.x - e * v, back);
    return ((there - back) / (2 * e) - h).norm() / (h.norm() + state.euclidean.norm());
  }));
  if (const auto lipschitz = objective.lipschitz())
    report.laws.push_back(check_law("curvatures stay below the Lipschitz constant", 1, [&] {
      const EvaluatedPoint state = at();
      Problem problem(manifold, objective);
      const Vector v = draw_tangent(manifold, state.x, 1);
      Vector h(v.size());
      problem.hessian(state, v, h);
      return h.norm() / *lipschitz;
    }));
  return report;
}

}  // namespace lagroid::laws
