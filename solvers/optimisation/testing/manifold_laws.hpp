#pragma once
/// Laws of manifolds and of functions on them, for your own: metric, projections, retractions, logarithm, transport,
/// Hessian and curvature at random points; gradients and Hessians of an objective against differences.
///
///     const laws::LawReport report = laws::manifold_laws(optimisation::Sphere(3));
///     std::cout << report;  // report.holds(): all of them
///
/// Requires a manifold whose `nearest` succeeds from random matrices, or else a draw of what it succeeds from.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>
#include <lagroid/solvers/optimisation/minimise.hpp>
#include <lagroid/solvers/optimisation/objective.hpp>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace lagroid::laws {

/// What `nearest` takes to a random point; where it is empty, a matrix with entries in [-1, 1].
using PointDraw = std::function<optimisation::Point()>;

namespace detail {

inline optimisation::Vector draw_ambient(const optimisation::Manifold& manifold) {
  optimisation::Vector v(manifold.size());
  for (double& x : v) x = draw_uniform();
  return v;
}
inline optimisation::Point draw_point(const optimisation::Manifold& manifold, const PointDraw& draw) {
  optimisation::Point x = draw ? draw() : draw_ambient(manifold);
  if (!manifold.nearest(x)) throw NotSampled("no nearest point");
  return x;
}
/// Of length `size`.
inline optimisation::Vector draw_tangent(const optimisation::Manifold& manifold, const optimisation::Point& x,
                                         double size) {
  optimisation::Vector v = draw_ambient(manifold);
  manifold.project(x, v);
  return size / manifold.norm(x, v) * v;
}
/// The end of the geodesic along v.
inline optimisation::Point geodesic_end(const optimisation::Manifold& manifold, const optimisation::Point& x,
                                        const optimisation::Vector& v) {
  optimisation::Point to;
  if (!manifold.retract(optimisation::ManifoldRetraction::exponential, x, v, to))
    throw std::runtime_error("there is no geodesic of this length");
  return to;
}
inline optimisation::Vector transported(const optimisation::Manifold& manifold, const optimisation::Point& from,
                                        const optimisation::Point& to, optimisation::Vector v) {
  if (!manifold.parallel_transport(from, to, v)) throw NotSampled("parallel transport is not known in closed form");
  return v;
}
/// f(x) = b^T x + x^T diag(d) x / 2.
struct Quadratic {
  optimisation::Vector b;
  optimisation::Vector d;

  explicit Quadratic(const optimisation::Manifold& manifold) : b(draw_ambient(manifold)), d(draw_ambient(manifold)) {}
  double value(const optimisation::Point& x) const { return b.dot(x) + 0.5 * x.dot(d.cwiseProduct(x)); }
  optimisation::Vector differential(const optimisation::Point& x) const { return b + d.cwiseProduct(x); }
  optimisation::Vector hessian(const optimisation::Manifold& manifold, const optimisation::Point& x,
                               const optimisation::Vector& v) const {
    optimisation::Vector h = d.cwiseProduct(v);
    manifold.hessian(x, differential(x), v, h);
    return h;
  }
};

/// The laws of metric, projection and gradient; "the projection is orthogonal" of manifolds with the metric of the
/// space around.
inline void metric_laws(const optimisation::Manifold& manifold, const PointDraw& draw, LawReport& report) {
  using optimisation::Point, optimisation::Vector;
  const auto law = [&](const std::string& name, double tolerance, const auto& defect) {
    report.laws.push_back(check_law(name, tolerance, defect));
  };
  if (!manifold.has_own_metric())
    law("the projection is orthogonal", 1e-13, [&] {
      const Point x = draw_point(manifold, draw);
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
  law("the projection is the derivative of the nearest point", 1e-7, [&] {
    constexpr double e = 1e-5;
    const Point x = draw_point(manifold, draw);
    const Vector v = draw_ambient(manifold);
    Point there = x + e * v;
    Point back = x - e * v;
    if (!manifold.nearest(there) || !manifold.nearest(back)) throw NotSampled("no nearest point");
    Vector pv = v;
    manifold.project(x, pv);
    return ((there - back) / (2 * e) - pv).norm() / v.norm();
  });
  law("the metric is symmetric, linear and positive", 1e-13, [&] {
    const Point x = draw_point(manifold, draw);
    const Vector u = draw_tangent(manifold, x, 1);
    const Vector v = draw_tangent(manifold, x, 1);
    const Vector w = draw_tangent(manifold, x, 1);
    const double product = manifold.inner(x, u, v);
    const double a = draw_uniform();
    if (!(manifold.inner(x, u, u) > 0)) return 1.0;
    return worst({std::abs(product - manifold.inner(x, v, u)), std::abs(product) - 1,
                  std::abs(manifold.inner(x, u + a * w, v) - product - a * manifold.inner(x, w, v))});
  });
  law("the gradient is that of the metric", 1e-12, [&] {
    const Point x = draw_point(manifold, draw);
    const Vector differential = draw_ambient(manifold);
    const Vector v = draw_tangent(manifold, x, 1);
    Vector gradient = differential;
    manifold.gradient(x, gradient);
    Vector back = v;
    manifold.differential(x, back);
    const double lowered = std::abs(back.dot(gradient) - manifold.inner(x, v, gradient));
    manifold.gradient(x, back);
    const double scale = manifold.norm(x, gradient) + differential.norm() * v.norm();
    return worst({std::abs(manifold.inner(x, gradient, v) - differential.dot(v)) / scale, lowered / scale,
                  manifold.norm(x, back - v)});
  });
}

/// The laws of exponential, logarithm, parallel transport, Hessian and curvature.
inline void geodesic_laws(const optimisation::Manifold& manifold, const PointDraw& draw, LawReport& report) {
  using optimisation::Point, optimisation::Vector;
  const auto law = [&](const std::string& name, double tolerance, const auto& defect) {
    report.laws.push_back(check_law(name, tolerance, defect));
  };
  const auto logarithm = [&](const Point& x, const Point& y) {
    Vector v;
    if (!manifold.logarithm(x, y, v)) throw NotSampled("the logarithm is not known in closed form");
    return v;
  };
  law("the logarithm inverts the exponential", 1e-11, [&] {
    const Point x = draw_point(manifold, draw);
    const Vector v = draw_tangent(manifold, x, 1);
    return manifold.norm(x, logarithm(x, geodesic_end(manifold, x, v)) - v);
  });
  law("the Hessian is the second derivative along geodesics", 1e-5, [&] {
    const Point x = draw_point(manifold, draw);
    const Vector v = draw_tangent(manifold, x, 1);
    const Quadratic quadratic(manifold);
    const auto f = [&](double t) { return quadratic.value(geodesic_end(manifold, x, t * v)); };
    constexpr double e = 1e-3;
    const double second = (16 * (f(e) + f(-e)) - f(2 * e) - f(-2 * e) - 30 * f(0)) / (12 * e * e);
    return std::abs(second - manifold.inner(x, v, quadratic.hessian(manifold, x, v))) / (1 + quadratic.b.norm());
  });
  law("parallel transport is an isometry that carries geodesics along", 1e-11, [&] {
    const Point x = draw_point(manifold, draw);
    const Vector along = draw_tangent(manifold, x, 1);
    const Point y = geodesic_end(manifold, x, along);
    const Vector u = draw_tangent(manifold, x, 1);
    const Vector v = draw_tangent(manifold, x, 1);
    const Vector there = transported(manifold, x, y, u);
    return worst({std::abs(manifold.inner(y, there, transported(manifold, x, y, v)) - manifold.inner(x, u, v)),
                  manifold.norm(y, transported(manifold, x, y, along) + logarithm(y, x)),
                  manifold.norm(x, transported(manifold, y, x, there) - u)});
  });
  law("parallel transport goes on along a geodesic", 1e-11, [&] {
    const Point x = draw_point(manifold, draw);
    const Vector along = draw_tangent(manifold, x, 1);
    const Point y = geodesic_end(manifold, x, 0.3 * along);
    const Point z = geodesic_end(manifold, x, along);
    const Vector u = draw_tangent(manifold, x, 1);
    return manifold.norm(z,
                         transported(manifold, y, z, transported(manifold, x, y, u)) - transported(manifold, x, z, u));
  });
  law("gradients change along transported vectors by the Hessian", 1e-6, [&] {
    constexpr double e = 1e-4;
    const Point x = draw_point(manifold, draw);
    const Vector along = draw_tangent(manifold, x, 1);
    const Vector u = draw_tangent(manifold, x, 1);
    const Quadratic quadratic(manifold);
    const auto slope = [&](double t) {
      const Point y = geodesic_end(manifold, x, t * along);
      Vector gradient = quadratic.differential(y);
      manifold.gradient(y, gradient);
      return manifold.inner(y, gradient, transported(manifold, x, y, u));
    };
    return std::abs((slope(e) - slope(-e)) / (2 * e) - manifold.inner(x, u, quadratic.hessian(manifold, x, along))) /
           (1 + quadratic.b.norm());
  });
  if (manifold.dimension() < 2) return;
  law("curvatures are not below their bound", 1e-2, [&] {
    // Of two geodesics at a right angle: their ends are |u - v|^2 t^2 - K t^4 / 3 apart, squared.
    constexpr double t = 0.05;
    const Point x = draw_point(manifold, draw);
    const Vector u = draw_tangent(manifold, x, 1);
    Vector v = draw_tangent(manifold, x, 1);
    v -= manifold.inner(x, u, v) * u;
    v /= manifold.norm(x, v);
    const auto apart = [&](double a, double b) {
      const Point there = geodesic_end(manifold, x, a * u);
      const Vector log = logarithm(there, geodesic_end(manifold, x, b * v));
      return manifold.inner(there, log, log);
    };
    const double mean = 0.25 * (apart(t, t) + apart(t, -t) + apart(-t, t) + apart(-t, -t));
    return manifold.least_curvature() - 3 * (2 * t * t - mean) / std::pow(t, 4);
  });
}

}  // namespace detail

/// What a manifold promises (`optimisation::Manifold`), at random points.
inline LawReport manifold_laws(const optimisation::Manifold& manifold, const PointDraw& draw = {}) {
  using optimisation::Point, optimisation::Vector, optimisation::ManifoldRetraction;
  using namespace detail;
  LawReport report{manifold.name(), {}};
  const double numbers = double(manifold.size());
  const auto law = [&](const std::string& name, double tolerance, const auto& defect) {
    report.laws.push_back(check_law(name, tolerance, defect));
  };

  law("nearest points lie on it", 1e-15 * numbers, [&] { return manifold.residual(draw_point(manifold, draw)); });
  metric_laws(manifold, draw, report);
  law("projected vectors are tangent", 1e-4, [&] {
    constexpr double e = 1e-6;
    const Point x = draw_point(manifold, draw);
    return manifold.residual(x + draw_tangent(manifold, x, e)) / e;
  });
  law("normal vectors are those that the penalty pulls along", 1e-8, [&] {
    const Point x = draw_point(manifold, draw);
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
      const Point x = draw_point(manifold, draw);
      Point to;
      const double size = *rc::gen::element(0.0, 1e-12, 1e-6, 0.1, 0.4);
      if (!manifold.retract(retraction, x, draw_tangent(manifold, x, size), to)) return 1.0;
      return worst({manifold.residual(to), size == 0 ? (to - x).norm() : 0.0});
    });
    law("retraction " + name + " begins along its vector", 1e-8, [&] {
      constexpr double e = 1e-5;
      const Point x = draw_point(manifold, draw);
      const Vector v = draw_tangent(manifold, x, 1);
      Point there;
      Point back;
      if (!manifold.retract(retraction, x, e * v, there) || !manifold.retract(retraction, x, -e * v, back)) return 1.0;
      return ((there - back) / (2 * e) - v).norm() / v.norm();
    });
  }
  if (manifold.offers(ManifoldRetraction::orthographic))
    law("a step with multipliers differs from its vector by a normal one", 1e-13, [&] {
      const Point x = draw_point(manifold, draw);
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
  if (manifold.offers(ManifoldRetraction::exponential)) geodesic_laws(manifold, draw, report);
  return report;
}

/// "the gradient is that of the value", "the Hessian is that of the gradient", and where a Lipschitz constant of the
/// Riemannian gradient is declared, "curvatures stay below the Lipschitz constant", where it says that it is convex, "a
/// convex function lies above its tangents": at random points of the manifold.
inline LawReport objective_laws(const optimisation::Manifold& manifold, const optimisation::Objective& objective,
                                const PointDraw& draw = {}) {
  using optimisation::Problem, optimisation::EvaluatedPoint, optimisation::Vector;
  using namespace detail;
  LawReport report{objective.name(), {}};
  const auto at = [&] {
    EvaluatedPoint state;
    state.x = draw_point(manifold, draw);
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
      return manifold.norm(state.x, h) / *lipschitz;
    }));
  if (objective.convex() && manifold.offers(optimisation::ManifoldRetraction::exponential))
    report.laws.push_back(check_law("a convex function lies above its tangents", 1e-12, [&] {
      const EvaluatedPoint state = at();
      const Vector v = draw_tangent(manifold, state.x, 1);
      const double tangent = state.value + manifold.inner(state.x, state.gradient, v);
      return (tangent - objective.value(geodesic_end(manifold, state.x, v))) / (1 + std::abs(state.value));
    }));
  return report;
}

}  // namespace lagroid::laws
