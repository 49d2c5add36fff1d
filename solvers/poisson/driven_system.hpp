#pragma once
/// A Poisson system as one step of it sees noise and friction: in place of dH stands the momentum
///
///     p(x) = dH + sum_k (r_k - f_k {H, H_k}) dH_k,    r_k = s_k dW_k / h,    f_k = s_k^2 / 2T,
///
/// H_k the system's noise Hamiltonians. A step of any chart with it is one of the Stratonovich equation
///
///     dX = pi dH dt + sum_k s_k pi dH_k o dW_k - sum_k f_k {H, H_k} pi dH_k dt:
///
/// h p is h dH + sum s_k dW_k dH_k, at the middle. Without friction it is closed, and the step a Poisson map, path by
/// path; with it Casimirs are kept all the same, since they are for every p. The friction is that for which
/// exp(-H / T) times the volume of the symplectic leaves stays as it is. On so(3)* with H_k = M_k and equal s it is the
/// double bracket s^2 / 2T M x (M x Omega); for H_k = positions, of a particle, Langevin's.
///
///     DrivenSystem<EulerTop> top;
///     top.rates = {0.3, 0, 0};
///     const Vector<double, 3> p = top.gradient(Vector<double, 3>(0.8, 0.6, 1.1));
///
/// Requires a system with noise Hamiltonians (core/poisson/poisson_system.hpp). Nothing throws.
///
/// Source: Bismut, Mecanique aleatoire, 1981; Milstein, Repin, Tretyakov, SIAM J. Numer. Anal. 40, 2002; Arnaudon, De
/// Castro, Holm, J. Nonlinear Sci. 28, 2018 (the friction on duals of Lie algebras).

#include <lagroid/core/poisson/poisson_system.hpp>

#include <array>
#include <concepts>
#include <utility>

namespace lagroid {

template <class Sys> struct DrivenSystem : Sys {
  static_assert(noise_count<Sys>() > 0, "a system with noise has noise_names and noise(k, x)");
  static constexpr int n = Sys::dimension;
  static constexpr int sources = noise_count<Sys>();
  using Weights = Vector<double, sources>;

  Weights rates = Weights::Zero();     ///< r_k
  Weights friction = Weights::Zero();  ///< f_k

  explicit DrivenSystem(Sys of = {}) : Sys(std::move(of)) {}

  /// p(x), in place of dH.
  template <class S> Vector<S, n> gradient(const Vector<S, n>& x) const {
    return momentum(x, Sys::template gradient<S>(x), [&](int k) { return noise_gradient(k, x); });
  }
  template <class S> Vector<S, n> velocity(const Vector<S, n>& x) const { return this->field(x, gradient(x)); }

  /// p and its derivative, in place of dH and d^2 H.
  EnergyDerivatives<n> momentum_derivatives(const Vector<double, n>& x) const {
    using J = Jet<double, n>;
    Vector<SecondJet<double, n>, n> at;
    Vector<J, n> moved;
    for (int i = 0; i < n; ++i) {
      at(i) = SecondJet<double, n>::variable(x(i), i);
      moved(i) = J::variable(x(i), i);
    }
    const auto slope = [&](const SecondJet<double, n>& f) {
      Vector<J, n> g;
      for (int i = 0; i < n; ++i) {
        g(i) = J(f.gradient(i));
        for (int j = 0; j < n; ++j) g(i) += (moved(j) - x(j)) * f.hessian(i, j);
      }
      return g;
    };
    const Vector<J, n> p =
        momentum(moved, slope(this->hamiltonian(at)), [&](int k) { return slope(this->noise(k, at)); });
    EnergyDerivatives<n> out;
    for (int i = 0; i < n; ++i) {
      out.gradient(i) = p(i).value;
      for (int j = 0; j < n; ++j) out.hessian(i, j) = p(i).gradient(j);
    }
    return out;
  }

 private:
  template <class S> Vector<S, n> noise_gradient(int k, const Vector<S, n>& x) const {
    if constexpr (std::same_as<S, double>) {
      Vector<Jet<double, n>, n> at;
      for (int i = 0; i < n; ++i) at(i) = Jet<double, n>::variable(x(i), i);
      return this->noise(k, at).gradient();
    } else {
      return gradient_of([this, k](const auto& y) { return this->noise(k, y); }, x);
    }
  }
  template <class S, class Noise>
  Vector<S, n> momentum(const Vector<S, n>& x, const Vector<S, n>& energy, const Noise& of) const {
    Vector<S, n> p = energy;
    for (int k = 0; k < sources; ++k) {
      if (rates(k) == 0 && friction(k) == 0) continue;
      const Vector<S, n> slope = of(k);
      S factor(rates(k));
      if (friction(k) != 0) {
        const Vector<S, n> field = this->field(x, slope);
        for (int i = 0; i < n; ++i) factor -= energy(i) * field(i) * friction(k);
      }
      for (int i = 0; i < n; ++i) p(i) += slope(i) * factor;
    }
    return p;
  }
};

/// p and its derivative: what formulas ask of an energy.
template <class Sys>
EnergyDerivatives<Sys::dimension> energy_derivatives(const DrivenSystem<Sys>& system,
                                                     const Vector<double, Sys::dimension>& x) {
  return system.momentum_derivatives(x);
}

}  // namespace lagroid
