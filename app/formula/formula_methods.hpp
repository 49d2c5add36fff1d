#pragma once
/// The methods of systems that scenes hold as formulas: curves of a Lagrangian, generating functions of a Hamiltonian.
///
///     const CurveMethod method = read_curve_method(time, constrained);
///     FormulaMethod begun = method.begun(*lagrangian);
///
/// Errors: SceneError for a method that is none, or does not take what is asked of it.

#include "../families/references.hpp"
#include "../keys/key.hpp"

#include <lagroid/run/formula/formula_hamiltonian.hpp>
#include <lagroid/run/formula/formula_lagrangian.hpp>
#include <lagroid/run/formula/formula_motion.hpp>
#include <lagroid/run/study/method.hpp>
#include <lagroid/solvers/galerkin/curve_step.hpp>

#include <memory>
#include <vector>

namespace lagroid::app {

/// Steps along curves of a Lagrangian.
struct CurveMethod {
  MethodTraits traits;  ///< of a system without forces
  CurveChoice curve;
  Composition composition;
  Source source;

  FormulaMethod begun(const FormulaLagrangian& lagrangian) const;
};
CurveMethod read_curve_method(const Section& time, bool constrained);
std::vector<Method> curve_methods(bool constrained);
/// The keys of [time], besides the grid.
std::vector<Key> curve_method_keys();

/// Steps of a Hamiltonian by generating functions of type II, III, or both in turn.
struct GeneratingMethod {
  MethodTraits traits;
  TaylorChoice taylor;
  enum class Types { two, three, both } types;
  Composition composition;

  FormulaMethod begun(const FormulaHamiltonian& hamiltonian) const;
};
inline constexpr Source generating_source{"duruisseaux2022", "Hamiltonian Taylor variational integrators"};
GeneratingMethod read_generating_method(const Section& time, bool constrained);
std::vector<Method> generating_methods(bool constrained);
std::vector<Key> generating_method_keys();

}  // namespace lagroid::app
