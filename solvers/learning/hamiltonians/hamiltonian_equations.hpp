#pragma once
/// Hamilton's equations with parameters on R^2n, or on T*Q for Q = {g(q) = 0}, with dissipation where it is declared,
///
///     q' = P H_p,    p' = -P H_q + W H_p - P R q'        ([H] (chameq)),
///
/// written for any scalar, so that derivatives in the parameters pass through an integrator. On T*Q, where G p = 0, the
/// W of (wmatr) comes to
///
///     W H_p = P A^T mu - G^T (G G^T)^{-1} A q',    mu = (G G^T)^{-1} G H_p,    A = d/ds G(q + s p) at s = 0,
///
/// which takes one derivative of G in place of one for each coordinate.
///
///     learning::HamiltonianEquations<learning::Polynomial, 1> equations({2, 2}, 1);  // quadratic in (q, p), n
///     const double theta[] = {0, 0, 0.5, 0, 0.5};
///     equations.set(theta);
///     Vector<double, 2> rates;
///     equations(0, Vector<double, 2>(1, 0), rates);
///
/// Requires `set` with size() parameters before anything is evaluated, and for the motion to stay on T*Q a state on it.
/// Nothing throws, and evaluations allocate nothing.
///
/// Source: [H] (proj), (chameq), (wmatr).

#include <lagroid/solvers/learning/functions/rayleigh_dissipation.hpp>
#include <lagroid/solvers/learning/hamiltonians/cotangent_bundle.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid::learning {

/// The field of a ParametricHamiltonian. N is n, or Eigen::Dynamic. Parameters: those of H, then those of
/// RayleighDissipation.
template <class H, int N, class S = double> class HamiltonianEquations {
 public:
  static constexpr int constraints = constraints_of<H, N>();
  using Space = std::conditional_t<constraints == 0, PhaseSpace<N, S>, CotangentBundle<H, N, S>>;
  using Z = Vector<S, twice(N)>;

  HamiltonianEquations(H hamiltonian, int coordinates, Dissipation dissipation = Dissipation::none)
      : hamiltonian_(std::move(hamiltonian)),
        n_(coordinates),
        theta_(std::size_t(hamiltonian_.size())),
        rayleigh_(coordinates, dissipation),
        q_(coordinates),
        p_(coordinates),
        gradient_(2 * coordinates) {
    if constexpr (GivesStateGradient<H, S, N>) scratch_.resize(std::size_t(hamiltonian_.scratch()));
  }

  int size() const { return hamiltonian_.size() + rayleigh_.size(); }
  Space space() const {
    if constexpr (constraints == 0) {
      return {n_};
    } else {
      return Space(hamiltonian_);
    }
  }
  /// R; of no size where none is declared.
  Eigen::MatrixXd dissipation() const requires std::same_as<S, double> {
    return rayleigh_.declared() ? Eigen::MatrixXd(rayleigh_.matrix()) : Eigen::MatrixXd();
  }

  /// `theta` has size() of them.
  void set(const S* theta) {
    for (S& x : theta_) x = *theta++;
    rayleigh_.set(theta);
  }

  [[gnu::noinline]] LAGROID_FLATTEN void operator()(double, const Z& z, Z& f) {
    value_and_gradient(z);
    S* force = gradient_.data();  // H_q, and what dissipation adds to it
    const S* velocity = force + n_;
    if constexpr (constraints == 0) {
      rayleigh_.add(velocity, force, 1);
      for (int i = 0; i < n_; ++i) {
        f(i) = velocity[i];
        f(n_ + i) = -force[i];
      }
    } else {
      const Curvature at = curvature(z);
      const auto mu = at.frame.multipliers(at.frame.across(velocity));
      S* rates = f.data();
      for (int i = 0; i < N; ++i) rates[i] = velocity[i];
      at.frame.subtract(mu, rates);
      rayleigh_.add(rates, force, 1);
      S* push = rates + N;
      for (int i = 0; i < N; ++i) {
        push[i] = -force[i];
        for (int c = 0; c < constraints; ++c) push[i] += at.turn.g(c, i) * mu(c);
      }
      at.frame.subtract(at.frame.multipliers(at.frame.across(push) + at.turn.across(rates)), push);
    }
  }

  /// H.
  S energy(const Z& z) { return value_and_gradient(z); }

 private:
  /// G, and its derivative A along p.
  struct Curvature {
    NormalFrame<constraints, N, S> frame, turn;
  };
  Curvature curvature(const Z& z) const {
    using D = Dual<S>;
    Curvature out;
    Vector<Dual<D>, N> x;
    for (int i = 0; i < N; ++i) x(i) = Dual<D>(D(z(i), z(N + i)), D(S(0.0), S(0.0)));
    for (int i = 0; i < N; ++i) {
      x(i).derivative.value = S(1.0);
      const Vector<Dual<D>, constraints> c = hamiltonian_.constraint(x);
      x(i).derivative.value = S(0.0);
      for (int k = 0; k < constraints; ++k) {
        out.frame.g(k, i) = c(k).derivative.value;
        out.turn.g(k, i) = c(k).derivative.derivative;
      }
    }
    return out;
  }

  /// H and (H_q, H_p), exactly: its own, or those of its energy, direction by direction.
  S value_and_gradient(const Z& z) {
    if constexpr (GivesStateGradient<H, S, N>) {
      return hamiltonian_.gradient(z, theta_.data(), scratch_.data(), gradient_);
    } else {
      using D = Dual<S>;
      for (int i = 0; i < n_; ++i) {
        q_(i) = D(z(i), S(0.0));
        p_(i) = D(z(n_ + i), S(0.0));
      }
      S value(0.0);
      for (int i = 0; i < 2 * n_; ++i) {
        D& x = i < n_ ? q_(i) : p_(i - n_);
        x.derivative = S(1.0);
        const D along = hamiltonian_.template hamiltonian<D, S>(q_, p_, theta_.data());
        x.derivative = S(0.0);
        gradient_(i) = along.derivative;
        value = along.value;
      }
      return value;
    }
  }

  H hamiltonian_;
  int n_;
  std::vector<S> theta_, scratch_;
  RayleighDissipation<N, S> rayleigh_;
  Vector<Dual<S>, N> q_, p_;
  Z gradient_;
};

}  // namespace lagroid::learning
