#pragma once
/// The methods of Lagroid that a system admits, deduced from what the system is.

#include "problem.hpp"

#include <lagroid/core/split_system.hpp>
#include <lagroid/solvers/compositions.hpp>
#include <lagroid/solvers/constrained_momentum.hpp>
#include <lagroid/solvers/march.hpp>

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace peers {

/// A way to march, by name.
struct Way {
  std::string name;
  lagroid::MarchOptions options;
};

/// With equal steps: of every composition, the variational step and, where the energy splits, Strang's.
template <class Sys> std::vector<Way> ways() {
  std::vector<Way> out;
  for (const lagroid::Composition& composition : lagroid::compositions::all) {
    const std::string suffix = composition.stages() > 1 ? ", " + std::string(composition.name) : "";
    lagroid::MarchOptions options;
    options.composition = composition;
    if (lagroid::Variational<Sys> || composition.stages() == 1) out.push_back({"variational" + suffix, options});
    options.splitting = true;
    if constexpr (lagroid::SplitSystem<Sys>) out.push_back({"splitting" + suffix, options});
  }
  return out;
}

/// A march of steps that `make` prepares for a step size; `coordinates` tells a point as the problem wants it.
template <class Sys, class P, class Make, class Coordinates>
Method marched(const P& problem, std::string name, int order, double coarsest, const Make& make,
               const Coordinates& coordinates) {
  return {ours, std::move(name), false, coarsest, ladder(order), [=](double end, double setting) -> Task {
            const long steps = std::lround(end / setting);
            const std::shared_ptr<lagroid::March<Sys>> march = make(end / double(steps));
            return [=] {
              Watch<P> watch(problem);
              for (long i = 0; i < steps; ++i) {
                const lagroid::StepReport report = march->advance();
                if (!report.converged())
                  return watch.fail(coordinates(march->point()), std::string(to_string(report.status)));
                watch.step([&] { return coordinates(march->point()); });
              }
              return watch.finish(coordinates(march->point()));
            };
          }};
}

/// All ways that a system has.
template <class Sys, class P, class Coordinates>
std::vector<Method> marches(const P& problem, const Sys& system,
                            const lagroid::State<typename Sys::GroupoidType>& start,
                            const lagroid::ArrowOf<typename Sys::GroupoidType>& configuration,
                            const Coordinates& coordinates) {
  std::vector<Method> out;
  for (const Way& way : ways<Sys>()) {
    const auto make = [=](double h) {
      Sys stepped = system;
      stepped.h = h;
      return lagroid::make_march(stepped, start, configuration, way.options);
    };
    const int stages = way.options.composition.stages();
    out.push_back(marched<Sys>(problem, way.name, way.options.composition.order,
                               0.5 * problem.unit() * std::sqrt(double(stages)), make, coordinates));
  }
  return out;
}

}  // namespace peers
