// A Lagrangian written once, discretised to order two, four, six and eight: Kepler's problem, error and time beside
// compositions of the rule of order two.
#include <lagroid/core/continuous/continuous_lagrangian.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/galerkin/galerkin.hpp>
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>
#include <lagroid/solvers/integrators/composition.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <chrono>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>
#include <string>

using namespace lagroid;

// |q'|^2 / 2 + 1 / |q|.
struct Orbit : ContinuousLagrangian<Pair<2>> {
  template <class S> S l(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    using std::sqrt;
    return (v(0) * v(0) + v(1) * v(1)) * 0.5 + 1.0 / sqrt(q(0) * q(0) + q(1) * q(1));
  }
};

// Ten revolutions of an orbit of eccentricity 0.3, after which all is where it was; false where a step failed.
const State<Pair<2>> perihelion{{0.7, 0}, {0, std::sqrt(1.3 / 0.7)}};
constexpr double duration = 20 * std::numbers::pi;

template <class Run> bool follow(const std::string& name, int steps, Run run) {
  const auto began = std::chrono::steady_clock::now();
  for (int k = 0; k < steps; ++k)
    if (!run.advance().converged()) return false;
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
  const double error = (run.point().state.object - perihelion.object).norm();
  std::cout << std::left << std::setw(34) << name << std::right << std::setw(6) << steps << std::scientific
            << std::setprecision(1) << std::setw(10) << error << std::fixed << std::setw(9) << took.count() << '\n';
  return true;
}

template <class Rule> bool by_rule(const std::string& name, int steps) {
  const Rule system{Orbit{}, duration / steps};
  return follow(name, steps,
                FixedStepIntegrator<Rule>(system, perihelion, system.groupoid.unit(perihelion.object),
                                          std::make_unique<NewtonStep<Rule>>()));
}
bool by_composition(const Composition& composition, int steps) {
  using Rule = Trapezoidal<Orbit>;
  const Rule system{Orbit{}, duration / steps};
  return follow(std::string("trapezoidal, ").append(composition.name), steps,
                CompositionIntegrator<Rule>(system, perihelion, system.groupoid.unit(perihelion.object), composition,
                                            [] { return std::make_unique<NewtonStep<Rule>>(); }));
}

int main() {
  std::cout << "method                             steps     error  time, ms\n";
  bool solved = true;
  for (const int steps : {500, 1000, 2000}) {
    solved = solved && by_rule<Midpoint<Orbit>>("midpoint, order 2", steps);
    solved = solved && by_rule<Galerkin<Orbit, 2>>("Galerkin, order 4", steps / 2);
    solved = solved && by_rule<Galerkin<Orbit, 3>>("Galerkin, order 6", steps / 4);
    solved = solved && by_rule<Galerkin<Orbit, 4>>("Galerkin, order 8", steps / 5);
    solved = solved && by_composition(compositions::suzuki, steps / 2);
    solved = solved && by_composition(compositions::kahan_li_6, steps / 2);
    solved = solved && by_composition(compositions::kahan_li_8, steps / 4);
  }
  return solved ? 0 : 1;
}
