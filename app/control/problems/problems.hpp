#pragma once
/// The problems of the library, a file each.

#include "../control_problem.hpp"

namespace lagroid::app {

const ControlProblem& double_integrator_problem();
const ControlProblem& swing_up_problem();
const ControlProblem& planar_mass_problem();
const ControlProblem& low_thrust_problem();
const ControlProblem& dubins_car_problem();
const ControlProblem& reeds_shepp_car_problem();
const ControlProblem& hovercraft_problem();
const ControlProblem& steered_sleigh_problem();
const ControlProblem& steered_car_problem();
const ControlProblem& satellite_turn_problem();
const ControlProblem& pendulum_problem();
const ControlProblem& rigid_body_problem();
const ControlProblem& two_link_arm_problem();
const ControlProblem& falling_cat_problem();
const ControlProblem& rolled_ball_problem();
const ControlProblem& controlled_bodies();

}  // namespace lagroid::app
