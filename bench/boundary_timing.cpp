// The plate-ball boundary-value problem: one Newton iteration and the whole solve, by hand, by the framework, by IPOPT.
#include "boundary_case.hpp"
#include "kernels/plate_ball_ipopt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

using namespace bench;

namespace {

struct Subject {
  std::string name;
  std::function<int()> run;  // returns the number of iterations
  std::vector<double> times{};
  int iterations = 0;
};

void measure(std::vector<Subject> subjects, int rounds) {
  using Clock = std::chrono::steady_clock;
  for (int round = 0; round < rounds; ++round)
    for (Subject& s : subjects) {
      const auto begin = Clock::now();
      s.iterations = s.run();
      s.times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
  for (Subject& s : subjects) {
    std::sort(s.times.begin(), s.times.end());
    fmt::print("{:<44}{:>11.4f}{:>11.4f}{:>6}\n", s.name, s.times.front(), s.times[s.times.size() / 2], s.iterations);
  }
}

}  // namespace

int main() {
  fmt::print("{:<44}{:>11}{:>11}{:>6}\n", "milliseconds", "minimum", "median", "its");
  for (const std::size_t count : {100, 1000, 10000}) {
    const BoundaryCase c = boundary_case(/*rotating=*/true, count);
    const auto& system = c.problem.system;
    const auto start = nodes(c.start);
    kernels::PlateBallBoundary iterated(parameters(system), start);
    BoundaryKkt<PlateBall> kkt;
    const auto named = [&](const char* what) { return fmt::format("N = {}: {}", count, what); };
    measure({{named("iteration by hand"),
              [&] {
                iterated.iterate();
                return 1;
              }},
             {named("iteration of the framework"),
              [&] {
                kkt.evaluate(system, c.start);
                kkt.choose_scale();
                kkt.factor(0, 0);
                const auto z = kkt.solve(kkt.scaled_residual());
                std::vector<Vector<double, 5>> move(count);
                std::vector<Vector<double, 3>> change(count);
                for (std::size_t k = 0; k < count; ++k) {
                  move[k] = -kkt.scale().tail<5>().cwiseProduct(z[k].tail<5>());
                  change[k] = -kkt.scale().head<3>().cwiseProduct(z[k].head<3>());
                }
                displaced(c.problem, c.start, move, change, 1.0);
                return 1;
              }}},
            count == 10000 ? 15 : 51);
    measure({{named("solve by hand"),
              [&] {
                kernels::PlateBallBoundary kernel(parameters(system), start);
                return kernel.solve(1e-10);
              }},
             {named("solve by the framework, with classification"),
              [&] { return BoundaryNewton<PlateBall>().solve(c.problem, c.start, true).iterations; }},
             {named("solve by IPOPT"),
              [&] {
                const auto solution = kernels::solve_with_ipopt(parameters(system), start, 1e-10);
                return solution.solved ? solution.iterations : -1;
              }}},
            count == 10000 ? 3 : 15);
  }
}
