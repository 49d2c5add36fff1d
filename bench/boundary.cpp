// The plate-ball boundary-value problem: one Newton iteration and the whole solve.
#include <lagroid/solvers/boundary_ceres.hpp>

#include "boundary_case.hpp"
#include "comparison.hpp"
#include "kernels/plate_ball_ipopt.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <utility>

namespace bench {

namespace {

constexpr const char* by_hand = "by hand";
constexpr const char* by_framework = "framework";
constexpr const char* by_ipopt = "IPOPT";
constexpr double tolerance = 1e-10;

std::string iteration_of(std::size_t count) {
  return fmt::format("boundary values, one Newton iteration, N = {}", count);
}
std::string solve_of(std::size_t count) { return fmt::format("boundary values, whole solve, N = {}", count); }

/// Evaluation, elimination and the new path.
class FrameworkIteration {
 public:
  explicit FrameworkIteration(const BoundaryCase& c) : case_(c), variation_(c.start.size()) {}
  void operator()() {
    kkt_.evaluate(case_.problem.system, case_.start);
    kkt_.choose_scale();
    kkt_.newton_side(step_);
    kkt_.factor(0, 0);
    kkt_.solve_in_place(step_);
    kkt_.unscale(step_, variation_);
    displace(case_.problem, case_.start, variation_, 1.0, moved_);
  }

 private:
  BoundaryCase case_;
  BoundaryKkt<PlateBall> kkt_;
  BoundaryKkt<PlateBall>::Columns step_;
  Variation<PlateBall> variation_;
  Path<PlateBall> moved_;
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
  const auto iteration = std::make_shared<FrameworkIteration>(*c);
  out.push_back(repeated(iteration_of(count), by_framework, [iteration] {
    (*iteration)();
    return true;
  }));
  BoundaryOptions options;
  options.tolerance = tolerance;
  options.classify = false;
  out.push_back(repeated(
      solve_of(count), by_framework,
      [c, options] { return BoundaryNewton<PlateBall>(options).solve(c->problem, c->start, true).converged(); },
      /*reference=*/true));
  out.push_back(repeated(solve_of(count), by_hand,
                         [p, start] { return kernels::PlateBallBoundary(p, start).solve(tolerance) < 50; }));
  out.push_back(repeated(solve_of(count), by_ipopt,
                         [p, start] { return kernels::solve_with_ipopt(p, start, tolerance).solved; }));
  if (count <= 1000)
    out.push_back(repeated(solve_of(count), "Ceres", [c, options] {
      return BoundaryCeres<PlateBall>(options).solve(c->problem, c->start, true).converged();
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
