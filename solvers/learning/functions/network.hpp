#pragma once
/// Small networks of some numbers x, with their gradients, in any scalar:
///
///     f = w . a_L,    a_l = tanh(W_l a_{l-1} + b_l),    a_0 = x.
///
/// For functions of no known form. What potentials on spheres (NetworkPotential) and Hamiltonians of (q, p) are made
/// of.
///
///     const learning::Network f(2, {8});            // of two numbers, one hidden layer of eight units
///     const Eigen::VectorXd theta = f.start(1);     // random parameters of this seed
///
/// No inputs, no layers, layers without units or more than `most` parameters throw std::invalid_argument.

#include <lagroid/core/scalars/elementary.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::learning {

/// w . a_L, a_l = tanh(W_l a_{l-1} + b_l), a_0 = x. No bias at the end: a constant moves nothing. Parameters, layer by
/// layer: for each unit its row of W_l, then its b; at the end w.
class Network {
 public:
  /// Throws std::invalid_argument unless there are inputs and layers, all with units, and `most` parameters or fewer.
  Network(int inputs, std::vector<int> hidden);
  static constexpr int most = 5000;

  int inputs() const { return inputs_; }
  const std::vector<int>& hidden() const { return hidden_; }
  int size() const { return size_; }
  int scratch() const { return 2 * units_ + 2 * widest_; }
  /// Random parameters. Inner ones are small, so that f begins near its linear part with all units at work.
  Eigen::VectorXd start(unsigned seed) const;
  /// As a formula of numbers with these names, in the words of scenes, every bit kept: of several layers the units of
  /// one stand in each unit of the next. Empty where it has more than `longest` characters.
  std::string formula(const Eigen::VectorXd& theta, std::span<const std::string> names, std::size_t longest) const;

  /// The value, and g <- df/dx.
  template <class X>
  typename X::Scalar gradient(const X& x, const typename X::Scalar* theta, typename X::Scalar* scratch, X& g) const {
    using S = typename X::Scalar;
    using std::tanh;
    S* a = scratch;            // of all layers
    S* slope = a + units_;     // 1 - a^2
    S* back = slope + units_;  // df/da of the layer, and of the one below
    S* below = back + widest_;
    const S* input = x.data();
    int inputs = int(x.size());
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
      const int lower = layer > 0 ? hidden_[layer - 1] : int(x.size());
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
