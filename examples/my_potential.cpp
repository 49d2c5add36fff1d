// A potential of one's own, learned from trajectories: a magnet of unknown strength and place under a spherical
// pendulum of unknown mass. See docs/learning.md.

#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/train.hpp>
#include <lagroid/systems/pendulums/chain_trajectories.hpp>

#include <cmath>
#include <iostream>

namespace {

using namespace lagroid;
using namespace lagroid::learning;

// V = theta_0 e_3.q + theta_1 / |q - (theta_2, theta_3, theta_4)|, an energy in any scalar; its gradient is deduced.
struct Magnet {
  int size() const { return 5; }
  Eigen::VectorXd start(unsigned seed) const {
    return Eigen::VectorXd{{0.5, -0.1, 0.1 * std::cos(seed), 0.1 * std::sin(seed), -1.5}};
  }
  template <class S, class T> S energy(const Positions<S, 1>& q, const T* theta) const {
    using std::sqrt;
    const Vector<S, 3> away = q - Vector<S, 3>(S(theta[2]), S(theta[3]), S(theta[4]));
    return S(theta[0]) * q(2) + S(theta[1]) / sqrt(away.squaredNorm());
  }
};

}  // namespace

int main() {
  const ParametricModel<Magnet, 1> model("magnet", Magnet{});
  // What is to be found: the logarithm of the square root of the mass, and the five numbers of the potential.
  const Eigen::VectorXd truth{{0.2, 1, -0.3, 0.3, -0.2, -1.4}};
  // Starts drawn as in [H]; the motion is the model's own.
  const PendulumChain<Eigen::Dynamic> pendulum(Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1), 1);
  Trajectories data = assemble(draw_trajectories(pendulum, {.count = 200}));
  const Schedule schedule{lie_group_methods::commutator_free_4, data.interval, data.points - 1, 2};
  model.predict(truth, schedule, data.starts, data.ends);

  const Trained trained = train(model, data, {.starts = 3});
  std::cout.precision(8);
  std::cout << to_string(trained.outcome) << " after " << trained.iterations
            << " iterations, mean squared error below 1e-25: " << (trained.mse < 1e-25 ? "yes" : "no") << "\nfound  "
            << trained.parameters.transpose() << "\ntruth  " << truth.transpose() << '\n';
  return (trained.parameters - truth).norm() < 1e-6 ? 0 : 1;
}
