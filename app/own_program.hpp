#pragma once
/// A program of one's own: the commands of lagroid, for systems of one's own.
///
/// Scenes, studies, sweeps and pictures then work for the system as they do for those of the library.
///
///     int main(int argc, char** argv) { return lagroid::program(argc, argv, {lagroid::module<Dido>()}); }
///
/// One source makes four programs (`lagroid_program` in CMake; `lagroid run dido.cpp` builds the one that it needs):
///
///     LAGROID_STEPS_ALONE defined   equal steps of the discrete Lagrangian alone: seconds to compile
///     neither                       all methods, studies, sweeps, boundary values
///     LAGROID_WITH_LAWS defined     the laws: `check`
///     LAGROID_WITH_DERIVATIVES      exact derivatives of runs: `gradient` and `fit`
///
/// Poisson systems are modules too (own_poisson.hpp).
///
/// Requires a system with a default constructor. Returns the exit code of the command; what goes wrong is one line on
/// standard error.

#if defined(LAGROID_STEPS_ALONE)
#include "own/steps_module.hpp"
#else
#include "reductions/reduced_scene.hpp"
#include "scenes/any_system.hpp"

#include <lagroid/solvers/boundary/boundary_methods.hpp>
#include <lagroid/solvers/integrators/integrator_methods.hpp>
#endif
#if defined(LAGROID_WITH_LAWS)
#include "check/certify_system.hpp"
#include "own/own_check.hpp"

#include <lagroid/solvers/testing/reduced_certificate.hpp>
#endif

#if defined(LAGROID_WITH_DERIVATIVES)
#include "gradient/columns/given_directions.hpp"
#include "gradient/gradient_subject_of.hpp"
#include "own/own_gradient.hpp"
#endif

#include "own/own_parts.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

namespace lagroid {

/// A system of a program, whatever its type: on a groupoid, or on a Poisson manifold.
struct Module {
  std::shared_ptr<const app::SystemModule> of = nullptr;
  std::shared_ptr<const app::PoissonEntry> bracket = nullptr;
#if defined(LAGROID_WITH_LAWS)
  std::function<Certificate(const app::Section& scene, const app::CheckCommandOptions& options)> certify;
#endif
#if defined(LAGROID_WITH_DERIVATIVES)
  app::AskGradient differentiate;
#endif
};

/// The module of a system for scenes with `system = "NAME"`: its parameters are those that it declares
/// (core/parameter.hpp). The name is the class's unless it is given: SpringPendulum becomes spring_pendulum. `dress`
/// changes the labels, units, panels and shapes that reports would choose.
template <DiscreteSystem Sys>
Module module(std::string name = app::snake_case(typeid(Sys)), std::string summary = {},
              std::type_identity_t<app::Dress<Sys>> dress = nullptr) {
  if (summary.empty()) summary = "a system on " + Sys::GroupoidType::name();
#if defined(LAGROID_STEPS_ALONE)
  return {.of = std::make_shared<const app::StepsModule<Sys>>(std::move(name), std::move(summary), dress)};
#else
  const auto made =
      std::make_shared<const app::ModuleOf<Sys>>(app::any_module<Sys>(std::move(name), std::move(summary), dress));
#if defined(LAGROID_WITH_LAWS)
  return {.of = made, .certify = [made](const app::Section& scene, const app::CheckCommandOptions& options) {
            return app::certify(made->prepare(scene, {.progress = !options.json}), options);
          }};
#elif defined(LAGROID_WITH_DERIVATIVES)
  return {.of = made, .differentiate = [made](const app::Section& scene) -> std::optional<app::GradientSubject> {
            if (&app::module_of_scene(scene) != made.get()) return std::nullopt;
            return app::in_numbers_of_the_scene(app::gradient_subject_of(made->prepare(scene, {}), scene),
                                                app::given_directions<Sys>(scene));
          }};
#else
  return {.of = made};
#endif
#endif
}

/// Serves a command line of lagroid for these systems: run, resume, view, plot, study, sweep, list, schema, cite and,
/// where the programs beside it with laws and with derivatives are built, check, gradient and fit. Returns the exit
/// code.
inline int program(int argc, char** argv, std::vector<Module> modules) {
  app::OwnSystems systems;
  for (const Module& each : modules) {
    if (each.of) systems.systems.push_back(each.of.get());
    if (each.bracket) systems.brackets.push_back(each.bracket.get());
  }
#if defined(LAGROID_WITH_LAWS)
  const auto ask = [&](const app::SystemModule& asked, const app::Section& scene, const app::CheckCommandOptions& how) {
    const auto is = [&](const Module& each) { return each.of.get() == &asked; };
    return std::find_if(modules.begin(), modules.end(), is)->certify(scene, how);
  };
  return app::own_check_program(argc, argv, std::move(systems), ask);
#elif defined(LAGROID_WITH_DERIVATIVES)
  std::vector<app::AskGradient> subjects;
  for (const Module& each : modules)
    if (each.differentiate) subjects.push_back(each.differentiate);
  return app::own_gradient_program(argc, argv, std::move(systems), std::move(subjects));
#elif defined(LAGROID_STEPS_ALONE)
  try {
    return app::own_program(argc, argv, std::move(systems));
  } catch (const app::NeedsAllMethods&) {
    return app::ask_for_all_methods();
  }
#else
  return app::own_program(argc, argv, std::move(systems));
#endif
}

}  // namespace lagroid
