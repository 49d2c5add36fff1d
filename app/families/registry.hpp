#pragma once
/// The systems a scene can name.

#include "../reading/parameter.hpp"
#include "../spheres/sphere_system.hpp"
#include "../systems/readers.hpp"

#include <lagroid/solvers/declared_methods.hpp>
#include <lagroid/systems/moser_veselov_method.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lagroid::app {

template <DiscreteSystem Sys> struct Entry {
  std::string_view name;
  std::string_view summary;
  Task<Sys> (*read)(const Section& scene, const RunContext& context);
  std::vector<Parameter> parameters;
  /// Methods beside those declared for every system.
  std::vector<DeclaredMethod> own_methods = {};
};

/// Visits the entry of every system whose groupoid is a type, in the order in which they are listed to users; those of
/// `sphere_systems` come after them.
template <class Visit> void for_each_system(const Visit& visit) {
  const Parameter quadrature{"quadrature", "", "", "of the potential over a step: midpoint or trapezoid"};
  const Parameter inertia{"inertia", "kg m^2", "", "three principal moments"};
  const Parameter rotation{"rotation", "", "exp", "how a rotation becomes an angular velocity: exp or cayley"};
  const auto with = [](Parameter p, std::string_view fallback) {
    p.fallback = fallback;
    return p;
  };
  visit(Entry<PlateBall>{"plate_ball",
                         "optimal control of a ball rolling on a rotating plate",
                         read_plate_ball,
                         {{"radius", "m", "1", "of the ball"},
                          {"plate_rate", "rad/s", "0", "angular velocity of the plate"},
                          {"spin", "rad/s", "0", "prescribed rate about the vertical"},
                          {"rotation", "", "trace", "form of the constraints: trace, exp or cayley"}}});
  visit(Entry<Unicycle>{
      "unicycle",
      "steering at constant speed: planar elastica on SE(2)",
      read_unicycle,
      {{"speed", "m/s", "1", "forward speed"}, {"map", "", "exp", "how a motion becomes a velocity: exp or cayley"}}});
  visit(Entry<AttitudeControl>{"attitude_control",
                               "optimal control of a rotation on SO(3) with one axis forbidden",
                               read_attitude_control,
                               {{"weights", "1", "1, 1, 1", "three weights of the cost w.W w / 2"},
                                {"forbidden", "1", "0, 0, 1", "the forbidden axis in the body"},
                                rotation}});
  visit(Entry<RigidBody>{
      "rigid_body", "free rigid body on SO(3)", read_rigid_body, {inertia, rotation}, {moser_veselov_method}});
  visit(Entry<HeavyTop>{"heavy_top",
                        "rigid body with a fixed point under gravity, SO(3) acting on S^2",
                        read_heavy_top,
                        {inertia, {"weight", "N m", "", "weight times the vector to the centre of mass"}, rotation}});
  visit(Entry<Pendulum>{"pendulum",
                        "planar pendulum",
                        read_pendulum,
                        {{"mass", "kg", "1", "of the bob"},
                         {"length", "m", "1", "of the rod"},
                         {"gravity", "m/s^2", "1", "acceleration"},
                         with(quadrature, "midpoint")}});
  visit(Entry<Kepler>{"kepler",
                      "planar Kepler problem",
                      read_kepler,
                      {{"strength", "m^3/s^2", "1", "of the attraction"}, with(quadrature, "trapezoid")}});
  visit(Entry<SphericalPendulum>{"spherical_pendulum",
                                 "spherical pendulum, R^3 with an object constraint",
                                 read_spherical_pendulum,
                                 {{"mass", "kg", "1", "of the bob"},
                                  {"length", "m", "1", "of the rod"},
                                  {"gravity", "m/s^2", "1", "acceleration"},
                                  with(quadrature, "trapezoid")}});
  visit(Entry<RollingBall>{"rolling_ball",
                           "ball rolling on a rotating plate (nonholonomic)",
                           read_rolling_ball,
                           {{"mass", "kg", "1", "of the ball"},
                            {"radius", "m", "1", "of the ball"},
                            {"inertia_factor", "1", "0.4", "moment of inertia over mass times radius squared"},
                            {"plate_rate", "rad/s", "0", "angular velocity of the plate"}}});
  visit(Entry<RollingDisk>{"rolling_disk",
                           "upright disk rolling on the plane (nonholonomic)",
                           read_rolling_disk,
                           {{"mass", "kg", "1", "of the disk"},
                            {"radius", "m", "1", "of the disk"},
                            {"rolling_inertia", "kg m^2", "0.5", "about its axis"},
                            {"turning_inertia", "kg m^2", "0.25", "about the vertical"}}});
  visit(Entry<ChaplyginSleigh>{"chaplygin_sleigh",
                               "body sliding on a blade (nonholonomic)",
                               read_chaplygin_sleigh,
                               {{"mass", "kg", "1", "of the body"},
                                {"inertia", "kg m^2", "1", "about its centre of mass"},
                                {"offset", "m", "1", "from the blade ahead to the centre of mass"},
                                {"map", "", "exp", "how a motion becomes a velocity: exp or cayley"}}});
  visit(Entry<DampedPendulum>{"damped_pendulum",
                              "planar pendulum with damping",
                              read_damped_pendulum,
                              {{"mass", "kg", "1", "of the bob"},
                               {"length", "m", "1", "of the rod"},
                               {"gravity", "m/s^2", "1", "acceleration"},
                               {"damping", "N m s", "0.1", "torque over angular velocity"},
                               with(quadrature, "midpoint")}});
  visit(Entry<DrivenPendulum>{"driven_pendulum",
                              "planar pendulum under a periodic torque or on a shaking support",
                              read_driven_pendulum,
                              {{"mass", "kg", "1", "of the bob"},
                               {"length", "m", "1", "of the rod"},
                               {"gravity", "m/s^2", "1", "acceleration"},
                               {"frequency", "rad/s", "1", "of the drive"},
                               {"torque", "N m", "0", "amplitude of the torque"},
                               {"amplitude", "m", "0", "of the support's motion up and down"}}});
  visit(Entry<DrivenBody>{"driven_body",
                          "rigid body with thrust and drag on SO(3)",
                          read_driven_body,
                          {inertia,
                           {"torque", "N m", "0, 0, 0", "of a thruster, fixed in the body"},
                           {"drag", "N m s", "0.1", "torque over angular velocity"},
                           rotation}});
}

/// What `visit(entry)` returns for the system that the scene names, which is none of `sphere_systems`.
template <class Visit> auto with_system_of(const Section& scene, const Visit& visit) {
  std::vector<std::string> names;
  for_each_system([&](const auto& entry) { names.emplace_back(entry.name); });
  for (const SphereEntry& entry : sphere_systems()) names.emplace_back(entry.name);
  const std::string name = scene.choice("system", names);
  std::optional<decltype(visit(Entry<PlateBall>{}))> result;
  for_each_system([&](const auto& entry) {
    if (entry.name == name) result = visit(entry);
  });
  return std::move(*result);
}

}  // namespace lagroid::app
