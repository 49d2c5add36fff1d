#include "sphere_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lagroid::app {

namespace {

using Spheres = CotangentSpheres<Eigen::Dynamic>;
using Points = SphereIntegrator::Points;
using V = Vector<double, 3>;

constexpr double slack = 1e-6;  // of what is typed in with a few digits

/// A vector for each point, or one for all.
std::vector<V> read_vectors(const Section& scene, const Section& initial, const char* key, int count,
                            const char* meaning) {
  const auto of_all = scene.numbers_at(fmt::format("initial.{}", key));
  std::vector<std::vector<double>> lists;
  if (of_all.size() == 3) {
    lists.assign(std::size_t(count), initial.numbers(key, 3, meaning));
  } else {
    lists = initial.points(key, std::size_t(count), 3, meaning);
  }
  std::vector<V> out;
  for (const auto& x : lists) out.emplace_back(x[0], x[1], x[2]);
  return out;
}

/// A number for each point, or one for all.
std::vector<double> read_angles(const Section& initial, const char* key, int count, const char* meaning) {
  if (initial.is_number(key)) return std::vector<double>(std::size_t(count), initial.number(key));
  return initial.numbers(key, std::size_t(count), meaning);
}

std::vector<V> read_directions(const Section& scene, const Section& initial, int count) {
  std::vector<V> out;
  if (initial.has("theta")) {
    if (initial.has("directions")) initial.fail("directions", "stand there beside theta: leave one of them out");
    const auto theta = read_angles(initial, "theta", count, "angles of the rods from the upward vertical, rad");
    auto phi = std::vector<double>(std::size_t(count), 0.0);
    if (initial.has("phi")) phi = read_angles(initial, "phi", count, "azimuths of the rods, rad");
    for (std::size_t i = 0; i < theta.size(); ++i)
      out.emplace_back(std::sin(theta[i]) * std::cos(phi[i]), std::sin(theta[i]) * std::sin(phi[i]),
                       std::cos(theta[i]));
    return out;
  }
  if (initial.has("phi")) initial.fail("phi", "goes with theta");
  if (!initial.has("directions"))
    initial.fail("", "give directions, unit vectors along the rods, or theta and phi, their angles");
  out = read_vectors(scene, initial, "directions", count, "unit vectors along the rods, z up (or one for all)");
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

Points read_start(const Section& scene, const SphereSystem& system, SphereForm form) {
  const int count = system.count();
  const Section initial = scene.section("initial", "directions and angular velocities or momenta");
  const auto q = read_directions(scene, initial, count);
  const auto forms = system.forms();
  const bool has_velocities = std::find(forms.begin(), forms.end(), SphereForm::velocities) != forms.end();
  SphereForm given = form;
  std::vector<V> moving(std::size_t(count), V::Zero());
  const auto read = [&](const char* key, SphereForm as, const char* meaning) {
    given = as;
    moving = read_vectors(scene, initial, key, count, meaning);
    const bool projects = initial.flag_or("project_velocities", false);
    for (std::size_t i = 0; i < moving.size(); ++i) {
      const double along = q[i].dot(moving[i]);
      if (!projects && !(std::abs(along) <= slack * moving[i].norm()))
        initial.fail(key, fmt::format("that of link {} has a part {:.6g} along its rod, which moves nothing; leave it "
                                      "away, or say initial.project_velocities = true",
                                      i + 1, along));
      moving[i] -= along * q[i];
    }
  };
  const bool has_momenta = initial.has("momenta");
  if (has_velocities && initial.has("angular_velocities")) {
    if (has_momenta) initial.fail("momenta", "stand there beside angular_velocities: leave one of them out");
    read("angular_velocities", SphereForm::velocities,
         "angular velocities of the rods in space, rad/s (or one for all)");
  } else if (has_momenta) {
    read("momenta", SphereForm::momenta, "momenta conjugate to the directions, kg m^2/s (or one for all)");
  } else {
    initial.flag_or("project_velocities", false);
  }
  Points z(6, count);
  for (int i = 0; i < count; ++i) Spheres::set(z, i, q[std::size_t(i)], moving[std::size_t(i)]);
  z = system.in_form(z, given, form);
  const auto measured = system.measure(z, form);
  const auto finite = [](const Measured& m) { return std::isfinite(m.value) && std::isfinite(m.size); };
  if (!z.allFinite() || !std::all_of(measured.begin(), measured.end(), finite))
    scene.fail("", "energy or momentum at the start is no finite number: a mass, a length or a velocity is too large");
  return z;
}

}  // namespace lagroid::app
