#include <lagroid/solvers/sensitivity/linearised_poisson_motion.hpp>

#include <utility>

namespace lagroid {

LinearisedPoissonMotion::LinearisedPoissonMotion(std::unique_ptr<PoissonIntegrator> integrator,
                                                 std::vector<std::string> parameters, Observe observe)
    : integrator_(std::move(integrator)),
      names_(std::move(parameters)),
      observe_(std::move(observe)),
      states_(int(integrator_->point().size())),
      // A vector of parameters has as many columns as numbers.
      stage_(0, states_, int(integrator_->slope(names_).cols()) - states_) {}

StepReport LinearisedPoissonMotion::advance() {
  before_ = save();
  return integrator_->advance();
}

bool LinearisedPoissonMotion::linearise() {
  const std::vector<double> after = save();
  restore(before_);
  stage_.end_by_start = integrator_->slope(names_);
  restore(after);
  return stage_.factor();
}

NodeValues LinearisedPoissonMotion::observe() const {
  const std::vector<double> x = integrator_->point();
  if (observe_) return observe_(x);
  return {Eigen::Map<const Eigen::VectorXd>(x.data(), states_),
          Eigen::MatrixXd::Identity(states_, states_ + parameters())};
}

void LinearisedPoissonMotion::serialize(NumberArchive& archive) { integrator_->serialize(archive); }

}  // namespace lagroid
