#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/systems/rotations/moser_veselov.hpp>

namespace lagroid {

template <>
std::unique_ptr<Integrator<MoserVeselov>> make_integrator(const MoserVeselov& system, const State<SO3>& initial,
                                                          const Matrix<double, 3, 3>& configuration,
                                                          const IntegratorOptions& options) {
  if (options.mode != TimeMode::fixed || options.fixed != StepKind::variational || options.composition.stages() > 1)
    throw std::invalid_argument("discrete Moser-Veselov steps are of the length and order they were preprocessed for");
  return std::make_unique<detail::IntegratorOf<MoserVeselov, FixedStepIntegrator<MoserVeselov>>>(
      system, initial, configuration, std::make_unique<MoserVeselovStep>());
}

template <> double step_for_accuracy(const MoserVeselov&, const State<SO3>&, double, const IntegratorOptions&) {
  throw std::invalid_argument("discrete Moser-Veselov steps are of the length they were preprocessed for");
}

}  // namespace lagroid
