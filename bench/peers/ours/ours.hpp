#pragma once
/// The methods of Lagroid that a system admits, deduced from what the system is.

#include "../problems/problem.hpp"

#include <lagroid/core/capabilities/split_system.hpp>
#include <lagroid/solvers/generating/constrained_momentum.hpp>
#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/solvers/integrators/transformed.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

namespace peers {

/// A way to integrate, by name.
struct Way {
  std::string name;
  lagroid::IntegratorOptions options;
};

/// With equal steps: of every composition the variational step and, where the energy splits, the splitting. Where
/// there is an attraction also with steps that are equal in a transformed time.
template <class Sys> std::vector<Way> ways(const Sys& system) {
  std::vector<Way> out;
  const auto add = [&](const char* kind, lagroid::StepKind step, lagroid::TimeMode mode,
                       const lagroid::Composition& composition) {
    const std::string suffix = composition.stages() > 1 ? ", " + std::string(composition.name) : "";
    lagroid::IntegratorOptions options;
    options.fixed = step;
    options.mode = mode;
    options.composition = composition;
    out.push_back({kind + suffix, options});
  };
  using lagroid::StepKind, lagroid::TimeMode;
  for (const lagroid::Composition& composition : lagroid::compositions::all)
    if (lagroid::Variational<Sys> || composition.stages() == 1)
      add("variational", StepKind::variational, TimeMode::fixed, composition);
  if constexpr (lagroid::SplitSystem<Sys>) {
    const auto add_splitting = [&](const lagroid::Composition& composition) {
      if (lagroid::splits_by(system, composition)) add("splitting", StepKind::splitting, TimeMode::fixed, composition);
      if (lagroid::AttractiveSystem<Sys> && composition.kicks.empty())
        add("transformed", StepKind::splitting, TimeMode::transformed, composition);
    };
    for (const lagroid::Composition& composition : lagroid::compositions::all) add_splitting(composition);
    for (const lagroid::Composition& composition : lagroid::splittings::all) add_splitting(composition);
  }
  return out;
}

/// The integrator whose one step ends after the time `span`, of either sign, found by the secant method from a first
/// step of that length.
template <class Make> auto landed(const Make& make, double span) {
  constexpr int most = 12;
  double h = span;
  double before = 0;
  double error_before = -span;
  auto integrator = make(h);
  for (int k = 0; k < most && integrator->advance().converged(); ++k) {
    const double error = integrator->point().time - span;
    if (std::abs(error) <= 1e-16 * std::abs(span) || error == error_before) break;
    const double next = h - error * (h - before) / (error - error_before);
    before = h;
    error_before = error;
    if (next == h) break;
    h = next;
    integrator = make(h);
  }
  return integrator;
}

/// So many steps, watched.
template <class Sys, class P, class Coordinates>
Task stepping(const P& problem, const std::shared_ptr<lagroid::Integrator<Sys>>& integrator, long steps,
              const Coordinates& coordinates) {
  return [=] {
    Watch<P> watch(problem);
    for (long i = 0; i < steps; ++i) {
      const lagroid::StepReport report = integrator->advance();
      if (!report.converged())
        return watch.fail(coordinates(integrator->point()), std::string(to_string(report.status)));
      watch.step([&] { return coordinates(integrator->point()); });
    }
    return watch.finish(coordinates(integrator->point()));
  };
}

/// An integrator of steps that `make` prepares for a step size; `coordinates` tells a point as the problem wants it.
template <class Sys, class P, class Make, class Coordinates>
Method integrated(const P& problem, std::string name, int order, double coarsest, const Make& make,
                  const Coordinates& coordinates) {
  return {ours, std::move(name), false, coarsest, ladder(order), [=](double end, double setting) -> Task {
            const long steps = std::lround(end / setting);
            const std::shared_ptr<lagroid::Integrator<Sys>> integrator = make(end / double(steps));
            return stepping<Sys>(problem, integrator, steps, coordinates);
          }};
}

/// An integrator of steps that vary, the last of which is made to end where the run does. `make(h, state,
/// configuration)` begins one whose first step is of length h.
template <class Sys, class P, class Make, class Coordinates>
Method integrated_to_the_end(const P& problem, std::string name, int order, double coarsest, const Make& make,
                             const lagroid::State<typename Sys::GroupoidType>& start,
                             const lagroid::ArrowOf<typename Sys::GroupoidType>& configuration,
                             const Coordinates& coordinates) {
  return {ours, std::move(name), false, coarsest, ladder(order), [=](double end, double setting) -> Task {
            const std::shared_ptr<lagroid::Integrator<Sys>> integrator = make(setting, start, configuration);
            return [=] {
              Watch<P> watch(problem);
              const auto& point = integrator->point();
              while (end - point.time > 0.5 * (point.index > 0 ? point.step_size : setting)) {
                const lagroid::StepReport report = integrator->advance();
                if (!report.converged()) return watch.fail(coordinates(point), std::string(to_string(report.status)));
                watch.step([&] { return coordinates(point); });
              }
              const auto last =
                  landed([&](double h) { return make(h, point.state, point.configuration); }, end - point.time);
              return watch.finish(coordinates(last->point()));
            };
          }};
}

/// Extrapolation by a tolerance, in nodes a hundred units of time apart.
template <class Sys, class P, class Coordinates>
Method extrapolated(const P& problem, const Sys& system, const lagroid::State<typename Sys::GroupoidType>& start,
                    const lagroid::ArrowOf<typename Sys::GroupoidType>& configuration, const Coordinates& coordinates) {
  return {ours,
          std::string(lagroid::extrapolation_method.name),
          true,
          1e-2,
          std::sqrt(10.0),
          [=](double end, double tolerance) -> Task {
            const long nodes = std::lround(std::ceil(end / 100));
            Sys stepped = system;
            stepped.h = end / double(nodes);
            const std::shared_ptr<lagroid::Integrator<Sys>> integrator = lagroid::make_integrator(
                stepped, start, configuration, {.fixed = lagroid::StepKind::extrapolation, .tolerance = tolerance});
            return stepping<Sys>(problem, integrator, nodes, coordinates);
          }};
}

/// All ways that a system has.
template <class Sys, class P, class Coordinates>
std::vector<Method> integrators(const P& problem, const Sys& system,
                                const lagroid::State<typename Sys::GroupoidType>& start,
                                const lagroid::ArrowOf<typename Sys::GroupoidType>& configuration,
                                const Coordinates& coordinates) {
  std::vector<Method> out;
  if constexpr (lagroid::SplitSystem<Sys>)
    out.push_back(extrapolated<Sys>(problem, system, start, configuration, coordinates));
  for (const Way& way : ways(system)) {
    const auto make = [=](double h, const auto& state, const auto& at) {
      Sys stepped = system;
      stepped.h = h;
      return lagroid::make_integrator(stepped, state, at, way.options);
    };
    const double coarsest = 0.5 * problem.unit() * std::sqrt(double(way.options.composition.stages()));
    const int order = way.options.composition.order;
    if (way.options.mode == lagroid::TimeMode::fixed)
      out.push_back(integrated<Sys>(
          problem, way.name, order, coarsest, [=](double h) { return make(h, start, configuration); }, coordinates));
    else
      out.push_back(
          integrated_to_the_end<Sys>(problem, way.name, order, coarsest, make, start, configuration, coordinates));
  }
  return out;
}

}  // namespace peers
