#pragma once
/// Chains of K spherical pendula by hand: the commutator-free method of order 4 on (T*S^2)^K, and RATTLE.

#include "vectors.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace kernels {

/// Masses and rods of equal size, the first from the origin; e3 points up.
struct PendulumParameters {
  double h = 0;
  double mass = 1;
  double length = 1;
  double gravity = 9.81;
};

/// x <- A^{-1} x for the symmetric tridiagonal matrix with these entries, which is lost.
template <std::size_t K>
void solve_tridiagonal(std::array<double, K>& diagonal, const std::array<double, K>& above, std::array<double, K>& x) {
  for (std::size_t i = 0; i + 1 < K; ++i) {
    const double ratio = above[i] / diagonal[i];
    diagonal[i + 1] -= ratio * above[i];
    x[i + 1] -= ratio * x[i];
  }
  x[K - 1] /= diagonal[K - 1];
  for (std::size_t i = K - 1; i-- > 0;) x[i] = (x[i] - above[i] * x[i + 1]) / diagonal[i];
}

/// z = (q_i, p_i), z' = (xi_i x q_i, xi_i x p_i + eta_i x q_i); CF4 of Celledoni, Marthinsen and Owren, its five
/// exponentials of SE(3) by Rodrigues' formula.
template <std::size_t K> class PendulumChainCf4 {
 public:
  using Triples = std::array<Triple, K>;
  struct Twist {
    Triples turn, shift;
  };

  PendulumChainCf4(const PendulumParameters& given, const Triples& q, const Triples& p) : g_(given), q_(q), p_(p) {}

  void step() {
    const double h = g_.h;
    slope(q_, p_, a1_);
    Triples q2 = q_;
    Triples p2 = p_;
    move([&](std::size_t i) { return pair(0.5 * h * a1_.turn[i], 0.5 * h * a1_.shift[i]); }, q2, p2);
    slope(q2, p2, a2_);
    Triples q3 = q_;
    Triples p3 = p_;
    move([&](std::size_t i) { return pair(0.5 * h * a2_.turn[i], 0.5 * h * a2_.shift[i]); }, q3, p3);
    slope(q3, p3, a3_);
    move(
        [&](std::size_t i) {
          return pair(h * a3_.turn[i] - 0.5 * h * a1_.turn[i], h * a3_.shift[i] - 0.5 * h * a1_.shift[i]);
        },
        q2, p2);
    slope(q2, p2, a4_);
    const double w = h / 12;
    const auto both = [&](double first, double last) {
      move(
          [&](std::size_t i) {
            return pair(w * (first * a1_.turn[i] + 2 * (a2_.turn[i] + a3_.turn[i]) + last * a4_.turn[i]),
                        w * (first * a1_.shift[i] + 2 * (a2_.shift[i] + a3_.shift[i]) + last * a4_.shift[i]));
          },
          q_, p_);
    };
    both(3, -1);
    both(-1, 3);
  }

  const Triples& directions() const { return q_; }
  const Triples& momenta() const { return p_; }

 private:
  struct Turn {
    Triple turn, shift;
  };
  static Turn pair(Triple turn, Triple shift) { return {turn, shift}; }

  template <class Of> static void move(const Of& of, Triples& q, Triples& p) {
    for (std::size_t i = 0; i < K; ++i) {
      const auto [u, v] = of(i);
      const double x = dot(u, u);
      double c1, c2, c3;
      if (x < 0.01) {
        c1 = 1 - x / 6 * (1 - x / 20 * (1 - x / 42 * (1 - x / 72)));
        c2 = 0.5 - x / 24 * (1 - x / 30 * (1 - x / 56 * (1 - x / 90)));
        c3 = 1.0 / 6 - x / 120 * (1 - x / 42 * (1 - x / 72 * (1 - x / 110)));
      } else {
        const double a = std::sqrt(x);
        const double half = std::sin(0.5 * a);
        c1 = std::sin(a) / a;
        c2 = 2 * half * half / x;
        c3 = (1 - c1) / x;
      }
      const Triple uq = cross(u, q[i]);
      const Triple up = cross(u, p[i]);
      const Triple uv = cross(u, v);
      const Triple r = v + c2 * uv + c3 * cross(u, uv);
      q[i] = q[i] + c1 * uq + c2 * cross(u, uq);
      p[i] = p[i] + c1 * up + c2 * cross(u, up) + cross(r, q[i]);
    }
  }

  void slope(const Triples& q, const Triples& p, Twist& out) const {
    const double inverse = 1 / g_.mass;
    const double shorten = 1 / g_.length;
    std::array<double, K> diagonal, above, tau;
    for (std::size_t i = 0; i < K; ++i) {
      diagonal[i] = i == 0 ? inverse : 2 * inverse;
      tau[i] = 0;
      if (i + 1 < K) {
        above[i] = -inverse * dot(q[i], q[i + 1]);
        tau[i] += inverse * shorten * dot(q[i], p[i + 1]);
      }
      if (i > 0) tau[i] += inverse * shorten * dot(q[i], p[i - 1]);
    }
    solve_tridiagonal(diagonal, above, tau);
    Triple momentum = shorten * p[0] + tau[0] * q[0];
    Triple before{0, 0, 0};
    for (std::size_t i = 0; i < K; ++i) {
      const Triple next = i + 1 < K ? shorten * p[i + 1] + tau[i + 1] * q[i + 1] : Triple{0, 0, 0};
      const Triple velocity = inverse * (momentum - next);
      out.turn[i] = cross(q[i], shorten * (velocity - before));
      const double weight = g_.gravity * g_.mass * double(K - i) * g_.length;
      out.shift[i] = -g_.length * tau[i] * out.turn[i] + weight * Triple{-q[i].y, q[i].x, 0};
      momentum = next;
      before = velocity;
    }
  }

  PendulumParameters g_;
  Triples q_, p_;
  Twist a1_, a2_, a3_, a4_;
};

/// RATTLE on directions q_i and velocities v_i = q_i', by tensions: Newton's iteration for those that keep |q_i| = 1
/// from the last ones, then the linear equations of those that keep q_i.v_i = 0.
template <std::size_t K> class PendulumChainRattle {
 public:
  using Triples = std::array<Triple, K>;

  PendulumChainRattle(const PendulumParameters& given, const Triples& q, const Triples& v) : g_(given), q_(q), v_(v) {}

  /// False where the iteration does not converge.
  bool step() {
    const double inverse = 1 / g_.mass;
    const double kick = 0.5 * g_.h / g_.length;
    Numbers tension;
    for (std::size_t i = 0; i < K; ++i) tension[i] = end_[i] + gap_[i];
    Triples half, next;
    bool close = false;
    double last = 1;
    for (int iteration = 0; !close; ++iteration) {
      if (iteration == 30) return false;
      Numbers diagonal, above, below, change;
      double worst = 0;
      for (std::size_t i = 0; i < K; ++i) {
        half[i] = v_[i] + kick * pull(q_, tension, i);
        if (i == 0) half[i].z -= kick * g_.gravity;
        next[i] = q_[i] + g_.h * half[i];
        const double off = 0.5 * (dot(next[i], next[i]) - 1);
        worst = std::fmax(worst, std::fabs(off));
        change[i] = off / (kick * g_.h);
        diagonal[i] = (i == 0 ? inverse : 2 * inverse) * dot(next[i], q_[i]);
        if (i + 1 < K) above[i] = -inverse * dot(next[i], q_[i + 1]);
        if (i > 0) below[i] = -inverse * dot(next[i], q_[i - 1]);
      }
      close = worst <= (worst < 0.5 * last ? 4e-16 : 2e-14);
      if (close) break;
      last = worst;
      for (std::size_t i = 0; i + 1 < K; ++i) {
        const double ratio = below[i + 1] / diagonal[i];
        diagonal[i + 1] -= ratio * above[i];
        change[i + 1] -= ratio * change[i];
      }
      change[K - 1] /= diagonal[K - 1];
      for (std::size_t i = K - 1; i-- > 0;) change[i] = (change[i] - above[i] * change[i + 1]) / diagonal[i];
      for (std::size_t i = 0; i < K; ++i) tension[i] += change[i];
    }
    for (std::size_t i = 0; i < K; ++i) gap_[i] = tension[i] - end_[i];
    q_ = next;
    Numbers diagonal, above;
    for (std::size_t i = 0; i < K; ++i) {
      diagonal[i] = i == 0 ? inverse : 2 * inverse;
      if (i + 1 < K) above[i] = -inverse * dot(q_[i], q_[i + 1]);
      end_[i] = dot(q_[i], half[i]) / kick;
    }
    end_[0] -= g_.gravity * q_[0].z;
    solve_tridiagonal(diagonal, above, end_);
    for (std::size_t i = 0; i < K; ++i) v_[i] = half[i] + kick * pull(q_, end_, i);
    v_[0].z -= kick * g_.gravity;
    return true;
  }

  const Triples& directions() const { return q_; }
  const Triples& velocities() const { return v_; }

 private:
  using Numbers = std::array<double, K>;

  Triple pull(const Triples& q, const Numbers& t, std::size_t i) const {
    const double inverse = 1 / g_.mass;
    Triple out = -(i == 0 ? inverse : 2 * inverse) * t[i] * q[i];
    if (i + 1 < K) out = out + inverse * t[i + 1] * q[i + 1];
    if (i > 0) out = out + inverse * t[i - 1] * q[i - 1];
    return out;
  }

  PendulumParameters g_;
  Triples q_, v_;
  Numbers end_{}, gap_{};
};

}  // namespace kernels
