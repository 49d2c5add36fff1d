// A system seen through numbers is the system: each function, to the bit where the compiler fuses no products with
// sums.
#include <lagroid/core/any_system/sized_system.hpp>
#include <lagroid/groupoids/pair_of.hpp>
#include <lagroid/solvers/boundary/boundary_methods.hpp>
#include <lagroid/systems/control/unicycle.hpp>
#include <lagroid/systems/pendulums/damped_pendulum.hpp>
#include <lagroid/systems/rolling/chaplygin_sleigh.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

#include "../solvers/boundary/boundary_cases.hpp"
#include "../support/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <random>

namespace lagroid::core_any_system_tests {
namespace {

/// Whether two results of the same function are the same. Compiled twice they are to the bit, but for products that are
/// fused with sums in one place and not in the other.
#ifdef __FP_FAST_FMA
constexpr double fused = 1e-12;
#else
constexpr double fused = 0;
#endif
bool same(double a, double b) { return std::abs(a - b) <= fused * (1 + std::abs(b)); }
bool same(const double* a, const double* b, Eigen::Index count) {
  double size = 0;
  for (Eigen::Index i = 0; i < count; ++i) size = std::max(size, std::abs(b[i]));
  for (Eigen::Index i = 0; i < count; ++i)
    if (!(std::abs(a[i] - b[i]) <= fused * (1 + size))) return false;
  return true;
}
template <class A, class B> bool same(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return a.size() == b.size() && same(a.derived().data(), b.derived().data(), b.size());
}

/// Everything that an AnySystem is asked, of one arrow, beside what the typed system answers.
template <class Sys> class Asked {
 public:
  using G = typename Sys::GroupoidType;
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;
  using Fibre = Vector<double, n>;
  using Numbers = Vector<double, G::arrow_coordinate_count()>;
  using ObjectNumbers = Vector<double, G::object_coordinate_count()>;

  explicit Asked(const Sys& system) : system_(system), any_(system) {}

  void about(const ObjectOf<G>& q, const Fibre& v, const Fibre& w, const typename Sys::Multipliers& lambda) {
    const G& groupoid = system_.groupoid;
    const AnySystem& any = any_;
    const ArrowOf<G> g = groupoid.tau(q, v);
    const ArrowOf<G> next = groupoid.tau(groupoid.target(g), w);
    const Numbers x = groupoid.coordinates_of_arrow(g);
    const Numbers y = groupoid.coordinates_of_arrow(next);
    const ObjectNumbers p = groupoid.coordinates_of_object(q);
    Numbers arrow;
    Fibre fibre;
    const auto is = [&](const char* what, const ArrowOf<G>& expected) {
      EXPECT_TRUE(same(arrow, Numbers(groupoid.coordinates_of_arrow(expected)))) << what;
    };
    any.tau(p.data(), v.data(), arrow.data());
    is("tau", g);
    any.unit(p.data(), arrow.data());
    is("unit", groupoid.unit(q));
    any.inverse(x.data(), arrow.data());
    is("inverse", groupoid.inverse(g));
    any.compose(x.data(), y.data(), arrow.data());
    is("compose", groupoid.compose(g, next));
    any.multiply(x.data(), y.data(), arrow.data());
    is("multiply", groupoid.multiply(g, next));
    any.project(x.data(), arrow.data());
    is("project", groupoid.project(g));
    any.extend(x.data(), w.data(), arrow.data());
    is("extend", groupoid.extend(g, w));
    any.arrow_in_chart(p.data(), v.data(), arrow.data());
    is("arrow_in_chart", groupoid.arrow_in_chart(q, v));
    any.left_invariant(x.data(), w.data(), arrow.data());
    EXPECT_TRUE(same(arrow, Numbers(groupoid.left_invariant(g, w))));
    any.tau_inverse(x.data(), fibre.data());
    EXPECT_TRUE(same(fibre, Fibre(groupoid.tau_inverse(g))));
    any.chart(x.data(), fibre.data());
    EXPECT_TRUE(same(fibre, Fibre(groupoid.chart(g))));
    any.coordinate_scale(x.data(), fibre.data());
    EXPECT_TRUE(same(fibre, Fibre(groupoid.coordinate_scale(g))));
    any.momentum_change(x.data(), v.data(), w.data(), fibre.data());
    EXPECT_TRUE(same(fibre, Fibre(groupoid.momentum_change(g, v, w))));
    ObjectNumbers object;
    any.source(x.data(), object.data());
    EXPECT_TRUE(same(object, ObjectNumbers(groupoid.coordinates_of_object(groupoid.source(g)))));
    any.target(x.data(), object.data());
    EXPECT_TRUE(same(object, ObjectNumbers(groupoid.coordinates_of_object(groupoid.target(g)))));
    {
      ArrowOf<G> moved = g;
      const Fibre small = 1e-16 * w;
      const Fibre left = groupoid.correct(moved, small);
      arrow = x;
      any.correct(arrow.data(), small.data(), fibre.data());
      is("correct", moved);
      EXPECT_TRUE(same(fibre, left));
    }
    {
      ArrowOf<G> back = groupoid.inverse(groupoid.tau(q, Fibre(0.1 * w)));
      ArrowOf<G> product = groupoid.unit(groupoid.source(back));
      ArrowOf<G> moved = g;
      Numbers flat_back = groupoid.coordinates_of_arrow(back);
      Numbers flat_product = groupoid.coordinates_of_arrow(product);
      displace_next(groupoid, g, Fibre(0.1 * v), back, moved, product);
      any.displace_next(x.data(), Fibre(0.1 * v).data(), flat_back.data(), arrow.data(), flat_product.data());
      is("displace_next", moved);
      EXPECT_TRUE(same(flat_back, Numbers(groupoid.coordinates_of_arrow(back))));
      EXPECT_TRUE(same(flat_product, Numbers(groupoid.coordinates_of_arrow(product))));
    }
    about_derivatives(g, x, lambda);
  }

  const AnySystemOf<Sys>& any() const { return any_; }

 private:
  void about_derivatives(const ArrowOf<G>& g, const Numbers& x, const typename Sys::Multipliers& lambda) {
    const AnySystem& any = any_;
    EXPECT_TRUE(same(any.lagrangian(x.data()), system_.lagrangian(g)));
    SecondDerivatives<n, m> found;
    const SecondDerivativesTo to{
        {{&found.value, found.source_gradient.data(), found.target_gradient.data(), found.constraint.data()},
         found.mixed.data(),
         found.constraint_source.data(),
         found.constraint_target.data()},
        found.source_hessian.data(),
        found.target_hessian.data()};
    const auto gradients_are = [&](const Gradients<n, m>& expected) {
      EXPECT_TRUE(same(found.value, expected.value));
      EXPECT_TRUE(same(found.source_gradient, expected.source_gradient));
      EXPECT_TRUE(same(found.target_gradient, expected.target_gradient));
      EXPECT_TRUE(same(found.constraint, expected.constraint));
    };
    const auto two_sided_is = [&](const TwoSided<n, m>& expected) {
      gradients_are(expected);
      EXPECT_TRUE(same(found.mixed, expected.mixed));
      EXPECT_TRUE(same(found.constraint_source, expected.constraint_source));
      EXPECT_TRUE(same(found.constraint_target, expected.constraint_target));
    };
    any.gradients(x.data(), lambda.data(), to);
    gradients_are(gradients(system_, g, lambda));
    any.two_sided(x.data(), lambda.data(), to);
    two_sided_is(two_sided(system_, g, lambda));
    const auto second = second_derivatives(system_, g, lambda);
    any.second_derivatives(x.data(), lambda.data(), to);
    two_sided_is(second);
    EXPECT_TRUE(same(found.source_hessian, second.source_hessian));
    EXPECT_TRUE(same(found.target_hessian, second.target_hessian));
    if constexpr (n == 1) {  // it compiles for long
      Matrix<double, n, n> matrix;
      any.gradient_derivative(x.data(), lambda.data(), End::target, matrix.data());
      EXPECT_TRUE(same(matrix, (gradient_derivative(system_, g, lambda, End::target))));
    }
    const Vector<double, m> values = constraint_values(system_, g);
    Vector<double, Sys::arrow_constraints> phi;
    any.arrow_constraint(x.data(), phi.data());
    EXPECT_TRUE(same(phi, part<0, Sys::arrow_constraints>(values)));
    const ObjectNumbers end = system_.groupoid.coordinates_of_object(system_.groupoid.target(g));
    Vector<double, Sys::object_constraints> c;
    any.object_constraint(end.data(), c.data());
    EXPECT_TRUE(same(c, part<Sys::arrow_constraints, Sys::object_constraints>(values)));
    if constexpr (HasBranch<Sys>) {
      EXPECT_EQ(any.admissible(x.data()), bool(system_.admissible(g)));
    }
  }

  Sys system_;
  AnySystemOf<Sys> any_;
};

/// Random arrows over q.
template <class Sys> void is_itself(const Sys& system, const ObjectOf<typename Sys::GroupoidType>& q) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal(0, 0.3);
  const auto draw = [&]<int Count>(Vector<double, Count> v) {
    for (double& x : v) x = normal(generator);
    return v;
  };
  Asked<Sys> asked(system);
  for (int sample = 0; sample < 5; ++sample)
    asked.about(q, draw(Vector<double, Sys::dimension>()), draw(Vector<double, Sys::dimension>()),
                draw(Vector<double, Sys::constraints>()));
  const SystemSizes& sizes = asked.any().sizes();
  EXPECT_EQ(sizes.dimension, Sys::dimension);
  EXPECT_EQ(sizes.constraints(), Sys::constraints);
  EXPECT_EQ(sizes.arrow_coordinates, Sys::GroupoidType::arrow_coordinate_count());
  EXPECT_EQ(asked.any().time_step(), system.h);
}

TEST(AnySystem, IsAPendulum) { is_itself(pendulum(), Vector<double, 1>(0.4)); }
TEST(AnySystem, IsAHeavyTop) { is_itself(HeavyTop{}, Vector<double, 3>(0.6, 0, 0.8)); }
TEST(AnySystem, IsASphericalPendulum) { is_itself(spherical_pendulum(), Vector<double, 3>(0.6, 0, -0.8)); }
TEST(AnySystem, IsAPlateBall) { is_itself(plate_ball(20), {Vector<double, 2>(0.2, -0.1), {}}); }
TEST(AnySystem, IsAUnicycle) { is_itself(Unicycle{}, {}); }
TEST(AnySystem, IsADampedPendulum) {
  is_itself(DampedPendulum{}, ObjectOf<DampedPendulum::GroupoidType>::Constant(0.4));
}
TEST(AnySystem, IsAChaplyginSleigh) { is_itself(ChaplyginSleigh{}, ObjectOf<ChaplyginSleigh::GroupoidType>{}); }

/// Fails: an adapter that hands out the derivatives of another step size than its own.
TEST(AnySystem, KeepsAStepSizeOfItsOwn) {
  const PlateBall system = plate_ball(20);
  AnySystemOf<PlateBall> any(system);
  const auto copy = any.clone();
  copy->set_time_step(2 * system.h);
  EXPECT_TRUE(any.has_time_step());
  EXPECT_EQ(any.time_step(), system.h);
  EXPECT_EQ(copy->time_step(), 2 * system.h);
  const auto g =
      system.groupoid.tau(system.groupoid.source(plate_ball_ends()), Vector<double, 5>(0.1, 0.2, 0.1, -0.1, 0.2));
  const auto x = system.groupoid.coordinates_of_arrow(g);
  PlateBall slower = system;
  slower.h *= 2;
  EXPECT_TRUE(same(any.lagrangian(x.data()), system.lagrangian(g)));
  EXPECT_TRUE(same(copy->lagrangian(x.data()), slower.lagrangian(g)));
  EXPECT_FALSE(same(system.lagrangian(g), slower.lagrangian(g)));
}

TEST(AnySystem, HandsOutPathsAndLoops) {
  const PlateBall ball = plate_ball(20);
  const auto ends = plate_ball_ends();
  const auto x = ball.groupoid.coordinates_of_arrow(ends);
  const AnySystemOf<PlateBall> any(ball);
  const auto numbers = any.path(x.data(), 7);
  const auto arrows = ball.path(ends, 7);
  ASSERT_EQ(numbers.size(), 7 * x.size());
  for (std::size_t k = 0; k < arrows.size(); ++k)
    EXPECT_TRUE(same(Eigen::Map<const Vector<double, 13>>(numbers.data() + 13 * k),
                     ball.groupoid.coordinates_of_arrow(arrows[k])));
  EXPECT_TRUE(AnySystemOf<Pendulum>(pendulum()).path(x.data(), 7).empty());

  const Kepler kepler;  // whose loop goes around the centre, and is no matter of the groupoid
  const AnySystemOf<Kepler> planet(kepler);
  ASSERT_EQ(planet.sizes().loops, 1);
  const Vector<double, 2> q(1, 0.2);
  const Vector<double, 2> axis(0.3, 0.1);
  const Vector<double, 1> turns(0.4);
  Vector<double, 4> loop;
  planet.loop(q.data(), axis.data(), turns.data(), loop.data());
  EXPECT_TRUE(same(loop, kepler.groupoid.coordinates_of_arrow(kepler.loop(q, axis, turns))));
}

TEST(AnySystem, DoesNotAllocate) {
  const PlateBall system = plate_ball(20);
  const SizedSystemOf<PlateBall> sized = by_sizes(system);
  const auto g = by_sizes(system, plate_ball_ends());
  const Vector<double, 3> lambda(0.1, 0.2, 0.3);
  const long before = allocation_count();
  const auto d = sized.second_derivatives(g, lambda);
  const auto product = sized.groupoid.compose(sized.groupoid.unit(sized.groupoid.source(g)), g);
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(d.mixed.allFinite());
  EXPECT_EQ(product, g);
}

/// A copy of a SizedSystem asks a copy of what the first asks. Fails: one that shares it, or whose groupoid asks what
/// is gone.
TEST(SizedSystem, IsAValue) {
  using Sized = SizedSystemOf<PlateBall>;
  auto first = std::make_unique<Sized>(by_sizes(plate_ball(20)));
  Sized copy = *first;
  set_time_step(copy, 0.5);
  EXPECT_EQ(time_step(*first), 0.05);
  EXPECT_NE(&copy.asked(), &first->asked());
  Sized moved = std::move(*first);
  copy = moved;
  first.reset();
  EXPECT_EQ(time_step(copy), 0.05);
  const auto g = by_sizes(plate_ball(20), plate_ball_ends());
  EXPECT_EQ(moved.groupoid.inverse(copy.groupoid.inverse(g)), g);
}

TEST(SizedSystem, HasRoomForItsArrows) {
  EXPECT_EQ(coordinate_room<PlateBall::GroupoidType>, 16);
  EXPECT_EQ((coordinate_room<PairOf<SO3>>), 32);
}

/// The same solve with the system's type and with its sizes alone.
template <class Sys> void solves_alike(const Known<Sys>& k, StationaryKind kind) {
  const auto start = geodesic_path(k.problem, k.path.size());
  const auto typed = BoundaryNewton<Sys>(BoundaryOptions{}, kind).solve(k.problem, start, false);
  const auto sized = make_boundary_solver<Sys>(BoundaryMethod::newton, {}, kind)->solve(k.problem, start, false);
  EXPECT_TRUE(typed.converged());
  EXPECT_EQ(typed.status, sized.status);
  if (fused == 0) {
    EXPECT_EQ(typed.iterations, sized.iterations);
  }
  EXPECT_LE(sized.residual, BoundaryOptions{}.tolerance);
  EXPECT_TRUE(same(typed.cost, sized.cost));
  ASSERT_EQ(typed.path.size(), sized.path.size());
  const auto& groupoid = k.problem.system.groupoid;
  for (std::size_t i = 0; i < sized.path.size(); ++i) {
    EXPECT_LE((groupoid.coordinates_of_arrow(typed.path[i].arrow) - groupoid.coordinates_of_arrow(sized.path[i].arrow))
                  .norm(),
              1e3 * fused);
    EXPECT_LE((typed.path[i].multipliers - sized.path[i].multipliers).norm(), 1e3 * fused);
  }
}

TEST(SizedSystem, IsSolvedAsThePendulumIs) {
  solves_alike(known(pendulum(), {Vector<double, 1>(1), Vector<double, 1>(-0.3)}, 40), StationaryKind::stationary);
}
TEST(SizedSystem, IsSolvedAsTheSphericalPendulumIs) {
  const auto q = Vector<double, 3>(0.6, 0, -0.8);
  solves_alike(known(spherical_pendulum(), {q, Vector<double, 3>(0, 0.5, 0)}, 40), StationaryKind::stationary);
}
TEST(SizedSystem, IsSolvedAsThePlateBallIs) {
  const PlateBall system = plate_ball(20);
  solves_alike<PlateBall>({{system, plate_ball_ends()}, {}, straight(system, 20)}, StationaryKind::minima);
}

/// A solver that a user derives for a system is asked by the search as ours are, with the typed problem.
TEST(SizedSystem, IsSolvedByASolverOfOnesOwn) {
  class Counting final : public BoundarySolver<Pendulum> {
   public:
    mutable std::atomic<int> solves = 0;

   private:
    BoundarySolution<Pendulum> solve_from(const BoundaryProblem<Pendulum>& problem, Path<Pendulum> path,
                                          bool keep_multipliers) const override {
      ++solves;
      return BoundaryNewton<Pendulum>().solve(problem, std::move(path), keep_multipliers);
    }
  };
  const auto k = known(pendulum(), {Vector<double, 1>(1), Vector<double, 1>(-0.3)}, 40);
  const Counting own;
  MultistartOptions options;
  options.starts = 6;
  const auto found = solve_boundary(own, k.problem, 40, options);
  const auto ours = solve_boundary(*make_boundary_solver<Pendulum>(), k.problem, 40, options);
  EXPECT_GE(own.solves, 6);
  ASSERT_EQ(found.solutions.size(), ours.solutions.size());
  for (std::size_t i = 0; i < found.solutions.size(); ++i)
    EXPECT_NEAR(found.solutions[i].cost, ours.solutions[i].cost, 1e-9);
}

}  // namespace
}  // namespace lagroid::core_any_system_tests
