#pragma once
/// Random problems, and the methods that solve them.

#include <lagroid/solvers/optimisation/methods/accelerated.hpp>
#include <lagroid/solvers/optimisation/methods/trust_region.hpp>
#include <lagroid/systems/optimisation/instances.hpp>
#include <lagroid/systems/optimisation/random.hpp>

#include <gtest/gtest.h>

#include <functional>

namespace lagroid::optimisation::tests {

using Eigen::MatrixXd;
using Eigen::VectorXd;

inline MatrixXd as_matrix(const Point& x, Eigen::Index n) {
  return Eigen::Map<const MatrixXd>(x.data(), n, x.size() / n);
}

/// Iterations until the gap of the value falls below 1e-8 and 1e-12; -1: never.
struct Counts {
  long to_8 = -1;
  long to_12 = -1;
  Result result;
};

inline Counts count(const Manifold& manifold, const Objective& objective, const Point& start, double least,
                    DescentMethod& method, long iterations, const std::function<double(const Point&)>& gap = nullptr) {
  Counts out;
  Stopping stopping;
  stopping.iterations = iterations;
  stopping.patience = 0;
  const Callback watch = [&](const Iterate& now, const Point& x) {
    const double left = gap ? gap(x) : now.value - least;
    if (out.to_8 < 0 && left < 1e-8) out.to_8 = now.iteration;
    if (out.to_12 < 0 && left < 1e-12) out.to_12 = now.iteration;
    return out.to_12 < 0;
  };
  out.result = minimise(manifold, objective, start, method, stopping, {.callback = watch});
  return out;
}

inline RobustDescent robust(double c = 2) { return RobustDescent({.c = c}, {.name = "robust", .rescale = true}); }

/// The four problems of [V] Figure 1, random, with their minima.
struct RandomInstance : Instance {
  RandomInstance(Instance instance, unsigned seed)
      : Instance(std::move(instance)), start(random_start(*manifold, seed)) {
    if (this->least) {
      minimum = this->least(start);
      return;
    }
    TrustRegion method;
    const Result best = minimise(*manifold, *objective, start, method, {.gradient = 1e-9});
    EXPECT_TRUE(best.converged()) << best.message;
    minimum = best.value;
  }
  Point start;
  double minimum = 0;
};

inline RandomInstance rayleigh(unsigned seed) {
  return {rayleigh_instance(SymmetricOperator::of(random_symmetric(100, seed))), seed + 100};
}

inline RandomInstance brockett(unsigned seed) {
  return {brockett_instance(SymmetricOperator::of(random_symmetric(100, seed)), VectorXd::LinSpaced(5, 1, 5)),
          seed + 100};
}

/// The paper's, with lambda = 1 also where curvatures are negative.
inline HamiltonianDescent hamiltonian(Bregman::Kind kind, double cap = 1) {
  return HamiltonianDescent({.bregman = {.kind = kind, .lambda = 1}, .cap = cap}, {.name = "Algorithm 1"});
}

}  // namespace lagroid::optimisation::tests
