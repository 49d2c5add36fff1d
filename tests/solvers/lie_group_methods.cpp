// Lie group integrators: the spaces they act on, their orders, and what breaks them.
#include <lagroid/core/testing/homogeneous_laws.hpp>
#include <lagroid/groupoids/groups/se3.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/groups/translations.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/groupoids/spheres.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/solvers/lie_group/magnus.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "../support/allocation_counter.hpp"
#include "../support/broken.hpp"

using namespace lagroid;

namespace solvers_lie_group_methods_tests {
namespace {

constexpr int any = Eigen::Dynamic;

template <class M> auto on_space(const M& space) {
  return [space] {
    typename M::Point z = space.zero_point();
    for (int i = 0; i < z.cols(); ++i) {
      Vector<double, 3> q(laws::draw_uniform(), laws::draw_uniform(), 2 + laws::draw_uniform());
      q.normalize();
      z.col(i).template head<3>() = q;
      if (z.rows() == 6) {
        const Vector<double, 3> p(laws::draw_uniform(), laws::draw_uniform(), laws::draw_uniform());
        z.col(i).template tail<3>() = p - q * q.dot(p);
      }
    }
    return z;
  };
}

template <class Group> auto on_group() {
  return [] { return Group::exp(laws::draw_vector<Group::dimension>(2.0)); };
}

template <int R, int C> Matrix<double, R, C> draw_matrix() {
  Matrix<double, R, C> y;
  for (Eigen::Index i = 0; i < y.size(); ++i) y.data()[i] = laws::draw_uniform();
  return y;
}

TEST(HomogeneousSpaces, FulfilTheLaws) {
  const auto holds = [](const laws::LawReport& report) { EXPECT_TRUE(report.holds()) << report; };
  holds(laws::homogeneous_laws(Spheres<2>{}, on_space(Spheres<2>{})));
  holds(laws::homogeneous_laws(Spheres<any>{3}, on_space(Spheres<any>{3})));
  holds(laws::homogeneous_laws(CotangentSpheres<1>{}, on_space(CotangentSpheres<1>{})));
  holds(laws::homogeneous_laws(CotangentSpheres<any>{3}, on_space(CotangentSpheres<any>{3})));
  holds(laws::homogeneous_laws(SpheresAndVectors<1>{}, on_space(SpheresAndVectors<1>{})));
  holds(laws::homogeneous_laws(SpheresAndVectors<any>{3}, on_space(SpheresAndVectors<any>{3})));
  holds(laws::homogeneous_laws(Translations<SO3>{}, on_group<SO3>()));
  holds(laws::homogeneous_laws(Translations<SE3>{}, on_group<SE3>()));
  holds(laws::homogeneous_laws(LinearAction<3, 2>{}, draw_matrix<3, 2>, 0.7));
  holds(laws::homogeneous_laws(EuclideanSpace<4>{}, draw_matrix<4, 1>));
}

template <class M> struct WrongBracket : M {
  using Algebra = typename M::Algebra;
  void bracket(const Algebra& u, const Algebra& v, Algebra& w) const { M::bracket(v, u, w); }
};
struct WrongAction : CotangentSpheres<1> {
  void act(const Algebra& u, Point& z) const {
    CotangentSpheres<1>::act(u, z);
    z.tail<3>() += 1e-4 * cross(V(u.tail<3>()), V(z.head<3>()));
  }
};
struct WrongGenerator : CotangentSpheres<1> {
  void generator(const Algebra& u, const Point& z, Point& v) const {
    v << cross(V(u.head<3>()), V(z.head<3>())), cross(V(u.tail<3>()), V(z.head<3>()));
  }
};
struct OffTheSphere : CotangentSpheres<1> {
  void act(const Algebra& u, Point& z) const {
    Point v = z;
    CotangentSpheres<1>::generator(u, z, v);
    z += v;
  }
};

TEST(HomogeneousSpaces, BrokenOnesBreakTheirLaw) {
  const auto draw = on_space(CotangentSpheres<1>{});
  const std::string conjugation = "exp(u) exp(v) exp(-u) = exp(exp(ad u) v)";
  EXPECT_TRUE(laws::seen_broken(laws::homogeneous_laws(WrongBracket<CotangentSpheres<1>>{}, draw).law(conjugation)));
  EXPECT_TRUE(laws::seen_broken(laws::homogeneous_laws(WrongAction{}, draw).law("exp(s u) exp(t u) = exp((s + t) u)")));
  EXPECT_TRUE(laws::seen_broken(laws::homogeneous_laws(WrongGenerator{}, draw).law("u_M = d/dt exp(t u)")));
  EXPECT_TRUE(laws::seen_broken(laws::homogeneous_laws(OffTheSphere{}, draw).law("the action stays on M")));
}

TEST(HomogeneousSpaces, StepsAreTargetsOfArrowsOfTheActionGroupoid) {
  // SO(3) acts from the right on directions by m R = R^T m: exp(u) q is the target of the arrow (exp(-u), q).
  using Groupoid = Action<SO3, RotatedDirections>;
  const Groupoid groupoid;
  const Vector<double, 3> u(0.3, -0.7, 0.4);
  Spheres<1>::Point q(0.6, 0, 0.8);
  const auto arrow = groupoid.tau(Vector<double, 3>(q), Vector<double, 3>(-u));
  Spheres<1>{}.act(u, q);
  EXPECT_LT((q - groupoid.target(arrow)).norm(), 1e-15);
}

// On two spheres, a field that depends on time and does not commute with itself.
struct Swirl {
  template <class Z> void operator()(double t, const Z& z, Z& u) const {
    for (int i = 0; i < z.cols(); ++i) {
      const int j = (i + 1) % int(z.cols());
      for (int r = 0; r < z.rows(); ++r)
        u(r, i) = std::cos(z(r, i) + 0.2 * t * (r + 1)) + 0.7 * std::sin(z((r + 1) % int(z.rows()), i) * z(r, j));
    }
  }
};

template <class M, class F>
typename M::Point flow(const M& space, F field, const LieGroupMethod& method, typename M::Point z, double horizon,
                       int steps) {
  LieGroupStep<M> step(space, method);
  const double h = horizon / steps;
  for (int n = 0; n < steps; ++n) step.advance(field, n * h, h, z);
  return z;
}

template <class P> Eigen::VectorXd flat(const P& z) { return Eigen::Map<const Eigen::VectorXd>(z.data(), z.size()); }

template <class M, class F>
laws::OrderProblem problem(const M& space, const F& field, const typename M::Point& start, const LieGroupMethod& method,
                           int coarsest = 20) {
  constexpr double horizon = 2;
  return {[=](int steps) { return flat(flow(space, field, method, start, horizon, steps)); },
          flat(flow(space, field, lie_group_methods::munthe_kaas_54, start, horizon, 1000)), coarsest, 1e-11};
}

CotangentSpheres<2>::Point swirl_start() {
  CotangentSpheres<2>::Point z;
  z.col(0) << 0.6, 0, 0.8, 0.8, 0.5, -0.6;
  z.col(1) << 0, 1, 0, -0.3, 0, 0.9;
  return z;
}

TEST(LieGroupMethods, HaveTheirOrder) {
  const Spheres<2>::Point directions = swirl_start().topRows<3>();
  for (const auto& method : lie_group_methods::all) {
    const auto traits = traits_of(method);
    for (const auto& report :
         {laws::order_laws(traits, problem(CotangentSpheres<2>{}, Swirl{}, swirl_start(), method)),
          laws::order_laws(traits, problem(CotangentSpheres<any>{2}, Swirl{}, swirl_start(), method)),
          laws::order_laws(traits, problem(Spheres<2>{}, Swirl{}, directions, method))})
      EXPECT_TRUE(report.holds()) << report;
  }
}

TEST(LieGroupMethods, ReferencesAreRight) {
  // The reference of the orders is one of the methods: the classical one, which shares nothing with it, ends there too.
  const auto by = [](const LieGroupMethod& method) {
    return flow(CotangentSpheres<2>{}, Swirl{}, method, swirl_start(), 1, 4000);
  };
  EXPECT_LT((by(lie_group_methods::munthe_kaas_54) - by(lie_group_methods::runge_kutta_4)).norm(), 1e-11);
}

TEST(LieGroupMethods, WrongOnesAreCaughtByTheirOrder) {
  const auto caught = [](const auto& space, const LieGroupMethod& method) {
    laws::OrderProblem asked = problem(CotangentSpheres<2>{}, Swirl{}, swirl_start(), method);
    asked.end = [space, method](int steps) { return flat(flow(space, Swirl{}, method, swirl_start(), 2, steps)); };
    return laws::seen_broken(laws::order_laws(traits_of(method), asked).law("the error falls as declared"));
  };
  const CotangentSpheres<2> space;
  EXPECT_FALSE(caught(space, lie_group_methods::munthe_kaas_4));
  EXPECT_TRUE(caught(WrongBracket<CotangentSpheres<2>>{}, lie_group_methods::munthe_kaas_4));
  EXPECT_TRUE(caught(WrongBracket<CotangentSpheres<2>>{}, lie_group_methods::munthe_kaas_54));
  LieGroupMethod swapped = lie_group_methods::commutator_free_4;
  std::swap(swapped.products[4].weights[0], swapped.products[4].weights[1]);
  EXPECT_TRUE(caught(space, swapped));
  LieGroupMethod restarted = lie_group_methods::commutator_free_4;
  restarted.products[3].from = 0;
  EXPECT_TRUE(caught(space, restarted));
  LieGroupMethod reversed = lie_group_methods::crouch_grossman_3;
  std::swap(reversed.products[3].weights[0], reversed.products[3].weights[2]);
  EXPECT_TRUE(caught(space, reversed));
}

TEST(LieGroupMethods, StayOnTheManifoldAndClassicalOnesDoNot) {
  for (const auto& method : lie_group_methods::all) {
    LieGroupIntegrator integrator(CotangentSpheres<2>{}, Swirl{}, method, swirl_start(), 0.05);
    double off = 0;
    for (int n = 0; n < 2000; ++n) {
      ASSERT_TRUE(integrator.advance().converged()) << method.name;
      for (int i = 0; i < 2; ++i) {
        const Vector<double, 3> q = integrator.point().col(i).head<3>();
        const Vector<double, 3> p = integrator.point().col(i).tail<3>();
        off = std::max({off, std::abs(q.squaredNorm() - 1), std::abs(q.dot(p)) / (1 + p.norm())});
      }
      if (off > 1e-2) break;
    }
    if (method.scheme == LieGroupScheme::classical) {
      EXPECT_GT(off, 1e-5) << method.name;
    } else {
      EXPECT_LT(off, 1e-14) << method.name;
    }
  }
}

TEST(LieGroupMethods, AllocateNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "allocations are not counted here";
  for (const auto& method : lie_group_methods::all) {
    LieGroupIntegrator integrator(CotangentSpheres<any>{2}, Swirl{}, method, swirl_start(), 0.01);
    integrator.advance();
    const long before = allocation_count();
    for (int n = 0; n < 100; ++n) integrator.advance();
    EXPECT_EQ(allocation_count(), before) << method.name;
  }
}

TEST(LieGroupMethods, StopAtNumbersThatAreNotFinite) {
  const auto field = [](double t, const Spheres<1>::Point&, Spheres<1>::Algebra& u) {
    u.setConstant(t > 0.35 ? std::numeric_limits<double>::quiet_NaN() : 1.0);
  };
  LieGroupIntegrator integrator(Spheres<1>{}, field, lie_group_methods::commutator_free_4, Spheres<1>::Point(0, 0, 1),
                                0.1);
  StepReport report;
  do {
    report = integrator.advance();
  } while (report.converged());
  EXPECT_EQ(report.status, SolveStatus::not_finite);
  EXPECT_NEAR(integrator.time(), 0.3, 1e-12);
  EXPECT_TRUE(integrator.point().allFinite());
}

TEST(ControlledSteps, ReachTheEndWithinTheirTolerance) {
  const auto exact = flow(CotangentSpheres<2>{}, Swirl{}, lie_group_methods::munthe_kaas_54, swirl_start(), 3, 20000);
  double last = 1;
  long steps = 0;
  for (const double tolerance : {1e-4, 1e-7, 1e-10, 1e-13}) {
    ControlledLieGroupIntegrator integrator(CotangentSpheres<2>{}, Swirl{}, lie_group_methods::munthe_kaas_54,
                                            swirl_start(), {.tolerance = tolerance});
    ASSERT_TRUE(integrator.advance_to(1).converged());
    EXPECT_EQ(integrator.time(), 1);
    ASSERT_TRUE(integrator.advance_to(3).converged());
    EXPECT_EQ(integrator.time(), 3);
    const double error = (integrator.point() - exact).norm();
    EXPECT_LT(error, 1e3 * tolerance);
    EXPECT_LT(error, last);
    EXPECT_GT(integrator.steps(), steps);
    last = error;
    steps = integrator.steps();
  }
}

TEST(ControlledSteps, SayWhyTheyStop) {
  using Point = Spheres<1>::Point;
  const auto begin = [](const auto& field, const LieGroupMethod& method, double tolerance) {
    return ControlledLieGroupIntegrator(Spheres<1>{}, field, method, Point(0, 0, 1), {.tolerance = tolerance});
  };
  const auto stops = [&](const auto& field, SolveStatus why) {
    auto integrator = begin(field, lie_group_methods::munthe_kaas_54, 1e-12);
    EXPECT_EQ(to_string(integrator.advance_to(2).status), to_string(why));
    EXPECT_LE(integrator.time(), 1);
    EXPECT_GT(integrator.time(), 0.99);
    EXPECT_TRUE(integrator.point().allFinite());
  };
  const auto undefined = [](double t, const Point&, Point& u) { u.setConstant(t < 1 ? 1.0 : std::nan("")); };
  const auto jump = [](double t, const Point&, Point& u) { u.setConstant(t < 1 ? 1.0 : 1e300); };
  stops(undefined, SolveStatus::not_finite);
  stops(jump, SolveStatus::not_finite);
  const auto singular = [](double t, const Point&, Point& u) { u.setConstant(1 / (1 - t)); };
  auto integrator = begin(singular, lie_group_methods::munthe_kaas_54, 1e-12);
  EXPECT_FALSE(integrator.advance_to(2).converged());
  EXPECT_LE(integrator.time(), 1);
  EXPECT_THROW(begin(undefined, lie_group_methods::commutator_free_4, 1e-12), std::invalid_argument);
  EXPECT_THROW(begin(undefined, lie_group_methods::munthe_kaas_54, std::nan("")), std::invalid_argument);
}

/// Y' = A(t) Y; A(t) does not commute with A(s).
struct Airy {
  void operator()(double t, Matrix<double, 2, 2>& a) const { a << 0.1 * t, 1, -1 - t * t, std::cos(3 * t); }
  void operator()(double t, const Vector<double, 2>&, Matrix<double, 2, 2>& a) const { (*this)(t, a); }
};
/// A body turning at a given rate in space, R' = hat(w(t)) R.
struct Turning {
  void operator()(double t, Vector<double, 3>& w) const { w << std::sin(2 * t), 1 + t * t, std::cos(5 * t); }
};

template <class M, class A>
laws::OrderProblem magnus_problem(const M& space, const A& field, const typename M::Point& start, int order) {
  const auto end = [=](int by, int steps) {
    MagnusStep<M> step(space, by);
    A a = field;
    auto z = start;
    for (int n = 0; n < steps; ++n) step.advance(a, 2.0 * n / steps, 2.0 / steps, z);
    return flat(z);
  };
  return {[=](int steps) { return end(order, steps); }, end(6, 3000), 8, 1e-12};
}

TEST(Magnus, HasItsOrder) {
  for (const int order : {2, 4, 6}) {
    const auto traits = MagnusStep<LinearAction<2>>({}, order).traits();
    const auto linear =
        laws::order_laws(traits, magnus_problem(LinearAction<2>{}, Airy{}, Vector<double, 2>(1, 0.5), order));
    EXPECT_TRUE(linear.holds()) << linear;
    const auto turning =
        laws::order_laws(traits, magnus_problem(Translations<SO3>{}, Turning{}, SO3::Arrow<double>::Identity(), order));
    EXPECT_TRUE(turning.holds()) << turning;
  }
  const auto classical =
      flow(LinearAction<2>{}, Airy{}, lie_group_methods::runge_kutta_4, Vector<double, 2>(1, 0.5), 2, 6000);
  EXPECT_LT((magnus_problem(LinearAction<2>{}, Airy{}, Vector<double, 2>(1, 0.5), 6).exact - classical).norm(), 1e-11);
}

TEST(Magnus, WrongBracketsAreCaughtByItsOrder) {
  for (const int order : {4, 6}) {
    auto asked = magnus_problem(Translations<SO3>{}, Turning{}, SO3::Arrow<double>::Identity(), order);
    asked.end = magnus_problem(WrongBracket<Translations<SO3>>{}, Turning{}, SO3::Arrow<double>::Identity(), order).end;
    const auto report = laws::order_laws(MagnusStep<LinearAction<2>>({}, order).traits(), asked);
    EXPECT_TRUE(laws::seen_broken(report.law("the error falls as declared"))) << report;
  }
  EXPECT_THROW(MagnusStep<LinearAction<2>>({}, 3), std::invalid_argument);
}

TEST(LieGroupMethods, OnVectorSpacesAreTheClassicalOnes) {
  struct Oscillator {
    void operator()(double, const Vector<double, 2>& z, Vector<double, 2>& u) const { u << z(1), -std::sin(z(0)); }
  };
  const Vector<double, 2> start(1, 0);
  const auto by = [&](const LieGroupMethod& method) {
    return flow(EuclideanSpace<2>{}, Oscillator{}, method, start, 2, 37);
  };
  EXPECT_LT((by(lie_group_methods::munthe_kaas_4) - by(lie_group_methods::runge_kutta_4)).norm(), 1e-15);
  EXPECT_LT((by(lie_group_methods::lie_euler) - by(lie_group_methods::euler)).norm(), 1e-15);
}

}  // namespace
}  // namespace solvers_lie_group_methods_tests
