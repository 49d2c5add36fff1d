#include "newton_on_lie_groups.hpp"

#include <lagroid/core/scalars/dual.hpp>
#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/groupoids/rotated.hpp>
#include <lagroid/solvers/ensemble/tasks.hpp>
#include <lagroid/solvers/newton/ceres_lie.hpp>
#include <lagroid/solvers/newton/crouch_grossman.hpp>
#include <lagroid/solvers/newton/lie_differentials.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <type_traits>
#include <utility>

namespace lagroid::app {

namespace {

using Fibre = RotationFibre<>;
using Field = ExampleField<>;
using Step = ImplicitStep<Fibre, Field>;

double success(double h) { return 1e-13 * (1 + h); }

LieNewtonOptions options_of(NewtonMethod method) {
  LieNewtonOptions options;
  options.tolerance = 1e-13;
  options.max_iterations = paper_iterations;
  if (method == NewtonMethod::fixed_point) options.iteration = LieIteration::fixed_point;
  if (method == NewtonMethod::version2 || method == NewtonMethod::damped2) options.iteration = LieIteration::version2;
  if (method == NewtonMethod::damped1 || method == NewtonMethod::damped2) options.halvings = damping_halvings;
  return options;
}

/// All steps from one starting point.
class StartingPoint {
 public:
  StartingPoint(NewtonExample example, int n, std::uint64_t seed)
      : example_(example), n_(n), seed_(seed), fibre_(random_orthogonal(n, seed)), field_(example) {}

  std::vector<NewtonCell> cells() const {
    std::vector<NewtonCell> out;
    for (const auto method : {NewtonMethod::fixed_point, NewtonMethod::version1, NewtonMethod::version2,
                              NewtonMethod::damped1, NewtonMethod::damped2})
      for (int log2h = least_log2h; log2h <= most_log2h; ++log2h) out.push_back(iterated(method, log2h));
    for (int log2h = least_log2h; log2h <= most_log2h; ++log2h) out.push_back(by_ceres(log2h));
    SolutionPath<Fibre, Field> path(fibre_, field_);
    for (int log2h = least_log2h; log2h <= most_log2h; ++log2h) out.push_back(by_path(log2h, path));
    return out;
  }

 private:
  Step step(int log2h) const { return {fibre_, field_, std::ldexp(1.0, log2h)}; }
  Eigen::VectorXd zero() const { return Eigen::VectorXd::Zero(fibre_.dimension()); }

  template <class Result> NewtonCell cell(NewtonMethod method, int log2h, const Result& result) const {
    NewtonCell out;
    out.example = example_;
    out.method = method;
    out.n = n_;
    out.seed = seed_;
    out.log2h = log2h;
    out.status = to_string(result.status);
    out.converged = result.converged();
    out.residual = result.residual;
    out.solved = out.residual <= success(std::ldexp(1.0, log2h));
    out.beyond = out.solved && fibre_.norm(result.v) > std::numbers::pi;  // of the last iterate
    out.order = std::numeric_limits<double>::quiet_NaN();
    return out;
  }

  NewtonCell iterated(NewtonMethod method, int log2h) const {
    std::vector<double> residuals;
    const auto result = lie_newton(step(log2h), zero(), options_of(method), [&](double r) { residuals.push_back(r); });
    NewtonCell out = cell(method, log2h, result);
    out.iterations = result.iterations;
    out.factorisations = method == NewtonMethod::fixed_point ? 0 : result.iterations;
    if (out.converged) out.order = observed_order(residuals);
    // The tolerance is below the round-off of h g(y) for large h: what counts there is how near the iteration came.
    for (const double r : residuals)
      if (std::isfinite(r)) out.residual = std::min(out.residual, r);
    out.solved = out.residual <= success(std::ldexp(1.0, log2h));
    return out;
  }

  NewtonCell by_ceres(int log2h) const {
    LieNewtonOptions options;
    options.tolerance = success(std::ldexp(1.0, log2h));
    options.max_iterations = ceres_iterations;
    const auto result = solve_by_ceres(step(log2h), zero(), options);
    NewtonCell out = cell(NewtonMethod::ceres, log2h, result);
    out.iterations = result.iterations;
    out.factorisations = result.iterations;
    return out;
  }

  /// What `solve_implicit_step` does, with one path for all steps. Its cost is counted as if this were the only one.
  NewtonCell by_path(int log2h, SolutionPath<Fibre, Field>& path) const {
    const Step equation = step(log2h);
    const auto newton = solve_plainly(equation);
    if (newton.converged()) {
      NewtonCell out = cell(NewtonMethod::path, log2h, newton);
      out.plain = true;
      out.iterations = newton.iterations;
      out.factorisations = newton.iterations;
      return out;
    }
    const auto found = path.reach(equation.step());
    NewtonCell out = cell(NewtonMethod::path, log2h, found);
    if (!found.converged()) out.solved = out.beyond = false;  // a solution, but of another step
    out.factorisations = newton.iterations + found.factorisations;
    out.iterations = int(out.factorisations);
    return out;
  }

  NewtonExample example_;
  int n_;
  std::uint64_t seed_;
  Fibre fibre_;
  Field field_;
};

}  // namespace

int number_of(NewtonExample example) { return example == NewtonExample::first ? 1 : 2; }

std::string name_of(NewtonMethod method) {
  switch (method) {
    case NewtonMethod::fixed_point:
      return "fixed point";
    case NewtonMethod::version1:
      return "version 1";
    case NewtonMethod::version2:
      return "version 2";
    case NewtonMethod::damped1:
      return "version 1 damped";
    case NewtonMethod::damped2:
      return "version 2 damped";
    case NewtonMethod::ceres:
      return "Ceres";
    case NewtonMethod::path:
      return "Newton and path";
  }
  return "";
}

std::vector<NewtonCell> run_newton_study(const NewtonStudy& study, const std::function<void(long, long)>& done) {
  const int sizes = study.largest - study.smallest + 1;
  const int starts = 2 * sizes * study.seeds;
  const auto cells_of = [&](long i) {
    const int n = study.largest - int(i) / (2 * study.seeds);  // the long ones first
    const auto example = i % 2 == 0 ? NewtonExample::first : NewtonExample::second;
    const auto seed = std::uint64_t(study.first_seed + i / 2 % study.seeds);
    return StartingPoint(example, n, seed).cells();
  };
  const auto cells = results_of_tasks(starts, /*threads=*/0, cells_of, [&](long finished) { done(finished, starts); });
  std::vector<NewtonCell> out;
  for (auto part = cells.rbegin(); part != cells.rend(); ++part) out.insert(out.end(), part->begin(), part->end());
  return out;
}

std::vector<IterationTime> time_newton_iterations(int largest) {
  const auto seconds = [](const auto& equation, LieIteration iteration) {
    using Clock = std::chrono::steady_clock;
    LieNewtonOptions options;
    options.iteration = iteration;
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(equation.fibre().dimension());
    double best = std::numeric_limits<double>::infinity();
    const auto start = Clock::now();
    do {
      const auto begin = Clock::now();
      const auto result = lie_newton(equation, zero, options);
      const double time = std::chrono::duration<double>(Clock::now() - begin).count();
      best = std::min(best, time / std::max(1, result.iterations));
    } while (Clock::now() - start < std::chrono::milliseconds(60));
    return best;
  };
  std::vector<int> sizes;
  for (int n = 2; n <= std::min(largest, 15); ++n) sizes.push_back(n);
  if (largest >= 15) sizes.insert(sizes.end(), {20, 30});
  std::vector<IterationTime> out;
  for (const int n : sizes) {
    const Step step{Fibre(random_orthogonal(n, 1)), Field(NewtonExample::first), 0.1};
    IterationTime time;
    time.n = n;
    time.fixed_point = seconds(step, LieIteration::fixed_point);
    time.version1 = seconds(step, LieIteration::version1);
    time.version2 = seconds(step, LieIteration::version2);
    if (n <= 20) {
      time.version1_quotients = seconds(FiniteDifferences(step), LieIteration::version1);
      time.version2_quotients = seconds(FiniteDifferences(step), LieIteration::version2);
    }
    out.push_back(time);
  }
  return out;
}

namespace {

/// Errors of every method over halved steps, against the method of order three with a sixteenth of the least step.
template <class F, class G, class Observe>
void halve(std::vector<IntegratorError>& out, const std::string& problem, const F& fibre, const G& field,
           double horizon, const Observe& observe) {
  using Value = decltype(observe(fibre.centre()));
  const auto end = [&](const CrouchGrossman& method, int steps) -> std::optional<Value> {
    LieIntegrator<F, G> integrator(method, fibre, field);
    for (int k = 0; k < steps; ++k)
      if (!integrator.advance(horizon / steps).converged()) return std::nullopt;
    return observe(integrator.y());
  };
  const auto limit = end(CrouchGrossman::dirk3(), 2048);
  for (const auto& method : CrouchGrossman::all()) {
    IntegratorError error{problem, method.name, method.order, {16, 32, 64, 128}, {}};
    for (const int steps : error.steps) {
      const auto at = end(method, steps);
      error.errors.push_back(at && limit ? (*at - *limit).norm() : std::numeric_limits<double>::quiet_NaN());
    }
    out.push_back(std::move(error));
  }
}

}  // namespace

std::vector<IntegratorError> measure_implicit_integrators() {
  std::vector<IntegratorError> out;
  using Body = Action<SO3, RotatedDirections>;
  const GroupoidFibre<Body> sphere(Body().unit(Vector<double, 3>(Vector<double, 3>(0.4, -0.8, 0.7).normalized())));
  const auto spin = [](const auto& arrow) {
    const auto m = Body::target(arrow);
    using S = typename std::decay_t<decltype(m)>::Scalar;
    return Vector<S, 3>(m(0) * 1.4, m(1) * 0.7, m(2) * 0.5);
  };
  const AutomaticField turning(sphere, spin);
  const auto itself = [](const Eigen::MatrixXd& y) { return y; };
  halve(out, "example 1 on O(5), T = 1", Fibre(random_orthogonal(5, 3)), Field(NewtonExample::first), 1.0, itself);
  halve(out, "example 2 on O(5), T = 0.1", Fibre(random_orthogonal(5, 3)), Field(NewtonExample::second), 0.1, itself);
  halve(out, "Euler's equations on S^2 by SO(3), T = 3", sphere, turning, 3.0,
        [](const auto& arrow) { return Vector<double, 3>(Body::target(arrow)); });
  return out;
}

}  // namespace lagroid::app
