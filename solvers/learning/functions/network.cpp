#include <lagroid/solvers/learning/functions/network.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <stdexcept>

namespace lagroid::learning {

namespace {

void require_at_most(long size) {
  if (size > Network::most)
    throw std::invalid_argument(fmt::format("a network with more than {} parameters; take fewer units", Network::most));
}

}  // namespace

Network::Network(int inputs, std::vector<int> hidden) : inputs_(inputs), hidden_(std::move(hidden)) {
  if (inputs < 1 || hidden_.empty() || *std::min_element(hidden_.begin(), hidden_.end()) < 1)
    throw std::invalid_argument("a network has numbers to depend on, and hidden layers of one or more units");
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

Eigen::VectorXd Network::start(unsigned seed) const {
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

std::string Network::formula(const Eigen::VectorXd& theta, std::span<const std::string> names,
                             std::size_t longest) const {
  Eigen::Index at = 0;
  const auto combined = [&](const std::vector<std::string>& terms) {
    std::string out;
    for (const std::string& term : terms) out += fmt::format("{}({})*{}", out.empty() ? "" : " + ", theta(at++), term);
    return out;
  };
  std::vector<std::string> below(names.begin(), names.end());
  for (const int width : hidden_) {
    std::vector<std::string> units;
    for (int u = 0; u < width; ++u) {
      const std::string sum = combined(below);
      units.push_back(fmt::format("tanh({} + ({}))", sum, theta(at++)));
      if (units.back().size() > longest) return {};  // layer upon layer it grows beyond all memory
    }
    below = std::move(units);
  }
  std::string out = combined(below);
  return out.size() > longest ? std::string() : out;
}

}  // namespace lagroid::learning
