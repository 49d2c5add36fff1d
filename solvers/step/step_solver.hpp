#pragma once
/// The interface of everything that solves one implicit step: for (q, mu), the arrow g from q and its multipliers with
///
///     F-(g, lambda) = mu,    phi(g) = 0,    C(beta(g)) = 0.
///
/// All integrators take their solver through it, so that each runs with any solver, one of your own included.
///
///     const Kepler kepler;
///     StepSolution<Kepler> found{{Pair<2>::unit(Vector<double, 2>(1, 0)), {}}, {}};
///     const StepReport report = make_step_solver(kepler, StepMethod::newton)->solve(kepler, {{1, 0}, {0, 1}}, found);
///
/// The solution is given on entry as a first guess whose arrow starts at q. The report has status, iterations and
/// residual; where it is `converged`, the solution holds the step. Failures are a SolveStatus, never an exception; only
/// the solver "ceres" throws, when it is made in a build without Ceres (MissingLibrary). [G] Def. 3.3 and after Def.
/// 3.5

#include <lagroid/core/derivatives/step_equations.hpp>
#include <lagroid/core/number_archive.hpp>
#include <lagroid/solvers/status.hpp>

#include <limits>
#include <memory>

namespace lagroid {

/// What a step solve reports. `residual` is the largest component of the scaled residual; `roundoff_ratio` the largest
/// ratio of a component to what round-off alone would give it (at most one: nothing more can be gained).
struct StepReport {
  SolveStatus status = SolveStatus::not_converged;
  int iterations = 0;
  double residual = 0;
  double roundoff_ratio = 0;
  bool converged() const { return status == SolveStatus::converged; }
};

/// A step with what the solver knows about it.
template <DiscreteSystem Sys, class S = double> struct StepSolution {
  using Fibre = AlgebroidVector<typename Sys::GroupoidType, S>;
  Step<Sys, S> step;
  Fibre momentum_change;  ///< (F+ - F-)(g, lambda)
  /// The correction w in A_{beta(g)}G, g tau(w), that the next iteration would make: below the spacing of the numbers
  /// the arrow is stored in, but a bias when it is lost step after step.
  Fibre remainder = Fibre::Zero();
};

/// Solves F-(g, lambda) = mu, phi(g) = 0, C(beta(g)) = 0 for the arrow g with source q and its multipliers.
template <DiscreteSystem Sys> class StepSolver {
 public:
  virtual ~StepSolver() = default;

  /// On entry `solution.step` is the starting guess (its arrow must have source `state.object`); on convergence it is
  /// the solution, and otherwise the last iterate.
  virtual StepReport solve(const Sys& system, const State<typename Sys::GroupoidType>& state,
                           StepSolution<Sys>& solution) = 0;
  /// Visits what it keeps from one solve to the next, if anything.
  virtual void serialize(NumberArchive&) {}
};

/// The solvers of a step that a user can name.
enum class StepMethod { newton, ceres };

struct StepOptions {
  int max_iterations = 0;  ///< 0: the method's own
  double tolerance = 0;    ///< a scaled residual this small is accepted; 0: iterate to round-off
};

namespace detail {

/// All solvers of a step by their names: complete where `step_methods.hpp` is included.
template <DiscreteSystem Sys> struct StepSolvers;

}  // namespace detail

/// A solver of the named kind. Include `step_methods.hpp` for a system of your own; those of `systems/` are compiled.
template <DiscreteSystem Sys>
std::unique_ptr<StepSolver<Sys>> make_step_solver(const Sys& system, StepMethod method, StepOptions options = {}) {
  constexpr bool included = requires { sizeof(detail::StepSolvers<Sys>); };
  static_assert(included,
                "include <lagroid/solvers/step/step_methods.hpp> to solve steps of a system of your own by name");
  if constexpr (included) return detail::StepSolvers<Sys>::make(system, method, options);
}

/// What round-off in mu, in the products J_ij lambda_j and in the arrow puts into each step equation.
template <DiscreteSystem Sys, class S = double>
typename StepEquations<Sys, S>::Residual round_off_level(const Sys& system,
                                                         const State<typename Sys::GroupoidType, S>& state,
                                                         const Step<Sys, S>& step,
                                                         const typename StepEquations<Sys, S>::Jacobian& jacobian) {
  using std::abs, std::max;
  constexpr int n = Sys::dimension;
  const AlgebroidVector<typename Sys::GroupoidType, S> scale = system.groupoid.coordinate_scale(step.arrow);
  typename StepEquations<Sys, S>::Residual level;
  for (int i = 0; i < n + Sys::constraints; ++i) {
    S size = i < n ? abs(state.momentum(i)) : S(0);
    for (int j = 0; j < n; ++j) size += abs(jacobian(i, j)) * scale(j);
    for (int a = 0; a < Sys::constraints; ++a) size += abs(jacobian(i, n + a)) * abs(step.multipliers(a));
    level(i) = max(S(std::numeric_limits<double>::epsilon() * size), S(std::numeric_limits<double>::min()));
  }
  return level;
}

/// The scaled step equations at one point, with an estimate of how far round-off lets them be solved.
template <DiscreteSystem Sys> struct ScaledResidual {
  using E = StepEquations<Sys>;
  typename E::Residual residual;
  typename E::Jacobian jacobian;
  double norm;            ///< max_i row_i |r_i|
  double roundoff_ratio;  ///< max_i |r_i| / f_i, f the round-off level

  ScaledResidual(const Sys& system, const State<typename Sys::GroupoidType>& state, const Step<Sys>& step,
                 const TwoSidedOf<Sys>& d, Scaling<E::size>& scaling, bool rescale) {
    residual = E::residual(d, state.momentum);
    jacobian = E::jacobian(d);
    if (rescale) scaling = Scaling<E::size>::equilibrate(jacobian);
    const typename E::Residual level = round_off_level(system, state, step, jacobian);
    norm = roundoff_ratio = 0;
    bool finite = true;
    for (int i = 0; i < E::size; ++i) {
      norm = std::max(norm, std::abs(residual(i) * scaling.row(i)));
      roundoff_ratio = std::max(roundoff_ratio, std::abs(residual(i)) / level(i));
      finite = finite && std::isfinite(residual(i)) && std::isfinite(level(i));
      for (int j = 0; j < E::size; ++j) finite = finite && std::isfinite(jacobian(i, j));
    }
    if (!finite || underflows(jacobian, level)) {
      norm = std::numeric_limits<double>::quiet_NaN();
      roundoff_ratio = std::numeric_limits<double>::infinity();
    }
  }

 private:
  /// Whether an equation has no digits left: its round-off is below the normal numbers, and not because the state is
  /// near rest at the origin, but because its coefficients are that small.
  static bool underflows(const typename E::Jacobian& jacobian, const typename E::Residual& level) {
    constexpr double small = 1e-100;
    for (Eigen::Index i = 0; i < level.size(); ++i) {
      double largest = 0;
      for (int j = 0; j < Sys::dimension; ++j) largest = std::max(largest, std::abs(jacobian(i, j)));
      if (level(i) <= std::numeric_limits<double>::min() && largest > 0 && largest < small) return true;
    }
    return false;
  }
};

}  // namespace lagroid
