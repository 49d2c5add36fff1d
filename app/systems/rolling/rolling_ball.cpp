#include "../../scenes/arrow_format.hpp"
#include "../../scenes/attitude.hpp"
#include "../../scenes/simulation.hpp"
#include "../../scenes/system_module.hpp"

#include <lagroid/systems/rolling/rolling_ball.hpp>

namespace lagroid::app {

namespace {

using G = RollingBall::GroupoidType;

RollingBall read_system(const Section& scene) {
  auto system = read_parameters<RollingBall>(scene);
  system.h = read_time(scene).step;
  return system;
}

Presentation<RollingBall> presentation(const RollingBall& system) {
  using Point = TrajectoryPoint<RollingBall>;
  const std::string energy = system.plate_rate == 0 ? "energy" : "moving energy E - Omega J";
  Presentation<RollingBall> p;
  p.name = "rolling_ball";
  p.position = {"x", "y"};
  p.position_unit = "m";
  p.has_attitude = true;
  p.momentum = {"px", "py", "M1", "M2", "M3"};
  p.momentum_unit = "kg m/s for px, py; kg m^2/s for M";
  p.multipliers = {"lambda1", "lambda2"};
  p.position_of = [](const Point& point) {
    const auto& q = std::get<0>(point.state.object);
    return std::vector<double>{q(0), q(1)};
  };
  p.attitude_of = [](const Point& point) {
    return quaternion_of(Matrix<double, 3, 3>(std::get<1>(point.configuration).transpose()));
  };
  p.extras = {{{"angular_velocity", {"w1", "w2", "w3"}, "rad/s", "of the ball, in space", false, {}},
               [system](const Point& point, double* out) {
                 Eigen::Map<Vector<double, 3>> w(out);
                 w = system.angular_velocity(point.state);
               }}};
  p.conventions = {{"attitude", "R of the ball, R_k = exp(h w) R_{k-1}; the groupoid carries its transpose"},
                   {"momentum", "px, py, M with M = -k m r^2 w, w the angular velocity in space"},
                   {"multipliers", "impulses of the reaction at the object the arrow starts from"}};
  p.shapes = {ball_on_plate(system.radius), turning_plate(system.plate_rate)};
  p.panels = {{"path of the point of contact", "x", "y", "x", {"y"}, true},
              attitude_panel(),
              {"angular velocity in space", "t", "w", "t", {"w1", "w2", "w3"}},
              {"constraint residual", "t", "largest |phi|", "t", {"residual"}},
              {energy + ", error", "t", "deviation", "t", {"drift " + energy}}};
  return p;
}

const KeyOf<NumberArray> position{"position", {2}, "m", "x, y"};
const KeyOf<NumberArray> velocity{"velocity", {2}, "m/s", "of the centre, dx/dt and dy/dt"};
const KeyOf<Number> spin{"spin", {}, "rad/s", "about the vertical; rolling says the rest of the angular velocity", 0.0};

SystemKeys own_keys() {
  return {parameter_keys<RollingBall>(), {position, velocity, spin, ArrowFormat<SO3>::declared(ArrowFormat<SO3>::key)}};
}

PreparedScene<RollingBall> read(const Section& scene, const RunContext& context) {
  const RollingBall system = read_system(scene);
  refuse_boundary<RollingBall>(scene);
  const Section initial = scene.section("initial", "position, velocity, spin and attitude");
  const auto at = read_key(initial, position);
  const auto v = read_key(initial, velocity);
  const Vector<double, 2> q(at[0], at[1]);
  const auto state = system.rolling(q, {v[0], v[1]}, read_key(initial, spin));
  const ArrowOf<G> configuration{PairArrow<double, 2>{q, q},
                                 ArrowFormat<SO3>::read(initial, ArrowFormat<SO3>::key).transpose()};
  return simulation(scene, context, system, presentation(system), state, configuration);
}

}  // namespace

const SystemModule& rolling_ball_module() {
  static const ModuleOf<RollingBall> module("rolling_ball", "ball rolling on a rotating plate (nonholonomic)", read,
                                            own_keys);
  return module;
}

}  // namespace lagroid::app
