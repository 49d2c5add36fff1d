#include <lagroid/solvers/learning/potentials/network_potential.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <stdexcept>

namespace lagroid::learning {

namespace {

void require_at_most(long size) {
  if (size > NetworkPotential::most)
    throw std::invalid_argument(
        fmt::format("a network with more than {} parameters; take fewer units", NetworkPotential::most));
}

}  // namespace

NetworkPotential::NetworkPotential(int bodies, std::vector<int> hidden)
    : inputs_(3 * bodies), hidden_(std::move(hidden)) {
  if (bodies < 1 || hidden_.empty() || *std::min_element(hidden_.begin(), hidden_.end()) < 1)
    throw std::invalid_argument("a network potential has bodies and hidden layers of one or more units");
  int below = inputs_;
  long size = 0;
  for (const int width : hidden_) {
    size += long(width) * (long(below) + 1);
    require_at_most(size);
    units_ += width;
    widest_ = std::max(widest_, width);
    below = width;
  }
  require_at_most(size + below);
  size_ = int(size) + below;
}

Eigen::VectorXd NetworkPotential::start(unsigned seed) const {
  std::mt19937 generator(seed);
  const auto uniform = [&](double bound) { return bound * (2 * (double(generator()) / 4294967296.0) - 1); };
  Eigen::VectorXd theta(size_);
  Eigen::Index at = 0;
  int below = inputs_;
  for (const int width : hidden_) {
    for (int u = 0; u < width; ++u) {
      for (int i = 0; i < below; ++i) theta(at++) = uniform(0.5 / std::sqrt(double(below)));
      theta(at++) = uniform(1);
    }
    below = width;
  }
  for (int u = 0; u < below; ++u) theta(at++) = uniform(1 / std::sqrt(double(below)));
  return theta;
}

}  // namespace lagroid::learning
