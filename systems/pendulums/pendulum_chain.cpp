#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/spheres/sphere_integrator.hpp>

#include <cmath>
#include <stdexcept>
#include <string>

namespace lagroid {

namespace {

using Chain = PendulumChain<Eigen::Dynamic>;

/// K = 1 where there is one link, of which the compiler makes use (docs/performance.md).
template <int K> class RattleIntegrator final : public SphereIntegrator {
 public:
  RattleIntegrator(const Chain& chain, const Points& start, const SphereIntegratorOptions& options)
      : chain_(chain),
        form_(options.form),
        rattle_({chain.mass, chain.length, chain.gravity},
                form_ == SphereForm::momenta ? chain.to_velocities(start) : start, options.step, options.composition) {}

  StepReport advance() override { return rattle_.advance(); }
  Points point() const override {
    return form_ == SphereForm::momenta ? chain_.to_momenta(rattle_.point()) : Points(rattle_.point());
  }
  double time() const override { return rattle_.time(); }
  MethodTraits traits() const override { return rattle_.traits(); }
  void serialize(NumberArchive& archive) override { rattle_.serialize(archive); }

 private:
  Chain chain_;
  SphereForm form_;
  ChainRattle<K> rattle_;
};

using RowSpace = SpheresAndVectors<Eigen::Dynamic, RowBatch>;
using ExtrapolatedRotations = ExtrapolationIntegrator<RowSpace, ChainRotationField<Eigen::Dynamic, RowBatch>>;

/// Extrapolation of (q, w) on (S^2 x R^3)^k, of which (TS^2)^k is kept by the field, and by extrapolation as far as the
/// tolerance goes: points are projected to it.
class ExtrapolatedChain final : public detail::ControlledSphereSteps<ExtrapolatedRotations> {
 public:
  ExtrapolatedChain(const Chain& chain, const Points& start, const SphereIntegratorOptions& options)
      : ControlledSphereSteps(
            {RowSpace{{chain.links()}}, ChainRotationField<Eigen::Dynamic, RowBatch>(chain),
             options.form == SphereForm::momenta ? chain.to_velocities(start) : start, detail::control_of(options)},
            options.step),
        chain_(chain),
        form_(options.form) {}

  Points point() const override {
    Points z = ControlledSphereSteps::point();
    chain_.space().project(z);
    return form_ == SphereForm::momenta ? chain_.to_momenta(z) : z;
  }

 private:
  Chain chain_;
  SphereForm form_;
};

}  // namespace

std::unique_ptr<SphereIntegrator> make_chain_integrator(const Chain& chain, const SphereIntegrator::Points& start,
                                                        const SphereIntegratorOptions& options) {
  if (start.cols() != chain.links())
    throw std::invalid_argument("a chain of " + std::to_string(chain.links()) +
                                " links starts from as many points, not " + std::to_string(start.cols()));
  if (options.method == rattle_method.name) {
    if (!std::isfinite(options.step) || options.step == 0)
      throw std::invalid_argument("the steps of rattle are finite and not zero");
    if (options.tolerance != 0) throw std::invalid_argument("rattle estimates no error");
    if (chain.links() == 1) return std::make_unique<RattleIntegrator<1>>(chain, start, options);
    return std::make_unique<RattleIntegrator<Eigen::Dynamic>>(chain, start, options);
  }
  if (options.method == extrapolation_method.name) {
    detail::require_extrapolation(options);
    return std::make_unique<ExtrapolatedChain>(chain, start, options);
  }
  if (options.form == SphereForm::momenta)
    return integrator_on_spheres(ChainMomentumField<Eigen::Dynamic>(chain), start, options);
  return integrator_on_spheres(ChainVelocityField<Eigen::Dynamic>(chain), start, options);
}

}  // namespace lagroid
