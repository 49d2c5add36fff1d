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
#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/poisson/poisson_methods.hpp>
#include <lagroid/solvers/poisson/steps.hpp>
#include <lagroid/solvers/poisson/wiener_path.hpp>

#include <algorithm>
#include <cmath>
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
    if (temperature > 0) system().friction = strength.cwiseProduct(strength) / (2 * temperature);
  }
  StepReport take(const X& x, double h, const Weights& dw, X& end) {
    system().rates = strength_.cwiseProduct(dw) / h;
    return step_.take(x, h, end);
  }
  /// The derivative of the step taken last, or of another from x with its increments.
  Matrix<double, size, size> slope(const X& x, double h) const { return step_.slope(x, h); }

 private:
  Driven& system() { return step_.formula.chart.system; }

  FormulaStep<Formula> step_;
  Weights strength_;
};

namespace detail {

template <class Sys, class Formula> class NoisyPoissonSteps final : public PoissonIntegrator {
 public:
  using X = Vector<double, Sys::dimension>;
  using Weights = typename NoisyStep<Formula>::Weights;

  NoisyPoissonSteps(const Sys& system, const NoisyStep<Formula>& step, const DeclaredMethod& method, const X& start,
                    const PoissonOptions& options)
      : system_(system),
        step_(step),
        name_(method.name),
        wiener_{options.noise.seed, options.noise.path},
        h_(options.step),
        thermostat_(options.noise.temperature > 0),
        x_(start) {}

  StepReport advance() override {
    X end;
    const StepReport report = step_.take(x_, h_, increments(), end);
    if (report.converged()) {
      x_ = end;
      ++index_;
    }
    return report;
  }
  std::vector<double> point() const override { return {x_.data(), x_.data() + x_.size()}; }
  void go_on_from(const std::vector<double>& point) override { x_ = Eigen::Map<const X>(point.data()); }
  double time() const override { return double(index_) * h_; }
  MethodTraits traits() const override { return {name_, 1, false, !thermostat_ && Formula::kept.bracket == 0, false}; }
  KeptStructure kept() const override {
    return {thermostat_ ? 1 : std::min(Formula::kept.bracket, noisy_power),
            std::min(Formula::kept.casimirs, noisy_power)};
  }
  double poisson_defect() const override {
    NoisyStep<Formula> next = step_;
    X end;
    if (!next.take(x_, h_, increments(), end).converged()) return std::numeric_limits<double>::quiet_NaN();
    return bracket_change(system_, x_, end, next.slope(x_, h_));
  }
  void serialize(NumberArchive& archive) override { archive(x_, index_); }

 private:
  /// What is wrong by h^3 in a step is by (sqrt h)^3 where noise moves it; the same of other odd powers.
  static constexpr int noisy_power = 1;
  Weights increments() const { return wiener_.increments<int(Weights::SizeAtCompileTime)>(index_, h_); }

  Sys system_;
  NoisyStep<Formula> step_;
  std::string name_;
  WienerPath wiener_;
  double h_;
  bool thermostat_;
  X x_;
  long index_ = 0;
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
    const auto offer = [&](const DeclaredMethod& method, const auto& formula) {
      using Formula = std::remove_cvref_t<decltype(formula)>;
      if (method.name != options.method) return;
      const typename Driven::Weights strength =
          Eigen::Map<const typename Driven::Weights>(options.noise.strength.data());
      const NoisyStep<Formula> step(formula, strength, options.noise.temperature);
      made = std::make_unique<NoisyPoissonSteps<Sys, Formula>>(system, step, method, start, options);
    };
    const Driven driven(system);
    using Natural = NaturalChart<Driven>;
    using Karasev = KarasevChart<Driven>;
    offer(poisson_methods::groupoid, GroupoidFormula<Natural>(Natural(driven)));
    if constexpr (!std::is_same_v<Natural, Karasev>)
      offer(poisson_methods::karasev, GroupoidFormula<Karasev>(Karasev(driven)));
    offer(poisson_methods::midpoint, TreeFormula<Driven, 1>(driven));
  }
  return made;
}

}  // namespace detail

}  // namespace lagroid
