// Accelerated methods and those beside them: counts, convergence, minima.
#include "instances.hpp"

#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
#include <lagroid/solvers/optimisation/methods/accelerated.hpp>
#include <lagroid/solvers/optimisation/methods/conjugate_gradient.hpp>
#include <lagroid/solvers/optimisation/methods/euler_lagrange.hpp>
#include <lagroid/solvers/optimisation/methods/gradient_descent.hpp>
#include <lagroid/solvers/optimisation/methods/trust_region.hpp>
#include <lagroid/systems/optimisation/instances.hpp>
#include <lagroid/systems/optimisation/random.hpp>
#include <lagroid/systems/optimisation/rayleigh.hpp>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace lagroid::optimisation::tests::methods_tests {
namespace {

/// Reference counts of shared/cases/newton-and-htvi.json ("sphere"), A = diag(linspace(0, 1 - 1/kappa, n - 1), 1).
struct SphereRecord {
  int n;
  double kappa;
  double a;
  double c;
  long to_8;
  long to_12;
  long shortened;
  bool nesterov = false;  ///< looks ahead and restarts, effective p = 2
  long restarts = 0;
  long descent_to_8 = 0;  ///< of gradient descent with the step 1 / L
};

TEST(Accelerated, ReproducesTheReferenceCountsOnTheSphere) {
  for (const SphereRecord& r : {SphereRecord{100, 100, 1.3, 1, 122, 164, 0},
                                {100, 100, 1.3, 2, 84, 114, 0},
                                {100, 100, 1.3, 3, 68, 110, 7},
                                {100, 1000, 1.3, 1, 385, 416, 0},
                                {100, 1000, 1.3, 2, 270, 292, 0},
                                {100, 1000, 1.3, 3, 219, 237, 8},
                                {300, 100, 2.1, 1, 123, 196, 0},
                                {300, 100, 2.1, 2, 85, 136, 0},
                                {300, 100, 2.1, 3, 68, 109, 5},
                                {100, 100, 1.3, 1, 108, 167, 0, true, 4, 650},
                                {100, 1000, 1.3, 1, 231, 314, 0, true, 3, 5351},
                                {300, 100, 2.1, 1, 110, 165, 0, true, 4, 647}}) {
    VectorXd w(r.n);
    w << VectorXd::LinSpaced(r.n - 1, 0, 1 - 1 / r.kappa), 1;
    const Sphere sphere(r.n);
    const Rayleigh objective(
        {r.n, [w](const Eigen::Ref<const MatrixXd>& x, Eigen::Ref<MatrixXd> y) { y = w.asDiagonal() * x; }});
    Point x(r.n);
    for (int i = 1; i <= r.n; ++i) x(i - 1) = std::sin(r.a * i) + 0.5 * std::cos(0.37 * i * i);
    x.normalize();
    RobustDescent method({.c = r.c, .power = r.nesterov ? 2.0 : 18.0, .lipschitz = 2},
                         {.name = "robust", .rescale = true, .restart = r.nesterov, .look_ahead = r.nesterov});
    const Counts found = count(sphere, objective, x, -1, method, 1000,
                               [&](const Point& at) { return at.cwiseAbs2().dot((1 - w.array()).matrix()); });
    EXPECT_NEAR(double(found.to_8), double(r.to_8), 2) << r.n << ' ' << r.kappa << ' ' << r.c;
    EXPECT_NEAR(double(found.to_12), double(r.to_12), 2) << r.n << ' ' << r.kappa << ' ' << r.c;
    EXPECT_EQ(method.shortened(), r.shortened) << r.n << ' ' << r.kappa << ' ' << r.c;
    EXPECT_EQ(method.restarts(), r.restarts) << r.n << ' ' << r.kappa << ' ' << r.c;
    if (r.nesterov) {
      GradientDescent descent({.step = 0.5});
      const Counts plain = count(sphere, objective, x, -1, descent, 10000,
                                 [&](const Point& at) { return at.cwiseAbs2().dot((1 - w.array()).matrix()); });
      EXPECT_NEAR(double(plain.to_8), double(r.descent_to_8), 2) << r.n << ' ' << r.kappa;
    }
  }
}

RandomInstance unbalanced(unsigned seed) {
  return {procrustes_instance(random_matrix(80, 60, seed), random_matrix(80, 5, seed + 1)), seed + 100};
}

RandomInstance balanced(unsigned seed) {
  return {procrustes_instance(random_matrix(30, 30, seed), random_matrix(30, 30, seed + 1)), seed + 100};
}

TEST(Accelerated, AdaptiveBeatsDirectWhichIsNoWorseThanEulerLagrange) {
  for (const auto make : {rayleigh, brockett, unbalanced, balanced}) {
    const RandomInstance problem = make(1);
    HamiltonianDescent adaptive = hamiltonian(Bregman::Kind::adaptive);
    HamiltonianDescent direct = hamiltonian(Bregman::Kind::direct);
    EulerLagrange euler_lagrange({.lambda = 1});
    const auto to_8 = [&](DescentMethod& method) {
      return count(*problem.manifold, *problem.objective, problem.start, problem.minimum, method, 30000).to_8;
    };
    const long a = to_8(adaptive);
    const long d = to_8(direct);
    const long e = to_8(euler_lagrange);
    SCOPED_TRACE(problem.objective->name() + " on the " + problem.manifold->name());
    EXPECT_GT(a, 0);
    EXPECT_LT(2 * a, d);
    EXPECT_LE(double(d), 1.05 * double(e));
  }
}

TEST(Accelerated, WithLambdaOfTheCurvatureTakesHalfTheIterations) {
  // On Stiefel manifolds, which curve down to -1/2.
  for (const auto make : {brockett, unbalanced})
    for (unsigned seed = 1; seed < 40; seed += 10) {
      const RandomInstance problem = make(seed);
      HamiltonianDescent paper = hamiltonian(Bregman::Kind::adaptive);
      HamiltonianDescent curved({}, {});
      const auto to_12 = [&](DescentMethod& method) {
        return count(*problem.manifold, *problem.objective, problem.start, problem.minimum, method, 6000).to_12;
      };
      const long with_zeta = to_12(curved);
      SCOPED_TRACE(problem.objective->name() + ", seed " + std::to_string(seed));
      EXPECT_GT(with_zeta, 0);
      EXPECT_GT(to_12(paper), 2 * with_zeta);
    }
}

TEST(Accelerated, WithManyColumnsLambdaOfTheCurvatureTakesMoreIterations) {
  const RandomInstance problem(
      brockett_instance(SymmetricOperator::of(random_symmetric(40, 1)), VectorXd::LinSpaced(20, 1, 20)), 101);
  HamiltonianDescent paper = hamiltonian(Bregman::Kind::adaptive);
  HamiltonianDescent curved({}, {});
  const auto to_12 = [&](DescentMethod& method) {
    return count(*problem.manifold, *problem.objective, problem.start, problem.minimum, method, 10000).to_12;
  };
  const long with_one = to_12(paper);
  EXPECT_GT(with_one, 0);
  EXPECT_GT(to_12(curved), with_one);
}

TEST(EulerLagrange, LosesConvergenceWithoutACap) {
  const RandomInstance problem = rayleigh(1);
  EulerLagrange uncapped({.cap = std::numeric_limits<double>::infinity()});
  EulerLagrange capped({});
  const auto last = [&](DescentMethod& method) {
    return minimise(*problem.manifold, *problem.objective, problem.start, method, {.iterations = 20000, .patience = 0},
                    {.history = true})
               .history.back()
               .value -
           problem.minimum;
  };
  EXPECT_LT(last(capped), 1e-10);
  EXPECT_GT(last(uncapped), 1e-3);
}

TEST(Robust, TakesAThirdOfTheIterationsAndNeverDiverges) {
  for (const auto make : {rayleigh, brockett, unbalanced, balanced})
    for (unsigned seed = 1; seed < 60; seed += 10) {
      const RandomInstance problem = make(seed);
      RobustDescent ours = robust();
      const Counts robust_counts =
          count(*problem.manifold, *problem.objective, problem.start, problem.minimum, ours, 4000);
      HamiltonianDescent adaptive = hamiltonian(Bregman::Kind::adaptive);
      SCOPED_TRACE(problem.objective->name() + " on the " + problem.manifold->name() + ", seed " +
                   std::to_string(seed));
      ASSERT_GT(robust_counts.to_12, 0) << robust_counts.result.message;
      const long allowed = 3 * robust_counts.to_12;
      const Counts theirs =
          count(*problem.manifold, *problem.objective, problem.start, problem.minimum, adaptive, allowed);
      EXPECT_EQ(theirs.to_12, -1) << robust_counts.to_12;
    }
}

TEST(Methods, StayOnTheManifoldToRoundOff) {
  for (const auto make : {brockett, unbalanced, balanced}) {
    const RandomInstance problem = make(3);
    RobustDescent ours = robust();
    HamiltonianDescent adaptive = hamiltonian(Bregman::Kind::adaptive);
    EulerLagrange euler_lagrange({});
    GradientDescent descent({.c = 1});
    ConjugateGradient conjugate;
    TrustRegion trust;
    for (DescentMethod* method :
         std::vector<DescentMethod*>{&ours, &adaptive, &euler_lagrange, &descent, &conjugate, &trust}) {
      long seen = 0;
      const Result r = minimise(*problem.manifold, *problem.objective, problem.start, *method, {.iterations = 500},
                                {.callback = [&](const Iterate&, const Point& x) {
                                  ++seen;
                                  EXPECT_LT(problem.manifold->residual(x), 1e-15 * double(problem.rows))
                                      << method->name() << " after " << seen;
                                  return true;
                                }});
      EXPECT_EQ(seen, r.iterations + 1) << method->name();
      EXPECT_GT(seen, 5) << method->name();
    }
  }
}

TEST(Methods, FindTheMinimumFromManyStarts) {
  // Markers of a body in three dimensions: small groups, long first steps.
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const RandomInstance problem(procrustes_instance(random_matrix(12, 3, seed), random_matrix(12, 3, seed + 50)),
                                 seed);
    ConjugateGradient conjugate;
    TrustRegion trust;
    RobustDescent ours = robust();
    for (DescentMethod* method : std::vector<DescentMethod*>{&conjugate, &trust, &ours}) {
      const Result r =
          minimise(*problem.manifold, *problem.objective, problem.start, *method, {.relative_gradient = 1e-7});
      EXPECT_TRUE(r.converged()) << method->name() << ", seed " << seed << ": " << r.message;
      EXPECT_NEAR(r.value, problem.minimum, 1e-9) << method->name() << ", seed " << seed;
    }
  }
}

TEST(Methods, DoNotSlowDownWhereTheirStepsAreLong) {
  // From a start where a step with multipliers does not exist at first, on O(60).
  const RandomInstance problem(procrustes_instance(random_matrix(60, 60, 1), random_matrix(60, 60, 2)), 3);
  RobustDescent ours = robust();
  const Result r =
      minimise(*problem.manifold, *problem.objective, problem.start, ours, {.iterations = 300, .seconds = 60});
  EXPECT_GT(ours.shortened(), 0);
  EXPECT_EQ(r.iterations, 300);
  EXPECT_LT(r.residual, 6e-14);
}

TEST(Methods, FindTheMinimum) {
  for (const auto make : {rayleigh, brockett, unbalanced, balanced}) {
    const RandomInstance problem = make(7);
    GradientDescent search({});
    ConjugateGradient conjugate;
    TrustRegion trust;
    RobustDescent ours = robust();
    for (DescentMethod* method : std::vector<DescentMethod*>{&search, &conjugate, &trust, &ours}) {
      const Result r = minimise(*problem.manifold, *problem.objective, problem.start, *method,
                                {.value = problem.minimum + 1e-7, .iterations = 40000});
      EXPECT_TRUE(r.converged()) << method->name() << ": " << r.message;
      EXPECT_NEAR(r.value, problem.minimum, 1.1e-7) << method->name();
    }
  }
}

}  // namespace
}  // namespace lagroid::optimisation::tests::methods_tests
