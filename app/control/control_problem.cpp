#include "control_problem.hpp"

#include "../reading/kinds.hpp"
#include "bodies/bodies_keys.hpp"
#include "control_scene.hpp"
#include "problems/problems.hpp"

#include <algorithm>
#include <array>

namespace lagroid::app {

std::span<const ControlProblem* const> control_problems() {
  static const std::array all{
      &double_integrator_problem(), &swing_up_problem(),        &planar_mass_problem(), &low_thrust_problem(),
      &dubins_car_problem(),        &reeds_shepp_car_problem(), &hovercraft_problem(),  &steered_sleigh_problem(),
      &steered_car_problem(),       &satellite_turn_problem(),  &rolled_ball_problem(), &pendulum_problem(),
      &rigid_body_problem(),        &two_link_arm_problem(),    &falling_cat_problem(), &controlled_bodies()};
  return all;
}

const ControlProblem& control_problem(const Section& scene) {
  KeyOf<OneOf> key{std::string(keys::control)};
  for (const ControlProblem* each : control_problems()) key.value.words.emplace_back(each->name());
  const std::string name = read_key(scene, key);
  return **std::find_if(control_problems().begin(), control_problems().end(),
                        [&](const ControlProblem* each) { return each->name() == name; });
}

Table control_table() {
  Table table;
  for (const ControlProblem* each : control_problems()) {
    Table kind{
        {KeyOf<OneOf>{std::string(keys::control), {{std::string(each->name())}}, "", std::string(each->summary())}},
        {},
        std::string(each->summary())};
    const bool of_bodies = each == &controlled_bodies();
    if (!of_bodies) kind.keys.push_back(optional_table("parameters", {each->parameters()}, "of the system"));
    for (Key& key : of_bodies ? controlled_bodies_keys() : control_scene_keys(*each))
      kind.keys.push_back(std::move(key));
    table.kinds.push_back(std::move(kind));
  }
  return table;
}

}  // namespace lagroid::app
