#include "bodies_keys.hpp"

#include <lagroid/groupoids/groups/so3.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

namespace lagroid::app {

namespace {

using multibody::DirectionCone;
using multibody::KeepOut;
using multibody::limit_rounding;
using multibody::SceneEnd;
using multibody::Site;
using multibody::SpeedLimit;
using multibody::Vec;

const KeyOf<Text> effect_key{"effect", {}, "", "name of the effect whose strength is a control u"};
const KeyOf<Either> bounds_key = range_key("bounds", "", "least and largest u");
const KeyOf<Number> weight_key{"weight", {nonnegative}, "", "w of the cost w u^2", 1.0};

const KeyOf<NumberArray> point_key =
    vector_key("at", "m", "the point of the body, in its frame, that position is of", Vec::Zero());
const KeyOf<NumberList> position_key{"position", {}, "m", "x, y, z; of a planar body x, y", {}, "free"};
const KeyOf<AnyAttitude> attitude_key{"attitude", {},    "", "a unit quaternion w, x, y, z, or a rotation vector (rad)",
                                      {},         "free"};
const KeyOf<Number> angle_key{"angle", {}, "rad", "of a planar body", {}, "free"};
const KeyOf<NumberList> velocity_key{"velocity", {}, "m/s", "of its centre; of a planar body x, y", {}, "free"};
const KeyOf<NumberList> turning_key{
    "angular_velocity", {}, "rad/s", "in the body's frame; of a planar body one number", {}, "free"};
const KeyOf<Flag> at_rest_key{"at_rest", {}, "", "true: velocity and angular velocity are zero", false};

const KeyOf<NumberArray> kept_point =
    vector_key("at", "m", "the point that keeps out, in the body's frame", Vec::Zero());
const KeyOf<NumberArray> centre_key = vector_key("centre", "m", "x, y, z");
const KeyOf<Number> radius_key{"radius", {positive}, "m", "of it"};
const KeyOf<NumberArray> on_plane_key = vector_key("point", "m", "of the plane");
const KeyOf<NumberArray> normal_key = vector_key("normal", "", "leads to the side that the point stays on");
const KeyOf<Number> time_weight{"weight", {nonnegative}, "", "w of the cost w T, which a free duration needs", 0.0};

const NumberRule an_angle{"between 0 and pi", [](double x) { return x > 0 && x < std::numbers::pi; }};
const KeyOf<NumberArray> direction_key = vector_key("direction", "", "fixed in the body, in its frame");
const KeyOf<NumberArray> axis_key = vector_key("axis", "", "of the cone, in space");
const KeyOf<Number> at_least_key{"at_least", {an_angle}, "rad", "of direction from axis: outside of a cone", {}, "any"};
const KeyOf<Number> at_most_key{"at_most", {an_angle}, "rad", "of direction from axis: inside of a cone", {}, "any"};
const KeyOf<NumberArray> limited_point =
    vector_key("at", "m", "the point that is limited, in the body's frame", Vec::Zero());
const KeyOf<Number> speed_key{"speed", {positive}, "m/s", "of its centre, or of the point at, at most", {}, "any"};
const KeyOf<Text> name_key{"name", {}, "", "what messages call it", {}, "by its kind, its body and where it is"};
const KeyOf<Number> angular_speed_key{"angular_speed", {positive}, "rad/s", "of its turning, at most", {}, "any"};

/// What [[constraint]] asks of a body at every node.
struct LimitKind {
  const char* name;
  const char* about;
  std::vector<Key> keys;
};
const std::vector<LimitKind>& limit_kinds() {
  static const std::vector<LimitKind> all{
      {"sphere", "a point keeps out of a sphere", {name_key, body_key, kept_point, centre_key, radius_key}},
      {"disk",
       "a point keeps out of a disk in the plane of x and y, a cylinder along z",
       {name_key, body_key, kept_point, centre_key, radius_key}},
      {"plane", "a point stays on one side of a plane", {name_key, body_key, kept_point, on_plane_key, normal_key}},
      {"cone",
       "a direction of a body that turns in space keeps off another, or near it",
       {name_key, body_key, direction_key, axis_key, at_least_key, at_most_key}},
      {"speed",
       "a body, or a point of it, does not move or turn faster",
       {name_key, body_key, limited_point, speed_key, angular_speed_key}}};
  return all;
}
KeyOf<OneOf> kind_key(const std::vector<LimitKind>& kinds) {
  KeyOf<OneOf> key{"kind"};
  for (const LimitKind& each : kinds) key.value.words.emplace_back(each.name);
  return key;
}

/// A point of a body.
struct PointOf {
  std::string body;
  Vec arm;
};
/// Adds them to a scene that was read over any numbers: they have the same sites in each.
template <class S> BasicSceneBodies<S> with_points(BasicSceneBodies<S> bodies, const std::vector<PointOf>& points) {
  for (const PointOf& each : points)
    for (const BasicNamedBody<S>& body : bodies.bodies)
      if (body.name == each.body) bodies.scene.point_of(body.body, each.arm.template cast<S>());
  return bodies;
}

/// What a table [[end]] gives of a body's places.
struct EndOf {
  std::string body;
  Vec arm = Vec::Zero();  ///< of the point that is at
  std::optional<Vec> place = {};
  std::optional<multibody::Mat> attitude = {};
  std::optional<Vec> velocity = {};  ///< of its centre
  std::optional<Vec> turning = {};   ///< in its frame

  /// How fast a point of a body is at the end, where this says so.
  std::optional<double> speed_of(const NamedBody& of, const Vec& point) const {
    if (of.name != body) return std::nullopt;
    const bool is_pivoted = of.linear < 0;
    if (turning && (velocity || is_pivoted) && attitude)
      return (velocity.value_or(Vec::Zero()) + *attitude * turning->cross(point)).norm();
    if (velocity && point.isZero(0)) return velocity->norm();
    return std::nullopt;
  }
  /// Where a point of a body is at the end, where this says so.
  std::optional<Vec> place_of(const NamedBody& of, const Vec& point) const {
    if (of.name != body) return std::nullopt;
    const bool is_pivoted = of.linear < 0;
    if (place && point == arm) return place;
    if (attitude && is_pivoted) return Vec(of.place + *attitude * point);
    if (attitude && place) return Vec(*place + *attitude * (point - arm));
    return std::nullopt;
  }
};

/// "(1, 0, 0.5)".
std::string numbers_of(const Vec& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v(0), v(1), v(2)); }
std::string exactly(const Vec& v) { return fmt::format("{} {} {}", v(0), v(1), v(2)); }
constexpr std::array<const char*, 3> axes{"x", "y", "z"};

/// Reads [[end]] and [[constraint]], of points that are added to the bodies.
class Reader {
 public:
  Reader(SceneBodies& bodies, BodiesControl& out) : bodies_(bodies), out_(out) {}

  void read_end(const Section& table) {
    const NamedBody& body = bodies_.named(table, body_key.name, read_key(table, body_key));
    SceneEnd& end = out_.task.end;
    EndOf& given = ends_.emplace_back(EndOf{body.name});
    if (table.has(position_key.name)) {
      const auto place = numbers(table, position_key, body.planar ? 2 : 3);
      const Attachment point = point_of(table, point_key, body);
      if (body.linear < 0 && point.arm.isZero(0))
        table.fail("position", fmt::format("\"{}\" is held at its pivot: give a point of it by at", body.name));
      for (int i = 0; i < int(place.size()); ++i) {
        end.places.push_back({point.site, i, place[std::size_t(i)]});
        out_.end.places.push_back(fmt::format("position of \"{}\" along {}", body.name, axes[std::size_t(i)]));
      }
      given.arm = point.arm;
      given.place = body.place;  // a planar body keeps its height
      std::copy(place.begin(), place.end(), given.place->begin());
    } else if (table.has(point_key.name)) {
      table.fail(point_key.name, "is the point that position is of: give position, or leave it out");
    }
    if (table.has(attitude_key.name)) {
      if (body.body.attitude.index < 0)
        table.fail("attitude",
                   fmt::format("\"{}\" does not turn in space{}", body.name, body.planar ? ": give its angle" : ""));
      const auto q = read_key_or(table, attitude_key, {});
      end.turns.push_back({body.body.attitude, {q[0], q[1], q[2], q[3]}});
      out_.end.turns.push_back(fmt::format("attitude of \"{}\"", body.name));
      given.attitude = SO3::from_quaternion(end.turns.back().value);
    }
    if (table.has(angle_key.name)) {
      if (!body.planar) table.fail("angle", fmt::format("\"{}\" is no planar body", body.name));
      end.places.push_back({bodies_.scene.planar_place(body.body), 2, read_key_or(table, angle_key, 0)});
      out_.end.places.push_back(fmt::format("angle of \"{}\"", body.name));
      given.attitude = SO3::exp(Vec(0, 0, end.places.back().value));
    }
    const bool at_rest = read_key(table, at_rest_key);
    if (table.has(velocity_key.name) || (at_rest && body.linear >= 0)) {
      if (body.linear < 0) table.fail("velocity", fmt::format("\"{}\" is held at its pivot", body.name));
      const auto v = given_or_zero(table, velocity_key, body.planar ? 2 : 3, at_rest);
      given.velocity = Vec(v[0], v[1], body.planar ? 0 : v[2]);
      for (int i = 0; i < int(v.size()); ++i) {
        end.velocities.push_back({body.linear, i, v[std::size_t(i)]});
        out_.end.velocities.push_back(fmt::format("velocity of \"{}\" along {}", body.name, axes[std::size_t(i)]));
      }
    }
    const bool turns = body.planar || body.body.attitude.index >= 0;
    if (!table.has(turning_key.name) && !(at_rest && turns)) return;
    if (!turns) table.fail("angular_velocity", fmt::format("\"{}\" does not turn", body.name));
    const auto w = given_or_zero(table, turning_key, body.planar ? 1 : 3, at_rest);
    given.turning = body.planar ? Vec(0, 0, w[0]) : Vec(w[0], w[1], w[2]);
    for (int i = 0; i < int(w.size()); ++i) {
      if (body.planar) end.velocities.push_back({body.linear, 2, w[0]});
      if (!body.planar) end.turnings.push_back({body.body.attitude, i, w[std::size_t(i)]});
      (body.planar ? out_.end.velocities : out_.end.turnings)
          .push_back(fmt::format("angular velocity of \"{}\"", body.name));
    }
  }

  void read_constraint(const Section& table) {
    ++constraints_;
    const std::string kind = read_key(table, kind_key(limit_kinds()));
    const NamedBody& body = bodies_.named(table, body_key.name, read_key(table, body_key));
    if (table.has(name_key.name)) require_new_name(table);
    if (kind == "cone") return read_cone(table, body);
    if (kind == "speed") return read_speed(table, body);
    read_keep_out(table, body,
                  kind == "plane"  ? KeepOut::Kind::plane
                  : kind == "disk" ? KeepOut::Kind::disk
                                   : KeepOut::Kind::sphere);
  }

  const std::vector<PointOf>& points() const { return points_; }

 private:
  void read_keep_out(const Section& table, const NamedBody& body, KeepOut::Kind kind) {
    KeepOut keep_out;
    keep_out.kind = kind;
    const Attachment point = point_of(table, kept_point, body);
    keep_out.site = point.site;
    const std::string of = point_name(body, point.arm);
    if (keep_out.kind == KeepOut::Kind::plane) {
      keep_out.centre = vector(table, on_plane_key);
      keep_out.normal = unit(table, normal_key);
      keep_out.name = fmt::format("plane through {} for {}", numbers_of(keep_out.centre), of);
    } else {
      keep_out.centre = vector(table, centre_key);
      keep_out.radius = read_key(table, radius_key);
      keep_out.name = fmt::format("{} about {} for {}", kind == KeepOut::Kind::disk ? "disk" : "sphere",
                                  numbers_of(keep_out.centre), of);
    }
    keep_out.name = read_key_or(table, name_key, keep_out.name);
    require_new(table, fmt::format("{} {} {} {} {} {}", int(kind), body.name, exactly(point.arm),
                                   exactly(keep_out.centre), keep_out.radius, exactly(keep_out.normal)));
    if (keep_out.value(point.place) > limit_rounding)
      table.fail("", fmt::format("\"{}\" is inside at the start", body.name));
    for (const EndOf& end : ends_)
      if (const auto place = end.place_of(body, point.arm); place && keep_out.value(*place) > limit_rounding)
        table.fail("", fmt::format("\"{}\" is inside at the end that [[end]] gives: change that, or the {}", body.name,
                                   keep_out.kind == KeepOut::Kind::plane ? "plane" : "centre or the radius"));
    out_.task.keep_outs.push_back(keep_out);
  }

  void read_cone(const Section& table, const NamedBody& body) {
    if (body.body.attitude.index < 0)
      table.fail("body", fmt::format("\"{}\" does not turn in space: keep points of it out instead", body.name));
    DirectionCone cone;
    cone.attitude = body.body.attitude;
    cone.direction = unit(table, direction_key);
    cone.axis = unit(table, axis_key);
    const double at_least = read_key_or(table, at_least_key, 0);
    const double at_most = read_key_or(table, at_most_key, std::numbers::pi);
    if (!table.has(at_least_key.name) && !table.has(at_most_key.name))
      table.fail("", "a cone has an angle: give at_least or at_most (rad)");
    if (!(at_least < at_most)) table.fail("at_least", fmt::format("{} is not below at_most, {}", at_least, at_most));
    const auto add = [&](const KeyOf<Number>& key, double angle, DirectionCone::Side side) {
      if (!table.has(key.name)) return;
      cone.angle = angle;
      cone.side = side;
      cone.name = read_key_or(table, name_key, fmt::format("cone about {} for {}", numbers_of(cone.axis), body.name));
      if (table.has(at_least_key.name) && table.has(at_most_key.name)) cone.name += ", " + key.name;
      require_new(table, fmt::format("cone {} {} {} {} {}", body.name, exactly(cone.direction), exactly(cone.axis),
                                     key.name, angle));
      const Vec seen = body.attitude * cone.direction;
      if (cone.value(body.attitude) > limit_rounding)
        table.fail(key.name, fmt::format("\"{}\" has its direction {:.4g} rad from the axis at the start", body.name,
                                         std::atan2(seen.cross(cone.axis).norm(), seen.dot(cone.axis))));
      out_.task.cones.push_back(cone);
    };
    add(at_least_key, at_least, DirectionCone::Side::outside);
    add(at_most_key, at_most, DirectionCone::Side::inside);
  }

  void read_speed(const Section& table, const NamedBody& body) {
    if (!table.has(speed_key.name) && !table.has(angular_speed_key.name))
      table.fail("", "give speed (m/s) or angular_speed (rad/s), the largest that it may have");
    if (table.has(speed_key.name)) {
      SpeedLimit& limit = out_.task.speed_limits.emplace_back();
      const Attachment point = moving_point(table, speed_key, body);
      if (point.arm.isZero(0))
        limit.linear = body.linear;
      else
        limit.site = point.site;
      if (body.planar) limit.axes = {0, 1};
      const Vec velocity = body.velocity + body.angular_velocity.cross(Vec(body.attitude * point.arm));
      limit.most = largest(table, speed_key, body, velocity.norm(), "m/s");
      for (const EndOf& end : ends_)
        if (const auto speed = end.speed_of(body, point.arm); speed && *speed > limit.most * (1 + limit_rounding))
          table.fail("speed", fmt::format("\"{}\" has {:.4g} m/s at the end that [[end]] gives: change one of them",
                                          point_name(body, point.arm), *speed));
      name_speed(table, speed_key, body, point.arm, "speed limit", limit);
    } else if (table.has(limited_point.name)) {
      table.fail(limited_point.name, "is the point that speed is of: give speed, or leave it out");
    }
    if (!table.has(angular_speed_key.name)) return;
    const bool turns = body.planar || body.body.attitude.index >= 0;
    if (!turns) table.fail("angular_speed", fmt::format("\"{}\" does not turn", body.name));
    SpeedLimit& limit = out_.task.speed_limits.emplace_back();
    if (body.planar) {
      limit.linear = body.linear;
      limit.axes = {2};
    } else {
      limit.attitude = body.body.attitude;
    }
    limit.most = largest(table, angular_speed_key, body, body.angular_velocity.norm(), "rad/s");
    name_speed(table, angular_speed_key, body, Vec::Zero(), "limit of angular speed", limit);
  }
  void name_speed(const Section& table, const KeyOf<Number>& key, const NamedBody& body, const Vec& arm,
                  const char* what, SpeedLimit& limit) {
    limit.name = fmt::format("{} of {}", what, point_name(body, arm));
    if (table.has(name_key.name)) {
      limit.name = read_key_or(table, name_key, {});
      if (table.has(speed_key.name) && table.has(angular_speed_key.name)) limit.name += ", " + key.name;
    }
    require_new(table, fmt::format("{} {} {} {}", key.name, body.name, exactly(arm), limit.most));
  }

  /// The point at, of which a key speaks: it moves. The body's centre is no point of its own.
  Attachment moving_point(const Section& table, const KeyOf<Number>& key, const NamedBody& body) {
    const Attachment point = table.has(limited_point.name) ? point_of(table, limited_point, body) : Attachment{};
    if (body.linear < 0 && point.arm.isZero(0))
      table.fail(key.name, fmt::format("\"{}\" is held at its pivot: give a point of it by at", body.name));
    return point;
  }
  static std::string point_name(const NamedBody& body, const Vec& arm) {
    return arm.isZero(0) ? body.name : fmt::format("{} at {}", body.name, numbers_of(arm));
  }

  /// Of what a constraint says; an earlier one that says it, too, makes multipliers ambiguous.
  void require_new(const Section& table, const std::string& says) {
    const auto [before, is_new] = said_.try_emplace(says, constraints_);
    if (!is_new) table.fail("", fmt::format("says what constraint.{} says: leave one of them out", before->second));
  }

  void require_new_name(const Section& table) {
    const auto [before, is_new] = names_.try_emplace(read_key_or(table, name_key, ""), constraints_);
    if (!is_new) table.fail(name_key.name, fmt::format("is that of constraint.{}: give another", before->second));
  }

  /// A largest speed, which the start keeps to.
  static double largest(const Section& table, const KeyOf<Number>& key, const NamedBody& body, double at_start,
                        std::string_view unit) {
    const double most = read_key_or(table, key, 0);
    if (at_start > most * (1 + limit_rounding))
      table.fail(key.name, fmt::format("\"{}\" has {:.4g} {} at the start", body.name, at_start, unit));
    return most;
  }
  static Vec vector(const Section& table, const KeyOf<NumberArray>& key) { return Vec(read_key(table, key).data()); }
  static Vec unit(const Section& table, const KeyOf<NumberArray>& key) {
    const Vec v = vector(table, key);
    if (!(v.stableNorm() > 0)) table.fail(key.name, "must not vanish");
    return v.stableNormalized();
  }
  static std::vector<double> numbers(const Section& table, const KeyOf<NumberList>& key, std::size_t count) {
    const std::vector<double> out = read_key_or(table, key, {});
    if (out.size() != count) table.fail(key.name, fmt::format("give {} numbers of this body", count));
    return out;
  }
  static std::vector<double> given_or_zero(const Section& table, const KeyOf<NumberList>& key, std::size_t count,
                                           bool at_rest) {
    if (!table.has(key.name)) return std::vector<double>(count, 0.0);
    if (at_rest) table.fail(key.name, "leave it out of a body at_rest");
    return numbers(table, key, count);
  }
  Attachment point_of(const Section& table, const KeyOf<NumberArray>& key, const NamedBody& body) {
    points_.push_back({body.name, Vec(read_key(table, key).data())});
    return bodies_.end_of(table, key.name, &body, points_.back().arm);
  }

  SceneBodies& bodies_;
  BodiesControl& out_;
  std::vector<PointOf> points_;
  std::vector<EndOf> ends_;
  int constraints_ = -1;              // the number of the one that is read
  std::map<std::string, int> said_;   // what they say, and which says it first
  std::map<std::string, int> names_;  // that scenes give them
};

}  // namespace

BodiesControl read_controlled_bodies(const Section& scene) {
  BodiesControl out;
  SceneBodies bodies = read_scene_bodies(scene);
  if (bodies.timed)
    scene.fail("effect", "forces and grounds that follow time are not controlled here: leave out rate and phase");
  if (bodies.projects)
    scene.fail("project_velocities", "give velocities that the joints allow: a controlled scene starts with them");
  Reader reader(bodies, out);
  for (const Section& table : scene.tables("end")) reader.read_end(table);
  for (const Section& table : scene.tables("constraint")) reader.read_constraint(table);
  const Section text = scene;
  const std::vector<PointOf> points = reader.points();
  out.task.scene = [text, points] { return with_points(read_scene_bodies(text), points).scene; };
  out.task.second = [text, points] { return with_points(read_second_scene(text), points).scene; };
  for (const Section& table : scene.tables("actuator")) {
    multibody::Actuator& actuator = out.task.actuators.emplace_back();
    actuator.effect = read_key(table, effect_key);
    actuator.weight = read_key(table, weight_key);
    if (!table.has(bounds_key.name)) continue;
    std::tie(actuator.lower, actuator.upper) =
        read_range(table, bounds_key.name, any_number, {actuator.lower, actuator.upper});
    if (!(actuator.lower < actuator.upper))
      table.fail("bounds",
                 fmt::format("{} is not below {}; give the lower bound first", actuator.lower, actuator.upper));
  }
  const Section horizon = scene.section("horizon", "duration and stages");
  out.task.duration = read_key(horizon, duration_key);
  out.task.duration_is_free = read_key(horizon, free_key);
  out.task.duration_weight = read_key(horizon, time_weight);
  out.task.stages = read_key(horizon, stages_key);
  const Section solver = scene.section_or_empty("solver");
  out.method = read_method(solver);
  read_search(solver, out.search);
  out.bodies.assign(bodies.bodies.begin(), bodies.bodies.end());
  scene.finish();
  return out;
}

std::vector<Key> controlled_bodies_keys() {
  std::vector<Key> out = bodies_table().keys;
  Table limits;
  for (const LimitKind& each : limit_kinds()) {
    Table& kind = limits.kinds.emplace_back(Table{{kind_key({each})}, {}, each.about});
    kind.keys.insert(kind.keys.end(), each.keys.begin(), each.keys.end());
  }
  const Table end{{body_key, point_key, position_key, attitude_key, angle_key, velocity_key, turning_key, at_rest_key}};
  out.insert(
      out.end(),
      {KeyOf<Tables>{"actuator", {{{effect_key, bounds_key, weight_key}}}, "", "the controls"},
       KeyOf<Tables>{"end", {end}, "", "what is given of the end, body by body", {}, "all is free"},
       KeyOf<Tables>{"constraint", {limits}, "", "what bodies keep to at every node", {}, "none"},
       KeyOf<Table>{"horizon", {{duration_key, free_key, stages_key, time_weight}}, "", "how long, in how many arrows"},
       optional_table("solver", {search_keys()}, "of the search")});
  return out;
}

}  // namespace lagroid::app
