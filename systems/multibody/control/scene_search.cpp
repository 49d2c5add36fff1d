#include <lagroid/systems/multibody/control/scene_search.hpp>

#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/solvers/control/search_starts.hpp>
#include <lagroid/systems/multibody/control/arrow_momenta.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

namespace lagroid::multibody {

namespace {

/// At rest, or in the middle of its bounds.
double resting(const Actuator& of) {
  if (std::isfinite(of.lower) && std::isfinite(of.upper)) return 0.5 * (of.lower + of.upper);
  return std::clamp(0.0, of.lower, of.upper);
}

/// Momenta of inner nodes: those with which arrows leave and reach them, in the mean.
void settle(ControlledScene& scene, ScenePath& path) {
  for (std::size_t k = 1; k + 1 < path.nodes.size(); ++k)
    for (int f = 0; f < scene.factors(); ++f) {
      const auto momenta = [&](const ControlledNode& from, const ControlledNode& to) {
        if (f < scene.linear()) {
          const Vec moved = to.places[std::size_t(f)] - from.places[std::size_t(f)];
          return arrow_momenta<double>(scene.inertia(f), scene.drag(f), moved, path.step);
        }
        const auto r = std::size_t(f - scene.linear());
        const Mat turn = from.attitudes[r].transpose() * to.attitudes[r];
        return arrow_momenta<double>(scene.inertia(f), scene.drag(f), scene.rotation(), turn, path.step);
      };
      path.nodes[k].momenta.segment<3>(3 * f) =
          0.5 * (momenta(path.nodes[k - 1], path.nodes[k]).target + momenta(path.nodes[k], path.nodes[k + 1]).source);
    }
}

ScenePath between_ends(const ControlledScene& scene) {
  const SceneControl& task = scene.task();
  ScenePath out;
  out.nodes.assign(std::size_t(task.stages) + 1, scene.start());
  out.nodes.back() = scene.end();
  out.controls = StageRows(task.stages, scene.actuators() + scene.joints());
  for (long k = 0; k < task.stages; ++k)
    for (int j = 0; j < scene.actuators(); ++j) out.controls[k][j] = resting(task.actuators[std::size_t(j)]);
  out.step = task.duration / double(task.stages);
  return out;
}

}  // namespace

ScenePath scene_guess(ControlledScene& scene, int index, const SceneSearchOptions& options) {
  ScenePath out = between_ends(scene);
  const long stages = out.stages();
  const int n = scene.n();
  Eigen::VectorXd whole = scene.difference(scene.start(), scene.end());
  const auto drift = index == 1 ? scene.drift(stages) : std::nullopt;
  if (drift) whole = scene.difference(drift->back(), scene.end());
  constexpr int modes = 3;
  Eigen::MatrixXd bends = Eigen::MatrixXd::Zero(n, modes);
  if (index > 1) {
    std::seed_seq sequence{std::uint32_t(options.seed), std::uint32_t(options.seed >> 32), std::uint32_t(index)};
    std::mt19937_64 generator(sequence);
    const double length = whole.head(n).norm();
    const double amplitude = options.amplitude > 0 ? options.amplitude : length > 1e-3 ? length : 1;
    std::uniform_real_distribution<double> octave(-3, 1);
    std::normal_distribution<double> normal(0, amplitude * std::exp2(octave(generator)));
    for (double& x : bends.reshaped()) x = normal(generator);
    if (scene.task().duration_is_free) out.step *= std::exp2(std::uniform_real_distribution<double>(-1, 1)(generator));
  }
  for (long k = 1; k < stages; ++k) {
    const double t = double(k) / double(stages);
    Eigen::VectorXd by = (drift ? t * t : t) * whole;
    for (int j = 0; j < modes; ++j) by.head(n) += std::sin((j + 1) * std::numbers::pi * t) / (j + 1) * bends.col(j);
    ControlledNode& node = out.nodes[std::size_t(k)];
    scene.displace(drift ? (*drift)[std::size_t(k)] : scene.start(), by.data(), 1, node);
    scene.project(node);  // where joints are not reached, the solver has to
  }
  settle(scene, out);
  return out;
}

ScenePath halved(ControlledScene& scene, const ScenePath& path) {
  ScenePath out;
  out.nodes.push_back(path.nodes.front());
  out.controls = StageRows(2 * path.stages(), path.controls.length());
  out.step = path.step / 2;
  for (long k = 0; k < path.stages(); ++k) {
    const ControlledNode& from = path.nodes[std::size_t(k)];
    const ControlledNode& to = path.nodes[std::size_t(k) + 1];
    const Eigen::VectorXd by = scene.difference(from, to);
    ControlledNode& middle = out.nodes.emplace_back(from);
    scene.displace(from, by.data(), 0.5, middle);
    middle.momenta = 0.5 * (from.momenta + to.momenta);
    scene.project(middle);
    out.nodes.push_back(to);
    for (const long half : {2 * k, 2 * k + 1})
      for (int j = 0; j < path.controls.length(); ++j)  // reactions are impulses
        out.controls[half][j] = path.controls[k][j] * (j < scene.actuators() ? 1 : 0.5);
  }
  return out;
}

void refuse_wide_steps(const ControlledScene& scene, SceneSolution& solution) {
  if (!solution.report.converged()) return;
  const std::vector<char>& planar = scene.motion().model().factors.planar;
  double widest = 0;
  long stage = 0;
  for (long k = 0; k < solution.path.stages(); ++k) {
    const ControlledNode& from = solution.path.nodes[std::size_t(k)];
    const ControlledNode& to = solution.path.nodes[std::size_t(k) + 1];
    for (int f = 0; f < scene.factors(); ++f) {
      const auto i = std::size_t(f < scene.linear() ? f : f - scene.linear());
      double turn = 0;
      if (f >= scene.linear())
        turn = SO3::log(Mat(from.attitudes[i].transpose() * to.attitudes[i])).norm();
      else if (planar[i])
        turn = std::abs(to.places[i](2) - from.places[i](2));
      if (turn <= widest) continue;
      widest = turn;
      stage = k;
    }
  }
  if (widest <= std::numbers::pi / 2) return;
  solution.report.status = ControlStatus::infeasible;
  solution.report.message = fmt::format(
      "stage {} turns a body by {:.2g} rad, and no step may turn one by more than a quarter turn, beyond which it "
      "would be free: take more stages, or start elsewhere",
      stage + 1, widest);
}

SceneSolution solve_scene(ControlledScene& scene, ScenePath start, const ControlOptions& options) {
  SceneTranscription transcription(scene, std::move(start));
  SceneSolution out;
  const CrossedSolution solved = solve_and_cross(transcription, options, [&](const auto& by) {
    out.path = transcription.path();
    out.costates = by.costates();
    out.inequality_multipliers = by.inequality_multipliers();
  });
  out.report = solved.report;
  out.crossover = solved.crossover;
  refuse_wide_steps(scene, out);
  return out;
}

SceneSearch search_scene(ControlledScene& scene, const SceneSearchOptions& options,
                         const std::function<bool(int)>& keep_going, const SceneSolver& solve) {
  SceneSearch found;
  search_starts(found, options, scene.task().duration_is_free, keep_going,
                [&](int start, double longer, const ControlOptions& solver) {
                  ScenePath path = scene_guess(scene, start, options);
                  if (longer != 1) {
                    path.step *= longer;
                    settle(scene, path);
                  }
                  return solve(scene, std::move(path), solver);
                });
  return found;
}

SceneSearch search_scene(SceneControl task, const SceneSearchOptions& options) {
  ControlledScene scene(std::move(task));
  return search_scene(scene, options);
}

}  // namespace lagroid::multibody
