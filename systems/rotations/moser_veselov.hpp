#pragma once
/// The free rigid body by the discrete Moser-Veselov algorithm,
///
///     h hat(M) = g D - D g^T,    M' = g^T M,    L(g) = tr(D (1 - g)) / h,    D = tr(I~) / 2 - I~.
///
/// It is explicit (in closed form), keeps energy and momentum, and with preprocessed moments I~ it is of order up to
/// ten.
///
///     const Vector<double, 3> momentum(0.1, 1, 0.1);
///     const auto body = MoserVeselov::preprocessed({1, 2, 3}, momentum, 0.1, 10);  // h, order
///     const auto turn = body.rodrigues(momentum);  // nothing where h is too large
///
/// Requires positive moments, finite numbers and one of the orders 2, 4, 6, 8, 10 (std::invalid_argument); throws
/// std::domain_error where h is too large for the moments or for a step. (Moser and Veselov 1991; Hairer and Vilmart
/// 2006.)

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/systems/instances.hpp>

#include <optional>
#include <vector>

namespace lagroid {

/// The moments of inertia I~ with which a discrete Moser-Veselov step of length h is the free rigid body of moments I,
/// momentum and attitude, to that order (Hairer and Vilmart, J. Phys. A 39 (2006) 13225): in every component
///
///     1 / I~ = (1 / I) (1 + h^2 s_3 + ... + h^{p-2} s_{p-1}) + h^2 d_3 + ... + h^{p-2} d_{p-1},      p = `order`,
///
/// where s and d are polynomials in H = M.I^{-1} M / 2 and |M|^2. These are constants of the motion: once is enough for
/// a trajectory, and h may have either sign.
///
/// Requires order 2 (I~ = I), 4, 6, 8 or 10, positive moments, h other than zero, and all of them finite; throws
/// std::invalid_argument otherwise. Throws std::domain_error for an h so large that a moment I~ is not positive.
Vector<double, 3> preprocess(const Vector<double, 3>& inertia, const Vector<double, 3>& momentum, double h, int order);
/// The same with derivatives. Requires what the other does not throw for. Where all three moments are equal those by
/// the moments are wrong: the axis of the middle one is known by their differences.
Vector<VariedNumber, 3> preprocess(const Vector<VariedNumber, 3>& inertia, const Vector<VariedNumber, 3>& momentum,
                                   double h, int order);

/// Free motion about a fixed point: L(g) = tr(D (1 - g)) / h on SO(3) with D = tr(I~) / 2 - I~ (Moser and Veselov,
/// Commun. Math. Phys. 139 (1991) 217), that is
///
///     h hat(M) = g D - D g^T,   M' = g^T M,   A_k = A_{k-1} g_k.
///
/// The momentum mu is the body angular momentum M. Besides A M the step keeps M.I~^{-1} M, and with it the energy
/// M.I^{-1} M / 2 where 1 / I~ is affine in 1 / I, as it is when preprocessed.
///
/// Closed form: in the quaternion (c, q) of g the equation reads h M / 2 = c I~ q + q x I~ q (Hairer and Vilmart). With
/// k = q.I~ q it becomes linear,
///
///     (I~ - k - hat(u)) r = u,   u = h M / 2,   r = q / c,   M' - M = (4 / h) (I~ r x r) / (1 + |r|^2),
///
/// and k is a constant of the motion, for tr(gD) = tr D - 2 k and the coefficients of the characteristic polynomial of
/// gD are: it is the least root of
///
///     f(k) = (|u|^2 - k tr D + k^2)^2 + e k^2 - det(I~) k + det(I~) u.I~^{-1} u,   e = sum_{i<j} D_i D_j.
///
/// Where f has no positive root, h |M| is too large and there is no step, from no point of the trajectory.
struct MoserVeselov : System<MoserVeselov, SO3> {
  double h = 0.01;
  Vector<double, 3> inertia{1, 2, 3};   ///< principal moments I, kg m^2
  Vector<double, 3> modified{1, 2, 3};  ///< the moments I~ of the Lagrangian
  int order = 2;                        ///< to which `modified` was preprocessed

  /// The method of that order for the trajectories of the same |M| and energy as `momentum`'s, and steps of length h:
  /// with any others it is of order two. Throws as `preprocess` does, and std::domain_error where there is no step.
  static MoserVeselov preprocessed(const Vector<double, 3>& inertia, const Vector<double, 3>& momentum, double h,
                                   int order);

  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const {
    const Vector<ParameterScalar<S>, 3> d = weights<S>() / h;
    return (1.0 - g(0, 0)) * d(0) + (1.0 - g(1, 1)) * d(1) + (1.0 - g(2, 2)) * d(2);
  }

  /// The Rodrigues vector r = tan(angle / 2) axis of the step from M, in closed form; none where there is no step. Of
  /// all solutions of the step equations it is the one that is continuous in h.
  std::optional<Vector<double, 3>> rodrigues(const Vector<double, 3>& momentum) const {
    double k = 0;
    return rodrigues(momentum, k);
  }
  /// The same, searching for the root k from a number below it, which is replaced by the root.
  std::optional<Vector<double, 3>> rodrigues(const Vector<double, 3>& momentum, double& k) const;

  /// Whether g is that solution: k is the least root of f where f' < 0 < f''.
  bool admissible(const Matrix<double, 3, 3>& g) const;

  /// M.I^{-1} M / 2.
  double energy(const State<SO3>& s) const { return 0.5 * s.momentum.cwiseQuotient(inertia).dot(s.momentum); }

  /// The continuous solution after time t, that of RigidBody. Returns M and updates `attitude`.
  State<SO3> reference(const State<SO3>& start, Matrix<double, 3, 3>& attitude, double t) const;

  /// The solution, or the unit where there is none.
  Step<MoserVeselov> first_guess(const State<SO3>& s) const;

  MethodTraits traits() const;
  std::vector<Quantity<MoserVeselov>> quantities() const;

 private:
  /// The diagonal of D.
  template <class S> Vector<ParameterScalar<S>, 3> weights() const {
    const auto& moments = varied<S>(modified);
    return Vector<ParameterScalar<S>, 3>::Constant(0.5 * moments.sum()) - moments;
  }
};

/// The step in closed form: no iteration but that for the one number k. No allocation.
class MoserVeselovStep final : public StepSolver<MoserVeselov> {
 public:
  /// Disregards the guess. `not_converged` where there is no step.
  StepReport solve(const MoserVeselov& system, const State<SO3>& state, StepSolution<MoserVeselov>& solution) override;
  void serialize(NumberArchive& archive) override { archive(root_); }

 private:
  double root_ = 0;  ///< k of the last step
};

LAGROID_STEPS(extern template, MoserVeselov);

/// By MoserVeselovStep, with steps of system.h: any other options are refused (std::invalid_argument).
template <>
std::unique_ptr<Integrator<MoserVeselov>> make_integrator(const MoserVeselov& system, const State<SO3>& initial,
                                                          const Matrix<double, 3, 3>& configuration,
                                                          const IntegratorOptions& options);

/// Throws std::invalid_argument: the moments were made for one step size.
template <>
double step_for_accuracy(const MoserVeselov& system, const State<SO3>& initial, double accuracy,
                         const IntegratorOptions& options);

}  // namespace lagroid
