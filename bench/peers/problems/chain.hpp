#pragma once
/// The hanging chain of twenty links.

#include "problem.hpp"

namespace peers {

/// Twenty equal masses on massless rods, of length and mass 1 in all, slanting and wound a little, let go from rest
/// (bench/cases/chain_case.hpp). Unknowns: the rods e_i = x_i - x_{i-1} and their rates u_i. With the tensions m s_i,
///
///     e_i'' = s_{i-1} e_{i-1} - 2 s_i e_i + s_{i+1} e_{i+1},        e_1'' = -s_1 e_1 + s_2 e_2 - g e3,
///
/// and e_i.e_i'' = -|u_i|^2, a tridiagonal system for s. Error: the largest distance of a mass from where it ought to
/// be, and as much of its velocity, in m and m/s. Invariants: energy, vertical angular momentum, the rods' length.
struct ChainProblem {
  static constexpr int links = 20;
  static constexpr int unknowns = 6 * links;
  static constexpr int compared = 6 * links;
  static constexpr int invariants = 3;
  static constexpr double gravity = 9.81;  ///< m/s^2
  template <class S> using Rods = std::array<S, unknowns>;

  static double unit() { return 0.02; }

  /// Where the masses are at first, by threes.
  static std::array<double, 3 * links> places() {
    std::array<double, 3 * links> out{};
    std::array<double, 3> x{};
    for (int i = 0; i < links; ++i) {
      const double winding = 0.6 * i / links;
      const std::array<double, 3> rod{std::sin(1.2) * std::cos(winding), std::sin(1.2) * std::sin(winding),
                                      -std::cos(1.2)};
      for (std::size_t k = 0; k < 3; ++k) out[std::size_t(3 * i) + k] = x[k] += rod[k] / links;
    }
    return out;
  }

  static Rods<double> start() {
    Rods<double> y{};
    const auto x = places();
    for (std::size_t i = 0; i < x.size(); ++i) y[i] = i < 3 ? x[i] : x[i] - x[i - 3];
    return y;
  }

  template <class S> void operator()(const Rods<S>& y, Rods<S>& dy) const {
    constexpr std::size_t n = links;
    const S* e = y.data();
    const S* u = y.data() + 3 * n;
    std::array<S, n> factor;   // of the elimination, e_i.e_{i+1} over the pivot
    std::array<S, n> tension;  // s
    S pivot = 1;
    for (std::size_t i = 0; i < n; ++i, e += 3, u += 3) {
      const S square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
      const S speed = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
      if (i == 0) {
        pivot = 1 / square;
        tension[0] = (speed - S(gravity) * e[2]) * pivot;
      } else {
        const S before = e[0] * e[-3] + e[1] * e[-2] + e[2] * e[-1];
        factor[i - 1] = before * pivot;
        pivot = 1 / (2 * square - before * factor[i - 1]);
        tension[i] = (speed + before * tension[i - 1]) * pivot;
      }
    }
    for (std::size_t i = n - 1; i-- > 0;) tension[i] += factor[i] * tension[i + 1];
    e = y.data();
    for (std::size_t i = 0; i < 3 * n; ++i) dy[i] = y[3 * n + i];
    S* a = dy.data() + 3 * n;
    for (std::size_t k = 0; k < 3; ++k) a[k] = tension[1] * e[3 + k] - tension[0] * e[k];
    a[2] -= S(gravity);
    for (std::size_t i = 1; i + 1 < n; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        a[3 * i + k] =
            tension[i - 1] * e[3 * i + k - 3] - 2 * tension[i] * e[3 * i + k] + tension[i + 1] * e[3 * i + k + 3];
    constexpr std::size_t last = 3 * (n - 1);
    for (std::size_t k = 0; k < 3; ++k)
      a[last + k] = tension[n - 2] * e[last + k - 3] - 2 * tension[n - 1] * e[last + k];
  }

  /// Places, then velocities, of the masses.
  template <class S> static Rods<S> coordinates(const Rods<S>& y) {
    Rods<S> out = y;
    for (std::size_t half = 0; half < unknowns; half += unknowns / 2)
      for (std::size_t i = half + 3; i < half + unknowns / 2; ++i) out[i] += out[i - 3];
    return out;
  }
  template <class S> static S distance(const Rods<S>& a, const Rods<S>& b) {
    using std::fmax;
    S most = 0;
    for (int i = 0; i < unknowns; i += 3) {
      const S at = distance_over(a, b, i, i + 3);
      if (!(at <= most)) most = at;
    }
    return most;
  }
  template <class S> static std::array<S, 3> kept(const Rods<S>& c) {
    using std::sqrt;
    S energy = 0;
    S turning = 0;
    S length = 0;
    const S* v = c.data() + 3 * links;
    for (std::size_t i = 0; i < 3 * std::size_t(links); i += 3) {
      energy += (v[i] * v[i] + v[i + 1] * v[i + 1] + v[i + 2] * v[i + 2]) / 2 + S(gravity) * c[i + 2];
      turning += c[i] * v[i + 1] - c[i + 1] * v[i];
      S square = 0;
      for (std::size_t k = i; k < i + 3; ++k) {
        const S rod = i == 0 ? c[k] : c[k] - c[k - 3];
        square += rod * rod;
      }
      length += sqrt(square);
    }
    return {energy / (links * S(gravity)), turning / links, length};
  }
};

}  // namespace peers
