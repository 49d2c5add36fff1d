// The plate-ball boundary-value problem: one Newton iteration and the whole solve.
#include <lagroid/solvers/boundary/boundary_values.hpp>

#include "../cases/boundary_case.hpp"
#include "../kernels/plate_ball/plate_ball_ipopt.hpp"
#include "../report/comparison.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <utility>

namespace bench {

namespace {

constexpr const char* by_hand = "by hand";
constexpr const char* by_framework = "framework";
constexpr const char* by_type = "framework, compiled for the system";  // and not for its sizes
constexpr const char* by_ipopt = "IPOPT";
constexpr double tolerance = 1e-10;

std::string iteration_of(std::size_t count) {
  return fmt::format("boundary values, one Newton iteration, N = {}", count);
}
std::string solve_of(std::size_t count) { return fmt::format("boundary values, whole solve, N = {}", count); }

/// Evaluation, elimination and the new path.
template <class Sys> class FrameworkIteration {
 public:
  FrameworkIteration(BoundaryProblem<Sys> problem, Path<Sys> start)
      : problem_(std::move(problem)), start_(std::move(start)), variation_(start_.size()) {}
  void operator()() {
    kkt_.evaluate(problem_.system, start_);
    kkt_.choose_scale();
    kkt_.newton_side(step_);
    kkt_.factor(0, 0);
    kkt_.solve_in_place(step_);
    kkt_.unscale(step_, variation_);
    displace(problem_, start_, variation_, 1.0, moved_);
  }

 private:
  BoundaryProblem<Sys> problem_;
  Path<Sys> start_;
  BoundaryKkt<Sys> kkt_;
  typename BoundaryKkt<Sys>::Columns step_;
  Variation<Sys> variation_;
  Path<Sys> moved_;
};

template <class F> Subject repeated(std::string group, std::string name, F run, bool reference = false) {
  return {std::move(group), std::move(name),
          [run](benchmark::State& state) mutable {
            for (auto _ : state)
              if (!run()) {
                state.SkipWithError("not solved");
                return;
              }
          },
          reference};
}

void add(std::vector<Subject>& out, std::size_t count) {
  const auto c = std::make_shared<const BoundaryCase>(boundary_case(/*rotating=*/true, count));
  const auto start = nodes(c->start);
  const auto p = parameters(c->problem.system);
  const auto kernel = std::make_shared<kernels::PlateBallBoundary>(p, start);
  out.push_back(repeated(
      iteration_of(count), by_hand,
      [kernel] {
        kernel->iterate();
        return true;
      },
      /*reference=*/true));
  const auto add_iteration = [&]<class Sys>(const char* name, const BoundaryProblem<Sys>& problem,
                                            const Path<Sys>& path) {
    const auto iteration = std::make_shared<FrameworkIteration<Sys>>(problem, path);
    out.push_back(repeated(iteration_of(count), name, [iteration] {
      (*iteration)();
      return true;
    }));
  };
  add_iteration(by_framework, by_sizes(c->problem), by_sizes(c->problem.system, c->start));
  add_iteration(by_type, c->problem, c->start);
  BoundaryOptions options;
  options.tolerance = tolerance;
  options.classify = false;
  out.push_back(repeated(
      solve_of(count), by_framework,
      [c, options] {
        return make_boundary_solver<PlateBall>(BoundaryMethod::newton, options)
            ->solve(c->problem, c->start, true)
            .converged();
      },
      /*reference=*/true));
  out.push_back(repeated(solve_of(count), by_hand,
                         [p, start] { return kernels::PlateBallBoundary(p, start).solve(tolerance) < 50; }));
  out.push_back(repeated(solve_of(count), by_ipopt,
                         [p, start] { return kernels::solve_with_ipopt(p, start, tolerance).solved; }));
  if (count <= 1000)
    out.push_back(repeated(solve_of(count), "Ceres", [c, options] {
      return make_boundary_solver<PlateBall>(BoundaryMethod::ceres, options)
          ->solve(c->problem, c->start, true)
          .converged();
    }));
}

constexpr std::size_t counts[] = {100, 1000, 10000};

}  // namespace

std::vector<Subject> boundary_subjects() {
  std::vector<Subject> out;
  for (const std::size_t count : counts) add(out, count);
  return out;
}

std::vector<Goal> boundary_goals() {
  std::vector<Goal> out;
  for (const std::size_t count : counts) {
    out.push_back({iteration_of(count), by_framework, by_hand, 1});
    out.push_back({solve_of(count), by_ipopt, by_framework, 15, /*at_least=*/true});
  }
  return out;
}

}  // namespace bench
