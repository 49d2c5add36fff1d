#include "../reading/kinds.hpp"
#include "poisson_entry.hpp"

#include <lagroid/solvers/poisson/poisson_methods.hpp>
#include <lagroid/systems/poisson/fields.hpp>
#include <lagroid/systems/poisson/lattices.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/rotations.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <utility>

namespace lagroid::app {

namespace {

template <class Sys> class Known final : public AnyPoissonSystem {
 public:
  static constexpr int n = Sys::dimension;
  using X = Vector<double, n>;
  using J = Jet<double, n>;

  explicit Known(Sys system) : system_(std::move(system)) {}

  std::unique_ptr<PoissonIntegrator> begin(const std::vector<double>& start,
                                           const PoissonOptions& options) const override {
    return make_poisson_integrator(system_, point(start), options);
  }
  std::vector<MeasuredFunction> measure(const std::vector<double>& x) const override {
    Vector<J, n> at;
    for (int i = 0; i < n; ++i) at(i) = J::variable(x[std::size_t(i)], i);
    std::vector<MeasuredFunction> out{measured(system_.hamiltonian(at), x)};
    if constexpr (casimir_count<Sys>() > 0) {
      const auto casimirs = system_.casimirs(at);
      for (int c = 0; c < casimirs.size(); ++c) out.push_back(measured(casimirs(c), x));
    }
    return out;
  }
  BracketDefect bracket_defect(const std::vector<double>& x) const override {
    return worst_bracket_defect(system_, point(x));
  }
  std::string refusal(const std::vector<double>& x) const override {
    const X at = point(x);
    if (!system_.contains(at)) return "is outside of where bracket and energy are smooth";
    const BracketDefect worst = worst_bracket_defect(system_, at);
    if (!(worst.relative <= 1e-10)) return worst.sentence();
    const MeasuredFunction energy = measure(x).front();
    return std::isfinite(energy.value) ? "" : "has an energy that is no finite number";
  }

 private:
  static X point(const std::vector<double>& x) { return Eigen::Map<const X>(x.data()); }
  static MeasuredFunction measured(const J& f, const std::vector<double>& x) {
    double size = std::abs(f.value);
    for (int i = 0; i < n; ++i) size += std::abs(x[std::size_t(i)] * f.gradient(i));
    return {f.value, size};
  }

  Sys system_;
};

template <class Sys>
PoissonEntry entry(std::string_view name, std::string_view summary, std::string_view bracket,
                   std::vector<std::string> casimirs) {
  PoissonEntry out{name, summary, bracket, std::move(casimirs), {}, {}, parameter_keys<Sys>(), {}, nullptr};
  for (const auto& label : Sys::labels()) out.labels.emplace_back(label);
  if constexpr (noise_count<Sys>() > 0) out.noises.assign(Sys::noise_names.begin(), Sys::noise_names.end());
  for (const std::string_view method : poisson_methods_of<Sys>()) out.methods.push_back(poisson_methods::named(method));
  out.read = [](const Section& scene) -> std::unique_ptr<AnyPoissonSystem> {
    // A table of no keys is none that a scene may have.
    return std::make_unique<Known<Sys>>(parameter_keys<Sys>().empty() ? Sys{} : read_parameters<Sys>(scene));
  };
  return out;
}

}  // namespace

const std::vector<PoissonEntry>& poisson_entries() {
  static const std::vector<PoissonEntry> all{
      entry<LotkaVolterra>(keys::lotka_volterra, "predator and prey", "{x, y} = x y", {}),
      entry<ThreeSpecies>(keys::three_species, "three species that feed on each other",
                          "{x_i, x_j} = c_ij x_i x_j on R^3", {"a b ln x1 - b ln x2 + ln x3"}),
      entry<VolterraRing<5>>(keys::volterra_ring, "five species on a ring, each feeding on the next",
                             "{x_i, x_i+1} = x_i x_i+1", {"sum of ln x_i"}),
      entry<EulerTop>(keys::euler_top, "free rigid body by its momentum in the body", "so(3)*", {"|M|^2 / 2"}),
      entry<Kirchhoff>(keys::kirchhoff, "rigid body in a fluid; on a sphere or in hyperbolic space",
                       "se(3)*, so(4)* or so(3, 1)*", {"|p|^2 + kappa |M|^2", "M.p"}),
      entry<OpenToda<4>>(keys::toda, "Toda lattice of four particles in Flaschka's variables",
                         "{a_i, b_i} = -a_i, {a_i, b_i+1} = a_i", {"total momentum"}),
      entry<PeriodicToda<3>>(keys::toda_ring, "Toda lattice of three particles on a ring",
                             "{a_i, b_i} = -a_i, {a_i, b_i+1} = a_i", {"total momentum", "product of all a_i"}),
      entry<MaxwellBloch>(keys::maxwell_bloch, "a laser: the real Maxwell-Bloch equations", "{x, y} = -z, {x, z} = y",
                          {"(y^2 + z^2) / 2"}),
      entry<Sklyanin>(keys::sklyanin, "spins by Sklyanin's quadratic bracket", "{f, g} = det(df, dg, dC1, dC2) on R^4",
                      {"first quadric", "second quadric"}),
      entry<MagneticParticle>(keys::magnetic_particle, "charge in a magnetic field that varies, in a trap",
                              "{x_i, v_j} = delta_ij, {v_i, v_j} = eps_ijk B_k(x)", {})};
  return all;
}

const PoissonEntry* poisson_entry_of(const Section& scene) {
  if (scene.has("body") || !scene.has("system")) return nullptr;
  const std::string name = scene.text("system", "the name of a system, as lagroid list tells them");
  for (const PoissonEntry& each : poisson_entries())
    if (each.name == name) return &each;
  return nullptr;
}

}  // namespace lagroid::app
