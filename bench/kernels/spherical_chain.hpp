#pragma once
/// A chain of point masses on massless rods by SHAKE, by hand: the multipliers' tridiagonal equations.

#include "vectors.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace kernels {

/// n equal masses m, each on a rod of length l from the one before, the first from the origin; e3 points up. A step is
///
///     x' = x + h p / m - h^2 g e3 / 2 + (h / m) (lambda_i e_i - lambda_{i+1} e_{i+1}),   e_i = x_i - x_{i-1},
///
/// with (|x'_i - x'_{i-1}|^2 - l^2) / 2 = 0, solved for the multipliers by Newton's iteration from their extrapolation,
/// its matrix factorised once a step. The momenta are the unprojected ones.
class SphericalChain {
 public:
  SphericalChain(double h, double mass, double length, double gravity, std::vector<Triple> place)
      : response_(h / mass),
        length_(length),
        h_(h),
        weight_(h * mass * gravity),
        links_(place.size()),
        place_(std::move(place)),
        momentum_(links_, Triple{0, 0, 0}),
        edge_(links_ + 1, Triple{0, 0, 0}),
        next_(links_ + 1, Triple{0, 0, 0}),
        free_(links_),
        lambda_(links_ + 1, 0.0),
        earlier_{lambda_, lambda_, lambda_},
        diagonal_(links_),
        above_(links_),
        below_(links_),
        right_(links_) {
    for (std::size_t i = 0; i < links_; ++i) edge_[i] = i == 0 ? place_[0] : place_[i] - place_[i - 1];
  }

  /// False where the iteration does not converge.
  bool step() {
    for (std::size_t i = 0; i < links_; ++i) {
      free_[i] = place_[i] + response_ * momentum_[i];
      free_[i].z -= 0.5 * response_ * weight_;
      lambda_[i] = 3 * (earlier_[0][i] - earlier_[1][i]) + earlier_[2][i];
    }
    bool factorised = false;
    double previous = 1;
    for (int iteration = 0; iteration < 30; ++iteration) {
      double worst = 0;
      Triple before{0, 0, 0};
      for (std::size_t i = 0; i < links_; ++i) {
        const Triple x = free_[i] + (response_ * lambda_[i]) * edge_[i] - (response_ * lambda_[i + 1]) * edge_[i + 1];
        next_[i] = x - before;
        place_[i] = x;
        before = x;
        right_[i] = 0.5 * (length_ * length_ - dot(next_[i], next_[i]));
        worst = std::fmax(worst, std::fabs(right_[i]));
      }
      const double residual = worst / (length_ * (length_ + 1));
      if (residual < 4e-16 && (factorised || previous < 4e-16)) {
        accept();
        return true;
      }
      if (factorised && residual > 0.3 * previous) factorised = false;
      previous = residual;
      if (!factorised) factorise();
      factorised = true;
      for (std::size_t i = 1; i < links_; ++i) right_[i] -= below_[i] * right_[i - 1];
      right_[links_ - 1] *= diagonal_[links_ - 1];
      for (std::size_t i = links_ - 1; i-- > 0;) right_[i] = (right_[i] - above_[i] * right_[i + 1]) * diagonal_[i];
      for (std::size_t i = 0; i < links_; ++i) lambda_[i] += right_[i];
    }
    return false;
  }

  const std::vector<Triple>& places() const { return place_; }

 private:
  void factorise() {
    for (std::size_t i = 0; i < links_; ++i) {
      diagonal_[i] = (i == 0 ? 1 : 2) * response_ * dot(next_[i], edge_[i]);
      if (i > 0) below_[i] = -response_ * dot(next_[i], edge_[i - 1]);
      above_[i] = -response_ * dot(next_[i], edge_[i + 1]);
    }
    diagonal_[0] = 1 / diagonal_[0];
    for (std::size_t i = 1; i < links_; ++i) {
      below_[i] *= diagonal_[i - 1];
      diagonal_[i] = 1 / (diagonal_[i] - below_[i] * above_[i - 1]);
    }
  }

  void accept() {
    for (std::size_t i = 0; i < links_; ++i) {
      momentum_[i] = momentum_[i] + lambda_[i] * edge_[i] - lambda_[i + 1] * edge_[i + 1];
      momentum_[i].z -= weight_;
    }
    std::swap(edge_, next_);
    std::swap(earlier_[2], earlier_[1]);
    std::swap(earlier_[1], earlier_[0]);
    std::swap(earlier_[0], lambda_);
  }

  double response_;
  double length_;
  double h_;
  double weight_;
  std::size_t links_;
  std::vector<Triple> place_;
  std::vector<Triple> momentum_;
  std::vector<Triple> edge_;
  std::vector<Triple> next_;
  std::vector<Triple> free_;
  std::vector<double> lambda_;
  std::array<std::vector<double>, 3> earlier_;
  std::vector<double> diagonal_, above_, below_, right_;
};

}  // namespace kernels
