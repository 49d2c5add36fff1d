#pragma once
/// Poisson systems, as scenes name them.

#include "../keys/parameter.hpp"
#include "../reading/scene_reader.hpp"

#include <lagroid/core/poisson/bracket_defects.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion.hpp>

#include <memory>
#include <string>
#include <vector>

namespace lagroid::app {

/// The value of a function of the state, and the size of what its rounding is relative to: |f| + sum |x_i d_i f|.
struct MeasuredFunction {
  double value = 0;
  double size = 0;
};

struct NamedNumber {
  std::string name;
  double value;
};

/// A system with the parameters of its scene.
class AnyPoissonSystem {
 public:
  virtual ~AnyPoissonSystem() = default;
  virtual std::unique_ptr<PoissonIntegrator> begin(const std::vector<double>& start,
                                                   const PoissonOptions& options) const = 0;
  /// The energy, and the Casimirs after it.
  virtual std::vector<MeasuredFunction> measure(const std::vector<double>& x) const = 0;
  /// The same, a row each, with derivatives by x and by these parameters. Throws as PoissonIntegrator::slope.
  virtual NodeValues differentiate(const std::vector<double>& x, const std::vector<std::string>& parameters) const = 0;
  /// Its parameters that are numbers.
  virtual std::vector<NamedNumber> numbers() const = 0;
  /// The system with one of these changed.
  virtual std::unique_ptr<AnyPoissonSystem> changed(const std::string& name, double by) const = 0;
  virtual BracketDefect bracket_defect(const std::vector<double>& x) const = 0;
  /// Why a motion cannot start at x; empty where it can.
  virtual std::string refusal(const std::vector<double>& x) const = 0;
};

struct PoissonEntry {
  std::string name;
  std::string summary;
  std::string bracket;
  std::vector<std::string> casimirs;  ///< what they are called
  std::vector<std::string> labels;    ///< of the state
  std::vector<std::string> noises;    ///< its noise Hamiltonians
  std::vector<Key> parameters;
  std::vector<const DeclaredMethod*> methods;  ///< the first is what scenes get
  /// Reads [parameters] of a scene.
  std::unique_ptr<AnyPoissonSystem> (*read)(const Section& scene);
};

}  // namespace lagroid::app
