// [[effect]]

#include "scene_bodies.hpp"

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace lagroid::app {

using multibody::Vec;

namespace {

/// How a force or a torque follows time: constant, or as cos(rate t + phase).
struct Drive {
  bool periodic = false;
  double rate = 0;
  double phase = 0;
};

Drive read_drive(const Section& table) {
  const double rate = table.number_or("rate", 0);
  return {rate != 0 || table.has("phase"), rate, table.number_or("phase", 0)};
}

void read_gravity(SceneBodies& bodies, const Section& table) {
  const Vec g = vector_or(table, "acceleration", "m/s^2", {0, 0, -9.81});
  const auto heavy = bodies.chosen(table, "bodies");
  const auto planar = [](const NamedBody* body) { return body->planar; };
  const bool across = g(0) == 0 && g(1) == 0;
  if (across && (table.has("bodies") ? std::any_of(heavy.begin(), heavy.end(), planar)
                                     : std::all_of(heavy.begin(), heavy.end(), planar)))
    table.fail(table.has("acceleration") ? "acceleration" : "",
               "planar bodies move in the plane of x and y, across which this gravity acts: give acceleration = "
               "[0, -9.81, 0]");
  for (const NamedBody* body : heavy)
    if (body->mass > 0) bodies.scene.add(multibody::ConstantForce{{body->mass_centre}, body->mass * g});
  bodies.isolated = false;
}

void read_central(SceneBodies& bodies, const Section& table) {
  const Vec centre = vector_or(table, "centre", "x, y, z in m");
  const double strength = table.number("strength", any_number);
  for (const NamedBody* body : bodies.chosen(table, "bodies")) {
    if (body->mass == 0) continue;
    if ((body->place + body->attitude * body->to_centre - centre).isZero(0))
      table.fail("centre", fmt::format("is where \"{}\" is at the start", body->name));
    bodies.scene.add(multibody::CentralGravity{{body->mass_centre}, centre, strength * body->mass});
  }
  bodies.isolated = false;
}

void read_mutual(SceneBodies& bodies, const Section& table) {
  auto gravity = std::make_unique<multibody::MutualGravity>(table.number_or("constant", 6.6743e-11),
                                                            table.number_or("softening", 0, nonnegative));
  for (const NamedBody* body : bodies.chosen(table, "bodies"))
    if (body->mass > 0) gravity->add(body->mass_centre, body->mass);
  bodies.scene.add_effects(std::move(gravity));
}

void read_charges(SceneBodies& bodies, const Section& table) {
  const auto charged = bodies.chosen(table, "bodies");
  const auto charges = table.numbers("charges", charged.size(), "of the bodies, in their order, C");
  const double constant = table.number_or("constant", 8.9875517923e9);
  const double softening = table.number_or("softening", 0, nonnegative);
  for (std::size_t i = 0; i < charged.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (charges[i] * charges[j] != 0)
        bodies.scene.add(multibody::InverseSquare{
            {charged[j]->mass_centre, charged[i]->mass_centre}, -constant * charges[i] * charges[j], softening});
}

void read_spring(SceneBodies& bodies, const Section& table) {
  const auto ends = bodies.ends(table);
  const double apart = (ends[1].place - ends[0].place).norm();
  const double length = table.number_or("length", apart, nonnegative);
  if (apart == 0 && length > 0)
    table.fail("points", "the ends of the spring meet at the start: its force has no direction");
  bodies.scene.add(multibody::Spring{{ends[0].site, ends[1].site}, table.number("stiffness", nonnegative), length});
  bodies.lines.push_back({ends[0], ends[1], 0.004});
}

/// Whether what acts on these ends acts in the plane.
bool turn_in_plane(const std::array<End, 2>& ends) {
  return std::any_of(ends.begin(), ends.end(), [](const End& end) { return end.body && end.body->planar; });
}

void require_across_plane(const Section& table, const std::string& name, const Vec& torque) {
  if (torque(0) != 0 || torque(1) != 0)
    table.fail("torque", fmt::format("\"{}\" turns in the plane of x and y: give first parts of 0", name));
}

/// The ends of what acts on two bodies that turn: both in space, or both in the plane; either may be the ground.
std::array<End, 2> turning_ends(SceneBodies& bodies, const Section& table, std::string_view effect) {
  const auto ends = bodies.ends(table, /*with_points=*/false);
  for (const End& end : ends)
    if (!end.turns_in_space() && !end.body->planar)
      table.fail("between", fmt::format("\"{}\" does not turn: {} acts on bodies that do", end.name(), effect));
  const auto in_space = [](const End& end) { return end.body && !end.body->planar; };
  if (turn_in_plane(ends) && std::any_of(ends.begin(), ends.end(), in_space))
    table.fail("between", fmt::format("{} acts on two bodies that turn in space, or on two in the plane", effect));
  return ends;
}

/// (x, y, angle) of what turns in the plane; the ground's angle is zero.
multibody::Site planar_place(SceneBodies& bodies, const End& end) {
  return end.body ? bodies.scene.planar_place(end.body->body) : bodies.scene.ground(Vec::Zero());
}

/// A torque on a planar body is the third part of a force on its place, and derived from a potential where it is
/// constant.
void turn(SceneBodies& bodies, const End& end, double torque, const Drive& drive) {
  const Vec force(0, 0, torque);
  if (drive.periodic) {
    bodies.scene.add(multibody::PeriodicForce{{planar_place(bodies, end)}, force, drive.rate, drive.phase});
    bodies.timed = true;
  } else {
    bodies.scene.add(multibody::ConstantForce{{planar_place(bodies, end)}, force});
  }
}

void read_torsion(SceneBodies& bodies, const Section& table) {
  const auto ends = turning_ends(bodies, table, "a torsion spring");
  if (turn_in_plane(ends)) {
    const auto angle = [](const End& end) { return end.body ? end.body->angle : 0.0; };
    bodies.scene.add(multibody::PlanarTorsionSpring{{planar_place(bodies, ends[0]), planar_place(bodies, ends[1])},
                                                    table.number("stiffness", nonnegative),
                                                    angle(ends[1]) - angle(ends[0])});
    return;
  }
  const Vec axis = vector_of(table, "direction", "in space at the start, fixed in both bodies");
  if (!(axis.norm() > 0)) table.fail("direction", "must not vanish");
  const Vec unit = axis.stableNormalized();
  bodies.scene.add(multibody::TorsionSpring{{},
                                            {ends[0].attitude(), ends[1].attitude()},
                                            ends[0].seen(unit),
                                            ends[1].seen(unit),
                                            table.number("stiffness", nonnegative)});
}

void read_drag(SceneBodies& bodies, const Section& table) {
  const double motion = table.number_or("motion", 0, nonnegative);
  const double turning = table.number_or("turning", 0, nonnegative);
  if (motion == 0 && turning == 0)
    table.fail("", "give motion (force over velocity, kg/s) or turning (torque over angular velocity, N m s)");
  const auto damped = bodies.chosen(table, "bodies");
  const auto turns = [](const NamedBody* body) { return body->planar || body->body.attitude.index >= 0; };
  const auto moves = [](const NamedBody* body) { return body->linear >= 0; };
  if (turning > 0 && std::none_of(damped.begin(), damped.end(), turns))
    table.fail("turning", "none of the bodies turns");
  if (motion > 0 && std::none_of(damped.begin(), damped.end(), moves))
    table.fail("motion", "none of the bodies has a centre that moves");
  for (const NamedBody* body : damped) {
    bodies.scene.damp(body->body, motion, turning);
    const double inertia = body->planar ? body->inertia(2) : body->inertia.minCoeff();
    if (turns(body)) bodies.damping_rate = std::max(bodies.damping_rate, turning / inertia);
    if (moves(body)) bodies.damping_rate = std::max(bodies.damping_rate, motion / body->mass);
  }
  bodies.dissipates = true;
  bodies.isolated = false;
}

void read_damper(SceneBodies& bodies, const Section& table) {
  const auto ends = bodies.ends(table);
  if ((ends[1].place - ends[0].place).norm() == 0)
    table.fail("points", "the ends of the damper meet at the start: its force has no direction");
  bodies.scene.add(
      multibody::Damper<multibody::Length>{{{ends[0].site, ends[1].site}}, table.number("damping", damping_rule)});
  bodies.lines.push_back({ends[0], ends[1], 0.004});
  bodies.dissipates = true;
}

void read_cost(SceneBodies& bodies, const Section&) { bodies.counts_cost = true; }

const NamedBody& require_point(const Section& table, const NamedBody* body, std::string_view effect) {
  if (body->linear < 0 || body->body.attitude.index >= 0 || body->planar)
    table.fail("bodies", fmt::format("\"{}\" is no point mass: {} acts on point masses alone; name them in bodies",
                                     body->name, effect));
  return *body;
}

void read_rotating_frame(SceneBodies& bodies, const Section& table) {
  const Vec rate = vector_of(table, "rate", "angular velocity of the frame, rad/s");
  const bool centrifugal = table.flag_or("centrifugal", true);
  for (const NamedBody* chosen : bodies.chosen(table, "bodies")) {
    const NamedBody& body = require_point(table, chosen, "a rotating frame");
    bodies.scene.gyroscopic_force(body.body, 2 * body.mass * rate);
    if (centrifugal) bodies.scene.add(multibody::Centrifugal{{body.body.centre}, body.mass, rate});
  }
  bodies.gyroscopic = true;
  bodies.isolated = false;
}

void read_magnetic(SceneBodies& bodies, const Section& table) {
  const Vec field = vector_of(table, "field", "T");
  const auto charged = bodies.chosen(table, "bodies");
  const auto charges = table.numbers("charges", charged.size(), "of the bodies, in their order, C");
  for (std::size_t i = 0; i < charged.size(); ++i)
    bodies.scene.gyroscopic_force(require_point(table, charged[i], "a magnetic field").body, charges[i] * field);
  bodies.gyroscopic = true;
  bodies.isolated = false;
}

void read_force(SceneBodies& bodies, const Section& table) {
  const NamedBody& body = bodies.named(table, "body", table.text("body", "the name of a body"));
  const Vec arm = vector_or(table, "at", "where it acts, in the body's frame, m");
  const Vec force = vector_of(table, "force", "in space, N");
  const Drive drive = read_drive(table);
  if (body.planar && force(2) != 0)
    table.fail("force", fmt::format("\"{}\" moves in the plane: give a third part of 0", body.name));
  const End end = bodies.end_of(table, "at", &body, arm);
  if (drive.periodic) {
    bodies.scene.add(multibody::PeriodicForce{{end.site}, force, drive.rate, drive.phase});
    bodies.timed = true;
  } else {
    bodies.scene.add(multibody::ConstantForce{{end.site}, force});
  }
  bodies.isolated = false;
}

void read_torque(SceneBodies& bodies, const Section& table) {
  const NamedBody& body = bodies.named(table, "body", table.text("body", "the name of a body"));
  if (!body.planar && body.body.attitude.index < 0)
    table.fail("body", fmt::format("\"{}\" does not turn: a torque acts on bodies that do", body.name));
  const Vec torque = vector_of(table, "torque", "in the body's frame, N m");
  bodies.isolated = false;
  if (body.planar) {
    require_across_plane(table, body.name, torque);
    End end;
    end.body = &body;
    turn(bodies, end, torque(2), {});
    return;
  }
  bodies.scene.add(multibody::BodyTorque{{}, {body.body.attitude}, torque});
  bodies.driven = true;
}

void read_motor(SceneBodies& bodies, const Section& table) {
  const auto ends = turning_ends(bodies, table, "a motor");
  const Vec torque = vector_of(table, "torque", "on the second, in space at the start, fixed in the first, N m");
  const Drive drive = read_drive(table);
  if (turn_in_plane(ends)) {
    require_across_plane(table, ends[ends[0].body ? 0 : 1].name(), torque);
    turn(bodies, ends[0], -torque(2), drive);
    turn(bodies, ends[1], torque(2), drive);
    return;
  }
  bodies.scene.add(
      multibody::Motor{{}, {ends[0].attitude(), ends[1].attitude()}, ends[0].seen(torque), drive.rate, drive.phase});
  bodies.driven = true;
}

/// The kinds of [[effect]], as they are listed to users.
constexpr std::array<SceneKind, 14> kinds{{{"gravity", read_gravity},
                                           {"central_gravity", read_central},
                                           {"mutual_gravity", read_mutual},
                                           {"spring", read_spring},
                                           {"torsion_spring", read_torsion},
                                           {"drag", read_drag},
                                           {"damper", read_damper},
                                           {"control_cost", read_cost},
                                           {"force", read_force},
                                           {"torque", read_torque},
                                           {"motor", read_motor},
                                           {"charges", read_charges},
                                           {"magnetic_field", read_magnetic},
                                           {"rotating_frame", read_rotating_frame}}};

}  // namespace

void read_effect(SceneBodies& bodies, const Section& table) { read_kind(kinds, bodies, table); }

}  // namespace lagroid::app
