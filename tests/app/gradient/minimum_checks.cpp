// What a table of derivatives of a minimum says of itself where the curvature is small: widths of differences follow
// it, so that right derivatives are not contradicted and wrong ones are.
#include <gradient/minima/minimum_table.hpp>

#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
#include <lagroid/solvers/optimisation/methods/trust_region.hpp>
#include <lagroid/systems/optimisation/random.hpp>
#include <lagroid/systems/optimisation/rayleigh.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app::minimum_checks_tests {
namespace {

using optimisation::ParameterEntry, optimisation::ParametricObjective, optimisation::Point, optimisation::Vector;

/// Rayleigh's quotient whose derivatives by entries are too large by a factor.
class Exaggerated final : public ParametricObjective {
 public:
  Exaggerated(std::shared_ptr<const ParametricObjective> f, double factor) : f_(std::move(f)), factor_(factor) {}
  double evaluate(const Point& x, Vector& gradient) const override { return f_->evaluate(x, gradient); }
  void hessian(const Point& x, const Vector& v, Vector& h) const override { f_->hessian(x, v, h); }
  std::vector<optimisation::ParameterTable> parameters() const override { return f_->parameters(); }
  double parameter(const ParameterEntry& which) const override { return f_->parameter(which); }
  double by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const override {
    const double value = f_->by_parameter(which, x, gradient);
    gradient *= factor_;
    return factor_ * value;
  }
  std::unique_ptr<ParametricObjective> changed(const ParameterEntry& which, double by) const override {
    return std::make_unique<Exaggerated>(f_->changed(which, by), factor_);
  }

 private:
  std::shared_ptr<const ParametricObjective> f_;
  double factor_;
};

/// Of the largest eigenvalue, above another one by so much.
MinimumTable checked(double gap, double factor, const std::vector<std::string>& rows) {
  const Eigen::Index n = 4;
  const Eigen::MatrixXd random = optimisation::random_matrix(n, n, 3);
  const Eigen::MatrixXd turn = random.householderQr().householderQ();
  const Eigen::VectorXd values = Eigen::Vector4d(4, 4 - gap, 2, 1);
  const Eigen::MatrixXd a = turn * values.asDiagonal() * turn.transpose();
  const Exaggerated f(std::make_shared<optimisation::Rayleigh>(
                          optimisation::SymmetricOperator::of(Eigen::MatrixXd((a + a.transpose()) / 2))),
                      factor);
  OptimisationScene scene;
  scene.problem = "rayleigh";
  scene.instance.manifold = std::make_unique<optimisation::Sphere>(n);
  scene.instance.rows = n;
  scene.method = std::make_unique<optimisation::TrustRegion>();
  const ObjectiveNumbers numbers("rayleigh", f, *scene.instance.manifold);
  MinimumRequest request;
  request.of = rows;
  request.check = true;
  MinimumTable out = minimum_table(scene, numbers, request);
  differentiate(scene, f, turn.col(0), out);
  return out;
}

TEST(MinimumChecks, TellRightDerivativesFromWrongOnesWhateverTheCurvature) {
  for (const double gap : {1.0, 1e-3, 1e-5, 1e-6, 1e-7, 1e-8}) {
    for (const auto& rows : {std::vector<std::string>{"minimum"}, {"minimum", "minimiser"}}) {
      const GradientTable right = checked(gap, 1, rows).table;
      EXPECT_EQ(right.failure, "");
      EXPECT_EQ(right.contradicted, std::vector<std::string>{}) << gap;
      EXPECT_EQ(right.untold, std::vector<std::string>{}) << gap;
      EXPECT_GT(checked(gap, 1.1, rows).table.contradicted.size(), 5u) << gap;
    }
  }
}

}  // namespace
}  // namespace lagroid::app::minimum_checks_tests
