#pragma once
/// The interface of everything that solves one boundary-value problem from one starting path.
///
///     const BoundaryProblem<Kepler> problem{Kepler{}, {{1, 0}, {-0.3, 0.8}}};
///     const auto solver = make_boundary_solver<Kepler>(BoundaryMethod::newton);
///     const auto found = solver->solve(problem, geodesic_path(problem, 100), false);  // its multipliers: unknown
///
/// Requires a path whose product is the boundary arrow (`solve` throws std::invalid_argument otherwise), and ends that
/// satisfy the object constraints (`inadmissible_ends`). Returns a BoundarySolution: path, cost, residual, kind of
/// stationary point, and a status; where it is not `converged` the path is the best or last iterate, and a message may
/// say why. (`geodesic_path` is in boundary_guesses.hpp.) From distant guesses use `solve_boundary`
/// (boundary_values.hpp), which has many starts. [G] section 5

#include <lagroid/solvers/boundary/boundary_problem.hpp>
#include <lagroid/solvers/step/optional_members.hpp>

#include <memory>
#include <stdexcept>
#include <utility>

namespace lagroid {

/// What a boundary-value solver looks for.
enum class StationaryKind {
  minima,      ///< of the action: descends it, and stops at saddles only where it cannot tell them from minima
  stationary,  ///< points of any kind: lowers the residual of the equations
};

namespace detail {

template <class Sys> constexpr StationaryKind natural_stationary_kind_of() {
  if constexpr (requires { typename Sys::Untimed; }) {
    return natural_stationary_kind_of<typename Sys::Untimed>();  // the constraint on the step is none on the motion
  } else {
    return Sys::arrow_constraints > 0 ? StationaryKind::minima : StationaryKind::stationary;
  }
}

}  // namespace detail

/// Optimal control, with its arrow constraints, is about minima of the cost. The action of a mechanical system has none
/// in general: its trajectories are stationary, and minimise only up to the first conjugate point.
template <DiscreteSystem Sys>
inline constexpr StationaryKind natural_stationary_kind = detail::natural_stationary_kind_of<Sys>();

struct BoundaryOptions {
  int max_iterations = 200;
  double tolerance = 1e-10;   ///< on the scaled residual, for `converged`; Newton goes on to a thousandth of it
  double feasibility = 1e-9;  ///< largest scaled constraint value at which a path counts as admissible on the way
  double largest_displacement = 1.0;  ///< bound on a node displacement in one iteration, in coordinates of AG
  bool classify = true;               ///< find out what kind of stationary point the solution is
};

template <DiscreteSystem Sys> class BoundarySolverBySizes;

/// Finds a stationary path near a given one. Virtual: one call per solve.
template <DiscreteSystem Sys> class BoundarySolver {
 public:
  explicit BoundarySolver(BoundaryOptions options = {}, StationaryKind kind = natural_stationary_kind<Sys>)
      : options_(options), stationary_kind_(kind) {}
  virtual ~BoundarySolver() = default;

  /// Starts from `path`, whose product must be the boundary arrow and whose ends must satisfy the object constraints.
  /// Multipliers are found from the arrows unless `keep_multipliers` is true, for a path whose own are worth starting
  /// from. Throws std::invalid_argument where `inadmissible_path` has a reason.
  BoundarySolution<Sys> solve(const BoundaryProblem<Sys>& problem, Path<Sys> path, bool keep_multipliers) const {
    if (const auto why = inadmissible_path(problem, path)) throw std::invalid_argument(*why);
    return solve_from(problem, std::move(path), keep_multipliers);
  }
  StationaryKind stationary_kind() const { return stationary_kind_; }

 protected:
  /// `solve`, for a path that is admissible.
  virtual BoundarySolution<Sys> solve_from(const BoundaryProblem<Sys>& problem, Path<Sys> path,
                                           bool keep_multipliers) const = 0;

  /// Cost and, where the options want it, kind of a converged solution.
  template <class Kkt> void describe(const Sys& system, Kkt& kkt, BoundarySolution<Sys>& solution) const {
    solution.cost = action(system, solution.path);
    if (!options_.classify) return;
    kkt.evaluate(system, solution.path);
    kkt.choose_scale();
    solution.kind = kkt.classify(system, solution.path);
  }

  BoundaryOptions options_;
  StationaryKind stationary_kind_;

 private:
  template <DiscreteSystem> friend class BoundarySolverBySizes;  // which has asked for `inadmissible_path`
};

/// The solvers of a boundary-value problem that a user can name.
enum class BoundaryMethod { newton, shooting, ceres };

/// A solver of the named kind, which knows of the system its sizes alone. Include `boundary_methods.hpp` for a system
/// whose sizes the library has not (boundary_sizes.hpp), and `boundary_values.hpp` for others of your own.
template <DiscreteSystem Sys>
std::unique_ptr<BoundarySolver<Sys>> make_boundary_solver(BoundaryMethod method = BoundaryMethod::newton,
                                                          BoundaryOptions options = {},
                                                          StationaryKind kind = natural_stationary_kind<Sys>);

}  // namespace lagroid
