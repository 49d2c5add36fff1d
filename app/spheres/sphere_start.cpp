#include "sphere_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::app {

namespace {

using AnySpheres = CotangentSpheres<Eigen::Dynamic>;
using Points = SphereIntegrator::Points;
using V = Vector<double, 3>;

constexpr double slack = 1e-6;  // of what is typed in with a few digits

/// A vector for each point, or one for all; and the same of numbers.
KeyOf<Either> vectors_key(std::string name, std::string unit, std::string meaning, std::string otherwise) {
  return {std::move(name),     {{{NumberArray{3}}, {SpacePoints{}}}}, std::move(unit), std::move(meaning), {},
          std::move(otherwise)};
}
KeyOf<Either> angles_key(std::string name, std::string meaning, std::string otherwise) {
  return {std::move(name), {{{Number{}}, {NumberList{}}}}, "rad", std::move(meaning), {}, std::move(otherwise)};
}

const KeyOf<Either> directions =
    vectors_key("directions", "", "unit vectors along the rods, z up (or one for all)", "`theta` and `phi`");
const KeyOf<Either> theta_key =
    angles_key("theta", "angles of the rods from the upward vertical (or one for all)", "`directions`");
const KeyOf<Either> phi_key = angles_key("phi", "azimuths of the rods (or one for all)", "0");
const KeyOf<Either> angular_velocities =
    vectors_key("angular_velocities", "rad/s",
                "angular velocities of the rods in space, at right angles to them (or one for all)", "0");
const KeyOf<Either> momenta = vectors_key(
    "momenta", "kg m^2/s", "momenta conjugate to the directions, at right angles to them (or one for all)", "0");
const KeyOf<Flag> project_velocities{"project_velocities",
                                     {},
                                     "",
                                     "true: take of angular velocities or momenta what is at right angles to the rods; "
                                     "else those that are not are refused",
                                     false};

bool has_velocities(const std::vector<SphereForm>& forms) {
  return std::find(forms.begin(), forms.end(), SphereForm::velocities) != forms.end();
}

std::vector<V> read_vectors(const Section& scene, const Section& initial, const KeyOf<Either>& key, int count) {
  const auto of_all = scene.numbers_at(fmt::format("initial.{}", key.name));
  std::vector<std::vector<double>> lists;
  if (of_all.size() == 3) {
    lists.assign(std::size_t(count), initial.numbers(key.name, 3, key.meaning));
  } else {
    lists = initial.points(key.name, std::size_t(count), 3, key.meaning);
  }
  std::vector<V> out;
  for (const auto& x : lists) out.emplace_back(x[0], x[1], x[2]);
  return out;
}

std::vector<double> read_angles(const Section& initial, const KeyOf<Either>& key, int count) {
  if (initial.is_number(key.name)) return std::vector<double>(std::size_t(count), initial.number(key.name));
  return initial.numbers(key.name, std::size_t(count), key.meaning);
}

std::vector<V> read_directions(const Section& scene, const Section& initial, int count) {
  std::vector<V> out;
  if (initial.has("theta")) {
    if (initial.has("directions")) initial.fail("directions", "stand there beside theta: leave one of them out");
    const auto theta = read_angles(initial, theta_key, count);
    auto phi = std::vector<double>(std::size_t(count), 0.0);
    if (initial.has("phi")) phi = read_angles(initial, phi_key, count);
    for (std::size_t i = 0; i < theta.size(); ++i)
      out.emplace_back(std::sin(theta[i]) * std::cos(phi[i]), std::sin(theta[i]) * std::sin(phi[i]),
                       std::cos(theta[i]));
    return out;
  }
  if (initial.has("phi")) initial.fail("phi", "goes with theta");
  if (!initial.has("directions"))
    initial.fail("", "give directions, unit vectors along the rods, or theta and phi, their angles");
  out = read_vectors(scene, initial, directions, count);
  for (std::size_t i = 0; i < out.size(); ++i) {
    V& q = out[i];
    const double norm = q.norm();
    if (!(norm > 0)) initial.fail("directions", fmt::format("that of link {} is zero; give a unit vector", i + 1));
    const V unit = q / norm;
    if (!(std::abs(norm - 1) <= slack))
      initial.fail("directions", fmt::format("that of link {} has length {:.8g}, not 1; write [{:.10g}, {:.10g}, "
                                             "{:.10g}]",
                                             i + 1, norm, unit(0), unit(1), unit(2)));
    q = unit;
  }
  return out;
}

}  // namespace

Table sphere_start_table(const std::vector<SphereForm>& forms) {
  Table table{{directions, theta_key, phi_key}};
  if (has_velocities(forms)) table.keys.push_back(angular_velocities);
  table.keys.insert(table.keys.end(), {momenta, project_velocities});
  return table;
}

GivenSphereStart read_given_start(const Section& scene, const SphereSystem& system, SphereForm form) {
  const int count = system.count();
  const Section initial = scene.section("initial", "directions and angular velocities or momenta");
  const auto q = read_directions(scene, initial, count);
  SphereForm given = form;
  std::vector<V> moving(std::size_t(count), V::Zero());
  const auto read = [&](const KeyOf<Either>& key, SphereForm as) {
    given = as;
    moving = read_vectors(scene, initial, key, count);
    const bool projects = read_key(initial, project_velocities);
    for (std::size_t i = 0; i < moving.size(); ++i) {
      const double along = q[i].dot(moving[i]);
      if (!projects && !(std::abs(along) <= slack * moving[i].norm()))
        initial.fail(key.name,
                     fmt::format("that of link {} has a part {:.6g} along its rod, which moves nothing; leave it "
                                 "away, or say initial.project_velocities = true",
                                 i + 1, along));
      moving[i] -= along * q[i];
    }
  };
  const bool has_momenta = initial.has("momenta");
  if (has_velocities(system.forms()) && initial.has("angular_velocities")) {
    if (has_momenta) initial.fail("momenta", "stand there beside angular_velocities: leave one of them out");
    read(angular_velocities, SphereForm::velocities);
  } else if (has_momenta) {
    read(momenta, SphereForm::momenta);
  } else {
    read_key(initial, project_velocities);
  }
  Points z(6, count);
  for (int i = 0; i < count; ++i) AnySpheres::set(z, i, q[std::size_t(i)], moving[std::size_t(i)]);
  return {std::move(z), given};
}

Points read_start(const Section& scene, const SphereSystem& system, SphereForm form) {
  const GivenSphereStart given = read_given_start(scene, system, form);
  Points z = system.in_form(given.z, given.form, form);
  const auto measured = system.measure(z, form);
  const auto finite = [](const Measured& m) { return std::isfinite(m.value) && std::isfinite(m.size); };
  if (!z.allFinite() || !std::all_of(measured.begin(), measured.end(), finite))
    scene.fail("", "energy or momentum at the start is no finite number: a mass, a length or a velocity is too large");
  return z;
}

}  // namespace lagroid::app
