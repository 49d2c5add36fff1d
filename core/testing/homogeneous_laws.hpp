#pragma once
/// The laws of a group acting on a manifold, as a test suite that any homogeneous space runs by naming itself: exp(s u)
/// exp(t u) z = exp((s + t) u) z, the action stays on M, u_M is its derivative, and the bracket is that of the group.
///
///     EXPECT_TRUE(lagroid::laws::homogeneous_laws(MySpace{}, draw_point).holds());
///
/// Requires RapidCheck, a `draw_point` that returns a random point of M, and a `name()` of the space. Returns a
/// LawReport.

#include <lagroid/core/hamiltonian/homogeneous_space.hpp>
#include <lagroid/core/testing/property.hpp>

#include <string>

namespace lagroid::laws {

/// The laws of HomogeneousSpace, with `draw_point()` a random point of M. Algebra elements are drawn with entries up to
/// `large`.
template <HomogeneousSpace M, class DrawPoint>
LawReport homogeneous_laws(const M& space, const DrawPoint& draw_point, double large = 2, double tolerance = 1e-12) {
  using Point = typename M::Point;
  using Algebra = typename M::Algebra;
  const auto draw = [&] {
    const double size = *rc::gen::element(0.0, 1e-12, 1e-8, 1e-3, 0.3, 1.0, large);
    Algebra u = space.zero_algebra();
    for (Eigen::Index i = 0; i < u.size(); ++i) u.data()[i] = size * draw_uniform();
    return u;
  };
  const auto defect = [](const auto& x, const auto& y) {
    if (!x.allFinite() || !y.allFinite()) return std::numeric_limits<double>::infinity();
    return (x - y).cwiseAbs().maxCoeff() / (1 + y.cwiseAbs().maxCoeff());
  };
  const auto moved = [&](const Algebra& u, Point z) {
    space.act(u, z);
    return z;
  };
  const auto bracket = [&](const Algebra& u, const Algebra& v) {
    Algebra w = space.zero_algebra();
    space.bracket(u, v, w);
    return w;
  };
  const auto generator = [&](const Algebra& u, const Point& z) {
    Point v = space.zero_point();
    space.generator(u, z, v);
    return v;
  };

  LawReport report{space.name(), {}};
  const auto law = [&](const char* name, double bound, const auto& of_sample) {
    report.laws.push_back(check_law(name, bound, of_sample));
  };
  law("exp(0) moves nothing", 0, [&] {
    const Point z = draw_point();
    return defect(moved(space.zero_algebra(), z), z);
  });
  law("exp(s u) exp(t u) = exp((s + t) u)", tolerance, [&] {
    const Algebra u = draw();
    const Point z = draw_point();
    const double s = draw_uniform();
    const double t = draw_uniform();
    return defect(moved(u * s, moved(u * t, z)), moved(u * (s + t), z));
  });
  law("the action stays on M", tolerance, [&] {
    const Point z = moved(draw(), draw_point());
    Point nearest = z;
    space.project(nearest);
    return defect(z, nearest);
  });
  law("u_M = d/dt exp(t u)", 1e-9, [&] {
    const Algebra u = draw();
    const Point z = draw_point();
    constexpr double t = 1e-3;
    const auto slope = [&](double h) { return Point((moved(u * h, z) - moved(u * -h, z)) / (2 * h)); };
    return defect(Point((4.0 * slope(t) - slope(2 * t)) / 3), generator(u, z));
  });
  law("u_M is linear in u", tolerance, [&] {
    const Algebra u = draw();
    const Algebra v = draw();
    const Point z = draw_point();
    const double s = draw_uniform();
    return defect(generator(u + v * s, z), Point(generator(u, z) + generator(v, z) * s));
  });
  law("exp(u) exp(v) exp(-u) = exp(exp(ad u) v)", tolerance, [&] {
    const Algebra u = draw();
    const Algebra v = draw();
    const Point z = draw_point();
    Algebra sum = v;
    Algebra term = v;
    for (int n = 1; n < 60; ++n) {
      term = bracket(u, term) * (1.0 / n);
      sum += term;
    }
    return defect(moved(u, moved(v, moved(-u, z))), moved(sum, z));
  });
  law("the bracket is antisymmetric and fulfils Jacobi's identity", tolerance, [&] {
    const Algebra u = draw();
    const Algebra v = draw();
    const Algebra w = draw();
    const Algebra cyclic = bracket(u, bracket(v, w)) + bracket(v, bracket(w, u)) + bracket(w, bracket(u, v));
    return worst({defect(bracket(u, v), Algebra(-bracket(v, u))), defect(cyclic, space.zero_algebra())});
  });
  return report;
}

}  // namespace lagroid::laws
