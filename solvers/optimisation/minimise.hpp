#pragma once
/// Minimisation on a manifold, min f(x), x in Q: the loop that all methods share, what stops it, and how it ends.
///
/// A method is one object with two functions, so that all are stopped, recorded and compared in the same way.
///
///     using namespace optimisation;
///     ConjugateGradient method;
///     const Result found = minimise(Sphere(3), Height(), Eigen::Vector3d(1, 0, 0), method, {.gradient = 1e-9});
///     std::cout << to_string(found.outcome) << ' ' << found.value << ' ' << found.message << '\n';
///
/// (`Height` stands in objective.hpp.) Requires a start on the manifold. Returns the best point with value, gradient
/// and effort. Numbers never throw: how it ended is a MinimisationStatus, with a message that names the remedy.

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>
#include <lagroid/solvers/optimisation/objective.hpp>

#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::optimisation {

enum class MinimisationStatus {
  converged,         ///< the gradient, or the value, is as small as the stopping criteria want it
  stagnated,         ///< neither falls any more: what is left is rounding
  stationary_start,  ///< the gradient vanishes where it starts, which need not be a minimum unless f is convex
  iteration_limit,   ///< as many iterations as were allowed
  time_limit,        ///< as long as was allowed
  interrupted,       ///< the callback said so
  infeasible_start,  ///< the start is not on the manifold
  off_manifold,      ///< a penalty was too weak (`minimise_penalised`)
  not_finite,        ///< a NaN or an infinity appeared: in the data, or because the method diverged
  no_step,           ///< the method's step does not exist: the manifold is left, or no step decreases f
};
std::string_view to_string(MinimisationStatus outcome);

/// How much was evaluated.
struct Evaluations {
  long values = 0;  ///< of f alone
  long gradients = 0;
  long hessians = 0;  ///< times a vector
};

/// A point and what is known there.
struct EvaluatedPoint {
  Point x;
  double value = 0;
  Vector euclidean;  ///< D f(x)
  Vector gradient;   ///< the Riemannian gradient; in the metric of the space around, the tangent part of D f(x)
};

/// A manifold and a function on it, which counts evaluations. Refers to both.
class Problem {
 public:
  Problem(const Manifold& manifold, const Objective& objective) : manifold_(manifold), objective_(objective) {}

  const Manifold& manifold() const { return manifold_; }
  const Objective& objective() const { return objective_; }
  /// Value and gradients at state.x.
  void evaluate(EvaluatedPoint& state);
  double value(const Point& x);
  /// The Riemannian Hessian at the state along the tangent vector v.
  void hessian(const EvaluatedPoint& state, const Vector& v, Vector& h);
  const Evaluations& evaluations() const { return evaluations_; }

 private:
  const Manifold& manifold_;
  const Objective& objective_;
  Evaluations evaluations_;
};

/// What a method's step came to.
enum class StepOutcome { taken, none };

/// One way to minimise. It keeps what it needs from step to step, and allocates in `begin` alone.
class DescentMethod {
 public:
  virtual ~DescentMethod() = default;
  virtual std::string name() const = 0;
  /// `state` has been evaluated. Throws std::invalid_argument, with the remedy, where the manifold does not offer what
  /// the method needs.
  virtual void begin(Problem& problem, const EvaluatedPoint& state) = 0;
  /// Moves the state and evaluates it. Where it returns `none` the state is as it was.
  virtual StepOutcome advance(Problem& problem, EvaluatedPoint& state) = 0;
};

/// After an iteration.
struct Iterate {
  long iteration = 0;
  double value = 0;
  double gradient = 0;  ///< |grad f|, in the metric of the manifold
  double seconds = 0;
  Evaluations evaluations;
};

/// What ends the loop; the first that holds.
struct Stopping {
  double gradient = 0;                                      ///< |grad f| at most this; 0: no criterion
  double relative_gradient = 0;                             ///< or this times the one at the start
  double value = -std::numeric_limits<double>::infinity();  ///< f at most this: the minimum, where known, and a gap
  long iterations = 10000;
  double seconds = std::numeric_limits<double>::infinity();
  /// Iterations without a lower value and without a smaller gradient after which rounding is what is left; 0: never.
  long patience = 1000;
};

struct Result {
  MinimisationStatus outcome = MinimisationStatus::not_finite;
  Point x;
  /// Not a number where nothing was evaluated.
  double value = std::numeric_limits<double>::quiet_NaN();
  double gradient = std::numeric_limits<double>::quiet_NaN();
  double residual = std::numeric_limits<double>::quiet_NaN();  ///< of the constraints
  double off_manifold = 0;                                     ///< of a penalty: what it left of them
  long iterations = 0;
  double seconds = 0;
  Evaluations evaluations;
  std::vector<Iterate> history;
  std::string message;  ///< one line where it did not converge, with the remedy

  bool converged() const { return outcome == MinimisationStatus::converged; }
};

/// Sees every iteration; false interrupts.
using Callback = std::function<bool(const Iterate&, const Point&)>;

struct Recording {
  bool history = false;
  Callback callback = nullptr;
};

/// Minimises f from `start`, a point of the manifold. Of methods that do not descend in every step the best point is
/// what is returned. Numbers never throw: how it ended is a MinimisationStatus. A method that the manifold is not made
/// for throws std::invalid_argument, with the remedy.
Result minimise(const Manifold& manifold, const Objective& objective, const Point& start, DescentMethod& method,
                const Stopping& stopping, const Recording& recording = {});

}  // namespace lagroid::optimisation
