#pragma once
/// Populations that feed on each other: predator and prey, three species with a Casimir, and a ring of five.
///
///     x' = a x - b x y,    y' = -c y + d x y           {x, y} = x y,  H = a ln y - b y + c ln x - d x
///
/// Their brackets are constant in ln x, and no linear one: a symplectic integrator of canonical coordinates does not
/// apply, a Runge-Kutta method lets the orbits spiral.
///
///     const LotkaVolterra system;
///     const double energy = system.hamiltonian(Vector<double, 2>(2, 0.5));
///
/// Requires positive numbers. Returns as PoissonSystem. Nothing throws.
///
/// Source: Plank, Hamiltonian structures for the n-dimensional Lotka-Volterra equations, 1995.

#include <lagroid/core/parameter.hpp>
#include <lagroid/systems/poisson/log_canonical.hpp>

#include <tuple>

namespace lagroid {

/// Prey x and predators y.
struct LotkaVolterra : LogCanonicalSystem<LotkaVolterra, 2> {
  double growth = 1;     ///< a
  double predation = 1;  ///< b
  double death = 1;      ///< c
  double gain = 1;       ///< d

  static auto parameters() {
    return std::tuple(
        parameter("growth", &LotkaVolterra::growth, "1/s", "of the prey, alone", positive),
        parameter("predation", &LotkaVolterra::predation, "1/s", "of the prey, for each predator", positive),
        parameter("death", &LotkaVolterra::death, "1/s", "of the predators, without prey", positive),
        parameter("gain", &LotkaVolterra::gain, "1/s", "of the predators, for each prey", positive));
  }
  static std::array<std::string, 2> labels() { return {"x", "y"}; }

  Matrix<double, 2, 2> log_coefficients() const { return skew<double, 2>({{0, 1, 1.0}}); }
  static constexpr int parts = 2;
  template <class S> S part(int i, const S& x) const {
    using std::log;
    return i == 0 ? S(log(x) * varied<S>(death) - x * varied<S>(gain))
                  : S(log(x) * varied<S>(growth) - x * varied<S>(predation));
  }
  template <class S> Vector<S, 2> velocity(const Vector<S, 2>& x) const {
    return {x(0) * (varied<S>(growth) - x(1) * varied<S>(predation)),
            x(1) * (x(0) * varied<S>(gain) - varied<S>(death))};
  }
  static constexpr bool in_lanes = true;
  template <class S> S part_slope(int i, const S& x) const {
    return i == 0 ? S(varied<S>(death) / x - varied<S>(gain)) : S(varied<S>(growth) / x - varied<S>(predation));
  }

  /// ln y and ln x, which make growth and death uncertain.
  static constexpr std::array<std::string_view, 2> noise_names{"growth", "death"};
  template <class S> S noise(int k, const Vector<S, 2>& x) const {
    using std::log;
    return log(x(1 - k));
  }
};

/// x1' = x1 (c x2 + x3 + lambda), x2' = x2 (x1 + a x3 + mu), x3' = x3 (b x1 + x2 + nu) with a b c = -1 and
/// nu = mu b - lambda a b: H = a b x1 + x2 - a x3 + nu ln x2 - mu ln x3, Casimir a b ln x1 - b ln x2 + ln x3.
struct ThreeSpecies : LogCanonicalSystem<ThreeSpecies, 3> {
  double a = -2;
  double b = -1;
  double lambda = 0;
  double mu = 1;

  static auto parameters() {
    constexpr NumberRule not_zero{"not zero", [](double x) { return x != 0; }};
    return std::tuple(
        parameter("a", &ThreeSpecies::a, "1", "what x3 does to x2", not_zero),
        parameter("b", &ThreeSpecies::b, "1", "what x1 does to x3; x2 does c = -1 / (a b) to x1", not_zero),
        parameter("lambda", &ThreeSpecies::lambda, "1/s", "growth of x1, alone"),
        parameter("mu", &ThreeSpecies::mu, "1/s", "growth of x2, alone; x3's is mu b - lambda a b"));
  }

  template <class S = double> Matrix<ParameterScalar<S>, 3, 3> log_coefficients() const {
    using P = ParameterScalar<S>;
    const P c = -1.0 / (varied<S>(a) * varied<S>(b));
    return skew<P, 3>({{0, 1, c}, {0, 2, varied<S>(b) * c}, {1, 2, P(-1.0)}});
  }
  static constexpr int parts = 3;
  template <class S> S part(int i, const S& x) const {
    using std::log;
    const auto ab = varied<S>(a) * varied<S>(b);
    if (i == 0) return x * ab;
    return i == 1 ? S(x + log(x) * (varied<S>(mu) * varied<S>(b) - varied<S>(lambda) * ab))
                  : S(-x * varied<S>(a) - log(x) * varied<S>(mu));
  }
  template <class S> Vector<S, 1> casimirs(const Vector<S, 3>& x) const {
    using std::log;
    const auto& of_x2 = varied<S>(b);
    return Vector<S, 1>(log(x(0)) * (varied<S>(a) * of_x2) - log(x(1)) * of_x2 + log(x(2)));
  }
};

/// The Volterra lattice on a ring, x_i' = x_i (x_{i+1} - x_{i-1}): H = sum x_i, Casimir sum ln x_i (N odd).
template <int N> struct VolterraRing : LogCanonicalSystem<VolterraRing<N>, N> {
  static_assert(N >= 3 && N % 2 == 1);
  Matrix<double, N, N> log_coefficients() const {
    Matrix<double, N, N> c;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) c(i, j) = (j == (i + 1) % N) - (i == (j + 1) % N);
    return c;
  }
  static constexpr int parts = N;
  template <class S> S part(int, const S& x) const { return x; }
  template <class S> Vector<S, 1> casimirs(const Vector<S, N>& x) const {
    using std::log;
    S sum = log(x(0));
    for (int i = 1; i < N; ++i) sum += log(x(i));
    return Vector<S, 1>(sum);
  }
};

}  // namespace lagroid
