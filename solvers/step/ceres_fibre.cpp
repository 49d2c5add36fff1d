#include <lagroid/solvers/ceres_solve.hpp>
#include <lagroid/solvers/step/ceres_fibre.hpp>

#include <ceres/cost_function.h>
#include <ceres/manifold.h>
#include <Eigen/LU>

#include <algorithm>
#include <vector>

namespace lagroid {

namespace {

using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// SourceFibreManifold of any groupoid, which is known by its equations alone.
class AnySourceFibreManifold final : public ceres::Manifold {
 public:
  explicit AnySourceFibreManifold(const FibreEquations& equations) : equations_(equations) {}
  int AmbientSize() const override { return equations_.sizes().ambient; }
  int TangentSize() const override { return equations_.sizes().tangent; }
  bool Plus(const double* x, const double* delta, double* out) const override { return equations_.plus(x, delta, out); }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<ByRows>(jacobian, AmbientSize(), TangentSize()) = frame(x);
    return true;
  }
  // A solve asks for neither of these.
  bool Minus(const double*, const double*, double*) const override { return false; }
  bool MinusJacobian(const double*, double*) const override { return false; }

  Eigen::MatrixXd frame(const double* x) const {
    Eigen::MatrixXd out(AmbientSize(), TangentSize());
    equations_.frame(x, out.data());
    return out;
  }

 private:
  const FibreEquations& equations_;
};

class Cost final : public ceres::CostFunction {
 public:
  Cost(const FibreEquations& equations, const AnySourceFibreManifold& fibre) : equations_(equations), fibre_(fibre) {
    const auto [ambient, tangent, multipliers] = equations.sizes();
    set_num_residuals(tangent + multipliers);
    mutable_parameter_block_sizes()->push_back(ambient);
    if (multipliers > 0) mutable_parameter_block_sizes()->push_back(multipliers);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const auto [ambient, tangent, multipliers] = equations_.sizes();
    const int equations = tangent + multipliers;
    Eigen::MatrixXd jacobian(equations, equations);
    if (!equations_.evaluate(parameters[0], multipliers > 0 ? parameters[1] : nullptr, residuals, jacobian.data()))
      return false;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      // A derivative along the fibre becomes one in arrow coordinates by the left inverse of least norm of the frame.
      const Eigen::MatrixXd f = fibre_.frame(parameters[0]);
      const Eigen::MatrixXd coframe = (f.transpose() * f).inverse() * f.transpose();
      Eigen::Map<ByRows>(jacobians[0], equations, ambient) = jacobian.leftCols(tangent) * coframe;
    }
    if (multipliers > 0 && jacobians[1] != nullptr)
      Eigen::Map<ByRows>(jacobians[1], equations, multipliers) = jacobian.rightCols(multipliers);
    return true;
  }

 private:
  const FibreEquations& equations_;
  const AnySourceFibreManifold& fibre_;
};

}  // namespace

struct FibreProblem::Work {
  AnySourceFibreManifold fibre;
  Cost cost;
  std::vector<double> arrow;
  std::vector<double> multipliers;
  ceres::Solver::Options options;
  ceres::Problem problem;

  Work(const FibreEquations& equations, int max_iterations)
      : fibre(equations),
        cost(equations, fibre),
        arrow(std::size_t(equations.sizes().ambient)),
        multipliers(std::size_t(equations.sizes().multipliers)),
        options(detail::to_round_off(max_iterations)),
        problem(ownership()) {
    options.linear_solver_type = ceres::DENSE_QR;
    options.parameter_tolerance = 1e-17;
    options.initial_trust_region_radius = 1e16;
    options.max_trust_region_radius = 1e32;
    problem.AddParameterBlock(arrow.data(), int(arrow.size()), &fibre);
    std::vector<double*> blocks{arrow.data()};
    if (!multipliers.empty()) blocks.push_back(multipliers.data());
    problem.AddResidualBlock(&cost, nullptr, blocks);
  }
  static ceres::Problem::Options ownership() {
    ceres::Problem::Options out;
    out.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    out.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return out;
  }
};

FibreProblem::FibreProblem(const FibreEquations& equations, int max_iterations)
    : work_(std::make_unique<Work>(equations, max_iterations)) {}
FibreProblem::~FibreProblem() = default;

int FibreProblem::solve(double* arrow, double* multipliers) {
  std::copy_n(arrow, work_->arrow.size(), work_->arrow.data());
  std::copy_n(multipliers, work_->multipliers.size(), work_->multipliers.data());
  const int iterations = int(detail::solve_by_ceres(work_->options, work_->problem).iterations.size());
  std::copy_n(work_->arrow.data(), work_->arrow.size(), arrow);
  std::copy_n(work_->multipliers.data(), work_->multipliers.size(), multipliers);
  return iterations;
}

}  // namespace lagroid
