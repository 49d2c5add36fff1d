#pragma once
/// A Poisson system as scenes name it, whatever its class.
///
///     const PoissonEntry entry = poisson_entry<EulerTop>("euler_top", "free rigid body", "so(3)*", {"|M|^2 / 2"});
///
/// Requires a system with a default constructor, and make_poisson_integrator of it: include
/// <lagroid/solvers/poisson/poisson_integrators.hpp> for one that is not compiled with the library. Reading a scene
/// throws SceneError.

#include "poisson_entry.hpp"

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/run/motion/parameter_values.hpp>
#include <lagroid/solvers/poisson/poisson_methods.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <cmath>
#include <type_traits>
#include <utility>

namespace lagroid::app {

template <class Sys> class PoissonSystemOf final : public AnyPoissonSystem {
 public:
  static constexpr int n = Sys::dimension;
  using X = Vector<double, n>;
  using J = Jet<double, n>;

  explicit PoissonSystemOf(Sys system) : system_(std::move(system)) {}

  std::unique_ptr<PoissonIntegrator> begin(const std::vector<double>& start,
                                           const PoissonOptions& options) const override {
    return make_poisson_integrator(system_, point(start), options);
  }
  std::vector<MeasuredFunction> measure(const std::vector<double>& x) const override {
    Vector<J, n> at;
    for (int i = 0; i < n; ++i) at(i) = J::variable(x[std::size_t(i)], i);
    std::vector<MeasuredFunction> out;
    for (const J& each : functions_at(at)) out.push_back(measured(each, x));
    return out;
  }
  NodeValues differentiate(const std::vector<double>& x, const std::vector<std::string>& parameters) const override {
    const auto functions = [&](const auto& at) { return functions_at(at); };
    const ParameterPlaces places = places_of_parameters(system_, parameters);
    return {functions_at(point(x)), varied_jacobian<rows>(functions, point(x), places.members)};
  }
  std::vector<NamedNumber> numbers() const override {
    std::vector<NamedNumber> all;
    for_each_parameter_number(system_, [&](const std::string& name, const double& number, const auto&) {
      all.push_back({name, number});
    });
    return all;
  }
  std::unique_ptr<AnyPoissonSystem> changed(const std::string& name, double by) const override {
    Sys other = system_;
    for_each_parameter_number(other, [&](const std::string& each, double& number, const auto&) {
      if (each == name) number += by;
    });
    return std::make_unique<PoissonSystemOf>(std::move(other));
  }
  BracketDefect bracket_defect(const std::vector<double>& x) const override {
    return worst_bracket_defect(system_, point(x));
  }
  std::string refusal(const std::vector<double>& x) const override {
    const X at = point(x);
    Sys own = system_;
    if (const std::string why = set_parameters(own, parameter_values(own)); !why.empty())
      return "is of no system: " + why;
    if (!system_.contains(at)) return "is outside of where bracket and energy are smooth";
    if (const std::string why = refused_by_the_system(at); !why.empty()) return why;
    if (const std::string what = contradicted_at(at); !what.empty())
      return "shows that the system's " + what + " is not that of its other members";
    const BracketDefect worst = worst_bracket_defect(system_, at);
    if (!(worst.relative <= 1e-10)) return worst.sentence();
    const MeasuredFunction energy = measure(x).front();
    return std::isfinite(energy.value) ? "" : "has an energy that is no finite number";
  }

 private:
  static constexpr int rows = 1 + casimir_count<Sys>();
  /// Energy and Casimirs.
  template <class S> Vector<S, rows> functions_at(const Vector<S, n>& at) const {
    Vector<S, rows> all;
    all(0) = system_.hamiltonian(at);
    if constexpr (rows > 1) {
      const auto casimirs = system_.casimirs(at);
      for (int c = 0; c + 1 < rows; ++c) all(c + 1) = casimirs(c);
    }
    return all;
  }
  std::string refused_by_the_system(const X& x) const {
    if constexpr (requires { system_.refusal(x); }) {
      return system_.refusal(x);
    } else {
      return {};
    }
  }
  /// Which member says what the others do not; empty where all agree.
  std::string contradicted_at(const X& x) const {
    const auto differ = [](const auto& a, const auto& b) {
      // At rest both are rounding.
      return !((a - b).cwiseAbs().maxCoeff() <= 1e-10 * (a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff()) + 1e-12);
    };
    if (differ(system_.velocity(x), system_.field(x, system_.gradient(x)))) return "velocity";
    if constexpr (HasLinearBracket<Sys>) {
      if (differ(system_.bivector(X(2 * x)), (2 * system_.bivector(x)).eval())) return "linear_bracket";
    }
    if constexpr (SumOfForms<Sys>) {
      for (int i = 0; i < Sys::parts; ++i)
        if constexpr (requires { system_.part_slope(i, 1.0); }) {
          const double at = system_.form(i).dot(x);
          const Vector<double, 1> slope(system_.part_slope(i, at));
          if (differ(slope, Vector<double, 1>(system_.part(i, Dual<double>(at, 1)).derivative))) return "part_slope";
        }
    }
    return {};
  }
  static X point(const std::vector<double>& x) { return Eigen::Map<const X>(x.data()); }
  static MeasuredFunction measured(const J& f, const std::vector<double>& x) {
    double size = std::abs(f.value);
    for (int i = 0; i < n; ++i) size += std::abs(x[std::size_t(i)] * f.gradient(i));
    return {f.value, size};
  }

  Sys system_;
};

/// Casimirs by what they are called.
template <class Sys>
PoissonEntry poisson_entry(std::string name, std::string summary, std::string bracket,
                           std::vector<std::string> casimirs) {
  PoissonEntry out{
      std::move(name), std::move(summary), std::move(bracket), std::move(casimirs), {}, {}, parameter_keys<Sys>(), {},
      nullptr};
  for (const auto& label : Sys::labels()) out.labels.emplace_back(label);
  if constexpr (noise_count<Sys>() > 0) out.noises.assign(Sys::noise_names.begin(), Sys::noise_names.end());
  for (const std::string_view method : poisson_methods_of<Sys>()) out.methods.push_back(poisson_methods::named(method));
  out.read = [](const Section& scene) -> std::unique_ptr<AnyPoissonSystem> {
    // A table of no keys is none that a scene may have.
    return std::make_unique<PoissonSystemOf<Sys>>(parameter_keys<Sys>().empty() ? Sys{} : read_parameters<Sys>(scene));
  };
  return out;
}

}  // namespace lagroid::app
