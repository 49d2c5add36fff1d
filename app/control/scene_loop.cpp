#include "scene_loop.hpp"

#include <lagroid/solvers/poisson/wiener_path.hpp>

#include <fmt/format.h>

#include <utility>

namespace lagroid::app {

ControlResult close_loop(const ControlProblem& problem, SceneLoop& loop, const LoopScene& scene,
                         std::vector<double> start, const std::function<bool(int)>& keep_going) {
  ControlResult out;
  out.problem = problem.name();
  out.states = problem.states();
  out.controls = problem.controls();
  out.report = loop.report();
  out.state_rows.push_back(std::move(start));
  out.times.push_back(0);
  LoopSummary summary;
  summary.stages = loop.stages();
  const WienerPath chance{.seed = scene.seed};
  double cost = 0;
  for (long sample = 1; out.report.converged() && sample <= scene.samples && keep_going(int(sample)); ++sample) {
    out.control_rows.push_back(loop.control());
    cost += loop.cost();
    std::vector<double> state = loop.predicted();
    if (scene.disturbance > 0)
      for (std::size_t i = 0; i < state.size(); ++i)
        state[i] += scene.disturbance * chance.normals(sample, std::uint32_t(i / 2))[i % 2];
    loop.advance(state);
    out.state_rows.push_back(std::move(state));
    out.times.push_back(double(sample) * loop.step());
    const ControlReport& report = loop.report();
    ++summary.samples;
    ++summary.iterations[report.iterations];
    out.iterations += report.iterations;
    if (report.converged()) continue;
    ++summary.not_converged;
    if (report.is_usable(scene.usable)) continue;
    out.report = report;
    out.report.message = fmt::format(
        "sample {}: its constraints are violated by {:.2g} after {} iterations; allow more of them "
        "(loop.iterations), look further ahead, or disturb it less",
        sample, report.violation, report.iterations);
  }
  out.report.cost = cost;
  summary.restarts = loop.restarts();
  summary.latency = loop.latency();
  out.loop = std::move(summary);
  return out;
}

long LoopSummary::iterations_of(double percent) const {
  long below = 0;
  for (const auto& [count, times] : iterations) {
    below += times;
    if (double(below) >= percent * double(samples) / 100 - 1e-9) return count;
  }
  return 0;
}

}  // namespace lagroid::app
