#pragma once
/// Steps of generating functions of types II and III on T*R^n whose n is known when it runs, with constraints of
/// places: Hamiltonian Taylor variational integrators of a Hamiltonian of any size,
///
///     II     p0 + C'(q0)^T lambda = D1 H_d+(q0, p1),    q1 = D2 H_d+(q0, p1),     C(q1) = 0,
///     III    q0 = -D2 H_d-(q1, p0 + C'(q0)^T lambda),   p1 = -D1 H_d-(q1, ...),   H_d-(q, p; h) = -H_d+(q, p; -h).
///
/// They are those of HamiltonianMap<TaylorHamiltonian> (hamiltonian_map.hpp), whose sizes are a type's. The momentum p~
/// from which Taylor's method reaches p1 is an unknown here, held by a multiplier sigma:
///
///     H_d+(q, p1) = stationary value in (p~, sigma) of W = p1.Q(q, p~) + G(q, p~) + <sigma, P(q, p~) - p1>,
///
/// P and Q the ends of Taylor's method of order r and r + 1, G = -h sum b_i (p_i.H_p - H) at the nodes c_i h of the
/// former. A Hamiltonian may depend on the time t: its function is that of t as a coordinate, E_d+(q0, t0, p1) with
/// t1 = t0 + h, looked at from t0 in type II and from t1 in type III.
///
///     GeneratingStep step(hamiltonian, GeneratingType::two);
///     const StepReport report = step.take(z, /*t*/ 0, /*h*/ 0.1);
///
/// Refers to the Hamiltonian. Errors: `singular`, `not_finite`, `not_converged`. Nothing is allocated in a step,
/// nothing throws.
///
/// Source: [V] 5.4.1, (3.19), (3.21).

#include <lagroid/core/derivatives/second_order.hpp>
#include <lagroid/core/hamiltonian/generating_function.hpp>
#include <lagroid/solvers/step/sized_step.hpp>

#include <utility>
#include <vector>

namespace lagroid {

/// H(q, p) with the parts of W, for a step h, behind virtual functions; with first and second derivatives where
/// SecondOrder has them (second_order.hpp).
class SizedHamiltonian {
 public:
  SizedHamiltonian(int dimension, int constraints, int parameters = 0)
      : n_(dimension), k_(constraints), parameters_(parameters) {}
  virtual ~SizedHamiltonian() = default;
  int dimension() const { return n_; }
  int constraints() const { return k_; }
  int parameters() const { return parameters_; }  ///< by which there are derivatives

  /// H at the time t with its derivatives by (q, p).
  virtual void hamiltonian(double t, const double* q, const double* p, double* out) const = 0;
  /// At (q, p~, sigma, p1), from the time t: W with its derivatives by (q, p~); then P, and its n x 2 n derivatives, a
  /// row each; Q and the same.
  virtual void generating(double t, const double* q, const double* p, const double* sigma, const double* far, double h,
                          double* out) const = 0;
  /// C and its derivatives, as SizedLagrangian has them.
  virtual void constraint(const double* q, double* out) const = 0;
  /// Of each parameter in turn the derivatives by it: of the 2 n derivatives of W, of P and of Q.
  virtual void by_parameters(double /*t*/, const double* /*q*/, const double* /*p*/, const double* /*sigma*/,
                             const double* /*far*/, double /*h*/, double* /*out*/) const {}

 private:
  int n_, k_, parameters_;
};

class GeneratingStep final : public SizedStep {
 public:
  /// Type II or III.
  GeneratingStep(const SizedHamiltonian& hamiltonian, GeneratingType type);

  StepReport take(SizedState& z, double t, double h) override;
  bool linearise(SizedState& z, double t, double h, std::vector<SizedSlopes>& stages) override;
  /// v = H_p at p + C'^T nu, which is the tangent momentum.
  void find_velocity(const SizedState& z, double t, TangentState& out) const override;

 private:
  void write_equations(const Eigen::VectorXd& q, const Eigen::VectorXd& p, double t, double h);
  /// Where the function of this type looks from, and how far.
  std::pair<double, double> span(double t, double h) const {
    return type_ == GeneratingType::two ? std::pair(t, h) : std::pair(t + h, -h);
  }

  const SizedHamiltonian& hamiltonian_;
  GeneratingType type_;
  int n_, k_;
  detail::SizedNewton newton_;
  Eigen::VectorXd base_, far_, to_;
  Eigen::MatrixXd reaction_;
  mutable std::vector<double> w_, c_, h_;
};

/// Type III after type II, half a step each: a map and its adjoint, whose product is symmetric and of even order.
class SymmetrisedGeneratingStep final : public ComposedSizedStep {
 public:
  explicit SymmetrisedGeneratingStep(const SizedHamiltonian& hamiltonian);
};

}  // namespace lagroid
