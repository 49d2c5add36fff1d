#pragma once
/// Poisson systems, as scenes name them.

#include "../keys/parameter.hpp"
#include "../reading/scene_reader.hpp"

#include <lagroid/core/poisson/bracket_defects.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/solvers/poisson/poisson_integrator.hpp>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// The value of a function of the state, and the size of what its rounding is relative to: |f| + sum |x_i d_i f|.
struct MeasuredFunction {
  double value = 0;
  double size = 0;
};

/// A system with the parameters of its scene.
class AnyPoissonSystem {
 public:
  virtual ~AnyPoissonSystem() = default;
  virtual std::unique_ptr<PoissonIntegrator> begin(const std::vector<double>& start,
                                                   const PoissonOptions& options) const = 0;
  /// The energy, and the Casimirs after it.
  virtual std::vector<MeasuredFunction> measure(const std::vector<double>& x) const = 0;
  virtual BracketDefect bracket_defect(const std::vector<double>& x) const = 0;
  /// Why a motion cannot start at x; empty where it can.
  virtual std::string refusal(const std::vector<double>& x) const = 0;
};

struct PoissonEntry {
  std::string_view name;
  std::string_view summary;
  std::string_view bracket;
  std::vector<std::string> casimirs;  ///< what they are called
  std::vector<std::string> labels;    ///< of the state
  std::vector<std::string> noises;    ///< its noise Hamiltonians
  std::vector<Key> parameters;
  std::vector<const DeclaredMethod*> methods;  ///< the first is what scenes get
  /// Reads [parameters] of a scene.
  std::unique_ptr<AnyPoissonSystem> (*read)(const Section& scene);
};

/// In the order in which they are listed to users.
const std::vector<PoissonEntry>& poisson_entries();
/// The one that the scene names; null where it names none of these.
const PoissonEntry* poisson_entry_of(const Section& scene);

}  // namespace lagroid::app
