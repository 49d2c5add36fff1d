#pragma once
/// A chain of classical spins: Heisenberg's, with an axis that is easy or hard and a field along it,
///
///     S_i' = S_i x dH/dS_i,    H = - J sum (S_i . S_{i+1} + (delta - 1) S_iz S_{i+1,z}) - B sum S_iz,
///
/// on K copies of so(3)*. Each spin keeps its length. With noise along every spin's axes and a temperature it is the
/// stochastic equation of Landau, Lifshitz and Gilbert.
///
///     const SpinChain<3> chain;
///     const Vector<double, 9> first_up = Vector<double, 9>::Unit(2);
///     const double energy = chain.hamiltonian(first_up);
///
/// Returns as PoissonSystem. Nothing throws.
///
/// Source: Landau and Lifshitz, On the theory of the dispersion of magnetic permeability in ferromagnetic bodies, 1935.

#include <lagroid/core/parameter.hpp>
#include <lagroid/core/poisson/poisson_system.hpp>

#include <tuple>

namespace lagroid {

template <int K> struct SpinChain : PoissonSystem<SpinChain<K>, 3 * K> {
  static constexpr int n = 3 * K;
  double coupling = 1;
  double anisotropy = 1;
  double magnetic_field = 0.5;

  static auto parameters() {
    return std::tuple(parameter("coupling", &SpinChain::coupling, "1/s", "J of neighbours"),
                      parameter("anisotropy", &SpinChain::anisotropy, "1", "delta: coupling along z over J"),
                      parameter("magnetic_field", &SpinChain::magnetic_field, "1/s", "B, along z"));
  }
  static std::array<std::string, n> labels() {
    std::array<std::string, n> out;
    for (int i = 0; i < n; ++i) out[std::size_t(i)] = "S" + std::to_string(i / 3 + 1) + std::string(1, "xyz"[i % 3]);
    return out;
  }

  /// S' = S x dH/dS: K symplectic groupoids of SO(3).
  static constexpr double rotation_sign = 1;
  template <class S> Matrix<S, n, n> bivector(const Vector<S, n>& x) const {
    auto pi = skew<S, n>({});
    for (int a = 0; a < n; a += 3)
      for (int i = 0; i < 3; ++i) set_skew<S>(pi, a + i, a + (i + 1) % 3, -x(a + (i + 2) % 3));
    return pi;
  }
  template <class S> S hamiltonian(const Vector<S, n>& x) const {
    S plane(0.0);
    S along(0.0);
    S sum(0.0);
    for (int a = 0; a < n; a += 3) {
      sum += x(a + 2);
      if (a + 3 == n) break;
      plane += x(a) * x(a + 3) + x(a + 1) * x(a + 4);
      along += x(a + 2) * x(a + 5);
    }
    return -(plane + along * varied<S>(anisotropy)) * varied<S>(coupling) - sum * varied<S>(magnetic_field);
  }
  template <class S> Vector<S, K> casimirs(const Vector<S, n>& x) const {
    Vector<S, K> out;
    for (int i = 0; i < K; ++i)
      out(i) = (x(3 * i) * x(3 * i) + x(3 * i + 1) * x(3 * i + 1) + x(3 * i + 2) * x(3 * i + 2)) * 0.5;
    return out;
  }

  /// Its own field along each axis, of every spin.
  static constexpr auto noise_names = [] {
    constexpr std::string_view all =
        "S1xS1yS1zS2xS2yS2zS3xS3yS3zS4xS4yS4zS5xS5yS5zS6xS6yS6zS7xS7yS7zS8xS8yS8zS9xS9yS9z";
    static_assert(K <= 9);
    std::array<std::string_view, n> names;
    for (std::size_t i = 0; i < n; ++i) names[i] = all.substr(3 * i, 3);
    return names;
  }();
  template <class S> S noise(int k, const Vector<S, n>& x) const { return x(k); }
};

}  // namespace lagroid
