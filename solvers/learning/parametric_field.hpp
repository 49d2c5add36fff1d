#pragma once
/// Hamilton's equations on (T*S^2)^k, as an element of the algebra se(3)^k at each point,
///
///     F = (q_i x v_i, dV/dq_i x q_i - tau_i q_i x v_i),    H = 1/2 p^T M(q)^{-1} p + V(q),
///
/// with parameters of mass matrix and potential, and of dissipation where it is declared. Written for any scalar, so
/// that derivatives in the parameters pass through an integrator. Requires `set` with size() parameters before anything
/// is evaluated. [H] (mapfham), (mmatrp)

#include <lagroid/groupoids/spheres.hpp>
#include <lagroid/solvers/learning/functions/rayleigh_dissipation.hpp>
#include <lagroid/solvers/learning/potentials/potential.hpp>

#include <cmath>
#include <concepts>
#include <vector>

namespace lagroid::learning {

/// How many parameters a mass matrix of k bodies has.
constexpr int mass_size(int bodies) { return bodies * (bodies + 1) / 2; }

/// F[H] of [H] (mapfham) for the Hamiltonian of the Lagrangian 1/2 sum m_ij q_i'.q_j' - V. There M_ij = m_ij (I - q_i
/// q_i^T) of [H] (mmatrp) is meant as a form on tangent vectors: as a block matrix it is not symmetric. The velocities
/// v of momenta p solve
///
///     sum_j m_ij v_j = p_i + tau_i q_i,   q_i.v_i = 0,
///     (m^{-1})_ij (q_i.q_j) tau_j = -(m^{-1})_ij q_i.p_j      (k equations, positive definite by Schur's theorem),
///
/// and from d/dt (p_i + tau_i q_i) = -dV/dq_i + lambda_i q_i,
///
///     F = (q_i x v_i, dV/dq_i x q_i - tau_i q_i x v_i),
///
/// which is F[H] up to what leaves (q_i, p_i) fixed. Dissipation -P sum_j R_ij v_j in p_i' adds sum_j R_ij v_j to
/// dV/dq_i.
///
/// m = L L^T, L lower triangular with diagonal exp(s_i): every vector of parameters then is a positive definite m, each
/// m belongs to one, and equal steps in s_i are equal factors, whatever the unit of mass. Parameters: the rows of L,
/// one after the other, with s_i in place of L_ii; then those of the potential; then those of RayleighDissipation.
template <class P, int K, class S = double> class ParametricField {
 public:
  using Space = CotangentSpheres<K, S>;
  using Z = typename Space::Point;
  using V = Vector<S, 3>;
  using Square = Eigen::Matrix<S, K, K>;

  ParametricField(P potential, int bodies, Dissipation dissipation = Dissipation::none)
      : potential_(std::move(potential)),
        bodies_(bodies),
        theta_(std::size_t(potential_.size())),
        scratch_(std::size_t(scratch_of(potential_))),
        rayleigh_(bodies, dissipation),
        mass_(bodies, bodies),
        inverse_(bodies, bodies),
        gram_(bodies, bodies),
        tau_(bodies),
        place_(3, bodies),
        gradient_(3, bodies),
        velocity_(3, bodies) {}

  const P& potential() const { return potential_; }
  int bodies() const { return K == Eigen::Dynamic ? bodies_ : K; }
  Space space() const { return {bodies()}; }
  int size() const { return mass_size(bodies()) + potential_.size() + rayleigh_.size(); }
  const Square& mass() const { return mass_; }
  /// R; of no size where none is declared.
  Eigen::MatrixXd dissipation() const requires std::same_as<S, double> {
    return rayleigh_.declared() ? Eigen::MatrixXd(rayleigh_.matrix()) : Eigen::MatrixXd();
  }

  /// `theta` has size() of them.
  void set(const S* theta) {
    using std::exp;
    const int k = bodies();
    Square l(k, k);
    for (int i = 0; i < k; ++i)
      for (int j = 0; j < k; ++j) l(i, j) = j < i ? *theta++ : j == i ? S(exp(*theta++)) : S(0.0);
    for (int i = 0; i < k; ++i)
      for (int j = 0; j < k; ++j) {
        S sum(0.0);
        for (int n = 0; n <= std::min(i, j); ++n) sum += l(i, n) * l(j, n);
        mass_(i, j) = sum;
      }
    // The columns of L^{-1}, then m^{-1} = L^{-T} L^{-1}.
    Square inverse(k, k);
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < k; ++i) {
        S sum(i == j ? 1.0 : 0.0);
        for (int n = j; n < i; ++n) sum -= l(i, n) * inverse(n, j);
        inverse(i, j) = i < j ? S(0.0) : S(sum / l(i, i));
      }
    for (int i = 0; i < k; ++i)
      for (int j = 0; j < k; ++j) {
        S sum(0.0);
        for (int n = std::max(i, j); n < k; ++n) sum += inverse(n, i) * inverse(n, j);
        inverse_(i, j) = sum;
      }
    for (S& x : theta_) x = *theta++;
    rayleigh_.set(theta);
  }

  [[gnu::noinline]] LAGROID_FLATTEN void operator()(double, const Z& z, Z& f) {
    solve(z);
    value_and_gradient<P, S, K>(potential_, place_, theta_.data(), scratch_.data(), gradient_);
    rayleigh_.add(velocity_.data(), gradient_.data(), 3);
    for (int i = 0; i < bodies(); ++i) {
      const V q = place_.col(i);
      const V xi = cross(q, V(velocity_.col(i)));
      const V force = gradient_.col(i);
      Space::set(f, i, xi, cross(force, q) - xi * tau_(i));
    }
  }

  S potential_energy(const Z& z) {
    place_ = z.template topRows<3>();
    return value_and_gradient<P, S, K>(potential_, place_, theta_.data(), scratch_.data(), gradient_);
  }
  /// H.
  S energy(const Z& z) {
    S sum = potential_energy(z);
    solve(z);
    for (int i = 0; i < bodies(); ++i) sum += Space::second(z, i).dot(V(velocity_.col(i))) * 0.5;
    return sum;
  }

 private:
  /// q, tau and v of z.
  void solve(const Z& z) {
    const int k = bodies();
    for (int i = 0; i < k; ++i) {
      const V q = Space::first(z, i);
      place_.col(i) = q;
      tau_(i) = S(0.0);
      for (int j = 0; j < k; ++j) {
        tau_(i) -= inverse_(i, j) * q.dot(Space::second(z, j));
        if (j <= i) gram_(i, j) = inverse_(i, j) * q.dot(Space::first(z, j));
      }
    }
    // Without square roots: gram = U D U^T.
    for (int j = 0; j < k; ++j) {
      for (int i = j + 1; i < k; ++i) {
        const S ratio = gram_(i, j) / gram_(j, j);
        for (int n = j + 1; n <= i; ++n) gram_(i, n) -= ratio * gram_(n, j);
        tau_(i) -= ratio * tau_(j);
      }
    }
    for (int j = k; j-- > 0;) {
      for (int i = j + 1; i < k; ++i) tau_(j) -= gram_(i, j) * tau_(i);
      tau_(j) /= gram_(j, j);
    }
    for (int i = 0; i < k; ++i) {
      V v = V::Zero();
      for (int j = 0; j < k; ++j) v += (Space::second(z, j) + V(place_.col(j)) * tau_(j)) * inverse_(i, j);
      velocity_.col(i) = v;
    }
  }

  P potential_;
  int bodies_;
  std::vector<S> theta_, scratch_;
  RayleighDissipation<K, S> rayleigh_;
  Square mass_, inverse_, gram_;
  Vector<S, K> tau_;
  Positions<S, K> place_, gradient_, velocity_;
};

}  // namespace lagroid::learning
