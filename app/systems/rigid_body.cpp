#include "readers.hpp"
#include "rotating.hpp"

#include <lagroid/systems/moser_veselov.hpp>
#include <lagroid/systems/moser_veselov_method.hpp>

#include <algorithm>
#include <array>

namespace lagroid::app {

namespace {

RigidBody read_system(const Section& scene) {
  const Section parameters = scene.section("parameters", "inertia, the three principal moments");
  RigidBody system;
  system.inertia = read_inertia(parameters);
  system.rotation = read_rotation_map(parameters);
  system.h = read_time(scene).step;
  return system;
}

BoundaryScene<RigidBody> read_boundary(const Section& scene) { return read_turn(scene, read_system(scene)); }

template <class Sys> Presentation<Sys> presentation(const Sys& system) {
  using Point = TrajectoryPoint<Sys>;
  Presentation<Sys> p;
  p.name = "rigid_body";
  p.has_attitude = true;
  p.momentum = {"M1", "M2", "M3"};
  p.momentum_unit = "kg m^2/s";
  p.position_of = [](const Point&) { return std::vector<double>{}; };
  p.attitude_of = [](const Point& point) { return quaternion_of(point.configuration); };
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k carries body to space"}, {"momentum", "body angular momentum M"}};
  p.shapes = {box_of({system.inertia(0), system.inertia(1), system.inertia(2)})};
  p.extras = {angular_velocity_of<Sys>(system.inertia)};
  p.panels = turning_panels();
  p.panels.push_back({"energy error", "t", "|H - H_0|", "t", {"drift energy"}});
  p.panels.push_back({"spatial momentum error", "t", "|A M - (A M)_0|", "t", {"drift spatial momentum A M"}});
  return p;
}

/// The method of [time] that is the body's own: the same motion by the preprocessed discrete Moser-Veselov algorithm.
Task<RigidBody> moser_veselov(const Section& scene, const RunContext& context, const RigidBody& body,
                              const State<SO3>& state, const Matrix<double, 3, 3>& attitude) {
  const Section time = scene.section("time", "step and steps");
  refuse_accuracy(scene);
  const auto& orders = moser_veselov_orders;
  const int order = int(time.integer_or("order", moser_veselov_method.order, orders.front(), orders.back()));
  if (std::find(orders.begin(), orders.end(), order) == orders.end())
    time.fail("order", fmt::format("must be {}, got {}", any_of_these(orders), order));
  const Pace pace = read_pace(scene, context);
  scene.finish();
  MoserVeselov system;
  try {
    system = MoserVeselov::preprocessed(body.inertia, state.momentum, body.h, order);
  } catch (const std::domain_error& error) {
    time.fail(time.has("step") ? "step" : "duration", error.what());
  }
  return {body,
          [=](const Observer<RigidBody>& observer) {
            const Observer<MoserVeselov> as_body = [&](const TrajectoryPoint<MoserVeselov>& p) {
              observer({p.index, p.time, p.step_size, p.state, p.configuration, {p.step.arrow, {}}});
            };
            return simulate(system, presentation(system), state, attitude, {}, pace, context,
                            observer ? as_body : nullptr);
          },
          [=] { return motion_of(system, presentation(system), state, attitude, {}); }};
}

void add_moser_veselov(std::vector<Method>& methods) {
  const std::string_view name = moser_veselov_method.name;
  for (const int order : moser_veselov_orders)
    methods.push_back({fmt::format("{}/{}", name, order),
                       order,
                       moser_veselov_method.stages,
                       true,
                       {fmt::format("time.method={}", name), fmt::format("time.order={}", order)}});
}

}  // namespace

Task<RigidBody> read_rigid_body(const Section& scene, const RunContext& context) {
  const RigidBody system = read_system(scene);
  const auto p = presentation(system);
  if (is_boundary_value(scene, "attitude and momentum"))
    return boundary_value<RigidBody>(scene, context, p, read_boundary);
  const Section initial = scene.section("initial", "attitude and momentum");
  const State<SO3> state = read_turning(initial);
  const Matrix<double, 3, 3> attitude = read_rotation(initial);
  const std::array own{moser_veselov_method};
  if (read_method_word(scene.section_or_empty("time"), own) == moser_veselov_method.name)
    return moser_veselov(scene, context, system, state, attitude);
  Task<RigidBody> task = simulation(scene, context, system, p, state, attitude);
  add_moser_veselov(task.methods);
  return task;
}

}  // namespace lagroid::app
