// [[effect]]

#include "scene_bodies.hpp"

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace lagroid::app {

using multibody::stays_zero;
using multibody::values_of;
using multibody::Vec;

namespace {

const KeyOf<Number> drive_rate{"rate", {}, "rad/s", "then times cos(rate t + phase)", 0.0};
const KeyOf<Number> phase{"phase", {}, "rad", "then times cos(rate t + phase)", 0.0};
const KeyOf<NumberArray> acceleration = vector_key("acceleration", "m/s^2", "of all bodies", Vec(0, 0, -9.81));
const KeyOf<Number> strength{"strength", {}, "m^3/s^2", "of the centre"};
const KeyOf<NumberArray> centre = vector_key("centre", "m", "x, y, z", Vec::Zero());
const KeyOf<Number> gravitation{"constant", {}, "m^3/(kg s^2)", "of gravitation", 6.6743e-11};
const KeyOf<Number> softening{
    "softening", {nonnegative}, "m", "e in distances sqrt(r^2 + e^2), which do not vanish where bodies meet", 0.0};
const KeyOf<Number> coulomb{"constant", {}, "N m^2/C^2", "Coulomb's", 8.9875517923e9};
/// As many as bodies are chosen.
KeyOf<NumberArray> charges(std::size_t count) { return {"charges", {count}, "C", "of the bodies, in their order"}; }
const KeyOf<NumberList> any_charges{"charges", {}, charges(1).unit, charges(1).meaning};
const KeyOf<Number> stiffness{"stiffness", {nonnegative}, "N/m", "of the spring"};
const KeyOf<Number> rest_length{"length", {nonnegative}, "m", "at which it does not act", {}, "that at the start"};
const KeyOf<Number> torsion_stiffness{
    "stiffness", {nonnegative}, "N m", "k of the energy k (1 - cos angle), the angle from that at the start"};
const KeyOf<NumberArray> torsion_direction{
    "direction", {3}, "", "in space at the start, fixed in both bodies", {}, "of planar bodies none"};
const KeyOf<Number> distance_damping{
    "damping", {damping_rule}, "N s/m", "force over the rate at which the distance changes"};
const KeyOf<Number> motion_drag{"motion", {nonnegative}, "kg/s", "force over velocity of the centre", 0.0};
const KeyOf<Number> turning_drag{"turning", {nonnegative}, "N m s", "torque over angular velocity", 0.0};
const KeyOf<NumberArray> acts_at = vector_key("at", "m", "where it acts, in the body's frame", Vec::Zero());
const KeyOf<NumberArray> force_key = vector_key("force", "N", "in space");
const KeyOf<NumberArray> torque_key = vector_key("torque", "N m", "in the body's frame; of a planar body [0, 0, T]");
const KeyOf<NumberArray> motor_torque =
    vector_key("torque", "N m", "on the second, in space at the start, fixed in the first; of planar bodies [0, 0, T]");
const KeyOf<NumberArray> field_key = vector_key("field", "T", "of induction");
const KeyOf<NumberArray> frame_rate = vector_key("rate", "rad/s", "angular velocity of the frame");
const KeyOf<Flag> centrifugal_key{"centrifugal", {}, "", "false: a weight holds that force", true};

/// How a force or a torque follows time: constant, or as cos(rate t + phase).
template <class S> struct Drive {
  bool periodic = false;
  S rate = 0;
  S phase = 0;
};

template <class S> Drive<S> read_drive(const BasicSceneBodies<S>& bodies, const Section& table) {
  const S rate = bodies.number(table, drive_rate);
  return {!stays_zero(rate) || table.has(phase.name), rate, bodies.number(table, phase)};
}

constexpr auto read_gravity = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const Vector<S, 3> g = bodies.vector(table, acceleration);
  const auto heavy = bodies.chosen(table);
  const auto planar = [](const BasicNamedBody<S>* body) { return body->planar; };
  const bool across = g(0) == S(0) && g(1) == S(0);
  if (across && (table.has("bodies") ? std::any_of(heavy.begin(), heavy.end(), planar)
                                     : std::all_of(heavy.begin(), heavy.end(), planar)))
    table.fail(table.has("acceleration") ? "acceleration" : "",
               "planar bodies move in the plane of x and y, across which this gravity acts: give acceleration = "
               "[0, -9.81, 0]");
  for (const BasicNamedBody<S>* body : heavy)
    if (!stays_zero(body->mass))
      bodies.scene.add(multibody::BasicConstantForce<S>{{body->mass_centre}, body->mass * g});
  bodies.isolated = false;
};

constexpr auto read_central = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const Vector<S, 3> origin = bodies.vector(table, centre);
  const S s = bodies.number(table, strength);
  for (const BasicNamedBody<S>* body : bodies.chosen(table)) {
    if (stays_zero(body->mass)) continue;
    if (values_of(Vector<S, 3>(body->place + body->attitude * body->to_centre - origin)).isZero(0))
      table.fail("centre", fmt::format("is where \"{}\" is at the start", body->name));
    bodies.scene.add(multibody::BasicCentralGravity<S>{{body->mass_centre}, origin, s * body->mass});
  }
  bodies.isolated = false;
};

constexpr auto read_mutual = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  auto gravity = std::make_unique<multibody::BasicMutualGravity<S>>(bodies.number(table, gravitation),
                                                                    bodies.number(table, softening));
  for (const BasicNamedBody<S>* body : bodies.chosen(table))
    if (!stays_zero(body->mass)) gravity->add(body->mass_centre, body->mass);
  bodies.scene.add_effects(std::move(gravity));
};

constexpr auto read_charges = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto charged = bodies.chosen(table);
  const std::vector<S> q = bodies.numbers(table, charges(charged.size()));
  const S constant = bodies.number(table, coulomb);
  const S e = bodies.number(table, softening);
  for (std::size_t i = 0; i < charged.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!stays_zero(q[i] * q[j]))
        bodies.scene.add(multibody::BasicInverseSquare<S>{
            {charged[j]->mass_centre, charged[i]->mass_centre}, -constant * q[i] * q[j], e});
};

constexpr auto read_spring = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = bodies.ends(table);
  const Vector<S, 3> between_ends = ends[1].place - ends[0].place;
  // Of ends that meet, the distance has no derivative.
  const S apart = between_ends == Vector<S, 3>::Zero() ? S(0) : between_ends.norm();
  const S length = bodies.number_or(table, rest_length, apart);
  if (apart == S(0) && length > S(0))
    table.fail("points", "the ends of the spring meet at the start: its force has no direction");
  bodies.scene.add(multibody::BasicSpring<S>{{ends[0].site, ends[1].site}, bodies.number(table, stiffness), length});
  bodies.lines.push_back({ends[0], ends[1], 0.004});
};

/// Whether what acts on these ends acts in the plane.
template <class S> bool turn_in_plane(const std::array<BasicAttachment<S>, 2>& ends) {
  return std::any_of(ends.begin(), ends.end(),
                     [](const BasicAttachment<S>& end) { return end.body && end.body->planar; });
}

template <class S>
void require_across_plane(const Section& table, const std::string& name, const Vector<S, 3>& torque) {
  if (torque(0) != S(0) || torque(1) != S(0))
    table.fail("torque", fmt::format("\"{}\" turns in the plane of x and y: give first parts of 0", name));
}

/// The ends of what acts on two bodies that turn: both in space, or both in the plane; either may be the ground.
template <class S>
std::array<BasicAttachment<S>, 2> turning_ends(BasicSceneBodies<S>& bodies, const Section& table,
                                               std::string_view effect) {
  const auto ends = bodies.ends(table, /*with_points=*/false);
  for (const BasicAttachment<S>& end : ends)
    if (!end.turns_in_space() && !end.body->planar)
      table.fail("between", fmt::format("\"{}\" does not turn: {} acts on bodies that do", end.name(), effect));
  const auto in_space = [](const BasicAttachment<S>& end) { return end.body && !end.body->planar; };
  if (turn_in_plane(ends) && std::any_of(ends.begin(), ends.end(), in_space))
    table.fail("between", fmt::format("{} acts on two bodies that turn in space, or on two in the plane", effect));
  return ends;
}

/// (x, y, angle) of what turns in the plane; the ground's angle is zero.
template <class S> multibody::Site planar_place(BasicSceneBodies<S>& bodies, const BasicAttachment<S>& end) {
  return end.body ? bodies.scene.planar_place(end.body->body) : bodies.scene.ground(Vector<S, 3>::Zero());
}

/// A torque on a planar body is the third part of a force on its place, and derived from a potential where it is
/// constant.
template <class S>
void turn(BasicSceneBodies<S>& bodies, const BasicAttachment<S>& end, const S& torque, const Drive<S>& drive) {
  const Vector<S, 3> force(S(0), S(0), torque);
  if (drive.periodic) {
    bodies.scene.add(multibody::BasicPeriodicForce<S>{{planar_place(bodies, end)}, force, drive.rate, drive.phase});
    bodies.timed = true;
  } else {
    bodies.scene.add(multibody::BasicConstantForce<S>{{planar_place(bodies, end)}, force});
  }
}

constexpr auto read_torsion = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = turning_ends(bodies, table, "a torsion spring");
  if (turn_in_plane(ends)) {
    const auto angle = [](const BasicAttachment<S>& end) { return end.body ? end.body->angle : S(0); };
    bodies.scene.add(
        multibody::BasicPlanarTorsionSpring<S>{{planar_place(bodies, ends[0]), planar_place(bodies, ends[1])},
                                               bodies.number(table, torsion_stiffness),
                                               angle(ends[1]) - angle(ends[0])});
    return;
  }
  const Vector<S, 3> axis = bodies.vector(table, torsion_direction);
  if (!(values_of(axis).norm() > 0)) table.fail("direction", "must not vanish");
  const Vector<S, 3> unit = unit_of(axis);
  bodies.scene.add(multibody::BasicTorsionSpring<S>{{},
                                                    {ends[0].attitude(), ends[1].attitude()},
                                                    ends[0].seen(unit),
                                                    ends[1].seen(unit),
                                                    bodies.number(table, torsion_stiffness)});
};

constexpr auto read_drag = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const S motion = bodies.number(table, motion_drag);
  const S turning = bodies.number(table, turning_drag);
  if (stays_zero(motion) && stays_zero(turning))
    table.fail("", "give motion (force over velocity, kg/s) or turning (torque over angular velocity, N m s)");
  const auto damped = bodies.chosen(table);
  const auto turns = [](const BasicNamedBody<S>* body) { return body->planar || body->body.attitude.index >= 0; };
  const auto moves = [](const BasicNamedBody<S>* body) { return body->linear >= 0; };
  if (turning > S(0) && std::none_of(damped.begin(), damped.end(), turns))
    table.fail("turning", "none of the bodies turns");
  if (motion > S(0) && std::none_of(damped.begin(), damped.end(), moves))
    table.fail("motion", "none of the bodies has a centre that moves");
  for (const BasicNamedBody<S>* body : damped) {
    bodies.scene.damp(body->body, motion, turning);
    const double inertia = body->planar ? value_of(body->inertia(2)) : values_of(body->inertia).minCoeff();
    if (turns(body)) bodies.damping_rate = std::max(bodies.damping_rate, value_of(turning) / inertia);
    if (moves(body)) bodies.damping_rate = std::max(bodies.damping_rate, value_of(motion) / value_of(body->mass));
  }
  bodies.dissipates = true;
  bodies.isolated = false;
};

constexpr auto read_damper = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = bodies.ends(table);
  if ((ends[1].place - ends[0].place).norm() == S(0))
    table.fail("points", "the ends of the damper meet at the start: its force has no direction");
  bodies.scene.add(multibody::Damper<multibody::BasicLength<S>, S>{{{ends[0].site, ends[1].site}},
                                                                   bodies.number(table, distance_damping)});
  bodies.lines.push_back({ends[0], ends[1], 0.004});
  bodies.dissipates = true;
};

constexpr auto read_cost = []<class S>(BasicSceneBodies<S>& bodies, const Section&) { bodies.counts_cost = true; };

template <class S>
const BasicNamedBody<S>& require_point(const Section& table, const BasicNamedBody<S>* body, std::string_view effect) {
  if (body->linear < 0 || body->body.attitude.index >= 0 || body->planar)
    table.fail("bodies", fmt::format("\"{}\" is no point mass: {} acts on point masses alone; name them in bodies",
                                     body->name, effect));
  return *body;
}

constexpr auto read_rotating_frame = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const Vector<S, 3> rate = bodies.vector(table, frame_rate);
  const bool centrifugal = read_key(table, centrifugal_key);
  for (const BasicNamedBody<S>* chosen : bodies.chosen(table)) {
    const BasicNamedBody<S>& body = require_point(table, chosen, "a rotating frame");
    bodies.scene.gyroscopic_force(body.body, 2.0 * body.mass * rate);
    if (centrifugal) bodies.scene.add(multibody::BasicCentrifugal<S>{{body.body.centre}, body.mass, rate});
  }
  bodies.gyroscopic = true;
  bodies.isolated = false;
};

constexpr auto read_magnetic = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const Vector<S, 3> field = bodies.vector(table, field_key);
  const auto charged = bodies.chosen(table);
  const std::vector<S> q = bodies.numbers(table, charges(charged.size()));
  for (std::size_t i = 0; i < charged.size(); ++i)
    bodies.scene.gyroscopic_force(require_point(table, charged[i], "a magnetic field").body, q[i] * field);
  bodies.gyroscopic = true;
  bodies.isolated = false;
};

constexpr auto read_force = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const BasicNamedBody<S>& body = bodies.named(table, body_key.name, read_key(table, body_key));
  const Vector<S, 3> arm = bodies.vector(table, acts_at);
  const Vector<S, 3> force = bodies.vector(table, force_key);
  const Drive<S> drive = read_drive(bodies, table);
  if (body.planar && force(2) != S(0))
    table.fail("force", fmt::format("\"{}\" moves in the plane: give a third part of 0", body.name));
  const BasicAttachment<S> end = bodies.end_of(table, "at", &body, arm);
  if (drive.periodic) {
    bodies.scene.add(multibody::BasicPeriodicForce<S>{{end.site}, force, drive.rate, drive.phase});
    bodies.timed = true;
  } else {
    bodies.scene.add(multibody::BasicConstantForce<S>{{end.site}, force});
  }
  bodies.isolated = false;
};

constexpr auto read_torque = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const BasicNamedBody<S>& body = bodies.named(table, body_key.name, read_key(table, body_key));
  if (!body.planar && body.body.attitude.index < 0)
    table.fail("body", fmt::format("\"{}\" does not turn: a torque acts on bodies that do", body.name));
  const Vector<S, 3> torque = bodies.vector(table, torque_key);
  bodies.isolated = false;
  if (body.planar) {
    require_across_plane(table, body.name, torque);
    BasicAttachment<S> end;
    end.body = &body;
    turn(bodies, end, torque(2), {});
    return;
  }
  bodies.scene.add(multibody::BasicBodyTorque<S>{{}, {body.body.attitude}, torque});
  bodies.driven = true;
};

constexpr auto read_motor = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = turning_ends(bodies, table, "a motor");
  const Vector<S, 3> torque = bodies.vector(table, motor_torque);
  const Drive<S> drive = read_drive(bodies, table);
  if (turn_in_plane(ends)) {
    require_across_plane(table, ends[ends[0].body ? 0 : 1].name(), torque);
    turn(bodies, ends[0], S(-torque(2)), drive);
    turn(bodies, ends[1], torque(2), drive);
    return;
  }
  bodies.scene.add(multibody::BasicMotor<S>{
      {}, {ends[0].attitude(), ends[1].attitude()}, ends[0].seen(torque), drive.rate, drive.phase});
  bodies.driven = true;
};

}  // namespace

const std::vector<SceneKind>& effect_kinds() {
  const std::vector<Key> ends = end_keys();
  const Key between_bodies = ends.front();
  const auto tie = [&](const Key& more, const std::vector<Key>& last = {}) {
    std::vector<Key> keys = ends;
    keys.push_back(more);
    keys.insert(keys.end(), last.begin(), last.end());
    return keys;
  };
  static const std::vector<SceneKind> all{
      {"gravity", "a uniform one", read_gravity, {acceleration, chosen_bodies}},
      {"central_gravity", "of a centre that rests", read_central, {strength, centre, chosen_bodies}},
      {"mutual_gravity", "of the bodies on each other", read_mutual, {gravitation, softening, chosen_bodies}},
      {"spring", "between two points", read_spring, tie(stiffness, {rest_length})},
      {"torsion_spring",
       "between two bodies that turn",
       read_torsion,
       {between_bodies, torsion_direction, torsion_stiffness}},
      {"drag", "of a medium that rests", read_drag, {motion_drag, turning_drag, chosen_bodies}, false},
      {"damper", "between two points that do not meet", read_damper, tie(distance_damping)},
      {"control_cost",
       "counts the kinetic terms, summed over the steps: a column, and a line of the report",
       read_cost,
       {},
       false},
      {"force", "on a point of a body", read_force, {body_key, acts_at, force_key, drive_rate, phase}},
      {"torque", "on a body", read_torque, {body_key, torque_key}},
      {"motor", "between two bodies that turn", read_motor, {between_bodies, motor_torque, drive_rate, phase}},
      {"charges", "of the bodies on each other", read_charges, {any_charges, coulomb, softening, chosen_bodies}},
      {"magnetic_field",
       "a uniform one; point masses alone",
       read_magnetic,
       {field_key, any_charges, chosen_bodies},
       false},
      {"rotating_frame",
       "in which the bodies are seen; point masses alone",
       read_rotating_frame,
       {frame_rate, centrifugal_key, chosen_bodies},
       false}};
  return all;
}

}  // namespace lagroid::app
