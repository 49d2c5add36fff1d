#include "accelerated_optimisation.hpp"

#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>
#include <lagroid/solvers/optimisation/methods/accelerated.hpp>
#include <lagroid/solvers/optimisation/methods/conjugate_gradient.hpp>
#include <lagroid/solvers/optimisation/methods/euler_lagrange.hpp>
#include <lagroid/solvers/optimisation/methods/gradient_descent.hpp>
#include <lagroid/solvers/optimisation/methods/trust_region.hpp>
#include <lagroid/systems/optimisation/instances.hpp>
#include <lagroid/systems/optimisation/random.hpp>
#include <lagroid/systems/optimisation/rayleigh.hpp>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>

namespace lagroid::app {

namespace {

using namespace optimisation;

struct Maker {
  AcceleratedMethod method;
  std::unique_ptr<DescentMethod> (*make)();
};

/// The paper's, also where curvatures are negative.
constexpr double lambda = 1;
template <Bregman::Kind kind> std::unique_ptr<DescentMethod> hamiltonian() {
  return std::make_unique<HamiltonianDescent>(HamiltonianOptions{.bregman = {.kind = kind, .lambda = lambda}},
                                              AcceleratedOptions{});
}
std::unique_ptr<DescentMethod> uncapped_hamiltonian() {
  return std::make_unique<HamiltonianDescent>(
      HamiltonianOptions{.bregman = {.lambda = lambda}, .cap = std::numeric_limits<double>::infinity()},
      AcceleratedOptions{});
}
template <int version> std::unique_ptr<DescentMethod> euler_lagrange() {
  return std::make_unique<EulerLagrange>(EulerLagrangeOptions{.lambda = lambda, .version = version});
}
template <int version> std::unique_ptr<DescentMethod> uncapped_euler_lagrange() {
  return std::make_unique<EulerLagrange>(
      EulerLagrangeOptions{.lambda = lambda, .version = version, .cap = std::numeric_limits<double>::infinity()});
}

const std::vector<Maker>& makers() {
  static const std::vector<Maker> all{
      {{"Algorithm 1 adaptive", "paper"}, hamiltonian<Bregman::Kind::adaptive>},
      {{"Algorithm 1 direct", "paper"}, hamiltonian<Bregman::Kind::direct>},
      {{"Algorithm 2 I", "paper"}, euler_lagrange<1>},
      {{"Algorithm 2 II", "paper"}, euler_lagrange<2>},
      {{"gradient descent by h", "paper"},
       []() -> std::unique_ptr<DescentMethod> {
         return std::make_unique<GradientDescent>(GradientDescentOptions{.step = 1e-3});
       }},
      {{"Algorithm 1 adaptive uncapped", "uncapped"}, uncapped_hamiltonian},
      {{"Algorithm 2 I uncapped", "uncapped"}, uncapped_euler_lagrange<1>},
      {{"Algorithm 2 II uncapped", "uncapped"}, uncapped_euler_lagrange<2>},
      {{"robust", "tuned"},
       []() -> std::unique_ptr<DescentMethod> {
         return std::make_unique<RobustDescent>(RobustOptions{}, AcceleratedOptions{.rescale = true});
       }},
      {{"Nesterov with restarts", "tuned"},
       []() -> std::unique_ptr<DescentMethod> {
         return std::make_unique<RobustDescent>(
             RobustOptions{.c = 1, .power = 2},
             AcceleratedOptions{.rescale = true, .restart = true, .look_ahead = true});
       }},
      {{"gradient descent by 1 / L", "tuned"},
       []() -> std::unique_ptr<DescentMethod> {
         return std::make_unique<GradientDescent>(GradientDescentOptions{.c = 1});
       }},
      {{"gradient descent with line search", "tuned"},
       []() -> std::unique_ptr<DescentMethod> { return std::make_unique<GradientDescent>(GradientDescentOptions{}); }},
      {{"conjugate gradients", "tuned"},
       []() -> std::unique_ptr<DescentMethod> { return std::make_unique<ConjugateGradient>(); }},
      {{"trust region", "tuned"}, []() -> std::unique_ptr<DescentMethod> { return std::make_unique<TrustRegion>(); }}};
  return all;
}

Instance instance(const std::string& problem, unsigned seed) {
  if (problem == "Rayleigh") return rayleigh_instance(SymmetricOperator::of(random_symmetric(100, seed)));
  if (problem == "Brockett")
    return brockett_instance(SymmetricOperator::of(random_symmetric(100, seed)), Eigen::VectorXd::LinSpaced(5, 1, 5));
  if (problem == "unbalanced Procrustes")
    return procrustes_instance(random_matrix(80, 60, seed), random_matrix(80, 5, seed + 1));
  return procrustes_instance(random_matrix(30, 30, seed), random_matrix(30, 30, seed + 1));
}

long evaluations(const Iterate& now) {
  return now.evaluations.values + now.evaluations.gradients + now.evaluations.hessians;
}

Arrival arrival(const Result& result, double value) {
  for (const Iterate& now : result.history)
    if (now.value < value) return {now.iteration, evaluations(now), now.seconds};
  return {};
}

/// About 400 of a history's points, evenly over its logarithm.
void sample(const std::string& problem, const std::string& method, const Result& result, double least,
            std::vector<AcceleratedPoint>& points) {
  constexpr double apart = 1.025;
  double next = 0;
  for (const Iterate& now : result.history) {
    if (double(now.iteration) < next && &now != &result.history.back()) continue;
    points.push_back({problem, method, now.iteration, now.value - least});
    next = std::max(double(now.iteration) + 1, apart * double(now.iteration));
  }
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Brockett's function of a diagonal matrix, whose gradient costs next to nothing.
IterationCost cost(long n, long m) {
  constexpr int rounds = 4;
  const int steps = int(std::clamp(5e7 / double(n * m * m), 16.0, 400.0));
  const Eigen::VectorXd w = Eigen::VectorXd::LinSpaced(n, 0, 1);
  const SymmetricOperator a{
      n, [&](const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::Ref<Eigen::MatrixXd> y) { y = w.asDiagonal() * x; }};
  const Stiefel manifold(n, m);
  const Brockett objective(a, Eigen::VectorXd::LinSpaced(m, 1, double(m)));
  const Point x = random_start(manifold, 1);
  Vector gradient(x.size());
  objective.evaluate(x, gradient);
  Vector v = gradient;
  manifold.project(x, v);
  v *= 0.1 / v.norm();
  Point to = x;
  Vector moved = v;
  RobustDescent ours({}, {.rescale = true});
  GradientDescent descent({.c = 1});
  const auto run = [&](DescentMethod& method) {
    return minimise(manifold, objective, x, method, {.iterations = steps, .patience = 0}).seconds;
  };

  IterationCost out{n, m};
  const auto keep = [steps](double& least, double seconds) {
    least = least > 0 ? std::min(least, seconds / steps) : seconds / steps;
  };
  const auto repeated = [steps](const auto& work) {
    return seconds_of([&] {
      for (int k = 0; k < steps; ++k) work();
    });
  };
  for (int round = 0; round < rounds; ++round) {
    keep(out.gradient, repeated([&] { objective.evaluate(x, gradient); }));
    keep(out.ours, run(ours));
    keep(out.descent, run(descent));
    keep(out.multipliers, repeated([&] { manifold.orthographic(x, v, to, moved); }));
    keep(out.qr, repeated([&] { manifold.retract(ManifoldRetraction::qr, x, v, to); }));
  }
  out.ours -= out.gradient;
  out.descent -= out.gradient;
  return out;
}

}  // namespace

const std::vector<AcceleratedMethod>& accelerated_methods() {
  static const std::vector<AcceleratedMethod> all = [] {
    std::vector<AcceleratedMethod> out;
    for (const Maker& maker : makers()) out.push_back(maker.method);
    return out;
  }();
  return all;
}

const std::vector<std::string>& accelerated_problems() {
  static const std::vector<std::string> all{"Rayleigh", "Brockett", "unbalanced Procrustes", "balanced Procrustes"};
  return all;
}

AcceleratedFindings run_accelerated_study(const AcceleratedStudy& study,
                                          const std::function<void(long, long)>& report) {
  constexpr double enough = 1e-13;
  AcceleratedFindings out;
  out.study = study;
  const std::vector<std::pair<long, long>> sizes{{250, 20},  {500, 20}, {1000, 20}, {2000, 20}, {4000, 20},
                                                 {8000, 20}, {2000, 5}, {2000, 10}, {2000, 40}, {2000, 80}};
  const long all = long(accelerated_problems().size() * makers().size()) * study.instances + long(sizes.size());
  long done = 0;
  for (const std::string& problem : accelerated_problems())
    for (int k = 0; k < study.instances; ++k) {
      const int seed = study.first_seed + 10 * k;
      const Instance each = instance(problem, unsigned(seed));
      const Point start = random_start(*each.manifold, unsigned(seed + 100));
      double least = each.least ? each.least(start) : std::numeric_limits<double>::infinity();
      std::vector<Result> results;
      for (const Maker& maker : makers()) {
        Stopping stopping;
        stopping.iterations = study.iterations;
        if (each.least) stopping.value = least + enough;
        results.push_back(minimise(*each.manifold, *each.objective, start, *maker.make(), stopping, {.history = true}));
        report(++done, all);
      }
      // Where nobody knows the minimum: the least that any method found.
      if (!each.least)
        for (const Result& result : results) least = std::min(least, result.value);
      for (std::size_t i = 0; i < results.size(); ++i) {
        const std::string& method = makers()[i].method.name;
        out.runs.push_back({problem, method, seed, arrival(results[i], least + 1e-8),
                            arrival(results[i], least + 1e-12), results[i].history.back().value - least,
                            std::string(to_string(results[i].outcome))});
        if (k == 0) sample(problem, method, results[i], least, out.points);
      }
    }
  for (const auto& [n, m] : sizes) {
    out.costs.push_back(cost(n, m));
    report(++done, all);
  }
  return out;
}

double median_of(const AcceleratedFindings& findings, const std::string& problem, const std::string& method,
                 const std::function<double(const AcceleratedRun&)>& count) {
  std::vector<double> counts;
  for (const AcceleratedRun& run : findings.runs)
    if (run.problem == problem && run.method == method) {
      const double c = count(run);
      counts.push_back(c >= 0 ? c : std::numeric_limits<double>::infinity());
    }
  if (counts.empty()) return -1;
  std::sort(counts.begin(), counts.end());
  const double median = counts[counts.size() / 2];
  return median < std::numeric_limits<double>::infinity() ? median : -1;
}

}  // namespace lagroid::app
