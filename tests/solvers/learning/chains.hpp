#pragma once
/// Chains that are learned, and data of them.

#include <lagroid/solvers/learning/measures.hpp>
#include <lagroid/solvers/learning/train.hpp>
#include <lagroid/systems/pendulums/chain_trajectories.hpp>

#include <random>

namespace lagroid::learning_tests {

using namespace lagroid::learning;
using Eigen::MatrixXd;
using Eigen::VectorXd;

using Chain = PendulumChain<Eigen::Dynamic>;

/// The original's: unit masses, lengths and gravity.
inline Chain unit_chain(int k) { return Chain(VectorXd::Ones(k), VectorXd::Ones(k), 1); }

inline Trajectories training_data(int k, int count = 500, double noise = 0, unsigned seed = 7) {
  return assemble(draw_trajectories(unit_chain(k), {.count = count, .noise = noise, .seed = seed}), noise);
}

/// The original's: a hundred trajectories of 15 points until t = 1.
inline Trajectories test_data(int k) {
  return assemble(draw_trajectories(unit_chain(k), {.count = 100, .points = 15, .duration = 1, .seed = 1007}));
}

inline double test_error(const Model& model, const Trained& trained, int k) {
  return measure(model, trained.parameters, test_data(k)).mse;
}

inline VectorXd random_vector(Eigen::Index n, unsigned seed) {
  std::mt19937 generator(seed);
  VectorXd out(n);
  for (double& x : out) x = 2 * (double(generator()) / 4294967296.0) - 1;
  return out;
}

/// A user's potential, its energy alone: springs of one stiffness from each mass to a point. With no stiffness the
/// point does not matter, so that training cannot begin at zero.
struct Springs {
  int size() const { return 4; }
  VectorXd start(unsigned seed) const { return VectorXd::Ones(4) + 0.5 * random_vector(4, seed); }
  template <class S, class T, int K> S energy(const Eigen::Matrix<S, 3, K>& q, const T* theta) const {
    S sum(0.0);
    for (int i = 0; i < q.cols(); ++i)
      for (int c = 0; c < 3; ++c) {
        const S stretch = q(c, i) - S(theta[1 + c]);
        sum += S(theta[0]) * stretch * stretch * 0.5;
      }
    return sum;
  }
};

}  // namespace lagroid::learning_tests
