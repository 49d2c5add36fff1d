#pragma once
/// The chain of pendula that its kernels compute too: of length and mass 1, fanned out, turning.

#include <lagroid/systems/pendulums/pendulum_chain.hpp>

#include "../kernels/pendulum_chain.hpp"

#include <cmath>

namespace bench {

constexpr double pendulum_step(int links) { return 0.02 / links; }

template <int K> lagroid::PendulumChain<K> pendulum_chain(int links) {
  using Numbers = typename lagroid::PendulumChain<K>::Numbers;
  return {Numbers::Constant(links, 1.0 / links), Numbers::Constant(links, 1.0 / links), 9.81};
}

/// (q, w) at the start.
template <int K> typename lagroid::PendulumChain<K>::Points pendulum_start(int links) {
  typename lagroid::PendulumChain<K>::Points z(6, links);
  for (int i = 0; i < links; ++i) {
    const double share = double(i) / links;
    const lagroid::Vector<double, 3> q(std::sin(1.6 + share) * std::cos(0.3 * share),
                                       std::sin(1.6 + share) * std::sin(0.3 * share), std::cos(1.6 + share));
    const lagroid::Vector<double, 3> a(share, 0.5, 1 - 0.5 * share);
    z.col(i) << q, a - q * q.dot(a);
  }
  return z;
}

template <int K> kernels::PendulumParameters pendulum_parameters() {
  return {pendulum_step(K), 1.0 / K, 1.0 / K, 9.81};
}
template <int K, class Points> std::array<kernels::Triple, std::size_t(K)> triples(const Points& columns) {
  std::array<kernels::Triple, std::size_t(K)> out;
  for (int i = 0; i < K; ++i) out[std::size_t(i)] = kernels::Triple(Eigen::Vector3d(columns.col(i)));
  return out;
}

template <int K> kernels::PendulumChainCf4<std::size_t(K)> pendulum_cf4() {
  const auto z = pendulum_chain<K>(K).to_momenta(pendulum_start<K>(K));
  return {pendulum_parameters<K>(), triples<K>(z.template topRows<3>()), triples<K>(z.template bottomRows<3>())};
}
template <int K> kernels::PendulumChainRattle<std::size_t(K)> pendulum_rattle() {
  const auto z = pendulum_start<K>(K);
  Eigen::Matrix<double, 3, K> v;
  for (int i = 0; i < K; ++i) v.col(i) = lagroid::PendulumChain<K>::link_velocity(z, i);
  return {pendulum_parameters<K>(), triples<K>(z.template topRows<3>()), triples<K>(v)};
}

}  // namespace bench
