#pragma once
/// Hamiltonian motion on (T*S^2)^k from any energy H(q, p), as a map to the algebra se(3)^k:
///
///     F[H](q, p) = (q x dH/dp, dH/dq x q + dH/dp x p).
///
/// A class with `energy` is a vector field for every Lie group integrator; its gradient is automatic.
///
///     struct Rod {
///       template <class S> S energy(const Eigen::Matrix<S, 6, 1>& z) const {
///         return z.template tail<3>().squaredNorm() * 0.5 + z(2);
///       }
///     };
///     inline const HamiltonianField<Rod, 1> field{Rod{}};
///
/// Requires an energy over any scalar, or one with a gradient of its own. [H] (mapfham), (hameqpend)

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/groupoids/spheres.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

namespace lagroid {

/// An energy that also writes its gradient, in any scalar S: dH <- (dH/dq_i, dH/dp_i), 6 x k.
template <class H, int K, class S>
concept HasGradient = requires(H& h, const typename CotangentSpheres<K, S>::Point& z,
                               typename CotangentSpheres<K, S>::Point& gradient) {
  h.gradient(z, gradient);
};

/// F[H] of [H] (mapfham), factor by factor:
///
///     F[H](q, p) = (q x dH/dp, dH/dq x q + dH/dp x p),
///
/// so that z' = F[H](z)_M(z) are Hamilton's equations on (T*S^2)^k, [H] (hameqpend): q' = (I - q q^T) dH/dp,
/// p' = -(I - q q^T) dH/dq + dH/dp x (p x q). The values of H off T*S^2 do not matter to the motion.
///
/// `H` supplies template <class S> S energy(const Eigen::Matrix<S, 6, K>& z) const, z holding (q_i, p_i) in column i;
/// its gradient is deduced, exactly, unless it has one of its own (HasGradient).
template <class H, int K, class S = double> class HamiltonianField {
 public:
  using Space = CotangentSpheres<K, S>;
  using Z = typename Space::Point;
  using V = Vector<S, 3>;

  explicit HamiltonianField(H hamiltonian, int count = K == Eigen::Dynamic ? 1 : K)
      : hamiltonian_(std::move(hamiltonian)), gradient_(Z::Zero(6, count)) {
    if constexpr (!HasGradient<H, K, S>) seeded_ = Seeded::Zero(6, count);
  }

  const H& hamiltonian() const { return hamiltonian_; }
  H& hamiltonian() { return hamiltonian_; }

  void operator()(double, const Z& z, Z& f) {
    differentiate(z);
    for (int i = 0; i < z.cols(); ++i) {
      const V q = Space::first(z, i);
      const V of_q = Space::first(gradient_, i);
      const V of_p = Space::second(gradient_, i);
      Space::set(f, i, cross(q, of_p), cross(of_q, q) + cross(of_p, Space::second(z, i)));
    }
  }

 private:
  // Eigen aligns arrays of run-time size to 16 bytes: two doubles.
  static constexpr int lanes = K == Eigen::Dynamic ? 2 : 6;
  using Seed = std::conditional_t<std::same_as<S, double>, Jet<double, lanes>, Dual<S>>;
  using Seeded = Eigen::Matrix<Seed, 6, K>;

  void differentiate(const Z& z) {
    if constexpr (HasGradient<H, K, S>) {
      hamiltonian_.gradient(z, gradient_);
    } else if constexpr (std::same_as<S, double>) {
      for (Eigen::Index i = 0; i < z.size(); ++i) seeded_.data()[i] = Seed(z.data()[i]);
      for (int i = 0; i < z.cols(); ++i) {
        for (int first = 0; first < 6; first += lanes) {
          for (int j = first; j < first + lanes; ++j) seeded_(j, i) = Seed::variable(z(j, i), j - first);
          const Seed energy = hamiltonian_.energy(seeded_);
          for (int j = first; j < first + lanes; ++j) {
            gradient_(j, i) = energy.gradient(j - first);
            seeded_(j, i) = Seed(z(j, i));
          }
        }
      }
    } else {
      value_and_gradient_of([this](const Seeded& at) { return hamiltonian_.energy(at); }, z, seeded_, gradient_);
    }
  }

  H hamiltonian_;
  Z gradient_;
  Seeded seeded_{};
};

}  // namespace lagroid
