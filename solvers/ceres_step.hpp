#pragma once
/// One implicit step through Ceres.

#include <lagroid/solvers/ceres_manifold.hpp>
#include <lagroid/solvers/ceres_solve.hpp>
#include <lagroid/solvers/step_solver.hpp>

#include <ceres/ceres.h>

#include <memory>

namespace lagroid {

/// The same equations as `NewtonStep`, as a least-squares problem of zero residual on the alpha-fibre, with tolerances
/// tight enough for momentum conservation. The Ceres problem is built once and reused. What Ceres says of its own
/// success is not believed: the status follows from the residual, evaluated anew.
template <DiscreteSystem Sys> class CeresStep final : public StepSolver<Sys> {
 public:
  using G = typename Sys::GroupoidType;
  using E = StepEquations<Sys>;

  explicit CeresStep(int max_iterations = 100, double tolerance = 0, const G& groupoid = {})
      : manifold_(groupoid), tolerance_(tolerance), options_(detail::to_round_off(max_iterations)) {
    options_.linear_solver_type = ceres::DENSE_QR;
    options_.parameter_tolerance = 1e-17;
    options_.initial_trust_region_radius = 1e16;
    options_.max_trust_region_radius = 1e32;
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    problem_ = std::make_unique<ceres::Problem>(ownership);
    problem_->AddParameterBlock(arrow_.data(), int(arrow_.size()), &manifold_);
    if constexpr (Sys::constraints > 0) {
      problem_->AddResidualBlock(&cost_, nullptr, arrow_.data(), multipliers_.data());
    } else {
      problem_->AddResidualBlock(&cost_, nullptr, arrow_.data());
    }
  }
  CeresStep(const CeresStep&) = delete;
  CeresStep& operator=(const CeresStep&) = delete;

  StepReport solve(const Sys& system, const State<G>& state, StepSolution<Sys>& solution) override {
    Step<Sys>& step = solution.step;
    StepReport report;
    const ScaledResidual<Sys> start(system, state, step, two_sided(system, step.arrow, step.multipliers), cost_.scaling,
                                    /*rescale=*/true);
    if (!std::isfinite(start.norm)) return end(report, SolveStatus::not_finite);
    cost_.system = &system;
    cost_.state = &state;
    arrow_ = system.groupoid.coordinates_of_arrow(step.arrow);
    multipliers_.template head<Sys::constraints>() = step.multipliers;
    report.iterations = int(detail::solve_by_ceres(options_, *problem_).iterations.size());
    step.arrow = manifold_.arrow(arrow_.data());
    step.multipliers = multipliers_.template head<Sys::constraints>();
    const auto derivative = two_sided(system, step.arrow, step.multipliers);
    solution.momentum_change = momentum_change(system, step, derivative);
    const ScaledResidual<Sys> final(system, state, step, derivative, cost_.scaling, /*rescale=*/false);
    report.residual = final.norm;
    report.excess = final.excess;
    if (!std::isfinite(final.norm)) return end(report, SolveStatus::not_finite);
    if (!(final.excess <= accept_excess || final.norm <= tolerance_)) return end(report, SolveStatus::stagnated);
    if constexpr (HasBranch<Sys>) {
      if (!system.admissible(step.arrow)) return end(report, SolveStatus::left_domain);
    }
    return end(report, SolveStatus::converged);
  }

 private:
  static constexpr double accept_excess = 1000;
  static constexpr int multiplier_size = Sys::constraints > 0 ? Sys::constraints : 1;

  static StepReport end(StepReport report, SolveStatus status) {
    report.status = status;
    return report;
  }

  struct Cost final : ceres::CostFunction {
    const AlphaFibreManifold<G>& manifold;
    const Sys* system = nullptr;
    const State<G>* state = nullptr;
    Scaling<E::size> scaling;

    explicit Cost(const AlphaFibreManifold<G>& fibre) : manifold(fibre) {
      set_num_residuals(E::size);
      mutable_parameter_block_sizes()->push_back(AlphaFibreManifold<G>::ambient);
      if constexpr (Sys::constraints > 0) mutable_parameter_block_sizes()->push_back(Sys::constraints);
    }
    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
      const auto g = manifold.arrow(parameters[0]);
      typename Sys::Multipliers lambda;
      for (int a = 0; a < Sys::constraints; ++a) lambda(a) = parameters[1][a];
      const auto d = two_sided(*system, g, lambda);
      Eigen::Map<typename E::Residual> r(residuals);
      r = E::residual(d, state->momentum).cwiseProduct(scaling.row);
      const typename E::Jacobian j = scaling.row.asDiagonal() * E::jacobian(d);
      // A point without derivatives is no point to go on from: Ceres, told so in time, tries a shorter step.
      if (!r.allFinite() || !j.allFinite()) return false;
      if (jacobians == nullptr) return true;
      if (jacobians[0] != nullptr) {
        using J = Eigen::Matrix<double, E::size, AlphaFibreManifold<G>::ambient, Eigen::RowMajor>;
        Eigen::Map<J> out(jacobians[0]);
        out = j.template leftCols<Sys::dimension>() * manifold.coframe(g);
      }
      if constexpr (Sys::constraints > 0) {
        if (jacobians[1] != nullptr) {
          constexpr int layout = Sys::constraints == 1 ? Eigen::ColMajor : Eigen::RowMajor;
          using J = Eigen::Matrix<double, E::size, Sys::constraints, layout>;
          Eigen::Map<J> out(jacobians[1]);
          out = j.template rightCols<Sys::constraints>();
        }
      }
      return true;
    }
  };

  AlphaFibreManifold<G> manifold_;
  double tolerance_;
  Cost cost_{manifold_};
  Vector<double, AlphaFibreManifold<G>::ambient> arrow_;
  Vector<double, multiplier_size> multipliers_ = Vector<double, multiplier_size>::Zero();
  ceres::Solver::Options options_;
  std::unique_ptr<ceres::Problem> problem_;
};

}  // namespace lagroid
