#include "../registry.hpp"
#include "attitude.hpp"

#include <lagroid/solvers/plate_ball_boundary.hpp>

#include <algorithm>
#include <limits>

namespace lagroid::app {

namespace {

using G = PlateBall::GroupoidType;

Presentation<PlateBall> presentation(const PlateBall& system) {
  using Point = TrajectoryPoint<PlateBall>;
  Presentation<PlateBall> p;
  p.name = "plate_ball";
  p.position = {"x", "y"};
  p.position_unit = "m";
  p.has_attitude = true;
  p.body_is_transposed = true;
  p.momentum = {"px", "py", "M1", "M2", "M3"};
  p.momentum_unit = "m/s for px, py; m^2/s for M";
  p.multipliers = {"lambda1", "lambda2", "lambda3"};
  p.position_of = [](const Point& point) {
    const auto& q = std::get<0>(point.state.object);
    return std::vector<double>{q(0), q(1)};
  };
  p.attitude_of = [](const Point& point) { return quaternion_of(std::get<1>(point.configuration)); };
  p.extras = {{{"controls", {"u", "v"}, "m/s", "velocity of the contact point over the arrow", true, {}},
               [h = system.h](const Point& point, double* out) {
                 const auto& move = std::get<0>(point.step.arrow);
                 Eigen::Map<Vector<double, 2>> u(out);
                 u = (move.target - move.source) / h;
               }}};
  p.panels = {{"path of the contact point", "x", "y", "x", {"y"}, true},
              {"controls", "t", "u, v", "t", {"u", "v"}},
              {"constraint residual", "t", "largest |phi|", "t", {"residual"}},
              {"momentum errors", "t", "deviation", "t", {"drift spatial momentum A M", "drift J = x py - y px - M3"}}};
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k (body velocity); the ball one sees has attitude A^T"},
                   {"momentum", "px, py, M1, M2, M3 with M the body momentum"},
                   {"multipliers", "sign of L + <lambda, phi>, phi as in Marrero, Martin de Diego, Stern (8)"}};
  return p;
}

/// A step that is too large or a path of too few: blamed on the key that set it.
[[noreturn]] void refuse_time(const Section& scene, const std::string& why) {
  const Section time = scene.section_or_empty("time");
  time.fail(time.has("step") ? "step" : "steps", why);
}

ArrowOf<G> end_point(const Section& end) {
  const auto q = end.numbers("position", 2, "x, y");
  const Vector<double, 2> at(q[0], q[1]);
  const auto a = end.has("attitude") ? end.attitude("attitude") : std::array<double, 4>{1, 0, 0, 0};
  return {PairArrow<double, 2>{at, at}, rotation_from(a)};
}

/// [solver] starts and seed. Initial-value runs read them too, so that a scene may switch between the two.
PlateBallBoundaryOptions read_multistart(const Section& solver) {
  PlateBallBoundaryOptions options;
  options.starts = int(solver.integer_or("starts", options.starts, 1, 100000));
  options.seed = std::uint64_t(solver.integer_or("seed", long(options.seed), 0, std::numeric_limits<long>::max()));
  return options;
}

RunResult initial_value(const Section& scene, const RunContext& context, const PlateBall& system, long steps) {
  const Section initial = scene.section("initial", "position, attitude and momentum");
  const ArrowOf<G> configuration = end_point(initial);
  State<G> state;
  std::get<0>(state.object) = std::get<0>(configuration).source;
  state.momentum = Eigen::Map<const Vector<double, 5>>(initial.numbers("momentum", 5, "px, py, M1, M2, M3").data());
  const Section solver = scene.section_or_empty("solver");
  const StepperChoice choice = read_stepper(solver);
  read_multistart(solver);
  const long every = read_every(scene, context);
  scene.finish();
  return simulate(system, presentation(system), state, configuration, steps, choice, every, context);
}

/// Replays a solved path through the recorder.
void record(const PlateBall& system, const Path<PlateBall>& path, const ArrowOf<G>& start, long every,
            RunResult& result) {
  const auto p = presentation(system);
  Recorder<PlateBall> recorder(system, p, every);
  TrajectoryPoint<PlateBall> point;
  point.configuration = start;
  point.state = legendre_minus(system, path.front());
  recorder.observe(point);
  for (const auto& step : path) {
    ++point.index;
    point.time = double(point.index) * system.h;
    point.step = step;
    point.configuration = system.groupoid.project(system.groupoid.compose(point.configuration, step.arrow));
    point.state = legendre_plus(system, step);
    recorder.observe(point);
  }
  recorder.finish(result);
}

std::string counted(const std::map<SolveStatus, int>& outcomes) {
  std::string out;
  for (const auto& [status, count] : outcomes)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, to_string(status));
  return out;
}

RunResult boundary_value(const Section& scene, const RunContext& context, const PlateBall& system, long steps) {
  const Section boundary = scene.section("boundary", "start and end");
  const Section start_section = boundary.section("start", "position and attitude");
  const Section end_section = boundary.section("end", "position and attitude");
  const ArrowOf<G> start = end_point(start_section);
  const ArrowOf<G> end = end_point(end_section);
  const Section solver = scene.section_or_empty("solver");
  PlateBallBoundaryOptions options = read_multistart(solver);
  options.steps = steps;
  options.ceres = solver.choice_or("method", "newton", {"newton", "ceres"}) == "ceres";
  options.tolerance = solver.number_or("tolerance", options.tolerance, positive);
  options.max_iterations = int(solver.integer_or("max_iterations", options.max_iterations, 1, 1000000));
  const long every = read_every(scene, context);
  scene.finish();
  if (const auto why = unreachable(system, steps)) refuse_time(scene, *why);

  const auto clock = std::chrono::steady_clock::now();
  const ArrowOf<G> displacement{PairArrow<double, 2>{std::get<0>(start).target, std::get<0>(end).target},
                                SO3::project(Matrix<double, 3, 3>(std::get<1>(start).transpose() * std::get<1>(end)))};
  MultistartResult<PlateBall> found;
  {
    Progress progress("starts", options.starts, context.progress);
    options.report = [&](int done) { progress.update(done); };
    found = solve_plate_ball(system, displacement, options);
  }
  RunResult result;
  result.system = "plate_ball";
  result.steps_asked = steps;
  result.iterations = found.iterations;
  for (const auto& s : found.solutions)
    result.minima.push_back(
        {s.cost, {}, s.kind.is_minimum, s.kind.isolated, s.kind.normal, s.kind.negative_directions});
  for (std::size_t i = 0; i < found.solutions.size(); ++i) {
    const auto momentum = initial_momentum(system, found.solutions[i].path);
    result.minima[i].momentum.assign(momentum.data(), momentum.data() + momentum.size());
  }
  result.notes.push_back(fmt::format("{} starts: {}", options.starts, counted(found.outcomes)));
  if (found.lost > 0)
    result.notes.push_back(
        fmt::format("{} solution(s) of the coarse problem could not be continued to this one", found.lost));

  const auto best =
      std::find_if(found.solutions.begin(), found.solutions.end(), [](const auto& s) { return s.kind.is_minimum; });
  if (best != found.solutions.end()) {
    record(system, best->path, start, every, result);
    result.cost = best->cost;
    result.steps = steps;
    if (best != found.solutions.begin())
      result.notes.push_back(
          fmt::format("a cheaper stationary path (cost {:.6g}) is no minimum: paths cheaper still lie "
                      "beside it and were not reached; try more starts or another number of steps",
                      found.solutions.front().cost));
    if (!best->kind.normal)
      result.notes.push_back(
          "the best path is abnormal: its constraints lose rank there, multipliers and momentum are not "
          "unique (the smallest are given)");
    if (!best->kind.isolated)
      result.notes.push_back("the best path is one of a continuous family of equal cost; its momentum is one of many");
  } else {
    const auto& failure = found.best_failure;
    if (found.solutions.empty()) {
      result.status = std::string(to_string(failure.status));
      result.message = fmt::format(
          "boundary value: none of {} starts converged (best residual {:.3g}); use more steps, "
          "more starts or a longer duration",
          options.starts, failure.residual);
    } else {
      result.status = "no_minimum";
      result.message =
          fmt::format("boundary value: {} stationary point(s) found, none of them a minimum; use more starts",
                      found.solutions.size());
    }
    const auto& path = found.solutions.empty() ? failure.path : found.solutions.front().path;
    if (!path.empty()) {
      record(system, path, start, every, result);
      for (auto& entry : result.ledger.entries) entry.verdict = "unjudged";
    }
  }
  result.ledger.mean_iterations = double(found.start_iterations) / double(options.starts);
  result.ledger.most_iterations = found.most_iterations;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return result;
}

}  // namespace

RunResult run_plate_ball(const Section& scene, const RunContext& context) {
  const Section parameters = scene.section_or_empty("parameters");
  PlateBall system;
  system.radius = parameters.number_or("radius", 1, positive);
  system.plate_rate = parameters.number_or("plate_rate", 0);
  system.spin = parameters.number_or("spin", 0);
  const std::string form = parameters.choice_or("rotation", "trace", {"trace", "exp", "cayley"});
  system.rotation = form == "trace" ? RotationForm::trace
                    : form == "exp" ? RotationForm::exponential
                                    : RotationForm::cayley;
  const TimeGrid grid = read_time(scene);
  system.h = grid.step;
  if (const auto why = system.infeasible()) refuse_time(scene, *why);
  if (scene.has("initial") && scene.has("boundary")) scene.fail("boundary", "give [initial] or [boundary], not both");
  if (scene.has("boundary")) return boundary_value(scene, context, system, grid.steps);
  if (!scene.has("initial"))
    scene.fail("", "missing table [initial] (position, attitude, momentum) or [boundary] (start, end)");
  return initial_value(scene, context, system, grid.steps);
}

}  // namespace lagroid::app
