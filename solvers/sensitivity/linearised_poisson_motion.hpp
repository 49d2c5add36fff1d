#pragma once
/// The motion of a Poisson system as one whose steps are linearised: the derivative of a step by its point and by
/// parameters of the system is exact, of all methods, and the product of these is that of the run.
///
///     LinearisedPoissonMotion motion(make_poisson_integrator(LotkaVolterra{}, {2, 0.5}, {}), {"growth"});
///     const Propagated end = propagate_forward(motion, 100, Eigen::MatrixXd::Identity(3, 3));
///
/// States are the N numbers of the point. What is observed is a function of the point, its derivatives by point and
/// parameters; without one, the point itself. Requires an integrator at its start. Errors: as those of
/// PoissonIntegrator::slope, where it is made.

#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lagroid {

class LinearisedPoissonMotion final : public LinearisedMotion {
 public:
  using Observe = std::function<NodeValues(const std::vector<double>& x)>;

  LinearisedPoissonMotion(std::unique_ptr<PoissonIntegrator> integrator, std::vector<std::string> parameters,
                          Observe observe = nullptr);

  int states() const override { return states_; }
  int parameters() const override { return int(stage_.end_by_start.cols()) - states_; }
  double time() const override { return integrator_->time(); }
  StepReport advance() override;
  bool linearise() override;
  int stages() const override { return 1; }
  const LinearStep& stage(int) const override { return stage_; }
  NodeValues observe() const override;
  void serialize(NumberArchive& archive) override;

 private:
  std::unique_ptr<PoissonIntegrator> integrator_;
  std::vector<std::string> names_;
  Observe observe_;
  int states_;
  LinearStep stage_;
  std::vector<double> before_;  ///< the last step
};

}  // namespace lagroid
