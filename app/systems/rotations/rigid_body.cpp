#include "../../scenes/any_system.hpp"
#include "../../scenes/scene_keys.hpp"
#include "rotating.hpp"

#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/moser_veselov_method.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <algorithm>
#include <array>

namespace lagroid {
LAGROID_VARIED_STEPS(extern template, RigidBody);
}

namespace lagroid::app {

namespace {

template <class Sys> void dress(Presentation<Sys>& p, const Sys& system) {
  p.momentum = {"M1", "M2", "M3"};
  p.momentum_unit = "kg m^2/s";
  p.conventions = {{"attitude", "A_k = A_{k-1} g_k carries body to space"}, {"momentum", "body angular momentum M"}};
  p.shapes = {box_of({system.inertia(0), system.inertia(1), system.inertia(2)})};
  p.extras = {angular_velocity_of<Sys>(system.inertia)};
  p.panels = turning_panels();
  p.panels.push_back({"energy error", "t", "|H - H_0|", "t", {"drift energy"}});
  p.panels.push_back({"spatial momentum error", "t", "|A M - (A M)_0|", "t", {"drift spatial momentum A M"}});
}

constexpr const char* name = "rigid_body";

/// The method of [time] that is the body's own: the same motion by the preprocessed discrete Moser-Veselov algorithm.
PreparedScene<RigidBody> moser_veselov(const Section& scene, const RunContext& context) {
  const auto body = read_system<RigidBody>(scene);
  const auto initial = read_initial(body, scene, {"M1", "M2", "M3"});
  const Section time = scene.section("time", "step and steps");
  refuse_accuracy(scene);
  const auto& orders = moser_veselov_orders;
  const int order = int(read_key(time, time_keys::order(moser_veselov_method.order, orders.back())));
  if (std::find(orders.begin(), orders.end(), order) == orders.end())
    time.fail("order", fmt::format("must be {}, got {}", any_of_these(orders), order));
  const RunExtent extent = read_extent(scene, context);
  scene.finish();
  MoserVeselov system;
  try {
    system = MoserVeselov::preprocessed(body.inertia, initial.state.momentum, body.h, order);
  } catch (const std::domain_error& error) {
    time.fail(time.has("step") ? "step" : "duration", error.what());
  }
  const auto presentation = dressed<MoserVeselov>(system, name, dress);
  return {body,
          [=](const Observer<RigidBody>& observer) {
            const Observer<MoserVeselov> as_body = [&](const TrajectoryPoint<MoserVeselov>& p) {
              observer({p.index, p.time, p.step_size, p.state, p.configuration, {p.step.arrow, {}}});
            };
            return simulate(system, presentation, initial.state, initial.configuration, {}, extent, context,
                            observer ? as_body : nullptr);
          },
          [=] { return motion_of(system, presentation, initial.state, initial.configuration, {}); },
          {},
          std::make_shared<const StatedInitialValue<RigidBody>>(
              StatedInitialValue<RigidBody>{.initial = initial.state,
                                            .configuration = initial.configuration,
                                            .presentation = dressed<RigidBody>(body, name, dress),
                                            .choice = {},
                                            .extent = extent,
                                            .own_order = order})};
}

void add_moser_veselov(std::vector<Method>& methods) {
  const std::string_view word = moser_veselov_method.name;
  for (const int order : moser_veselov_orders)
    methods.push_back({fmt::format("{}/{}", word, order),
                       order,
                       moser_veselov_method.stages,
                       true,
                       {fmt::format("time.method={}", word), fmt::format("time.order={}", order)}});
}

const std::array own_methods{moser_veselov_method};

PreparedScene<RigidBody> read(const Section& scene, const RunContext& context) {
  if (!scene.has("boundary") &&
      read_method_word(scene.section_or_empty("time"), own_methods) == moser_veselov_method.name)
    return moser_veselov(scene, context);
  PreparedScene<RigidBody> prepared = read_any_system<RigidBody>(scene, context, name, dress);
  if (prepared.begin) add_moser_veselov(prepared.methods);
  return prepared;
}

}  // namespace

const SystemModule& rigid_body_module() {
  static const ModuleOf<RigidBody> module(
      name, "free rigid body on SO(3)", read, [] { return keys_of<RigidBody>(name, dress); }, own_methods);
  return module;
}

}  // namespace lagroid::app
