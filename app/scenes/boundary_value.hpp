#pragma once
/// Boundary-value scenes of any system: paths g_1 ... g_N = g for which the action is stationary, searched from many
/// first guesses and, with [continuation], along a parameter.
///
///     const PreparedScene<Sys> prepared = boundary_value<Sys>(scene, context, presentation, read_ends<Sys>);
///     const RunResult result = prepared.run(nullptr);
///
/// Requires a variational system that does not depend on time. Returns the cheapest minimum found, or stationary path
/// where the scene wants one, and all others in RunResult::stationary_paths; where there is none, a status and the best
/// path as far as it came. Errors: SceneError for a mistake in the scene, before anything is computed.
///
/// Source: [G] section 5.

#include "../keys/key.hpp"
#include "boundary_times.hpp"
#include "simulation.hpp"

#include <lagroid/run/files/checkpoint.hpp>
#include <lagroid/run/motion/recorder.hpp>
#include <lagroid/run/motion/system_node.hpp>
#include <lagroid/run/reports/progress.hpp>
#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// The tables of a boundary value; both ends hold the keys of `end`.
Table boundary_table(const Table& end);
Table boundary_time_table(const std::vector<std::string>& modes, bool depends_on_time);
Table boundary_solver_table();
Table continuation_table();

/// [solver] of a boundary-value run.
struct BoundaryChoice {
  BoundaryMethod method = BoundaryMethod::newton;
  std::optional<StationaryKind> stationary_kind;
  std::size_t path = 0;  ///< among all that were found, from the cheapest, 1; 0: the cheapest of that kind
  BoundaryOptions options;
  MultistartOptions multistart;
  std::vector<std::string> notes;  ///< of keys that were given by their old names
};
BoundaryChoice read_boundary_solver(const Section& solver);

/// [solver] starts and seed. Scenes of the plate-ball read them from initial values too, so that they may switch
/// between the two.
std::vector<Key> multistart_keys();
MultistartOptions read_multistart(const Section& solver);

/// [continuation]: a parameter of the scene that goes from other numbers (`from`, at s = 0) to the scene's own (`to`,
/// at s = 1).
struct ContinuationChoice {
  std::string parameter;
  std::vector<double> from;
  std::vector<double> to;
  long steps = 10;  ///< of equal size, to begin with

  std::vector<double> at(double s) const;
  std::string value(double s) const;  ///< in words
  Section scene_at(const Section& scene, double s) const;
};
std::optional<ContinuationChoice> read_continuation(const Section& scene);

/// True for [boundary], false for [initial]; refuses a scene with both or neither. `initial` is what [initial] holds,
/// in words for the message.
bool is_boundary_value(const Section& scene, const std::string& initial);

/// A boundary-value problem as a scene states it: the configuration at the start, and the arrow from there to the end.
template <DiscreteSystem Sys> struct BoundaryScene {
  BoundaryStage<EqualSteps<Sys>> stage;
  ArrowOf<typename Sys::GroupoidType> start;
};

/// Returns read(S), S the scene with its continuation at s. An error of S is reported as one of `continuation.from`:
/// the scene itself may be right.
template <class Read>
auto read_along(const Section& scene, const ContinuationChoice& along, double s, const Read& read) {
  try {
    return read(along.scene_at(scene, s));
  } catch (const SceneError& error) {
    scene.section_or_empty("continuation")
        .fail("from", fmt::format("at {} = {}: {}", along.parameter, along.value(s), error.problem()));
  }
}

/// The round-off of F+(g, lambda), relative to its size: the arrow's own, which the step divides by h, included.
template <DiscreteSystem Sys>
double evaluation_noise(const Sys& system, const Step<Sys>& step, const State<typename Sys::GroupoidType>& state) {
  const double size = state.momentum.norm();
  if (size == 0) return 0;
  const auto jacobian = StepEquations<Sys>::jacobian(two_sided(system, step.arrow, step.multipliers));
  return round_off_level(system, state, step, jacobian).template head<Sys::dimension>().maxCoeff() / size;
}

/// The system on the k-th arrow of a path of such steps.
template <DiscreteSystem Sys> Sys on_arrow(Sys system, TimeMode mode, const TimedPath<Sys>& timed, std::size_t k) {
  if (mode == TimeMode::fixed) {
    set_time(system, timed.times[k]);
  } else {
    set_arrow(system, timed.times[k], timed.times[k + 1] - timed.times[k]);
  }
  return system;
}

/// The state at the k-th node of a path, by the momentum of the arrow before or after it.
template <DiscreteSystem Sys>
State<typename Sys::GroupoidType> node_of(State<typename Sys::GroupoidType> by_arrow, const TimedSolution<Sys>& timed,
                                          std::size_t k) {
  if (!timed.momenta.empty()) by_arrow.momentum = timed.momenta[k];
  return by_arrow;
}

/// Records and judges a solved path, of whose nodes each `every`-th is recorded, and the last; 0: none.
template <DiscreteSystem Sys>
void record_path(const Sys& system, const Presentation<Sys>& presentation, const TimedSolution<Sys>& timed,
                 const ArrowOf<typename Sys::GroupoidType>& start, TimeMode mode, long every,
                 const Observer<Sys>& observer, RunResult& result) {
  const Path<Sys>& path = timed.path;
  const IntegratorOptions steps{.mode = mode};
  Presentation<Sys> shown = with_step_sizes(presentation, steps);
  if (!timed.step_multipliers.empty()) {
    shown.extras.push_back({{"step_multiplier", {"nu"}, "unit of the energy", "of t1 - t0 = h(g)", true, {}},
                            [&timed](const TrajectoryPoint<Sys>& point, double* out) {
                              *out = timed.step_multipliers[std::size_t(point.index - 1)];
                            }});
    shown.panels.push_back({"multiplier of the step", "t", "nu", "t", {"nu"}});
  }
  SystemNode<Sys> node(system, shown, mode == TimeMode::fixed ? quantities_of(system) : watched(system, steps));
  Judge judge(node);
  Recorder recorder(node);
  TrajectoryPoint<Sys> point;
  const auto see = [&](double noise) {
    node.see(point, noise);
    if (observer) observer(node.point());
    judge.observe(node);
    if (every > 0 && (point.index % every == 0 || point.index == std::ssize(path))) recorder.record(node, &judge);
  };
  point.configuration = start;
  if constexpr (HasTimeStep<Sys>) point.time = timed.times.front();
  point.state = node_of(legendre_minus(on_arrow(system, mode, timed, 0), path.front()), timed, 0);
  see(0);
  result.initial = node.endpoint();
  for (std::size_t k = 0; k < path.size(); ++k) {
    const Step<Sys>& step = path[k];
    const Sys there = on_arrow(system, mode, timed, k);
    ++point.index;
    if constexpr (HasTimeStep<Sys>) {
      point.time = timed.times[k + 1];
      point.step_size = there.h;
    }
    point.step = step;
    point.configuration = system.groupoid.project(system.groupoid.compose(point.configuration, step.arrow));
    point.state = node_of(legendre_plus(there, step), timed, k + 1);
    see(evaluation_noise(there, step, point.state));
  }
  judge.report(result.ledger);
  if (every > 0) result.trajectory = std::move(recorder.trajectory());
  result.system = presentation.name;
  result.final = node.endpoint();
  const auto list = [](const auto& v) { return std::vector<double>(v.begin(), v.end()); };
  result.first_multipliers = list(path.front().multipliers);
  result.last_multipliers = list(path.back().multipliers);
  present(shown, result);
}

/// Follows every solution found at the beginning of a continuation to its end. Returns the largest s that one reached.
template <DiscreteSystem Sys, class Read>
double continue_solutions(const BoundarySolver<Sys>& solver, const Section& scene, const ContinuationChoice& along,
                          const Read& read, const RunContext& context, MultistartResult<Sys>& found,
                          RunResult& result) {
  const auto stage = [&](double s) { return read_along(scene, along, s, read).stage; };
  HomotopyOptions options;
  options.first_step = 1 / double(along.steps);
  std::vector<BoundarySolution<Sys>> arrived;
  std::optional<std::pair<double, SolveStatus>> farthest;
  Progress progress("solutions", long(found.solutions.size()), context.progress);
  const std::size_t count = found.solutions.size();
  std::size_t arrivals = 0;
  for (std::size_t i = 0; i < count; ++i) {
    auto followed = lagroid::follow(solver, stage, std::move(found.solutions[i]), options);
    found.iterations += followed.iterations;
    if (followed.converged()) {
      ++arrivals;
      detail::keep_if_new(arrived, stage(1).problem.system, std::move(followed.solution));
    } else if (!farthest || followed.reached > farthest->first) {
      farthest = {followed.reached, followed.status};
      if (arrived.empty()) found.best_failure = std::move(followed.solution);
    }
    progress.update(long(i) + 1);
  }
  result.notes.push_back(
      fmt::format("continuation of {} from {} to {}: {} of {} solution(s) arrived{}", along.parameter, along.value(0),
                  along.value(1), arrivals, count,
                  arrived.size() < arrivals ? fmt::format(", {} of them different", arrived.size()) : ""));
  if (farthest) {
    result.notes.push_back(fmt::format("continuation: of those lost, the last came to {} = {} ({})", along.parameter,
                                       along.value(farthest->first), to_string(farthest->second)));
    if (arrived.empty()) {
      result.status = std::string(to_string(farthest->second));
      result.message = fmt::format(
          "continuation: no solution could be followed beyond {} = {}; a path of solutions may turn back there: use "
          "more continuation.steps or another parameter",
          along.parameter, along.value(farthest->first));
    }
  }
  std::sort(arrived.begin(), arrived.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  found.solutions = std::move(arrived);
  return found.solutions.empty() ? farthest->first : 1;
}

/// Chooses a path and records it, with a note on the choice; or writes why there is none.
template <DiscreteSystem Sys>
void report_solutions(const BoundaryScene<Sys>& problem, const Presentation<Sys>& presentation, StationaryKind kind,
                      std::size_t asked, const FoundPaths<Sys>& found, TimeMode mode, long every,
                      const Observer<Sys>& observer, RunResult& result) {
  const Sys& system = untimed<Sys>(problem.stage.problem.system);
  const auto record = [&](const TimedSolution<Sys>& path) {
    record_path(system, presentation, path, problem.start, mode, every, observer, result);
  };
  for (const auto& s : found.solutions) {
    const auto by_arrow = legendre_minus(on_arrow(system, mode, s, 0), s.path.front());
    const auto momentum = tangent_momentum(system, node_of(by_arrow, s, 0));
    result.stationary_paths.push_back({s.cost,
                                       s.starts,
                                       {momentum.data(), momentum.data() + momentum.size()},
                                       s.kind.is_minimum,
                                       s.kind.isolated,
                                       s.kind.normal,
                                       s.kind.negative_directions});
  }
  const auto cheapest = std::find_if(found.solutions.begin(), found.solutions.end(), [&](const auto& s) {
    return kind == StationaryKind::stationary || s.kind.is_minimum;
  });
  const auto best = asked > 0 ? found.solutions.begin() + long(asked - 1) : cheapest;
  if (best != found.solutions.end()) {
    record(*best);
    result.cost = best->cost;
    result.steps = long(best->path.size());
    const std::string which =
        asked > 0 ? fmt::format("path {} of {}, counted from the cheapest", asked, found.solutions.size())
                  : "the cheapest of those found";
    result.notes.push_back(fmt::format("{}: {} of {} starts led to it", which, best->starts, found.starts));
    if constexpr (Timed<Sys>)
      if (mode != TimeMode::fixed) result.notes.push_back(words_of_steps(*best));
    if (asked == 0 && best != found.solutions.begin())
      result.notes.push_back(
          fmt::format("a cheaper stationary path (cost {:.6g}) is no minimum: paths cheaper still lie "
                      "beside it and were not reached; try more starts or another number of steps",
                      found.solutions.front().cost));
    if (!best->kind.is_minimum)
      result.notes.push_back(fmt::format(
          "the path given is stationary but no minimum of the action: {} direction(s) lower it, as for every motion "
          "past a conjugate point",
          best->kind.negative_directions));
    if (!best->kind.normal)
      result.notes.push_back(
          "the best path is abnormal: its constraints lose rank there, multipliers and momentum are not "
          "unique (the smallest are given)");
    if (!best->kind.isolated)
      result.notes.push_back("the best path is one of a continuous family of equal cost; its momentum is one of many");
    return;
  }
  const auto& failure = found.best_failure;
  if (!found.solutions.empty()) {
    result.status = "no_minimum";
    result.message =
        fmt::format("boundary value: {} stationary point(s) found, none of them a minimum; use more starts",
                    found.solutions.size());
  } else if (result.message.empty()) {
    result.status = std::string(to_string(failure.status));
    result.message = failure.message.empty()
                         ? fmt::format(
                               "boundary value: none of {} starts converged (best residual {:.3g}); use more steps, "
                               "more starts{} or a longer duration",
                               found.starts, failure.residual,
                               failure.status == SolveStatus::not_converged ? ", a larger solver.max_iterations" : "")
                         : fmt::format("boundary value: none of {} starts converged; the best of them: {}",
                                       found.starts, failure.message);
  }
  const TimedSolution<Sys>& path = found.solutions.empty() ? failure : found.solutions.front();
  if (!path.path.empty()) {
    record(path);
    for (auto& entry : result.ledger.entries) {
      entry.verdict = "unjudged";
      entry.reason = "the path is no solution";
    }
  }
}

/// Everything that a boundary-value run takes from its scene.
template <DiscreteSystem Sys> struct BoundaryRun {
  Section scene;
  Presentation<Sys> presentation;
  BoundaryScene<Sys> problem;
  BoundaryStage<EqualSteps<Sys>> first;  ///< where the continuation begins; the problem itself without one
  BoundaryChoice choice;
  std::optional<ContinuationChoice> along;
  TimeMode mode = TimeMode::fixed;
  long every = 0;
};

/// Searches, continues, varies the steps, reports. `search(solver, stage, options)` is the multistart.
template <DiscreteSystem Sys, class Read, class Search>
RunResult solve_boundary_scene(const BoundaryRun<Sys>& run, const RunContext& context, const Read& read,
                               const Search& search, const Observer<Sys>& observer) {
  const auto& [scene, presentation, problem, first, choice, along, mode, every] = run;
  using Equal = EqualSteps<Sys>;
  const auto clock = std::chrono::steady_clock::now();
  const auto solver = make_boundary_solver<Equal>(choice.method, choice.options,
                                                  choice.stationary_kind.value_or(natural_stationary_kind<Equal>));
  MultistartOptions multistart = choice.multistart;
  MultistartResult<Equal> found;
  {
    Progress progress("starts", multistart.starts, context.progress);
    multistart.report = [&](int done) { progress.update(done); };
    found = search(*solver, first, multistart);
  }
  RunResult result;
  result.system = presentation.name;
  result.steps_asked = long(problem.stage.steps);
  std::string counted;
  for (const auto& [status, count] : found.outcomes)
    counted += fmt::format("{}{} {}", counted.empty() ? "" : ", ", count, to_string(status));
  result.starts = found.starts;
  result.notes = choice.notes;
  result.notes.push_back(fmt::format("{} starts: {}", found.starts, counted));
  if (found.lost > 0)
    result.notes.push_back(
        fmt::format("{} solution(s) of the coarse problem could not be continued to this one", found.lost));
  double reached = 1;
  if (along && !found.solutions.empty())
    reached = continue_solutions(*solver, scene, *along, read, context, found, result);
  // Where nothing arrived, the farthest path is one of the problem it was solved for.
  const BoundaryScene<Sys> solved = reached < 1 ? read_along(scene, *along, reached, read) : problem;
  FoundPaths<Sys> paths(solved.stage, found);
  if constexpr (Timed<Sys>)
    if (mode != TimeMode::fixed && !paths.solutions.empty())
      vary_steps(mode, untimed<Sys>(solved.stage.problem.system), untimed_boundary<Sys>(solved.stage.problem),
                 solver->stationary_kind(), paths, result);
  result.iterations = paths.iterations;
  if (choice.path > paths.solutions.size() && !paths.solutions.empty())
    scene.section_or_empty("solver").fail("path",
                                          fmt::format("{} stationary path(s) were found", paths.solutions.size()));
  const std::size_t asked = paths.solutions.empty() ? 0 : choice.path;
  report_solutions(solved, presentation, solver->stationary_kind(), asked, paths, mode, every, observer, result);
  result.ledger.mean_iterations = double(found.start_iterations) / double(found.starts);
  result.ledger.most_iterations = found.most_iterations;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return result;
}

/// A boundary-value run. `read(scene)` gives the BoundaryScene of a scene, with every check of its data.
template <DiscreteSystem Sys, class Read, class Search>
PreparedScene<Sys> boundary_value(const Section& scene, const RunContext& context,
                                  const Presentation<Sys>& presentation, const Read& read, const Search& search) {
  const BoundaryScene<Sys> stated = read(scene);
  const long every = read_every(scene);
  BoundaryRun<Sys> run{scene,
                       presentation,
                       stated,
                       stated.stage,
                       read_boundary_solver(scene.section_or_empty("solver")),
                       read_continuation(scene),
                       read_boundary_mode<Sys>(scene),
                       context.record ? every : 0};
  refuse_accuracy(scene);
  scene.finish();
  const auto& problem = run.problem.stage;
  if (const auto why = inadmissible_ends(problem.problem)) scene.section_or_empty("boundary").fail("", *why);
  if (problem.steps < 2) scene.section_or_empty("time").fail("steps", "a boundary value needs at least 2 steps");
  if (run.along) run.first = read_along(scene, *run.along, 0, read).stage;
  if (const auto why = inadmissible_ends(run.first.problem)) scene.section("continuation", "").fail("from", *why);
  return {untimed<Sys>(problem.problem.system),
          [=](const Observer<Sys>& observer) {
            std::optional<Checkpoint> folder;
            if (!context.folder.empty()) folder.emplace(context.folder, 0).remove();
            return solve_boundary_scene(run, context, read, search, observer);
          },
          nullptr};
}

/// The same with the multistart that serves any system.
template <DiscreteSystem Sys, class Read>
PreparedScene<Sys> boundary_value(const Section& scene, const RunContext& context,
                                  const Presentation<Sys>& presentation, const Read& read) {
  return boundary_value<Sys>(scene, context, presentation, read,
                             [](const BoundarySolver<EqualSteps<Sys>>& solver,
                                const BoundaryStage<EqualSteps<Sys>>& stage, const MultistartOptions& options) {
                               return lagroid::solve_boundary(solver, stage.problem, stage.steps, options);
                             });
}

}  // namespace lagroid::app
