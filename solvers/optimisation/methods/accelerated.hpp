#pragma once
/// Accelerated descent by constrained Hamiltonian maps: with D = x - x_before, the step
///
///     V = P_x(mu D - s grad f(x)),    x+ = x + V + normal vector at x, on the manifold.
///
/// The momentum mu D makes it faster than gradient descent where f is ill-conditioned, at one gradient a step.
/// `RobustDescent` is the setting that we recommend.
///
///     using namespace optimisation;
///     RobustDescent method({}, {.rescale = true, .restart = true});
///     const Result found = minimise(Sphere(3), Height(), Eigen::Vector3d(1, 0, 0), method, {.gradient = 1e-9});
///
/// (`Height` stands in objective.hpp.) Options out of range throw std::invalid_argument, with the remedy; a step that
/// leads off the manifold ends as `no_step`, unless `rescale` shortens it. A manifold without steps with multipliers
/// throws std::invalid_argument: take `Constraint::geodesics` there. [V] Algorithm 1, (3.19)

#include <lagroid/solvers/optimisation/methods/bregman.hpp>
#include <lagroid/solvers/optimisation/minimise.hpp>

#include <string>

namespace lagroid::optimisation {

/// How a step meets the constraint.
enum class Constraint {
  multipliers,  ///< by the constrained type II map ([V] (3.19)): the orthographic step
  projection,   ///< by the unconstrained map and the nearest point ([V] 5.5); in flat space neither does anything
  geodesics     ///< along geodesics, the momentum transported: without a space around, in the manifold's own metric
};

struct AcceleratedOptions {
  std::string name = "accelerated";
  Constraint constraint = Constraint::multipliers;
  bool rescale = false;     ///< shorten a step that leads off the manifold; else there is none
  bool restart = false;     ///< forget the momentum after a step that went uphill
  bool look_ahead = false;  ///< take the gradient where the momentum alone would lead (Nesterov)
};

/// From the point x, reached by the displacement D = x - x_before, the step
///
///     V = P_x(mu D - s grad f(x)),   x+ = x + V + normal vector at x on the manifold.
///
/// This is the type II map with r = 0 and multipliers: mu = alpha_k / alpha_(k-1) and s = alpha_k beta_k, since
/// D = alpha_(k-1) r_k. What P_x takes away and the normal vector belong to the multipliers. Without momenta as
/// variables, which grow like powers of t, nothing cancels. Subclasses say mu and s.
///
/// With `Constraint::geodesics` it is the map's intrinsic form, q+ = exp_q(alpha r+) and r+ transported to q+:
///
///     V = mu D - s grad f(x),   x+ = exp_x(V),   D+ = V, brought to x+ by parallel transport,
///
/// or, where that is not known in closed form, by the manifold's transport.
class Accelerated : public DescentMethod {
 public:
  explicit Accelerated(AcceleratedOptions options) : options_(std::move(options)) {}

  std::string name() const override { return options_.name; }
  void begin(Problem& problem, const EvaluatedPoint& state) override;
  StepOutcome advance(Problem& problem, EvaluatedPoint& state) override;
  /// How often a step was shortened, and the momentum forgotten.
  long shortened() const { return shortened_; }
  long restarts() const { return restarts_; }

 protected:
  struct Shares {
    double momentum;  ///< mu
    double gradient;  ///< s
  };
  bool looks_ahead() const { return options_.look_ahead; }
  virtual void start(Problem& problem, const EvaluatedPoint& state) = 0;
  /// Of the next step.
  virtual Shares next() = 0;
  /// The momentum was forgotten.
  virtual void forget() {}
  /// Whether it wants to know that the gradient changed by `change` over the displacement `moved`.
  virtual bool learning() const { return false; }
  virtual void learn(double, double) {}

 private:
  bool step(const Manifold& manifold, const Point& x);

  AcceleratedOptions options_;
  Vector displacement_, v_, moved_, before_;
  Point to_;
  EvaluatedPoint ahead_;
  long shortened_ = 0;
  long restarts_ = 0;
};

/// With the coefficients of a Bregman Hamiltonian.
struct HamiltonianOptions {
  Bregman bregman;
  double h = 1e-3;
  double start_time = 0.1;
  /// s = alpha beta <= cap / L; infinite: it grows past what is stable, 4 / L ([V] 5.5 bounds its coefficient).
  double cap = 1;
  /// Of the domain, for zeta where lambda is not given; 0: that of the manifold.
  double diameter = 0;
};
class HamiltonianDescent final : public Accelerated {
 public:
  /// Throws std::invalid_argument, with the remedy, for options out of range.
  HamiltonianDescent(HamiltonianOptions hamiltonian, AcceleratedOptions options);

 private:
  void start(Problem& problem, const EvaluatedPoint& state) override;
  Shares next() override;
  void forget() override;

  HamiltonianOptions hamiltonian_;
  Bregman bregman_;
  double time_ = 0;
  double last_alpha_ = 0;
  double largest_ = 0;
};

/// s constant from the start, mu_j = (j / (j + 1))^(power + 1): to leading order the adaptive Hamiltonian with
/// p^2 / po = `power` at the largest stable s, instead of growing towards it (docs/optimisation.md).
struct RobustOptions {
  double c = 2;          ///< s = c / L; stable below 4, with look_ahead below 4 / 3
  double power = 18;     ///< effective p
  double lipschitz = 0;  ///< L, of the Riemannian gradient; 0: the objective's, or found by power steps and on the way
};
class RobustDescent final : public Accelerated {
 public:
  /// Throws std::invalid_argument, with the remedy, for options out of range.
  RobustDescent(RobustOptions robust, AcceleratedOptions options);
  double lipschitz() const { return lipschitz_; }

 private:
  void start(Problem& problem, const EvaluatedPoint& state) override;
  Shares next() override;
  void forget() override { steps_ = 0; }
  bool learning() const override { return !known_; }
  void learn(double change, double moved) override;

  RobustOptions robust_;
  double lipschitz_ = 0;
  bool known_ = false;
  long steps_ = 0;
};

}  // namespace lagroid::optimisation
