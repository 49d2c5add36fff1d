// [[joint]]

#include "scene_bodies.hpp"

#include <lagroid/systems/multibody/joints.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lagroid::app {

using multibody::values_of;
using multibody::Vec;

namespace {

const KeyOf<Number> length{"length", {positive}, "m", "of the rod", {}, "that at the start"};
const KeyOf<Number> turning_damping{"damping", {damping_rule}, "N m s", "torque over turning rate", {}, "none"};
const KeyOf<Number> sliding_damping{"damping", {damping_rule}, "N s/m", "force over sliding rate", {}, "none"};
const KeyOf<NumberArray> axis = vector_key("axis", "", "in space at the start");
const KeyOf<Number> hinge_rate{
    "rate", {}, "rad/s", "at which the second turns against the first, as it must at the start", {}, "free"};
const KeyOf<NumberArray> normal = vector_key("normal", "", "of the plane, in space at the start, fixed in the first");

const KeyOf<OneOf> principle{
    "principle", {{"nonholonomic", "vakonomic"}}, "", "friction holds, or an optimal control does", "nonholonomic"};
KeyOf<NumberArray> multipliers(int rows) {
  return {"multipliers", {std::size_t(rows)}, "", "of its equations, at the start, if it is vakonomic", {}, "0"};
}
const KeyOf<Number> radius{"radius", {positive}, "m", "of the ball"};
const KeyOf<Number> plate_rate{"plate_rate", {}, "rad/s", "at which the plate turns about the origin", 0.0};
const KeyOf<NumberArray> spin_axis = vector_key("axis", "", "in space, or in the body");
const KeyOf<OneOf> fixed_in{"fixed_in", {{"space", "body"}}, "", "where the axis is fixed", "space"};
const KeyOf<Number> spin_rate{"rate", {}, "rad/s", "of turning about the axis", 0.0};
const KeyOf<Number> blade_direction{"direction", {}, "rad", "angle of the blade in the body", 0.0};
const KeyOf<Number> ahead{"ahead", {}, "m", "of the blade before the centre of mass, along the blade", 0.0};
const KeyOf<Number> blade_rate{"rate", {}, "m/s", "of moving across the blade", 0.0};

/// Unit vectors: the direction under `key`, and two that complete it.
template <class S>
Matrix<S, 3, 3> frame_along(const BasicSceneBodies<S>& bodies, const Section& table, const KeyOf<NumberArray>& key) {
  const Vector<S, 3> given = bodies.vector(table, key);
  if (!(values_of(given).norm() > 0)) table.fail(key.name, "must not vanish");
  const Vector<S, 3> third = unit_of(given);
  int least = 0;
  values_of(third).cwiseAbs().minCoeff(&least);
  const Vector<S, 3> first = Vector<S, 3>(Vector<S, 3>::Unit(least)).cross(third).normalized();
  Matrix<S, 3, 3> out;
  out << first, third.cross(first), third;
  return out;
}

template <class S>
void require_turning(const Section& table, const std::array<BasicAttachment<S>, 2>& ends, const std::string& kind) {
  for (const BasicAttachment<S>& end : ends) {
    if (end.turns_in_space()) continue;
    const bool rubs = table.has(turning_damping.name);
    table.fail(
        rubs ? turning_damping.name : "between",
        end.body->planar && rubs
            ? fmt::format("\"{}\" turns in the plane only, where joints do not rub; leave it out", end.name())
        : end.body->planar
            ? fmt::format("\"{}\" turns in the plane only: a joint of kind \"ball\" is its hinge", end.name())
            : fmt::format("\"{}\" is a point mass and does not turn: a {} needs bodies that do", end.name(), kind));
  }
}

template <class S>
void require_together(const BasicSceneBodies<S>& bodies, const Section& table,
                      const std::array<BasicAttachment<S>, 2>& ends) {
  const double apart = (values_of(ends[1].place) - values_of(ends[0].place)).norm();
  const Vec here = values_of(ends[0].place), there = values_of(ends[1].place);
  if (!bodies.is_free_in_place() && apart > 1e-9 * (1 + values_of(ends[0].place).norm()))
    table.fail("points", fmt::format("the two points are {:.6g} m apart at the start, and must be one: \"{}\" has "
                                     "its own at ({:.10g}, {:.10g}, {:.10g}), \"{}\" at ({:.10g}, {:.10g}, {:.10g})",
                                     apart, ends[0].name(), here(0), here(1), here(2), ends[1].name(), there(0),
                                     there(1), there(2)));
}

/// The direction u in space, fixed in the first body, and v, fixed in the second, keep their right angle.
template <class S>
void keep_right_angle(BasicSceneBodies<S>& bodies, const std::array<BasicAttachment<S>, 2>& ends, const Vector<S, 3>& u,
                      const Vector<S, 3>& v) {
  bodies.scene.add(multibody::BasicFixedAngle<S>{
      {}, {ends[0].attitude(), ends[1].attitude()}, ends[0].seen(u), ends[1].seen(v), S(0)});
}

/// The second body keeps its attitude relative to the first.
template <class S> void keep_attitude(BasicSceneBodies<S>& bodies, const std::array<BasicAttachment<S>, 2>& ends) {
  for (int i = 0; i < 3; ++i) keep_right_angle<S>(bodies, ends, Vector<S, 3>::Unit(i), Vector<S, 3>::Unit((i + 1) % 3));
}

/// The second point stays in the plane with this normal, fixed in the first body, through the first point.
template <class S>
void keep_in_plane(BasicSceneBodies<S>& bodies, const std::array<BasicAttachment<S>, 2>& ends,
                   const Vector<S, 3>& across) {
  bodies.scene.add(
      multibody::BasicInPlane<S>{{ends[0].site, ends[1].site}, {ends[0].attitude()}, ends[0].seen(across)});
}

template <class S>
void require_in_plane(const BasicSceneBodies<S>& bodies, const Section& table,
                      const std::array<BasicAttachment<S>, 2>& ends, const Vector<S, 3>& across) {
  const double off = value_of(across.dot(ends[1].place - ends[0].place));
  if (!bodies.is_free_in_place() &&
      std::abs(off) > 1e-9 * (1 + values_of(ends[0].place).norm() + values_of(ends[1].place).norm()))
    table.fail("points", fmt::format("the point of \"{}\" is {:.6g} m off where the joint lets it go, at the start",
                                     ends[1].name(), off));
}

template <class S> std::array<BasicAttachment<S>, 2> tied_ends(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = bodies.ends(table);
  if (!ends[0].body && !ends[1].body) table.fail("between", "ties the ground to itself");
  return ends;
}

/// Ends that turn in space, and meet.
template <class S>
std::array<BasicAttachment<S>, 2> joined_ends(BasicSceneBodies<S>& bodies, const Section& table,
                                              const std::string& kind) {
  const auto ends = tied_ends(bodies, table);
  require_turning(table, ends, kind);
  require_together(bodies, table, ends);
  bodies.scene.add(multibody::BasicCoincidence<S>{{ends[0].site, ends[1].site}});
  return ends;
}

/// The length of a rod: what is given, or how far its ends are apart at the start.
template <class S>
S length_or(const BasicSceneBodies<S>& bodies, const Section& table, const std::array<BasicAttachment<S>, 2>& ends,
            double apart) {
  if constexpr (std::is_same_v<S, double>) {
    return bodies.number_or(table, length, apart);
  } else {
    return bodies.number_or(table, length, (ends[1].place - ends[0].place).norm());
  }
}

constexpr auto read_rod = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = tied_ends(bodies, table);
  const double apart = (values_of(ends[1].place) - values_of(ends[0].place)).stableNorm();
  const S given = length_or(bodies, table, ends, apart);
  if (!(given > S(0))) table.fail("points", "the ends of the rod meet; a joint of kind \"ball\" makes two points one");
  if (!bodies.is_free_in_place() && std::abs(value_of(given) - apart) > 1e-9 * value_of(given))
    table.fail("length", fmt::format("is {:.10g} m, but its ends are {:.10g} m apart at the start; leave it out to "
                                     "take that",
                                     value_of(given), apart));
  bodies.scene.add(multibody::BasicRod<S>{{ends[0].site, ends[1].site}, given});
  bodies.lines.push_back({ends[0], ends[1], 0.008});
};

/// Adds the damper that a joint with a key `damping` is, too.
template <class S, class J>
void read_damping(BasicSceneBodies<S>& bodies, const Section& table, const KeyOf<Number>& damping, const J& measure) {
  if (!table.has(damping.name)) return;
  bodies.scene.add(multibody::Damper<J, S>{measure, bodies.number(table, damping)});
  bodies.dissipates = true;
}

constexpr auto read_ball = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = tied_ends(bodies, table);
  require_together(bodies, table, ends);
  bodies.scene.add(multibody::BasicCoincidence<S>{{ends[0].site, ends[1].site}});
  if (table.has(turning_damping.name)) require_turning(table, ends, "joint that rubs");
  read_damping(bodies, table, turning_damping,
               multibody::BasicRelativeTurn<S>{{}, {ends[0].attitude(), ends[1].attitude()}});
};

constexpr auto read_hinge = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = joined_ends(bodies, table, "hinge");
  const Matrix<S, 3, 3> frame = frame_along(bodies, table, axis);
  for (int i = 0; i < 2; ++i) keep_right_angle<S>(bodies, ends, frame.col(i), frame.col(2));
  const Vector<S, 3> along = frame.col(2);
  multibody::BasicHingeTurn<S> turn{
      {}, {ends[0].attitude(), ends[1].attitude()}, ends[0].seen(along), ends[1].seen(along), S(0)};
  read_damping(bodies, table, turning_damping, turn);
  if (!table.has(hinge_rate.name)) return;
  turn.rate = bodies.number(table, hinge_rate);
  const double rate = value_of(turn.rate);
  const auto turning = [&](const BasicAttachment<S>& end) {
    return end.body ? value_of(along.dot(end.body->angular_velocity)) : 0.0;
  };
  const double has = turning(ends[1]) - turning(ends[0]);
  if (!bodies.is_free_to_start() && std::abs(has - rate) > 1e-9 * (1 + std::abs(rate)))
    table.fail("rate", fmt::format("the second body turns against the first at {:.10g} rad/s at the start: give it an "
                                   "angular_velocity (and a velocity of its centre) that agrees",
                                   has));
  bodies.scene.add(turn);
  bodies.nonholonomic = true;
  if (rate != 0) bodies.timed = true;
};

constexpr auto read_weld = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  keep_attitude(bodies, joined_ends(bodies, table, "weld"));
};

constexpr auto read_slider = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = tied_ends(bodies, table);
  require_turning(table, ends, "slider");
  const Matrix<S, 3, 3> frame = frame_along(bodies, table, axis);
  for (int i = 0; i < 2; ++i) {
    require_in_plane<S>(bodies, table, ends, frame.col(i));
    keep_in_plane<S>(bodies, ends, frame.col(i));
  }
  keep_attitude(bodies, ends);
  read_damping(
      bodies, table, sliding_damping,
      multibody::BasicInPlane<S>{{ends[0].site, ends[1].site}, {ends[0].attitude()}, ends[0].seen(frame.col(2))});
};

constexpr auto read_plane = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const auto ends = tied_ends(bodies, table);
  if (!ends[0].turns_in_space())
    table.fail("between", "the first holds the plane: it must be a body that turns in space, or the ground");
  const Vector<S, 3> across = frame_along(bodies, table, normal).col(2);
  require_in_plane(bodies, table, ends, across);
  keep_in_plane(bodies, ends, across);
};

template <class S> BasicNamedBody<S>& turning_body(BasicSceneBodies<S>& bodies, const Section& table) {
  BasicNamedBody<S>& body = bodies.named(table, body_key.name, read_key(table, body_key));
  if (body.body.attitude.index < 0) table.fail("body", fmt::format("\"{}\" does not turn in space", body.name));
  return body;
}

/// The angular velocity in space that the body should have, where it has another.
template <class S>
void require_spin(const BasicSceneBodies<S>& bodies, const Section& table, const BasicNamedBody<S>& body,
                  const Vec& wanted) {
  const Vec has = values_of(body.angular_velocity);
  if (bodies.is_free_to_start() || (wanted - has).norm() <= 1e-9 * (1 + wanted.norm() + has.norm())) return;
  const Vec w = values_of(Vector<S, 3>(body.attitude.transpose() * wanted.template cast<S>()));
  table.fail("body", fmt::format("\"{}\" does not begin as this joint has it; give it angular_velocity = [{:.17g}, "
                                 "{:.17g}, {:.17g}], or another velocity",
                                 body.name, w(0), w(1), w(2)));
}

/// A constraint on arrows, under the principle that the table names.
template <class S, class J>
void add_on_arrows(BasicSceneBodies<S>& bodies, const Section& table, BasicNamedBody<S>& body, const J& joint) {
  const std::string given = read_key(table, principle);
  if (!body.principle.empty() && body.principle != given)
    table.fail("principle",
               fmt::format("another joint of \"{}\" is {}: one principle moves a body", body.name, body.principle));
  body.principle = given;
  const bool vakonomic = given != *principle.fallback;
  bodies.isolated = false;
  if (!vakonomic) {
    if (table.has("multipliers")) table.fail("multipliers", "go with principle = \"vakonomic\"");
    bodies.scene.add(joint);
    bodies.nonholonomic = true;
    return;
  }
  if (table.has("name"))
    table.fail("name",
               "what has principle = \"vakonomic\" is not switched: momenta hold its multipliers; leave it out");
  multibody::Vakonomic<J, S> optimal{joint, {}};
  if (table.has("multipliers")) {
    const std::vector<S> start = bodies.numbers(table, multipliers(J::rows));
    std::copy(start.begin(), start.end(), optimal.multipliers.begin());
  }
  bodies.scene.add(optimal);
  bodies.vakonomic = true;
}

constexpr auto read_rolling = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  BasicNamedBody<S>& ball = turning_body(bodies, table);
  if (ball.linear < 0) table.fail("body", fmt::format("\"{}\" turns about a fixed point and cannot roll", ball.name));
  const S r = bodies.number(table, radius);
  const S rate = bodies.number(table, plate_rate);
  const Vec v = values_of(ball.velocity);
  if (v(2) != 0 && !bodies.is_free_to_start())
    table.fail("body", fmt::format("\"{}\" rolls on a level plate: its velocity has no third part", ball.name));
  const Vec slip = v - value_of(rate) * Vec(Vec::UnitZ()).cross(values_of(ball.place));
  require_spin(bodies, table, ball,
               {-slip(1) / value_of(r), slip(0) / value_of(r), value_of(ball.angular_velocity(2))});
  add_on_arrows(bodies, table, ball, multibody::BasicRolling<S>{{ball.body.centre}, {ball.body.attitude}, r, rate});
  bodies.scene.add(multibody::BasicInPlane<S>{
      {bodies.scene.ground(ball.place), ball.body.centre}, {multibody::Attitude{}}, Vector<S, 3>::UnitZ()});
  if (rate != S(0)) bodies.timed = true;
  Shape plate = turning_plate(value_of(rate));
  plate.position = {0.0, 0.0, value_of(ball.place(2) - r)};
  if (bodies.scenery.empty()) bodies.scenery.push_back(plate);
  ball.radius = value_of(r);
};

constexpr auto read_spin = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  BasicNamedBody<S>& body = turning_body(bodies, table);
  const Vector<S, 3> along = frame_along(bodies, table, spin_axis).col(2);
  const bool in_body = read_key(table, fixed_in) != *fixed_in.fallback;
  const S rate = bodies.number(table, spin_rate);
  const Vec in_space = values_of(in_body ? Vector<S, 3>(body.attitude * along) : along);
  const Vec has = values_of(body.angular_velocity);
  require_spin(bodies, table, body, has + (value_of(rate) - in_space.dot(has)) * in_space);
  if (in_body) {
    add_on_arrows(bodies, table, body, multibody::BasicBodySpin<S>{{}, {body.body.attitude}, along, rate});
  } else {
    add_on_arrows(bodies, table, body, multibody::BasicPrescribedSpin<S>{{}, {body.body.attitude}, along, rate});
  }
  if (rate != 0) bodies.timed = true;
};

constexpr auto read_blade = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  BasicNamedBody<S>& body = bodies.named(table, body_key.name, read_key(table, body_key));
  if (!body.planar)
    table.fail("body", fmt::format("\"{}\" does not move in the plane: a blade needs a body of kind "
                                   "\"planar\"",
                                   body.name));
  multibody::BasicBlade<S> blade{{bodies.scene.planar_place(body.body)},
                                 bodies.number(table, blade_direction),
                                 bodies.number(table, ahead),
                                 bodies.number(table, blade_rate)};
  const double angle = value_of(blade.direction), rate = value_of(blade.rate);
  const Vec along = values_of(Vector<S, 3>(body.attitude * Vector<S, 3>(S(std::cos(angle)), S(std::sin(angle)), S(0))));
  const double slip = Vec(Vec::UnitZ()).cross(along).dot(values_of(body.velocity)) +
                      value_of(blade.arm) * value_of(body.angular_velocity(2));
  if (!bodies.is_free_to_start() &&
      std::abs(slip - rate) > 1e-9 * (1 + values_of(body.velocity).norm() + std::abs(slip)))
    table.fail("body", fmt::format("\"{}\" moves across the blade at {:.10g} m/s at the start, and may at {:.10g}: "
                                   "give it another velocity or angular_velocity",
                                   body.name, slip, rate));
  add_on_arrows(bodies, table, body, blade);
  if (rate != 0) bodies.timed = true;
};

/// The keys of what ties two bodies, and these.
std::vector<Key> tie(const std::vector<Key>& more) {
  std::vector<Key> keys = end_keys();
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}
/// The keys of what holds velocities by so many equations, and these.
std::vector<Key> hold(int rows, const std::vector<Key>& more) {
  std::vector<Key> keys{body_key};
  keys.insert(keys.end(), more.begin(), more.end());
  keys.insert(keys.end(), {principle, multipliers(rows)});
  return keys;
}

}  // namespace

const std::vector<SceneKind>& joint_kinds() {
  static const std::vector<SceneKind> all{
      {"rod", "keeps the distance of the points", read_rod, tie({length})},
      {"ball", "makes the points one; between planar bodies a pin", read_ball, tie({turning_damping})},
      {"hinge", "makes the points one and keeps an axis", read_hinge, tie({axis, turning_damping, hinge_rate})},
      {"weld", "makes the points one and keeps the attitude", read_weld, tie({})},
      {"slider", "the second moves along an axis fixed in the first, without turning", read_slider,
       tie({axis, sliding_damping})},
      {"plane", "the second's point stays in the plane through the first's", read_plane, tie({normal})},
      {"rolling", "a ball rolls without slipping on a level plate; one that is tilted is one under a gravity that is",
       read_rolling, hold(multibody::Rolling::rows, {radius, plate_rate})},
      {"spin", "the body turns about an axis at a rate", read_spin,
       hold(multibody::BodySpin::rows, {spin_axis, fixed_in, spin_rate})},
      {"blade", "a planar body moves across a blade at a rate alone: a wheel, the edge of a sleigh", read_blade,
       hold(multibody::Blade::rows, {blade_direction, ahead, blade_rate})}};
  return all;
}

}  // namespace lagroid::app
