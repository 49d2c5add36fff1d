#include "../../scenes/arrow_format.hpp"
#include "../../scenes/attitude.hpp"
#include "../../scenes/boundary_value.hpp"
#include "../../scenes/system_module.hpp"

#include <lagroid/systems/control/plate_ball.hpp>

#include <lagroid/systems/control/plate_ball_boundary.hpp>

namespace lagroid {
LAGROID_VARIED_STEPS(extern template, PlateBall);
}

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
               [](const Point& point, double* out) {
                 const auto& move = std::get<0>(point.step.arrow);
                 Eigen::Map<Vector<double, 2>> u(out);
                 u = (move.target - move.source) / point.step_size;
               }},
              {{"angular_velocity", {"w1", "w2", "w3"}, "rad/s", "body velocity of A over the arrow", true, {}},
               [system](const Point& point, double* out) {
                 Eigen::Map<Vector<double, 3>> w(out);
                 w = system.rotation_vector(std::get<1>(point.step.arrow)) / point.step_size;
               }}};
  Shape ball = ball_on_plate(system.radius);
  ball.transposed = true;
  p.shapes = {ball, turning_plate(system.plate_rate)};
  p.panels = {{"path of the contact point", "x", "y", "x", {"y"}, true},
              {"controls", "t", "u, v", "t", {"u", "v"}},
              attitude_panel(),
              {"angular velocity", "t", "w", "t", {"w1", "w2", "w3"}},
              {"momentum of turning", "t", "M", "t", {"M1", "M2", "M3"}},
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
  time.fail(time.has("step") ? "step" : time.has("accuracy") ? "accuracy" : "steps", why);
}

const KeyOf<NumberArray> position{"position", {2}, "m", "x, y"};
const KeyOf<NumberArray> momentum{"momentum", {5}, "", "px, py, M1, M2, M3 at the first object"};

SystemKeys own_keys() {
  const std::vector<Key> end{position, ArrowFormat<SO3>::declared(ArrowFormat<SO3>::key)};
  std::vector<Key> initial = end;
  initial.push_back(momentum);
  return {parameter_keys<PlateBall>(), std::move(initial), end, multistart_keys()};
}

ArrowOf<G> end_point(const Section& end) {
  const auto q = read_key(end, position);
  const Vector<double, 2> at(q[0], q[1]);
  return {PairArrow<double, 2>{at, at}, ArrowFormat<SO3>::read(end, ArrowFormat<SO3>::key)};
}

PreparedScene<PlateBall> initial_value(const Section& scene, const RunContext& context, const PlateBall& system) {
  const Section initial = scene.section("initial", "position, attitude and momentum");
  const ArrowOf<G> configuration = end_point(initial);
  State<G> state;
  std::get<0>(state.object) = std::get<0>(configuration).source;
  state.momentum = Eigen::Map<const Vector<double, 5>>(read_key(initial, momentum).data());
  read_multistart(scene.section_or_empty("solver"));
  return simulation(scene, context, system, presentation(system), state, configuration);
}

/// [parameters] and [time].
PlateBall read_system(const Section& scene) {
  auto system = read_parameters<PlateBall>(scene);
  system.h = read_time(scene).step;
  if (const auto why = system.infeasible()) refuse_time(scene, *why);
  return system;
}

BoundaryScene<PlateBall> read_boundary(const Section& scene) {
  const PlateBall system = read_system(scene);
  const long steps = read_time(scene).steps;
  const Section boundary = scene.section("boundary", "start and end");
  const ArrowOf<G> start = end_point(boundary.section("start", "position and attitude"));
  const ArrowOf<G> end = end_point(boundary.section("end", "position and attitude"));
  if (const auto why = unreachable(system, steps)) refuse_time(scene, *why);
  const ArrowOf<G> displacement{PairArrow<double, 2>{std::get<0>(start).target, std::get<0>(end).target},
                                SO3::project(Matrix<double, 3, 3>(std::get<1>(start).transpose() * std::get<1>(end)))};
  return {{{system, displacement}, std::size_t(steps)}, start};
}

MultistartResult<PlateBall> search(const BoundarySolver<PlateBall>& solver, const BoundaryStage<PlateBall>& stage,
                                   const MultistartOptions& multistart) {
  PlateBallBoundaryOptions options;
  options.steps = long(stage.steps);
  options.starts = multistart.starts;
  options.seed = multistart.seed;
  options.report = multistart.report;
  return solve_plate_ball(solver, stage.problem.system, stage.problem.boundary, options);
}

PreparedScene<PlateBall> read(const Section& scene, const RunContext& context) {
  const PlateBall system = read_system(scene);
  if (is_boundary_value(scene, "position, attitude, momentum"))
    return boundary_value<PlateBall>(scene, context, presentation(system), read_boundary, search);
  return initial_value(scene, context, system);
}

}  // namespace

const SystemModule& plate_ball_module() {
  static const ModuleOf<PlateBall> module("plate_ball", "optimal control of a ball rolling on a rotating plate", read,
                                          own_keys);
  return module;
}

}  // namespace lagroid::app
