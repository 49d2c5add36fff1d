#include <lagroid/solvers/ceres_solve.hpp>
#include <lagroid/solvers/newton/ceres_lie.hpp>

#include <ceres/ceres.h>

#include <algorithm>
#include <utility>

namespace lagroid::detail {

namespace {

class ChartCost final : public ceres::CostFunction {
 public:
  ChartCost(const ChartFunction& function, int size) : function_(function) {
    set_num_residuals(size);
    mutable_parameter_block_sizes()->push_back(size);
  }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const int n = num_residuals();
    const bool differentiate = jacobians != nullptr && jacobians[0] != nullptr;
    Eigen::VectorXd f;
    Eigen::MatrixXd derivative;
    if (!function_(Eigen::Map<const Eigen::VectorXd>(parameters[0], n), f, differentiate ? &derivative : nullptr))
      return false;
    Eigen::Map<Eigen::VectorXd>(residuals, n) = f;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    if (differentiate) Eigen::Map<RowMajor>(jacobians[0], n, n) = derivative;
    return true;
  }

 private:
  const ChartFunction& function_;
};

}  // namespace

CeresRoot minimise_by_ceres(const ChartFunction& function, Eigen::VectorXd start, int max_iterations) {
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  ChartCost cost(function, int(start.size()));
  problem.AddResidualBlock(&cost, nullptr, start.data());
  auto options = to_round_off(max_iterations);
  options.linear_solver_type = ceres::DENSE_QR;
  options.parameter_tolerance = 1e-16;
  const int points = int(solve_by_ceres(options, problem).iterations.size());
  return {std::move(start), std::max(0, points - 1)};
}

}  // namespace lagroid::detail
