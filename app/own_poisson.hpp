#pragma once
/// A Poisson system of one's own as a module of a program (own_program.hpp): run, study, sweep, check, view and list
/// then know its scenes, `system = "NAME"`, as they know those of the library's.
///
///     int main(int argc, char** argv) { return lagroid::program(argc, argv, {lagroid::module<RoundedCube>()}); }
///
/// Requires a default constructor, and what PoissonSystem does (core/poisson/poisson_system.hpp).

#include "own_program.hpp"
#include "poisson/poisson_entry_of.hpp"

#include <lagroid/solvers/poisson/poisson_integrators.hpp>

namespace lagroid {

/// Under the class's name, unless another is given.
template <PoissonStructure Sys>
Module module(std::string name = app::snake_case(typeid(Sys)), std::string summary = "a Poisson system") {
  static_assert(Sys::dimension >= 2, "a bracket that is not zero takes two numbers");
  std::vector<std::string> casimirs;
  for (int i = 0; i < casimir_count<Sys>(); ++i) casimirs.push_back(std::to_string(i + 1));
  return {.bracket = std::make_shared<const app::PoissonEntry>(app::poisson_entry<Sys>(
              std::move(name), std::move(summary), "R^" + std::to_string(Sys::dimension), std::move(casimirs)))};
}

}  // namespace lagroid
