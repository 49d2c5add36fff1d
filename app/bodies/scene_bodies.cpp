#include "scene_bodies.hpp"

#include "../reading/parameter.hpp"

#include <lagroid/systems/multibody/joints.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace lagroid::app {

using multibody::Mat;
using multibody::Quaternion;
using multibody::Vec;

Vec vector_of(const Section& table, std::string_view key, std::string_view meaning) {
  const auto v = table.numbers(key, 3, meaning);
  return {v[0], v[1], v[2]};
}

Vec vector_or(const Section& table, std::string_view key, std::string_view meaning, const Vec& fallback) {
  return table.has(key) ? vector_of(table, key, meaning) : fallback;
}

namespace {

Vec read_moments(const Section& table) {
  Vec inertia;
  reading::read_vector(table, "inertia", "principal moments", positive, true, false, inertia.data(), 3);
  for (int i = 0; i < 3; ++i) {
    const double others = inertia((i + 1) % 3) + inertia((i + 2) % 3);
    if (inertia(i) > others * (1 + 1e-12))
      table.fail("inertia",
                 fmt::format("no body has these moments: {:.8g} is more than the sum of the others", inertia(i)));
  }
  return inertia;
}

Quaternion read_attitude(const Section& table) {
  if (!table.has("attitude")) return {1, 0, 0, 0};
  const auto q = table.attitude("attitude");
  return {q[0], q[1], q[2], q[3]};
}

std::string read_name(const SceneBodies& bodies, const Section& table) {
  const std::string name = table.text("name", "a name for the body");
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), allowed))
    table.fail("name", fmt::format("\"{}\": use letters, digits, - and _", name));
  for (const char* taken : {"energy", "time", "t", "constraint_residual", "residual", "step_size", "h", "cost"})
    if (name == taken) table.fail("name", fmt::format("\"{}\" is a column of every run; choose another name", name));
  if (name == "ground") table.fail("name", "\"ground\" is what joints tie bodies to; choose another name");
  const auto taken = [&](const NamedBody& body) { return body.name == name || body.name.starts_with(name + "."); };
  if (std::any_of(bodies.bodies.begin(), bodies.bodies.end(), taken))
    table.fail("name", fmt::format("there is a body \"{}\" already; choose another name", name));
  return name;
}

void keep(SceneBodies& bodies, NamedBody body) {
  body.linear = bodies.scene.linear_of(body.body);
  bodies.bodies.push_back(std::move(body));
}

void read_point(SceneBodies& bodies, const Section& table) {
  NamedBody b;
  b.name = read_name(bodies, table);
  b.mass = table.number("mass", positive);
  b.place = vector_of(table, "position", "x, y, z in m");
  b.body = bodies.scene.point_mass(b.mass, b.place, vector_or(table, "velocity", "m/s"));
  b.mass_centre = b.body.centre;
  keep(bodies, b);
}

void read_rigid(SceneBodies& bodies, const Section& table) {
  NamedBody b;
  b.name = read_name(bodies, table);
  b.mass = table.number("mass", positive);
  b.inertia = read_moments(table);
  b.place = vector_of(table, "position", "x, y, z of the centre of mass in m");
  const Quaternion q = read_attitude(table);
  b.attitude = SO3::from_quaternion(q);
  const Vec w = vector_or(table, "angular_velocity", "in the body's frame, rad/s");
  b.velocity = vector_or(table, "velocity", "m/s");
  b.angular_velocity = b.attitude * w;
  b.body = bodies.scene.rigid_body(b.mass, b.inertia, b.place, q, b.velocity, w);
  b.mass_centre = b.body.centre;
  keep(bodies, b);
}

void read_pivoted(SceneBodies& bodies, const Section& table) {
  NamedBody b;
  b.name = read_name(bodies, table);
  b.mass = table.number_or("mass", 0, nonnegative);
  b.inertia = read_moments(table);
  b.place = vector_or(table, "pivot", "x, y, z of the fixed point in m");
  b.to_centre = vector_or(table, "centre", "from the pivot to the centre of mass, in the body's frame, m");
  for (int i = 0; i < 3; ++i) {
    const Vec& c = b.to_centre;
    const double least = b.mass * (c.squaredNorm() - c(i) * c(i));
    if (b.inertia(i) < least * (1 - 1e-9))
      table.fail("inertia",
                 fmt::format("about the pivot, it is at least the mass times the square of the distance of the "
                             "centre from the axis: moment {} is {:.6g}, and must be {:.6g} or more",
                             i + 1, b.inertia(i), least));
  }
  const Quaternion q = read_attitude(table);
  b.attitude = SO3::from_quaternion(q);
  const Vec w = vector_or(table, "angular_velocity", "in the body's frame, rad/s");
  b.angular_velocity = b.attitude * w;
  b.body = bodies.scene.pivoted_body(b.inertia, b.place, q, w);
  b.mass_centre = bodies.scene.point_of(b.body, b.to_centre);
  bodies.isolated = false;
  keep(bodies, b);
}

void read_planar(SceneBodies& bodies, const Section& table) {
  NamedBody b;
  b.name = read_name(bodies, table);
  b.planar = true;
  b.mass = table.number("mass", positive);
  const double inertia = table.number("inertia", positive);
  b.inertia = {0, 0, inertia};
  const auto at = table.numbers("position", 2, "x, y of the centre of mass in m");
  const double angle = table.number_or("angle", 0);
  const auto v = table.has("velocity") ? table.numbers("velocity", 2, "m/s") : std::vector<double>{0, 0};
  b.place = {at[0], at[1], 0};
  b.attitude = SO3::exp(Vec(0, 0, angle));
  b.angle = angle;
  b.velocity = {v[0], v[1], 0};
  b.angular_velocity = {0, 0, table.number_or("angular_velocity", 0)};
  b.body = bodies.scene.planar_body(b.mass, inertia, {at[0], at[1], angle}, {v[0], v[1], b.angular_velocity(2)});
  b.mass_centre = b.body.centre;
  keep(bodies, b);
}

/// Links of equal length, each a point mass on a massless rod, in a straight line at first.
void read_chain(SceneBodies& bodies, const Section& table) {
  const std::string name = read_name(bodies, table);
  const long links = table.integer("links", 1, 100'000);
  const double mass = table.number("mass", positive) / double(links);
  const double length = table.number("length", positive) / double(links);
  const Vec direction = vector_or(table, "direction", "from link to link", {0, 0, -1});
  if (!(direction.norm() > 0)) table.fail("direction", "must not vanish");
  const Vec turning = vector_or(table, "angular_velocity", "of the whole, in space, rad/s");
  const std::string on = table.has("on") ? table.text("on", "the body it hangs on, or \"ground\"") : "ground";
  const Vec arm = vector_or(table, "at", "where: in the frame of the body it hangs on, of the ground in space");
  const NamedBody* holder = on == "ground" ? nullptr : &bodies.named(table, "on", on);
  End last = holder ? bodies.end_of(table, "at", holder, arm) : bodies.ground_of(table, arm);
  if (!holder) bodies.isolated = false;
  const Vec origin = last.place;
  for (long k = 1; k <= links; ++k) {
    NamedBody b;
    b.name = fmt::format("{}.{}", name, k);
    b.mass = mass;
    b.place = origin + (double(k) * length) * direction.stableNormalized();
    b.body = bodies.scene.point_mass(mass, b.place, turning.cross(Vec(b.place - origin)));
    b.mass_centre = b.body.centre;
    keep(bodies, b);
    const End here = bodies.end_of(table, "name", &bodies.bodies.back(), Vec::Zero());
    bodies.scene.add(multibody::Rod{{last.site, here.site}, length});
    bodies.lines.push_back({last, here, 0.008});
    last = here;
  }
}

}  // namespace

const NamedBody& SceneBodies::named(const Section& table, std::string_view key, const std::string& name) const {
  for (const auto& body : bodies)
    if (body.name == name) return body;
  std::vector<std::string> names;
  for (const auto& body : bodies)
    if (names.size() < 12) names.push_back(body.name);
  if (names.empty()) table.fail(key, fmt::format("there is no body \"{}\" above this one", name));
  table.fail(key, fmt::format("there is no body \"{}\"; there are {}{}", name, fmt::join(names, ", "),
                              bodies.size() > names.size() ? ", ..." : ""));
}

std::vector<const NamedBody*> SceneBodies::chosen(const Section& table, std::string_view key) const {
  std::vector<const NamedBody*> out;
  if (!table.has(key)) {
    for (const auto& body : bodies) out.push_back(&body);
    return out;
  }
  for (const std::string& name : table.texts_or_none(key, "names of bodies")) {
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

End SceneBodies::end_of(const Section& table, std::string_view key, const NamedBody* body, const Vec& arm) {
  if (body && body->body.attitude.index < 0 && !body->planar && !arm.isZero(0))
    table.fail(key, fmt::format("\"{}\" is a point mass and has no other points: give [0, 0, 0]", body->name));
  if (body && body->planar && arm(2) != 0)
    table.fail(key, fmt::format("\"{}\" moves in the plane: give it a third coordinate of 0", body->name));
  End end;
  end.body = body;
  end.arm = arm;
  end.place = body ? Vec(body->place + body->attitude * arm) : arm;
  end.site = body ? scene.point_of(body->body, arm) : scene.ground(arm);
  return end;
}

End SceneBodies::ground_of(const Section& table, const Vec& place) {
  End end = end_of(table, "", nullptr, place);
  if (!table.has("ground_amplitude") && !table.has("ground_rate")) return end;
  const Vec amplitude = vector_of(table, "ground_amplitude", "of the motion amplitude (1 - cos(rate t)), m");
  const double rate = table.number("ground_rate");
  if (amplitude.isZero(0) || rate == 0)
    table.fail("ground_amplitude", "a ground that moves has an amplitude and a rate; leave both out for one at rest");
  end.site = scene.moving_ground(place, amplitude, rate);
  end.moved = true;
  timed = true;
  return end;
}

std::array<End, 2> SceneBodies::ends(const Section& table, bool with_points) {
  const auto names = table.texts_or_none("between", "two names of bodies, or \"ground\"");
  if (names.size() != 2)
    table.fail(table.has("between") ? "between" : "",
               "give in between the two names of the bodies that it ties, or \"ground\" for one of them");
  if (names[0] == names[1]) table.fail("between", fmt::format("\"{}\" is tied to itself", names[0]));
  std::vector<std::vector<double>> points(2, {0, 0, 0});
  if (with_points && table.has("points"))
    points = table.points("points", 2, 3, "a point of each, in its body's frame, of the ground in space");
  std::array<End, 2> out;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec arm(points[i][0], points[i][1], points[i][2]);
    if (names[i] != "ground") {
      out[i] = end_of(table, "points", &named(table, "between", names[i]), arm);
    } else {
      out[i] = with_points ? ground_of(table, arm) : end_of(table, "points", nullptr, arm);
      isolated = false;
      const std::string& other = names[1 - i];
      if (out[i].moved && other != "ground" && named(table, "between", other).planar &&
          vector_of(table, "ground_amplitude", "")(2) != 0)
        table.fail("ground_amplitude", fmt::format("\"{}\" moves in the plane: give a third part of 0", other));
    }
  }
  return out;
}

void read_body(SceneBodies& bodies, const Section& table) {
  constexpr std::array<SceneKind, 5> kinds{{{"point", read_point},
                                            {"rigid", read_rigid},
                                            {"pivoted", read_pivoted},
                                            {"planar", read_planar},
                                            {"chain", read_chain}}};
  read_kind(kinds, bodies, table);
}

SceneBodies read_scene_bodies(const Section& scene) {
  SceneBodies out;
  out.scene.rotation =
      scene.choice_or("rotation", "exp", {"exp", "cayley"}) == "exp" ? Retraction::exponential : Retraction::cayley;
  out.projects = scene.flag_or("project_velocities", false);
  for (const auto& table : scene.tables("body")) read_body(out, table);
  for (const auto& table : scene.tables("joint")) read_joint(out, table);
  for (const auto& table : scene.tables("effect")) read_effect(out, table);
  // The plane of planar bodies holds what is tied to bodies in space.
  const auto planar = [](const NamedBody& body) { return body.planar; };
  if (std::any_of(out.bodies.begin(), out.bodies.end(), planar) &&
      !std::all_of(out.bodies.begin(), out.bodies.end(), planar))
    out.isolated = false;
  Vec least = Vec::Zero();
  Vec most = Vec::Zero();
  const auto cover = [&](const Vec& x) {
    least = least.cwiseMin(x);
    most = most.cwiseMax(x);
  };
  for (const auto& body : out.bodies) cover(body.place);
  for (const auto& line : out.lines) {
    cover(line.from.place);
    cover(line.to.place);
  }
  out.extent = (most - least).norm();
  return out;
}

}  // namespace lagroid::app
