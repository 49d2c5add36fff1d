#pragma once
/// Integrators on Poisson manifolds by a method chosen at run time, with equal steps.
///
///     const auto motion = make_poisson_integrator(LotkaVolterra{}, {2, 0.5}, {.method = "splitting", .step = 0.05});
///     while (motion->time() < 10 && motion->advance().converged()) {
///     }
///
/// For a system of your own include <lagroid/solvers/poisson/poisson_integrators.hpp>; those of systems/poisson/ are
/// compiled. Requires a start in the system's domain. Throws std::invalid_argument for a method that the system does
/// not have, a step that is zero or not finite, compositions of methods that have none, and noise that cannot be
/// (noisy_steps.hpp). `advance` reports a status;
/// unless it is `converged` everything stays as it was.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/poisson/poisson_system.hpp>
#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/poisson/kept_structure.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid {

/// What drives a system along the fields of its noise Hamiltonians (driven_system.hpp).
struct NoiseOptions {
  std::vector<double> strength = {};  ///< of each of them; none: there is no noise
  std::uint64_t seed = 1;
  std::uint32_t path = 0;  ///< which of the seed's
  double temperature = 0;  ///< of the thermostat, whose friction comes with the noise; 0: there is none
  bool project = false;    ///< after each step to the Casimirs of the start, from which rounding walks away otherwise

  bool present() const { return !strength.empty(); }
};

struct PoissonOptions {
  std::string method = "symplectic-groupoid";  ///< of poisson_methods
  double step = 0.01;
  Composition composition = compositions::single;  ///< of a step of order two
  NoiseOptions noise = {};
  double tolerance = 1e-9;               ///< of steps that go by one
  std::function<bool()> stop = nullptr;  ///< called before each of these; true ends the advance, unconverged
};

/// A trajectory in the making. A step that does not converge leaves everything as it was.
class PoissonIntegrator {
 public:
  virtual ~PoissonIntegrator() = default;
  virtual StepReport advance() = 0;
  virtual std::vector<double> point() const = 0;
  /// Goes on from another state at this time. Requires as many numbers.
  virtual void go_on_from(const std::vector<double>& point) = 0;
  virtual double time() const = 0;
  virtual MethodTraits traits() const = 0;
  virtual KeptStructure kept() const = 0;
  /// D Phi at the present point, Phi the next step: columns by the point, and then by these parameters of the system,
  /// with noise on its path. Not numbers where the step does not converge. Throws std::invalid_argument for a name that
  /// is no parameter; WithoutDerivative for a parameter that the system reads as a plain number. By a tolerance D holds
  /// the sizes and rows of the inner steps that it asks for (held_steps.hpp).
  virtual Eigen::MatrixXd slope(const std::vector<std::string>& parameters) const = 0;
  /// The largest entry of D pi D^T - pi(Phi) over the largest of pi(Phi), Phi the next step and D its derivative; not a
  /// number where the method goes by a tolerance.
  virtual double poisson_defect() const = 0;
  /// Visits all that the next step goes on from: an integrator begun with the same arguments, to which it is restored,
  /// goes on with the same bits.
  virtual void serialize(NumberArchive& archive) = 0;
};

/// The names of the methods that the system has, the usual one first. Noise goes with those of which
/// poisson_methods::takes_noise is true.
template <class Sys> std::vector<std::string_view> poisson_methods_of();

template <class Sys>
std::unique_ptr<PoissonIntegrator> make_poisson_integrator(const Sys& system,
                                                           const Vector<double, Sys::dimension>& start,
                                                           const PoissonOptions& options);

}  // namespace lagroid
