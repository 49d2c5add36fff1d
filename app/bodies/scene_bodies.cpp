#include "scene_bodies.hpp"

#include <lagroid/systems/multibody/joints.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lagroid::app {

using multibody::Mat;
using multibody::Quaternion;
using multibody::Vec;

KeyOf<NumberArray> vector_key(std::string name, std::string unit, std::string meaning, std::optional<Vec> fallback) {
  KeyOf<NumberArray> key{std::move(name), {3}, std::move(unit), std::move(meaning)};
  if (fallback) key.fallback = {fallback->data(), fallback->data() + 3};
  return key;
}

template <class S> S BasicSceneBodies<S>::varied_number(const std::string& key, double x) const {
  S out = x;
  if constexpr (std::is_same_v<S, VariedNumber>)
    for (const VariedAt& each : varied)
      if (each.path == reads + "." + key) {
        each.is_read = true;
        out += each.number - each.number.value;
      }
  return out;
}

template <class S>
std::vector<S> BasicSceneBodies<S>::numbers(const Section& table, const KeyOf<NumberArray>& key) const {
  std::vector<S> out;
  for (const double x : read_key(table, key))
    out.push_back(varied_number(fmt::format("{}.{}", key.name, out.size()), x));
  return out;
}

template <class S> Vector<S, 3> BasicSceneBodies<S>::vector(const Section& table, const KeyOf<NumberArray>& key) const {
  return varied_vector(key.name, read_key(table, key));
}
template <class S>
Vector<S, 3> BasicSceneBodies<S>::varied_vector(const std::string& key, const std::vector<double>& x) const {
  Vector<S, 3> out;
  for (int i = 0; i < 3; ++i) out(i) = varied_number(fmt::format("{}.{}", key, i), x[std::size_t(i)]);
  return out;
}

namespace {

const KeyOf<Text> name_key{"name", {}, "", "a name for the body, of letters, digits, - and _"};
const KeyOf<Number> mass{"mass", {positive}, "kg", "of the body"};
const KeyOf<NumberArray> moments{"inertia", {3, positive}, "kg m^2", "three principal moments"};
const KeyOf<AnyAttitude> attitude{
    "attitude", {}, "", "a unit quaternion w, x, y, z, or a rotation vector (rad)", {{1, 0, 0, 0}}};
const KeyOf<NumberArray> velocity = vector_key("velocity", "m/s", "of the centre of mass", Vec::Zero());
const KeyOf<NumberArray> angular_velocity = vector_key("angular_velocity", "rad/s", "in the body's frame", Vec::Zero());
const KeyOf<NumberArray> position = vector_key("position", "m", "x, y, z of the centre of mass");

const KeyOf<Number> pivoted_mass{"mass", {nonnegative}, "kg", "of the body", 0.0};
const KeyOf<NumberArray> pivot = vector_key("pivot", "m", "x, y, z of the fixed point", Vec::Zero());
const KeyOf<NumberArray> pivoted_moments{"inertia", {3, positive}, "kg m^2", "three principal moments about the pivot"};
const KeyOf<NumberArray> to_centre =
    vector_key("centre", "m", "from the pivot to the centre of mass, in the body's frame", Vec::Zero());

const KeyOf<Number> planar_inertia{"inertia", {positive}, "kg m^2", "about the centre of mass"};
const KeyOf<NumberArray> planar_position{"position", {2}, "m", "x, y of the centre of mass"};
const KeyOf<Number> planar_angle{"angle", {}, "rad", "by which the body is turned", 0.0};
const KeyOf<NumberArray> planar_velocity{"velocity", {2}, "m/s", "of the centre of mass", {{0, 0}}};
const KeyOf<Number> planar_turning{"angular_velocity", {}, "rad/s", "of the body", 0.0};

const KeyOf<Whole> links{"links", {1, 100'000}, "", "how many"};
const KeyOf<Number> chain_mass{"mass", {positive}, "kg", "of the whole: each of n links has an n-th"};
const KeyOf<Number> chain_length{"length", {positive}, "m", "of the whole: each of n links has an n-th"};
const KeyOf<NumberArray> direction = vector_key("direction", "", "from link to link", Vec(0, 0, -1));
const KeyOf<NumberArray> chain_turning = vector_key("angular_velocity", "rad/s", "of the whole, in space", Vec::Zero());
const KeyOf<Text> hangs_on{"on", {}, "", "the body it hangs on, or \"ground\"", "ground"};
const KeyOf<NumberArray> hangs_at =
    vector_key("at", "m", "where: in the frame of the body it hangs on, of the ground in space", Vec::Zero());

const KeyOf<Texts> between{"between", {}, "", "two names of bodies, or \"ground\" for one of them"};
const KeyOf<SpacePoints> points{
    "points", {2}, "m", "a point of each, in its body's frame, of the ground in space", {}, "[[0, 0, 0], [0, 0, 0]]"};
const KeyOf<NumberArray> ground_amplitude{
    "ground_amplitude", {3}, "m", "the ground's point is at point + amplitude (1 - cos(rate t))", {},
    "the ground rests"};
const KeyOf<Number> ground_rate{"ground_rate", {}, "rad/s", "of that motion", {}, "the ground rests"};

const KeyOf<OneOf> rotation{"rotation", {{"exp", "cayley"}}, "", "how a turn becomes an angular velocity", "exp"};
const KeyOf<Flag> project_velocities{"project_velocities",
                                     {},
                                     "",
                                     "true: of velocities that the joints do not allow, take the part that they do; "
                                     "else they are refused",
                                     false};

template <class S>
Vector<S, 3> read_moments(const BasicSceneBodies<S>& bodies, const Section& table, const KeyOf<NumberArray>& key) {
  const Vector<S, 3> inertia = bodies.vector(table, key);
  for (int i = 0; i < 3; ++i) {
    const double others = value_of(inertia((i + 1) % 3)) + value_of(inertia((i + 2) % 3));
    if (value_of(inertia(i)) > others * (1 + 1e-12))
      table.fail("inertia", fmt::format("no body has these moments: {:.8g} is more than the sum of the others",
                                        value_of(inertia(i))));
  }
  return inertia;
}

Quaternion read_attitude(const Section& table) {
  const auto q = read_key(table, attitude);
  return {q[0], q[1], q[2], q[3]};
}

void require_name(const Section& table, const std::string& name) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), allowed))
    table.fail("name", fmt::format("\"{}\": use letters, digits, - and _", name));
}

template <class S> std::string read_name(const BasicSceneBodies<S>& bodies, const Section& table) {
  const std::string name = read_key(table, name_key);
  require_name(table, name);
  for (const char* taken : {"energy", "time", "t", "constraint_residual", "residual", "step_size", "h", "cost"})
    if (name == taken) table.fail("name", fmt::format("\"{}\" is a column of every run; choose another name", name));
  if (name == "ground") table.fail("name", "\"ground\" is what joints tie bodies to; choose another name");
  const auto taken = [&](const BasicNamedBody<S>& body) {
    return body.name == name || body.name.starts_with(name + ".");
  };
  if (std::any_of(bodies.bodies.begin(), bodies.bodies.end(), taken))
    table.fail("name", fmt::format("there is a body \"{}\" already; choose another name", name));
  return name;
}

template <class S> void keep(BasicSceneBodies<S>& bodies, BasicNamedBody<S> body) {
  body.linear = bodies.scene.linear_of(body.body);
  bodies.bodies.push_back(std::move(body));
}

constexpr auto read_point = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  BasicNamedBody<S> b;
  b.name = read_name(bodies, table);
  b.mass = bodies.number(table, mass);
  b.place = bodies.vector(table, position);
  b.body = bodies.scene.point_mass(b.mass, b.place, bodies.vector(table, velocity));
  b.mass_centre = b.body.centre;
  keep(bodies, b);
};

constexpr auto read_rigid = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  BasicNamedBody<S> b;
  b.name = read_name(bodies, table);
  b.mass = bodies.number(table, mass);
  b.inertia = read_moments(bodies, table, moments);
  b.place = bodies.vector(table, position);
  const Quaternion q = read_attitude(table);
  b.attitude = SO3::from_quaternion(q).template cast<S>();
  const Vector<S, 3> w = bodies.vector(table, angular_velocity);
  b.velocity = bodies.vector(table, velocity);
  b.angular_velocity = b.attitude * w;
  b.body = bodies.scene.rigid_body(b.mass, b.inertia, b.place, q.template cast<S>(), b.velocity, w);
  b.mass_centre = b.body.centre;
  keep(bodies, b);
};

constexpr auto read_pivoted = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  BasicNamedBody<S> b;
  b.name = read_name(bodies, table);
  b.mass = bodies.number(table, pivoted_mass);
  b.inertia = read_moments(bodies, table, pivoted_moments);
  b.place = bodies.vector(table, pivot);
  b.to_centre = bodies.vector(table, to_centre);
  for (int i = 0; i < 3; ++i) {
    const Vector<S, 3>& c = b.to_centre;
    const double least = value_of(b.mass * (c.squaredNorm() - c(i) * c(i)));
    if (value_of(b.inertia(i)) < least * (1 - 1e-9))
      table.fail("inertia",
                 fmt::format("about the pivot, it is at least the mass times the square of the distance of the "
                             "centre from the axis: moment {} is {:.6g}, and must be {:.6g} or more",
                             i + 1, value_of(b.inertia(i)), least));
  }
  const Quaternion q = read_attitude(table);
  b.attitude = SO3::from_quaternion(q).template cast<S>();
  const Vector<S, 3> w = bodies.vector(table, angular_velocity);
  b.angular_velocity = b.attitude * w;
  b.body = bodies.scene.pivoted_body(b.inertia, b.place, q.template cast<S>(), w);
  b.mass_centre = bodies.scene.point_of(b.body, b.to_centre);
  bodies.isolated = false;
  keep(bodies, b);
};

constexpr auto read_planar = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  BasicNamedBody<S> b;
  b.name = read_name(bodies, table);
  b.planar = true;
  b.mass = bodies.number(table, mass);
  const S inertia = bodies.number(table, planar_inertia);
  b.inertia = {S(0), S(0), inertia};
  const std::vector<S> at = bodies.numbers(table, planar_position);
  b.angle = bodies.number(table, planar_angle);
  const std::vector<S> v = bodies.numbers(table, planar_velocity);
  b.place = {at[0], at[1], S(0)};
  b.attitude = SO3::exp(Vector<S, 3>(S(0), S(0), b.angle));
  b.velocity = {v[0], v[1], S(0)};
  b.angular_velocity = {S(0), S(0), bodies.number(table, planar_turning)};
  b.body = bodies.scene.planar_body(b.mass, inertia, {at[0], at[1], b.angle}, {v[0], v[1], b.angular_velocity(2)});
  b.mass_centre = b.body.centre;
  keep(bodies, b);
};

/// Links of equal length, each a point mass on a massless rod, in a straight line at first.
constexpr auto read_chain = []<class S>(BasicSceneBodies<S>& bodies, const Section& table) {
  const std::string name = read_name(bodies, table);
  const long count = read_key(table, links);
  const S each_mass = bodies.number(table, chain_mass) / double(count);
  const S each_length = bodies.number(table, chain_length) / double(count);
  const Vector<S, 3> along = bodies.vector(table, direction);
  if (!(along.norm() > 0)) table.fail(direction.name, "must not vanish");
  const Vector<S, 3> turning = bodies.vector(table, chain_turning);
  const std::string on = read_key(table, hangs_on);
  const Vector<S, 3> arm = bodies.vector(table, hangs_at);
  const BasicNamedBody<S>* holder = on == "ground" ? nullptr : &bodies.named(table, "on", on);
  BasicAttachment<S> last = holder ? bodies.end_of(table, "at", holder, arm) : bodies.ground_of(table, arm);
  if (!holder) bodies.isolated = false;
  const Vector<S, 3> origin = last.place;
  for (long k = 1; k <= count; ++k) {
    BasicNamedBody<S> b;
    b.name = fmt::format("{}.{}", name, k);
    b.mass = each_mass;
    b.place = origin + (double(k) * each_length) * unit_of(along);
    b.body = bodies.scene.point_mass(each_mass, b.place, turning.cross(Vector<S, 3>(b.place - origin)));
    b.mass_centre = b.body.centre;
    keep(bodies, b);
    const BasicAttachment<S> here = bodies.end_of(table, "name", &bodies.bodies.back(), Vector<S, 3>::Zero());
    bodies.scene.add(multibody::BasicRod<S>{{last.site, here.site}, each_length});
    bodies.lines.push_back({last, here, 0.008});
    last = here;
  }
};

}  // namespace

template <class S>
const BasicNamedBody<S>& BasicSceneBodies<S>::named(const Section& table, std::string_view key,
                                                    const std::string& name) const {
  for (const auto& body : bodies)
    if (body.name == name) return body;
  std::vector<std::string> names;
  for (const auto& body : bodies)
    if (names.size() < 12) names.push_back(body.name);
  if (names.empty()) table.fail(key, fmt::format("there is no body \"{}\" above this one", name));
  table.fail(key, fmt::format("there is no body \"{}\"; there are {}{}", name, fmt::join(names, ", "),
                              bodies.size() > names.size() ? ", ..." : ""));
}

template <class S> std::vector<const BasicNamedBody<S>*> BasicSceneBodies<S>::chosen(const Section& table) const {
  const std::string& key = chosen_bodies.name;
  std::vector<const BasicNamedBody<S>*> out;
  if (!table.has(key)) {
    for (const auto& body : bodies) out.push_back(&body);
    return out;
  }
  for (const std::string& name : read_key(table, chosen_bodies)) {
    const std::size_t before = out.size();
    for (const auto& body : bodies)
      if (body.name == name || body.name.starts_with(name + ".")) {
        if (std::find(out.begin(), out.end(), &body) != out.end())
          table.fail(key, fmt::format("\"{}\" is named twice", body.name));
        out.push_back(&body);
      }
    if (out.size() == before) named(table, key, name);  // says that there is none
  }
  if (out.empty()) table.fail(key, "names no body; leave it out for all of them");
  return out;
}

template <class S>
BasicAttachment<S> BasicSceneBodies<S>::end_of(const Section& table, std::string_view key,
                                               const BasicNamedBody<S>* body, const Vector<S, 3>& arm) {
  if (body && body->body.attitude.index < 0 && !body->planar && !multibody::stays_zero(arm))
    table.fail(key, fmt::format("\"{}\" is a point mass and has no other points: give [0, 0, 0]", body->name));
  if (body && body->planar && arm(2) != S(0))
    table.fail(key, fmt::format("\"{}\" moves in the plane: give it a third coordinate of 0", body->name));
  BasicAttachment<S> end;
  end.body = body;
  end.arm = arm;
  end.place = body ? Vector<S, 3>(body->place + body->attitude * arm) : arm;
  end.site = body ? scene.point_of(body->body, arm) : scene.ground(arm);
  return end;
}

template <class S> BasicAttachment<S> BasicSceneBodies<S>::ground_of(const Section& table, const Vector<S, 3>& place) {
  BasicAttachment<S> end = end_of(table, "", nullptr, place);
  if (!table.has(ground_amplitude.name) && !table.has(ground_rate.name)) return end;
  const Vector<S, 3> amplitude = vector(table, ground_amplitude);
  const S rate = number(table, ground_rate);
  if (amplitude.isZero(0) || rate == S(0))
    table.fail("ground_amplitude", "a ground that moves has an amplitude and a rate; leave both out for one at rest");
  end.site = scene.moving_ground(place, amplitude, rate);
  end.moved = true;
  timed = true;
  return end;
}

template <class S> std::array<BasicAttachment<S>, 2> BasicSceneBodies<S>::ends(const Section& table, bool with_points) {
  const auto names = read_key(table, between);
  if (names.size() != 2)
    table.fail(table.has("between") ? "between" : "",
               "give in between the two names of the bodies that it ties, or \"ground\" for one of them");
  if (names[0] == names[1]) table.fail("between", fmt::format("\"{}\" is tied to itself", names[0]));
  std::vector<std::vector<double>> arms(2, {0, 0, 0});
  if (with_points && table.has(points.name)) arms = table.points(points.name, *points.value.count, 3, points.meaning);
  std::array<BasicAttachment<S>, 2> out;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector<S, 3> arm = varied_vector(fmt::format("{}.{}", points.name, i), arms[i]);
    if (names[i] != "ground") {
      out[i] = end_of(table, "points", &named(table, "between", names[i]), arm);
    } else {
      out[i] = with_points ? ground_of(table, arm) : end_of(table, "points", nullptr, arm);
      isolated = false;
      const std::string& other = names[1 - i];
      if (out[i].moved && other != "ground" && named(table, "between", other).planar &&
          vector(table, ground_amplitude)(2) != S(0))
        table.fail("ground_amplitude", fmt::format("\"{}\" moves in the plane: give a third part of 0", other));
    }
  }
  return out;
}

std::vector<Key> ground_keys() { return {ground_amplitude, ground_rate}; }
std::vector<Key> end_keys() { return {between, points, ground_amplitude, ground_rate}; }

namespace {

const KeyOf<Text> switch_name{"name", {}, "", "by which events switch it", {}, "it is never switched"};
const KeyOf<Flag> switch_on{"on", {}, "", "false: it does not act until an event switches it on", true};

template <class S> void begin_switch(BasicSceneBodies<S>& bodies, const Section& table) {
  const bool on = read_key(table, switch_on);
  if (!table.has(switch_name.name)) {
    if (!on) table.fail(switch_on.name, "what does not act at the start needs a name by which an event switches it on");
    return;
  }
  const std::string name = read_key(table, switch_name);
  require_name(table, name);
  const std::vector<std::string>& taken = bodies.scene.switches().names;
  if (std::find(taken.begin(), taken.end(), name) != taken.end())
    table.fail(switch_name.name, fmt::format("there is a \"{}\" already; choose another name", name));
  bodies.scene.begin_switch(name, on);
  bodies.is_off = !on;
}

KeyOf<OneOf> kind_key(const std::vector<SceneKind>& kinds) {
  KeyOf<OneOf> key{"kind"};
  for (const SceneKind& kind : kinds) key.value.words.emplace_back(kind.name);
  return key;
}

}  // namespace

template <class S>
void read_kind(const std::vector<SceneKind>& kinds, BasicSceneBodies<S>& bodies, const Section& table) {
  const std::string name = read_key(table, kind_key(kinds));
  for (const SceneKind& kind : kinds) {
    if (kind.name != name) continue;
    if (kind.has_switch) begin_switch(bodies, table);
    const std::size_t before = bodies.lines.size();
    kind.read(bodies, table);
    if (kind.has_switch && table.has(switch_name.name))
      for (std::size_t k = before; k < bodies.lines.size(); ++k)
        bodies.lines[k].switched_by = int(bodies.scene.switches().names.size()) - 1;
    bodies.scene.end_switch();
    bodies.is_off = false;
  }
}

Table table_of(const std::vector<SceneKind>& kinds) {
  Table out;
  for (const SceneKind& kind : kinds) {
    Table& each = out.kinds.emplace_back(Table{{kind_key({kind})}, {}, kind.about});
    each.keys.insert(each.keys.end(), kind.keys.begin(), kind.keys.end());
    if (kind.has_switch) each.keys.insert(each.keys.end(), {switch_name, switch_on});
  }
  return out;
}

const std::vector<SceneKind>& body_kinds() {
  static const std::vector<SceneKind> all{
      {"point", "a point mass", read_point, {name_key, mass, position, velocity}, false},
      {"rigid",
       "moves and turns in space",
       read_rigid,
       {name_key, mass, moments, position, attitude, velocity, angular_velocity},
       false},
      {"pivoted",
       "turns about a fixed point",
       read_pivoted,
       {name_key, pivoted_moments, pivot, pivoted_mass, to_centre, attitude, angular_velocity},
       false},
      {"planar",
       "moves in the plane of x and y",
       read_planar,
       {name_key, mass, planar_inertia, planar_position, planar_angle, planar_velocity, planar_turning},
       false},
      {"chain",
       "point masses on massless rods, NAME.1, NAME.2, ...",
       read_chain,
       {name_key, links, chain_mass, chain_length, direction, chain_turning, hangs_on, hangs_at, ground_amplitude,
        ground_rate},
       false}};
  return all;
}

Table bodies_table() {
  return {
      {rotation, project_velocities, KeyOf<Tables>{"body", {table_of(body_kinds())}, "", "what moves"},
       KeyOf<Tables>{"joint", {table_of(joint_kinds())}, "", "what ties bodies, or holds their velocities", {}, "none"},
       KeyOf<Tables>{"effect", {table_of(effect_kinds())}, "", "what acts on bodies", {}, "none"}}};
}

namespace {

template <class S> void read_all(const Section& scene, BasicSceneBodies<S>& out) {
  out.scene.rotation = read_key(scene, rotation) == *rotation.fallback ? Retraction::exponential : Retraction::cayley;
  out.projects = read_key(scene, project_velocities);
  const auto read_tables = [&](const std::string& name, const std::vector<SceneKind>& kinds) {
    int number = 0;
    for (const Section& table : scene.tables(name)) {
      out.reads = fmt::format("{}.{}", name, number++);
      read_kind(kinds, out, table);
    }
  };
  read_tables("body", body_kinds());
  read_tables("joint", joint_kinds());
  read_tables("effect", effect_kinds());
  // The plane of planar bodies holds what is tied to bodies in space.
  const auto planar = [](const BasicNamedBody<S>& body) { return body.planar; };
  if (std::any_of(out.bodies.begin(), out.bodies.end(), planar) &&
      !std::all_of(out.bodies.begin(), out.bodies.end(), planar))
    out.isolated = false;
  Vec least = Vec::Zero();
  Vec most = Vec::Zero();
  const auto cover = [&](const Vec& x) {
    least = least.cwiseMin(x);
    most = most.cwiseMax(x);
  };
  for (const auto& body : out.bodies) cover(multibody::values_of(body.place));
  for (const auto& line : out.lines) {
    cover(multibody::values_of(line.from.place));
    cover(multibody::values_of(line.to.place));
  }
  out.extent = (most - least).norm();
}

}  // namespace

SceneBodies read_scene_bodies(const Section& scene, bool on_its_way) {
  SceneBodies out;
  out.is_on_its_way = on_its_way;
  read_all(scene, out);
  return out;
}

BasicSceneBodies<VariedNumber> read_varied_scene(const Section& scene, const std::vector<VariedAt>& varied) {
  BasicSceneBodies<VariedNumber> out;
  out.varied = varied;
  read_all(scene, out);
  for (const VariedAt& each : out.varied)
    if (!each.is_read) throw std::invalid_argument(fmt::format("there is no derivative by {}", each.path));
  return out;
}

BasicSceneBodies<multibody::SecondNumber> read_second_scene(const Section& scene) {
  BasicSceneBodies<multibody::SecondNumber> out;
  read_all(scene, out);
  return out;
}

template struct BasicSceneBodies<double>;
template struct BasicSceneBodies<VariedNumber>;
template struct BasicSceneBodies<multibody::SecondNumber>;
template void read_kind(const std::vector<SceneKind>&, SceneBodies&, const Section&);

}  // namespace lagroid::app
