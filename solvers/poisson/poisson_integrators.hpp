#pragma once
/// What `make_poisson_integrator` makes of a system: every method that it has.
///
///     const auto motion = make_poisson_integrator(Mine{}, start, {.method = "hamilton-jacobi-4", .step = 0.1});
///
/// Include it for a system of your own, once: it compiles some seconds. Requires and throws as poisson_integrator.hpp.

#include <lagroid/solvers/integrators/composed_step.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/solvers/poisson/extrapolated_steps.hpp>
#include <lagroid/solvers/poisson/noisy_steps.hpp>
#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/poisson/poisson_methods.hpp>
#include <lagroid/solvers/poisson/step_slopes.hpp>
#include <lagroid/solvers/poisson/steps.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace lagroid {

namespace detail {

/// Equal steps, each composed of stages.
template <class Sys, class Step> class PoissonSteps final : public PoissonIntegrator {
 public:
  using X = Vector<double, Sys::dimension>;

  PoissonSteps(const Sys& system, std::function<Step(const Sys&)> make, const DeclaredMethod& method, const X& start,
               const PoissonOptions& options)
      : system_(system), make_(std::move(make)), step_(make_(system)), method_(method), options_(options), x_(start) {
    for (const double gamma : options.composition.coefficients) sizes_.push_back(gamma * options.step);
  }

  StepReport advance() override {
    const StepReport report = take_stages(step_, x_);
    if (report.converged()) ++index_;
    return report;
  }
  std::vector<double> point() const override { return {x_.data(), x_.data() + x_.size()}; }
  void go_on_from(const std::vector<double>& point) override { x_ = Eigen::Map<const X>(point.data()); }
  double time() const override { return double(index_) * options_.step; }
  MethodTraits traits() const override {
    const bool composed = options_.composition.stages() > 1;
    return {composed_name(method_.name, options_.composition),
            composed ? options_.composition.order : Step::order,
            Step::symmetric,
            Step::kept.bracket == 0,
            Step::explicit_step,
            Step::explicit_step ? options_.composition.stages() * method_.stages : 0};
  }
  KeptStructure kept() const override { return Step::kept; }
  Eigen::MatrixXd slope(const std::vector<std::string>& parameters) const override {
    return slope_by_parameters(
        system_, parameters, make_,
        [&](const Step& step) {
          X end = x_;
          if (!take_stages(step, end).converged()) end.setConstant(std::numeric_limits<double>::quiet_NaN());
          return end;
        },
        [&](const Step& step, const auto& members) { return along_stages(step, members).second; }, checked_);
  }
  double poisson_defect() const override {
    const auto [end, slope] = along_stages(step_, {});
    if (!end.allFinite()) return std::numeric_limits<double>::quiet_NaN();
    return bracket_change(system_, x_, end, Matrix<double, Sys::dimension, Sys::dimension>(slope));
  }
  void serialize(NumberArchive& archive) override { archive(x_, index_); }

 private:
  /// x to where a step leads; unless it converges, x stays.
  StepReport take_stages(const Step& step, X& x) const {
    const X before = x;
    X end;
    if constexpr (requires { step.take(before, sizes_, end); }) {
      const StepReport report = step.take(before, sizes_, end);
      if (report.converged()) x = end;
      return report;
    } else {
      return step_by_stages(
          sizes_,
          [&](double h) {
            const StepReport found = step.take(x, h, end);
            if (found.converged()) x = end;
            return found;
          },
          [&] { x = before; });
    }
  }
  /// The end of the next step, and its derivative: the product of those of its stages.
  std::pair<X, StepSlope<Sys::dimension>> along_stages(const Step& step, std::span<const double* const> members) const {
    constexpr int n = Sys::dimension;
    const auto others = Eigen::Index(members.size());
    std::pair<X, StepSlope<n>> out{x_, StepSlope<n>::Identity(n, n + others)};
    auto& [x, slope] = out;
    for (const double h : sizes_) {
      const StepSlope<n> stage = step.slope(x, h, members);
      slope = (stage.leftCols(n) * slope).eval();
      slope.rightCols(others) += stage.rightCols(others);
      const X before = x;
      if (!step.take(before, h, x).converged()) {
        x.setConstant(std::numeric_limits<double>::quiet_NaN());
        slope = unknown_slope<n>(int(n + others));
        break;
      }
    }
    return out;
  }

  Sys system_;
  std::function<Step(const Sys&)> make_;
  Step step_;
  DeclaredMethod method_;
  PoissonOptions options_;
  std::vector<double> sizes_;  ///< of its stages
  X x_;
  long index_ = 0;
  mutable std::vector<std::string> checked_;  ///< parameters whose slopes were compared
};

/// Calls visit(method, make) for each method that the system has; make(system) is its step, null where it has none of
/// one size.
template <class Sys, class Visit> void each_poisson_step(const Visit& visit) {
  namespace m = poisson_methods;
  visit(m::groupoid, [](const Sys& s) {
    return FormulaStep<GroupoidFormula<NaturalChart<Sys>>>(GroupoidFormula<NaturalChart<Sys>>(NaturalChart<Sys>(s)));
  });
  const auto karasev = [&]<int Order>(const DeclaredMethod& method) {
    visit(method, [](const Sys& s) {
      using Formula = GroupoidFormula<KarasevChart<Sys>, Order>;
      return FormulaStep<Formula>(Formula(KarasevChart<Sys>(s)));
    });
  };
  if constexpr (!std::is_same_v<NaturalChart<Sys>, KarasevChart<Sys>>) karasev.template operator()<2>(m::karasev);
  karasev.template operator()<4>(m::hamilton_jacobi_4);
  karasev.template operator()<6>(m::hamilton_jacobi_6);
  if constexpr (SumOfForms<Sys>)
    visit(m::splitting, [](const Sys& s) { return SplitStep<FlowChart<Sys>>(FlowChart<Sys>(s)); });
  visit(m::extrapolation, nullptr);
  visit(m::truncated, [](const Sys& s) { return FormulaStep<TreeFormula<Sys, 3>>(TreeFormula<Sys, 3>(s)); });
  const auto midpoint = [](const Sys& s) { return FormulaStep<TreeFormula<Sys, 1>>(TreeFormula<Sys, 1>(s)); };
  visit(m::midpoint, midpoint);
  if constexpr (casimir_count<Sys>() > 0)
    visit(m::projected, [=](const Sys& s) { return ProjectedStep<FormulaStep<TreeFormula<Sys, 1>>>(midpoint(s)); });
  visit(m::runge_kutta, [](const Sys& s) { return PoissonRungeKuttaStep<Sys>(s); });
}

}  // namespace detail

template <class Sys> std::vector<std::string_view> poisson_methods_of() {
  std::vector<std::string_view> names;
  detail::each_poisson_step<Sys>([&](const DeclaredMethod& method, const auto&) { names.push_back(method.name); });
  return names;
}

template <class Sys>
std::unique_ptr<PoissonIntegrator> make_poisson_integrator(const Sys& system,
                                                           const Vector<double, Sys::dimension>& start,
                                                           const PoissonOptions& options) {
  if (!std::isfinite(options.step) || options.step == 0)
    throw std::invalid_argument("the step of an integrator on a Poisson manifold is a finite number, not zero");
  std::unique_ptr<PoissonIntegrator> made;
  if (options.noise.present()) {
    made = detail::make_noisy_steps(system, start, options);
    if (!made) throw std::invalid_argument("this system has no method \"" + options.method + "\" for noise");
    return made;
  }
  detail::each_poisson_step<Sys>([&](const DeclaredMethod& method, const auto& make) {
    if (method.name != options.method) return;
    if (options.composition.stages() > 1 && method.other_orders != OtherOrders::composed_steps)
      throw std::invalid_argument("steps of " + options.method + " are not composed");
    if constexpr (std::is_null_pointer_v<std::remove_cvref_t<decltype(make)>>) {
      made = std::make_unique<detail::ExtrapolatedPoissonSteps<Sys>>(system, start, options);
    } else {
      made = std::make_unique<detail::PoissonSteps<Sys, decltype(make(system))>>(system, make, method, start, options);
    }
  });
  if (!made) throw std::invalid_argument("this system has no method \"" + options.method + "\"");
  return made;
}

/// For each system of the library: LAGROID_POISSON_INTEGRATORS(extern template, System).
#define LAGROID_POISSON_INTEGRATORS(prefix, Sys)                          \
  prefix std::vector<std::string_view> poisson_methods_of<Sys>();         \
  prefix std::unique_ptr<PoissonIntegrator> make_poisson_integrator<Sys>( \
      const Sys&, const Vector<double, Sys::dimension>&, const PoissonOptions&)

}  // namespace lagroid
