// [[joint]]

#include "scene_bodies.hpp"

#include <lagroid/systems/multibody/joints.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lagroid::app {

using multibody::Coincidence;
using multibody::FixedAngle;
using multibody::InPlane;
using multibody::Mat;
using multibody::Rod;
using multibody::Vec;

namespace {

/// Unit vectors: the direction under `key`, and two that complete it.
Mat frame_along(const Section& table, std::string_view key, std::string_view meaning) {
  const Vec axis = vector_of(table, key, meaning);
  if (!(axis.norm() > 0)) table.fail(key, "must not vanish");
  const Vec third = axis.stableNormalized();
  int least = 0;
  third.cwiseAbs().minCoeff(&least);
  const Vec first = Vec(Vec::Unit(least)).cross(third).normalized();
  Mat out;
  out << first, third.cross(first), third;
  return out;
}

void require_turning(const Section& table, const std::array<End, 2>& ends, const std::string& kind) {
  for (const End& end : ends) {
    if (end.turns_in_space()) continue;
    table.fail(
        "between",
        end.body->planar
            ? fmt::format("\"{}\" turns in the plane only: a joint of kind \"ball\" is its hinge", end.name())
            : fmt::format("\"{}\" is a point mass and does not turn: a {} needs bodies that do", end.name(), kind));
  }
}

void require_together(const Section& table, const std::array<End, 2>& ends) {
  const double apart = (ends[1].place - ends[0].place).norm();
  if (apart > 1e-9 * (1 + ends[0].place.norm()))
    table.fail("points", fmt::format("the two points are {:.6g} m apart at the start, and must be one: \"{}\" has "
                                     "its own at ({:.10g}, {:.10g}, {:.10g}), \"{}\" at ({:.10g}, {:.10g}, {:.10g})",
                                     apart, ends[0].name(), ends[0].place(0), ends[0].place(1), ends[0].place(2),
                                     ends[1].name(), ends[1].place(0), ends[1].place(1), ends[1].place(2)));
}

/// The direction u in space, fixed in the first body, and v, fixed in the second, keep their right angle.
void keep_right_angle(SceneBodies& bodies, const std::array<End, 2>& ends, const Vec& u, const Vec& v) {
  bodies.scene.add(FixedAngle{{}, {ends[0].attitude(), ends[1].attitude()}, ends[0].seen(u), ends[1].seen(v), 0});
}

/// The second body keeps its attitude relative to the first.
void keep_attitude(SceneBodies& bodies, const std::array<End, 2>& ends) {
  for (int i = 0; i < 3; ++i) keep_right_angle(bodies, ends, Vec::Unit(i), Vec::Unit((i + 1) % 3));
}

/// The second point stays in the plane with this normal, fixed in the first body, through the first point.
void keep_in_plane(SceneBodies& bodies, const std::array<End, 2>& ends, const Vec& normal) {
  bodies.scene.add(InPlane{{ends[0].site, ends[1].site}, {ends[0].attitude()}, ends[0].seen(normal)});
}

void require_in_plane(const Section& table, const std::array<End, 2>& ends, const Vec& normal) {
  const double off = normal.dot(ends[1].place - ends[0].place);
  if (std::abs(off) > 1e-9 * (1 + ends[0].place.norm() + ends[1].place.norm()))
    table.fail("points", fmt::format("the point of \"{}\" is {:.6g} m off where the joint lets it go, at the start",
                                     ends[1].name(), off));
}

std::array<End, 2> tied_ends(SceneBodies& bodies, const Section& table) {
  const auto ends = bodies.ends(table);
  if (!ends[0].body && !ends[1].body) table.fail("between", "ties the ground to itself");
  return ends;
}

/// Ends that turn in space, and meet.
std::array<End, 2> joined_ends(SceneBodies& bodies, const Section& table, const std::string& kind) {
  const auto ends = tied_ends(bodies, table);
  require_turning(table, ends, kind);
  require_together(table, ends);
  bodies.scene.add(Coincidence{{ends[0].site, ends[1].site}});
  return ends;
}

void read_rod(SceneBodies& bodies, const Section& table) {
  const auto ends = tied_ends(bodies, table);
  const double apart = (ends[1].place - ends[0].place).stableNorm();
  const double length = table.number_or("length", apart, positive);
  if (!(length > 0)) table.fail("points", "the ends of the rod meet; a joint of kind \"ball\" makes two points one");
  if (std::abs(length - apart) > 1e-9 * length)
    table.fail("length", fmt::format("is {:.10g} m, but its ends are {:.10g} m apart at the start; leave it out to "
                                     "take that",
                                     length, apart));
  bodies.scene.add(Rod{{ends[0].site, ends[1].site}, length});
  bodies.lines.push_back({ends[0], ends[1], 0.008});
}

/// Adds the damper that a joint with a key `damping` is, too.
template <class J> void read_damping(SceneBodies& bodies, const Section& table, const J& measure) {
  if (!table.has("damping")) return;
  bodies.scene.add(multibody::Damper<J>{measure, table.number("damping", damping_rule)});
  bodies.dissipates = true;
}

void read_ball(SceneBodies& bodies, const Section& table) {
  const auto ends = tied_ends(bodies, table);
  require_together(table, ends);
  bodies.scene.add(Coincidence{{ends[0].site, ends[1].site}});
  if (table.has("damping")) require_turning(table, ends, "joint that rubs");
  read_damping(bodies, table, multibody::RelativeTurn{{}, {ends[0].attitude(), ends[1].attitude()}});
}

void read_hinge(SceneBodies& bodies, const Section& table) {
  const auto ends = joined_ends(bodies, table, "hinge");
  const Mat frame = frame_along(table, "axis", "in space at the start");
  for (int i = 0; i < 2; ++i) keep_right_angle(bodies, ends, frame.col(i), frame.col(2));
  const Vec axis = frame.col(2);
  multibody::HingeTurn turn{{}, {ends[0].attitude(), ends[1].attitude()}, ends[0].seen(axis), ends[1].seen(axis), 0};
  read_damping(bodies, table, turn);
  if (!table.has("rate")) return;
  turn.rate = table.number("rate");
  const auto turning = [&](const End& end) { return end.body ? axis.dot(end.body->angular_velocity) : 0.0; };
  const double has = turning(ends[1]) - turning(ends[0]);
  if (!bodies.projects && std::abs(has - turn.rate) > 1e-9 * (1 + std::abs(turn.rate)))
    table.fail("rate", fmt::format("the second body turns against the first at {:.10g} rad/s at the start: give it an "
                                   "angular_velocity (and a velocity of its centre) that agrees",
                                   has));
  bodies.scene.add(turn);
  bodies.nonholonomic = true;
  if (turn.rate != 0) bodies.timed = true;
}

void read_weld(SceneBodies& bodies, const Section& table) { keep_attitude(bodies, joined_ends(bodies, table, "weld")); }

void read_slider(SceneBodies& bodies, const Section& table) {
  const auto ends = tied_ends(bodies, table);
  require_turning(table, ends, "slider");
  const Mat frame = frame_along(table, "axis", "in space at the start");
  for (int i = 0; i < 2; ++i) {
    require_in_plane(table, ends, frame.col(i));
    keep_in_plane(bodies, ends, frame.col(i));
  }
  keep_attitude(bodies, ends);
  read_damping(bodies, table, InPlane{{ends[0].site, ends[1].site}, {ends[0].attitude()}, ends[0].seen(frame.col(2))});
}

void read_plane(SceneBodies& bodies, const Section& table) {
  const auto ends = tied_ends(bodies, table);
  if (!ends[0].turns_in_space())
    table.fail("between", "the first holds the plane: it must be a body that turns in space, or the ground");
  const Vec normal = frame_along(table, "normal", "of the plane, in space at the start").col(2);
  require_in_plane(table, ends, normal);
  keep_in_plane(bodies, ends, normal);
}

NamedBody& turning_body(SceneBodies& bodies, const Section& table) {
  NamedBody& body = bodies.named(table, "body", table.text("body", "the name of a body"));
  if (body.body.attitude.index < 0) table.fail("body", fmt::format("\"{}\" does not turn in space", body.name));
  return body;
}

/// The angular velocity in space that the body should have, where it has another.
void require_spin(const SceneBodies& bodies, const Section& table, const NamedBody& body, const Vec& wanted) {
  const Vec& has = body.angular_velocity;
  if (bodies.projects || (wanted - has).norm() <= 1e-9 * (1 + wanted.norm() + has.norm())) return;
  const Vec w = body.attitude.transpose() * wanted;
  table.fail("body", fmt::format("\"{}\" does not begin as this joint has it; give it angular_velocity = [{:.17g}, "
                                 "{:.17g}, {:.17g}], or another velocity",
                                 body.name, w(0), w(1), w(2)));
}

/// A constraint on arrows, under the principle that the table names.
template <class J> void add_on_arrows(SceneBodies& bodies, const Section& table, NamedBody& body, const J& joint) {
  const std::string principle = table.choice_or("principle", "nonholonomic", {"nonholonomic", "vakonomic"});
  if (!body.principle.empty() && body.principle != principle)
    table.fail("principle",
               fmt::format("another joint of \"{}\" is {}: one principle moves a body", body.name, body.principle));
  body.principle = principle;
  const bool vakonomic = principle == "vakonomic";
  bodies.isolated = false;
  if (!vakonomic) {
    if (table.has("multipliers")) table.fail("multipliers", "go with principle = \"vakonomic\"");
    bodies.scene.add(joint);
    bodies.nonholonomic = true;
    return;
  }
  multibody::Vakonomic<J> optimal{joint, {}};
  if (table.has("multipliers")) {
    const auto start = table.numbers("multipliers", std::size_t(J::rows), "of its equations, at the start");
    std::copy(start.begin(), start.end(), optimal.multipliers.begin());
  }
  bodies.scene.add(optimal);
  bodies.vakonomic = true;
}

void read_rolling(SceneBodies& bodies, const Section& table) {
  NamedBody& ball = turning_body(bodies, table);
  if (ball.linear < 0) table.fail("body", fmt::format("\"{}\" turns about a fixed point and cannot roll", ball.name));
  const double radius = table.number("radius", positive);
  const double rate = table.number_or("plate_rate", 0);
  const Vec& v = ball.velocity;
  if (v(2) != 0 && !bodies.projects)
    table.fail("body", fmt::format("\"{}\" rolls on a level plate: its velocity has no third part", ball.name));
  const Vec slip = v - rate * Vec(Vec::UnitZ()).cross(ball.place);
  require_spin(bodies, table, ball, {-slip(1) / radius, slip(0) / radius, ball.angular_velocity(2)});
  add_on_arrows(bodies, table, ball, multibody::Rolling{{ball.body.centre}, {ball.body.attitude}, radius, rate});
  bodies.scene.add(InPlane{{bodies.scene.ground(ball.place), ball.body.centre}, {multibody::Attitude{}}, Vec::UnitZ()});
  if (rate != 0) bodies.timed = true;
  Shape plate = turning_plate(rate);
  plate.position = {0.0, 0.0, ball.place(2) - radius};
  if (bodies.scenery.empty()) bodies.scenery.push_back(plate);
  ball.radius = radius;
}

void read_spin(SceneBodies& bodies, const Section& table) {
  NamedBody& body = turning_body(bodies, table);
  const Vec axis = frame_along(table, "axis", "in space, or in the body").col(2);
  const bool in_body = table.choice_or("fixed_in", "space", {"space", "body"}) == "body";
  const double rate = table.number_or("rate", 0);
  const Vec in_space = in_body ? Vec(body.attitude * axis) : axis;
  require_spin(bodies, table, body, body.angular_velocity + (rate - in_space.dot(body.angular_velocity)) * in_space);
  if (in_body) {
    add_on_arrows(bodies, table, body, multibody::BodySpin{{}, {body.body.attitude}, axis, rate});
  } else {
    add_on_arrows(bodies, table, body, multibody::PrescribedSpin{{}, {body.body.attitude}, axis, rate});
  }
  if (rate != 0) bodies.timed = true;
}

void read_blade(SceneBodies& bodies, const Section& table) {
  NamedBody& body = bodies.named(table, "body", table.text("body", "the name of a body"));
  if (!body.planar)
    table.fail("body", fmt::format("\"{}\" does not move in the plane: a blade needs a body of kind "
                                   "\"planar\"",
                                   body.name));
  multibody::Blade blade{{bodies.scene.planar_place(body.body)},
                         table.number_or("direction", 0),
                         table.number_or("ahead", 0),
                         table.number_or("rate", 0)};
  const Vec along = body.attitude * Vec(std::cos(blade.direction), std::sin(blade.direction), 0);
  const double slip = Vec(Vec::UnitZ()).cross(along).dot(body.velocity) + blade.arm * body.angular_velocity(2);
  if (!bodies.projects && std::abs(slip - blade.rate) > 1e-9 * (1 + body.velocity.norm() + std::abs(slip)))
    table.fail("body", fmt::format("\"{}\" moves across the blade at {:.10g} m/s at the start, and may at {:.10g}: "
                                   "give it another velocity or angular_velocity",
                                   body.name, slip, blade.rate));
  add_on_arrows(bodies, table, body, blade);
  if (blade.rate != 0) bodies.timed = true;
}

/// The kinds of [[joint]], as they are listed to users.
constexpr std::array<SceneKind, 9> kinds{{{"rod", read_rod},
                                          {"ball", read_ball},
                                          {"hinge", read_hinge},
                                          {"weld", read_weld},
                                          {"slider", read_slider},
                                          {"plane", read_plane},
                                          {"rolling", read_rolling},
                                          {"spin", read_spin},
                                          {"blade", read_blade}}};

}  // namespace

void read_joint(SceneBodies& bodies, const Section& table) { read_kind(kinds, bodies, table); }

}  // namespace lagroid::app
