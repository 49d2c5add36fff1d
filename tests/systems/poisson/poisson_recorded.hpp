#pragma once
/// The recorded motions of tests/data/poisson.json, each with what makes integrators of its system.

#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/systems/poisson/fields.hpp>
#include <lagroid/systems/poisson/lattices.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/rotations.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lagroid {

using Numbers = std::vector<double>;

/// A recorded motion, and what makes integrators of its system.
struct Recorded {
  std::string id;
  double duration = 0;
  Numbers start, end, casimirs;
  double energy = 0;
  double amplification = 1;
  std::vector<std::string_view> methods;
  std::function<std::unique_ptr<PoissonIntegrator>(const PoissonOptions&)> begin;
  std::function<double(const Numbers&)> hamiltonian;
  std::function<Numbers(const Numbers&)> casimirs_at;
};

inline Numbers numbers(const nlohmann::json& list) {
  Numbers out;
  for (const auto& each : list) out.push_back(std::stod(each.get<std::string>()));
  return out;
}

/// What is recorded of it.
inline Recorded record_of(const nlohmann::json& cases, const char* id) {
  for (const auto& c : cases) {
    if (c["id"] != id) continue;
    const auto& results = c["results"];
    const auto number = [&](const char* key) { return std::stod(results[key].get<std::string>()); };
    Recorded out;
    out.id = id;
    out.start = numbers(c["initial"]);
    out.duration = number("T");
    out.end = numbers(results["state_at_T"]);
    out.energy = number("H");
    out.casimirs = numbers(results["casimir_values"]);
    out.amplification = number("amplification");
    return out;
  }
  throw std::invalid_argument(id);
}

template <class Sys>
void put(std::vector<Recorded>& all, const nlohmann::json& cases, const char* id, const Sys& system = {}) {
  using X = Vector<double, Sys::dimension>;
  Recorded out = record_of(cases, id);
  out.methods = poisson_methods_of<Sys>();
  const auto at = [](const Numbers& x) { return X(Eigen::Map<const X>(x.data())); };
  out.begin = [=, start = out.start](const PoissonOptions& options) {
    return make_poisson_integrator(system, at(start), options);
  };
  out.hamiltonian = [=](const Numbers& x) { return system.hamiltonian(at(x)); };
  out.casimirs_at = [=](const Numbers& x) {
    Numbers values;
    if constexpr (casimir_count<Sys>() > 0) {
      const auto c_at = system.casimirs(at(x));
      values.assign(c_at.data(), c_at.data() + c_at.size());
    }
    return values;
  };
  all.push_back(std::move(out));
}

inline const std::vector<Recorded>& recorded() {
  static const std::vector<Recorded> all = [] {
    const auto cases = nlohmann::json::parse(std::ifstream(std::string(LAGROID_TEST_DATA) + "/poisson.json"))["cases"];
    std::vector<Recorded> out;
    put<LotkaVolterra>(out, cases, "B-lotka-volterra-2d");
    put<ThreeSpecies>(out, cases, "B-lotka-volterra-3d");
    put<VolterraRing<5>>(out, cases, "B-volterra-5");
    put<EulerTop>(out, cases, "B-euler-top");
    put<EulerTop>(out, cases, "B-euler-top-near-separatrix");
    put<OpenToda<4>>(out, cases, "B-toda-open-4");
    put<PeriodicToda<3>>(out, cases, "B-toda-periodic-3");
    put<Kirchhoff>(out, cases, "B-kirchhoff");
    Kirchhoff on_sphere;
    on_sphere.kappa = 1;
    on_sphere.a = {1, 0.5, 0.8};
    on_sphere.b = {0, 0, 0};
    on_sphere.c = {0.3, 0.9, 0.6};
    put(out, cases, "B-so4", on_sphere);
    put<MaxwellBloch>(out, cases, "B-maxwell-bloch");
    put<Sklyanin>(out, cases, "B-sklyanin");
    put<MagneticParticle>(out, cases, "B-magnetic");
    return out;
  }();
  return all;
}

inline Numbers end_of(const Recorded& c, const PoissonOptions& asked, long steps) {
  PoissonOptions options = asked;
  options.step = c.duration / double(steps);
  const auto motion = c.begin(options);
  for (long k = 0; k < steps; ++k)
    if (const StepReport report = motion->advance(); !report.converged())
      throw std::runtime_error(c.id + ": " + std::string(to_string(report.status)));
  return motion->point();
}
inline double distance(const Numbers& a, const Numbers& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// How far energy and Casimirs go over so many steps: over the first tenth, and over the last.
struct Drift {
  double energy_first = 0, energy_last = 0, casimirs = 0;
};
inline Drift drift(const Recorded& c, const PoissonOptions& options, long steps) {
  const auto motion = c.begin(options);
  Drift out;
  for (long k = 0; k < steps; ++k) {
    if (!motion->advance().converged()) throw std::runtime_error(c.id);
    const double energy = std::abs(c.hamiltonian(motion->point()) - c.energy);
    if (k < steps / 10) out.energy_first = std::max(out.energy_first, energy);
    if (k >= steps - steps / 10) out.energy_last = std::max(out.energy_last, energy);
    out.casimirs = std::max(out.casimirs, distance(c.casimirs_at(motion->point()), c.casimirs));
  }
  return out;
}

}  // namespace lagroid
