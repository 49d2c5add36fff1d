#include "learned_derivatives.hpp"

#include <utility>

namespace lagroid::app {

namespace {

class LearnedDerivatives final : public SphereDerivatives {
 public:
  LearnedDerivatives(std::unique_ptr<learning::ModelDerivatives> model, const SphereIntegratorOptions& options)
      : model_(std::move(model)), method_(lie_group_methods::named(options.method)) {}

  int parameters() const override { return model_->parameters(); }
  bool step(const Points& z, const SphereStep& step, Points& end, Eigen::MatrixXd& by) override {
    model_->step(z, method_, step.size, step.rows, end, by);
    return true;
  }
  /// There is one form.
  Eigen::MatrixXd in_form(const Points& z, SphereForm, SphereForm) const override {
    return Eigen::MatrixXd::Identity(z.size(), z.size() + parameters());
  }
  NodeValues observe(const Points& z) const override {
    const Eigen::Index k = z.cols(), energy = 9 * k, rows = energy + 2;
    NodeValues out{Eigen::VectorXd(rows), Eigen::MatrixXd::Zero(rows, z.size() + parameters())};
    Vector<double, 3> bob = Vector<double, 3>::Zero();
    double vertical = 0;
    for (Eigen::Index i = 0; i < k; ++i) {
      const Vector<double, 3> q = z.col(i).head<3>(), p = z.col(i).tail<3>();
      bob += q;
      out.values.segment<3>(3 * i) = bob;
      out.values.segment<3>(3 * (k + i)) = q;
      out.values.segment<3>(3 * (2 * k + i)) = p;
      for (Eigen::Index below = i; below < k; ++below) out.derivatives.block<3, 3>(3 * below, 6 * i).setIdentity();
      out.derivatives.block<3, 3>(3 * (k + i), 6 * i).setIdentity();
      out.derivatives.block<3, 3>(3 * (2 * k + i), 6 * i + 3).setIdentity();
      vertical += q(0) * p(1) - q(1) * p(0);
      out.derivatives.block<1, 6>(energy + 1, 6 * i) << p(1), -p(0), 0, -q(1), q(0), 0;
    }
    Eigen::MatrixXd by;
    out.values.tail<2>() << model_->energy(z, by), vertical;
    out.derivatives.row(energy) = by;
    return out;
  }

 private:
  std::unique_ptr<learning::ModelDerivatives> model_;
  const LieGroupMethod* method_;  ///< null: extrapolation
};

}  // namespace

std::unique_ptr<SphereDerivatives> learned_derivatives(const LearnedHamiltonian& learned,
                                                       const SphereIntegratorOptions& options,
                                                       std::vector<Eigen::Index> places) {
  return std::make_unique<LearnedDerivatives>(learned.model->derivatives(learned.parameters, std::move(places)),
                                              options);
}

}  // namespace lagroid::app
