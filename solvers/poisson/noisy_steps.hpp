#pragma once
/// Equal steps on a Poisson manifold that noise drives, with or without the friction of a thermostat
/// (driven_system.hpp), on a path of a counter-based generator (wiener_path.hpp).
///
///     const auto motion = make_poisson_integrator(
///         EulerTop{}, {0.8, 0.6, 1.1}, {.step = 0.01, .noise = {.strength = {0.2, 0.2, 0.2}, .seed = 3}});
///
/// Included by poisson_integrators.hpp; `make_noisy_steps` is its part for these. Strong order 1 where one noise alone
/// drives or the fields of all commute, else 1/2; weak order 1. Requires a system with noise Hamiltonians, strengths
/// that are not negative, one for each, a temperature that is not, and a step above zero; throws std::invalid_argument
/// otherwise, and for methods and compositions that noise does not go with.
///
/// Source: as driven_system.hpp.

#include <lagroid/solvers/poisson/driven_system.hpp>
#include <lagroid/solvers/poisson/levels.hpp>
#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/poisson/poisson_methods.hpp>
#include <lagroid/solvers/poisson/step_slopes.hpp>
#include <lagroid/solvers/poisson/steps.hpp>
#include <lagroid/solvers/poisson/wiener_path.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// The largest entry of D pi D^T - pi(to), relative to the largest of pi(to), D = d to / d from.
template <class Sys, int N>
double bracket_change(const Sys& system, const Vector<double, N>& from, const Vector<double, N>& to,
                      const Matrix<double, N, N>& slope) {
  const Matrix<double, N, N> before = system.bivector(from);
  const Matrix<double, N, N> after = system.bivector(to);
  const double size = after.cwiseAbs().maxCoeff();
  return (slope * before * slope.transpose() - after).cwiseAbs().maxCoeff() / (size > 0 ? size : 1);
}

}  // namespace detail

/// One step of a formula that noise drives: x_0 -> x_1 for increments dW that are given.
template <class Formula> class NoisyStep {
 public:
  static constexpr int size = Formula::size;
  using Driven = std::remove_cvref_t<decltype(std::declval<const Formula&>().system())>;
  using X = Vector<double, size>;
  using Weights = typename Driven::Weights;

  /// Strengths s_k; friction for the temperature, unless it is 0.
  NoisyStep(const Formula& formula, const Weights& strength, double temperature) : step_(formula), strength_(strength) {
    if (temperature > 0) driven().friction = strength.cwiseProduct(strength) / (2 * temperature);
  }
  StepReport take(const X& x, double h, const Weights& dw, X& end) {
    driven().rates = strength_.cwiseProduct(dw) / h;
    return step_.take(x, h, end);
  }
  const Driven& system() const { return step_.system(); }
  /// The derivative of the step taken last, or of another from x with its increments.
  StepSlope<size> slope(const X& x, double h, std::span<const double* const> members = {}) const {
    return step_.slope(x, h, members);
  }

 private:
  Driven& driven() { return step_.formula.chart.system; }

  FormulaStep<Formula> step_;
  Weights strength_;
};

namespace detail {

template <class Sys, class Formula> class NoisyPoissonSteps final : public PoissonIntegrator {
 public:
  using X = Vector<double, Sys::dimension>;
  using Weights = typename NoisyStep<Formula>::Weights;

  using Make = std::function<NoisyStep<Formula>(const Sys&)>;

  NoisyPoissonSteps(const Sys& system, Make make, const DeclaredMethod& method, const X& start,
                    const PoissonOptions& options)
      : system_(system),
        make_(std::move(make)),
        step_(make_(system)),
        name_(method.name),
        wiener_{options.noise.seed, options.noise.path},
        h_(options.step),
        thermostat_(options.noise.temperature > 0),
        x_(start),
        levels_(system, start),
        project_(options.noise.project) {}

  StepReport advance() override {
    X end;
    StepReport report = step_.take(x_, h_, increments(), end);
    if (report.converged() && project_ && !levels_.project(system_, end)) report.status = SolveStatus::left_domain;
    if (report.converged()) {
      x_ = end;
      ++index_;
    }
    return report;
  }
  std::vector<double> point() const override { return {x_.data(), x_.data() + x_.size()}; }
  void go_on_from(const std::vector<double>& point) override {
    x_ = Eigen::Map<const X>(point.data());
    levels_ = Levels<Sys, false>(system_, x_);
  }
  double time() const override { return double(index_) * h_; }
  MethodTraits traits() const override { return {name_, 1, false, !thermostat_ && Formula::kept.bracket == 0, false}; }
  KeptStructure kept() const override {
    return {thermostat_ ? 1 : std::min(Formula::kept.bracket, noisy_power),
            std::min(Formula::kept.casimirs, noisy_power)};
  }
  Eigen::MatrixXd slope(const std::vector<std::string>& parameters) const override {
    X end;
    const auto taken = [&](const Sys& system) {  // by which it knows its increments
      NoisyStep<Formula> step = make_(system);
      if (!step.take(x_, h_, increments(), end).converged()) end.setConstant(std::numeric_limits<double>::quiet_NaN());
      return step;
    };
    return slope_by_parameters(
        system_, parameters, taken, [&](const NoisyStep<Formula>&) { return end; },
        [&](const NoisyStep<Formula>& step, const auto& members) { return step.slope(x_, h_, members); }, checked_);
  }
  double poisson_defect() const override {
    NoisyStep<Formula> next = step_;
    X end;
    if (!next.take(x_, h_, increments(), end).converged()) return std::numeric_limits<double>::quiet_NaN();
    return bracket_change(system_, x_, end, Matrix<double, Sys::dimension, Sys::dimension>(next.slope(x_, h_)));
  }
  void serialize(NumberArchive& archive) override {
    archive(x_, index_);
    levels_.serialize(archive);
  }

 private:
  /// What is wrong by h^3 in a step is by (sqrt h)^3 where noise moves it; the same of other odd powers.
  static constexpr int noisy_power = 1;
  Weights increments() const { return wiener_.increments<int(Weights::SizeAtCompileTime)>(index_, h_); }

  Sys system_;
  Make make_;
  NoisyStep<Formula> step_;
  std::string name_;
  WienerPath wiener_;
  double h_;
  bool thermostat_;
  X x_;
  Levels<Sys, false> levels_;
  bool project_;
  long index_ = 0;
  mutable std::vector<std::string> checked_;  ///< parameters whose slopes were compared
};

/// What is wrong with the options.
inline std::string noise_refusal(const PoissonOptions& options, int sources) {
  const NoiseOptions& noise = options.noise;
  if (sources == 0) return "this system has no noise Hamiltonians";
  if (int(noise.strength.size()) != sources)
    return "there is one strength of noise for each of the system's noise Hamiltonians, " + std::to_string(sources);
  for (const double s : noise.strength)
    if (!(s >= 0) || !std::isfinite(s)) return "a strength of noise is a finite number, not negative";
  if (!(noise.temperature >= 0) || !std::isfinite(noise.temperature))
    return "the temperature of a thermostat is a finite number, not negative";
  if (!(options.step > 0)) return "noise goes forward in time: its steps are above zero";
  if (options.composition.stages() > 1) return "steps with noise are not composed";
  const DeclaredMethod* method = poisson_methods::named(options.method);
  if (method == nullptr || !poisson_methods::takes_noise(*method))
    return "the method " + options.method + " is not one for noise";
  return {};
}

/// Null where the system does not have the method.
template <class Sys>
std::unique_ptr<PoissonIntegrator> make_noisy_steps(const Sys& system, const Vector<double, Sys::dimension>& start,
                                                    const PoissonOptions& options) {
  if (const std::string why = noise_refusal(options, noise_count<Sys>()); !why.empty())
    throw std::invalid_argument(why);
  std::unique_ptr<PoissonIntegrator> made;
  if constexpr (noise_count<Sys>() > 0) {
    using Driven = DrivenSystem<Sys>;
    const auto offer = [&]<class Formula>(const DeclaredMethod& method, Formula (*formula)(const Driven&)) {
      if (method.name != options.method) return;
      const typename Driven::Weights strength =
          Eigen::Map<const typename Driven::Weights>(options.noise.strength.data());
      const auto make = [formula, strength, temperature = options.noise.temperature](const Sys& of) {
        return NoisyStep<Formula>(formula(Driven(of)), strength, temperature);
      };
      made = std::make_unique<NoisyPoissonSteps<Sys, Formula>>(system, make, method, start, options);
    };
    using Natural = NaturalChart<Driven>;
    using Karasev = KarasevChart<Driven>;
    offer(
        poisson_methods::groupoid, +[](const Driven& of) { return GroupoidFormula<Natural>(Natural(of)); });
    if constexpr (!std::is_same_v<Natural, Karasev>)
      offer(
          poisson_methods::karasev, +[](const Driven& of) { return GroupoidFormula<Karasev>(Karasev(of)); });
    offer(
        poisson_methods::midpoint, +[](const Driven& of) { return TreeFormula<Driven, 1>(of); });
  }
  return made;
}

}  // namespace detail

}  // namespace lagroid
