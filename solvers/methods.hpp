#pragma once
/// The methods by which a system can be marched, by name.

#include <lagroid/core/rates.hpp>
#include <lagroid/core/split_system.hpp>
#include <lagroid/core/stepped.hpp>
#include <lagroid/solvers/compositions.hpp>
#include <lagroid/solvers/march.hpp>
#include <lagroid/solvers/splitting.hpp>
#include <lagroid/solvers/step_control.hpp>
#include <lagroid/solvers/transformed.hpp>

#include <span>
#include <string>
#include <vector>

namespace lagroid {

/// What a system has for methods to use.
struct Abilities {
  bool variational = false;
  bool timed = false;
  bool time_scale = false;
  bool rates = false;
  bool attractive = false;
  std::vector<Composition> splittings;  ///< of its flows; empty where it has none
};
template <class Sys> Abilities abilities_of(const Sys& system) {
  Abilities able{Variational<Sys>,      Timed<Sys>, Timed<Sys> && HasTimeScale<Sys>, HasRates<Sys>,
                 AttractiveSystem<Sys>, {}};
  if constexpr (SplitSystem<Sys>) {
    able.splittings.assign(compositions::all.begin(), compositions::all.end());
    for (const auto& of_two_flows : splittings::all)
      if (splits_by(system, of_two_flows)) able.splittings.push_back(of_two_flows);
  }
  return able;
}

/// A method of a system by its name, as studies and `lagroid study --list` know it.
struct NamedMethod {
  std::string name;
  int order = 2;
  int stages = 1;  ///< steps of order two that it is made of
  bool equal_steps = true;
  MarchOptions options{};
  bool to_compare = false;  ///< there to be compared with, and not chosen for anyone
};

/// All that `make_march` takes of a system with these abilities, with Newton's iteration where there is one.
std::vector<NamedMethod> named_methods(const Abilities& able);

/// The compositions of a step of order 2; the step alone where it cannot be taken back.
inline std::span<const Composition> steps_composed(bool composable) {
  return std::span(compositions::all).first(composable ? compositions::all.size() : 1);
}

/// The step's name, and that of the composition where there is more than one stage: "splitting/suzuki-4".
std::string composed_name(const std::string& step, const Composition& composition);

}  // namespace lagroid
