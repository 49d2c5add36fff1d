#pragma once
/// Potentials that are small networks,
///
///     V = w . a_L,    a_l = tanh(W_l a_{l-1} + b_l),    a_0 = (q_1, ..., q_k).
///
/// For potentials of no known form. No bodies, no layers, layers without units or more than `most` parameters throw
/// std::invalid_argument.

#include <lagroid/core/scalars/elementary.hpp>
#include <lagroid/solvers/learning/potentials/potential.hpp>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace lagroid::learning {

/// V = w . a_L, a_l = tanh(W_l a_{l-1} + b_l), a_0 = (q_1, ..., q_k). No bias at the end: a constant of V moves
/// nothing. Parameters, layer by layer: for each unit its row of W_l, then its b; at the end w.
class NetworkPotential {
 public:
  /// Throws std::invalid_argument unless there are bodies and layers, all with units, and `most` parameters or fewer.
  NetworkPotential(int bodies, std::vector<int> hidden);
  static constexpr int most = 5000;

  const std::vector<int>& hidden() const { return hidden_; }
  int size() const { return size_; }
  int scratch() const { return 2 * units_ + 2 * widest_; }
  /// Random parameters. Inner ones are small, so that V begins near its linear part with all units at work.
  Eigen::VectorXd start(unsigned seed) const;

  template <class S, int K> S gradient(const Positions<S, K>& q, const S* theta, S* scratch, Positions<S, K>& g) const {
    using std::tanh;
    S* a = scratch;            // of all layers
    S* slope = a + units_;     // 1 - a^2
    S* back = slope + units_;  // dV/da of the layer, and of the one below
    S* below = back + widest_;
    const S* input = q.data();
    int inputs = int(q.size());
    const S* at = theta;
    for (const int width : hidden_) {
      for (int u = 0; u < width; ++u, at += inputs + 1) {
        S sum = at[inputs];
        for (int i = 0; i < inputs; ++i) sum += at[i] * input[i];
        a[u] = tanh(sum);
        slope[u] = (1.0 - a[u]) * (1.0 + a[u]);
      }
      input = a;
      inputs = width;
      a += width;
      slope += width;
    }
    S value(0.0);
    for (int u = 0; u < inputs; ++u) {
      value += at[u] * input[u];
      back[u] = at[u];
    }
    for (std::size_t layer = hidden_.size(); layer-- > 0;) {
      const int width = hidden_[layer];
      const int lower = layer > 0 ? hidden_[layer - 1] : int(q.size());
      S* into = layer > 0 ? below : g.data();
      slope -= width;
      at -= width * (lower + 1);
      for (int i = 0; i < lower; ++i) into[i] = S(0.0);
      for (int u = 0; u < width; ++u) {
        const S down = back[u] * slope[u];
        for (int i = 0; i < lower; ++i) into[i] += down * at[u * (lower + 1) + i];
      }
      std::swap(back, below);
    }
    return value;
  }

 private:
  int inputs_;
  std::vector<int> hidden_;
  int size_ = 0;
  int units_ = 0;
  int widest_ = 0;
};

}  // namespace lagroid::learning
