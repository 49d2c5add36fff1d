// A Hamiltonian of one's own, learned on a surface and with friction: a bead in a bowl that turns at an unknown rate,
// seen from the bowl. Neither its H is separable nor its energy conserved. See docs/learning.md.

#include <lagroid/solvers/learning/hamiltonians/hamiltonian_model.hpp>
#include <lagroid/solvers/learning/measures.hpp>
#include <lagroid/solvers/learning/train.hpp>

#include <iostream>
#include <random>

namespace {

using namespace lagroid;
using namespace lagroid::learning;

// H = theta_0 |p|^2 / 2 - theta_1 (x p_y - y p_x) + theta_2 z on the paraboloid 2 z = x^2 + y^2.
struct Bead {
  int size() const { return 3; }
  Eigen::VectorXd start(unsigned) const { return Eigen::VectorXd::Constant(3, 0.5); }
  template <class S, class T> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p, const T* theta) const {
    return p.squaredNorm() * S(theta[0]) * 0.5 - (q(0) * p(1) - q(1) * p(0)) * S(theta[1]) + q(2) * S(theta[2]);
  }
  template <class S> Vector<S, 1> constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>(q(2) - (q(0) * q(0) + q(1) * q(1)) * 0.5);
  }
};

}  // namespace

int main() {
  const HamiltonianModel<Bead, 3> model("bead", Bead{}, 3, Dissipation::rayleigh);
  // One over the mass, rate, weight; and L of the friction R = L L^T, row by row: 0.16 in all directions.
  const Eigen::VectorXd truth{{0.8, 0.7, 2, 0.4, 0, 0.4, 0, 0, 0.4}};

  // Trajectories of five points from random starts, followed to a tolerance.
  std::mt19937 generator(1);
  const auto uniform = [&] { return 2 * (double(generator()) / 4294967296.0) - 1; };
  std::vector<Observation> rows;
  for (long n = 0; n < 40; ++n) {
    Eigen::VectorXd start(6);
    for (double& x : start) x = uniform();
    model.space().project(start);
    Eigen::MatrixXd z;
    if (!model.follow(truth, start, std::vector{0.05, 0.1, 0.15, 0.2}, 1e-13, z)) return 1;
    rows.push_back({.row = long(rows.size()), .trajectory = n, .time = 0, .z = start});
    for (int j = 0; j < 4; ++j)
      rows.push_back({.row = long(rows.size()), .trajectory = n, .time = 0.05 * (j + 1), .z = z.col(j)});
  }
  const Trajectories data = assemble(rows, model.space());

  const Trained trained = train(model, data, {.method = lie_group_methods::runge_kutta_4, .substeps = 4, .starts = 1});
  std::cout.precision(8);
  std::cout << to_string(trained.outcome) << " after " << trained.iterations << " iterations\nfound  "
            << trained.parameters.head(3).transpose() << "\ntruth  " << truth.head(3).transpose() << "\nR\n"
            << model.dissipation(trained.parameters) << '\n';
  const double off = (trained.parameters - truth).head(3).norm() +
                     (model.dissipation(trained.parameters) - model.dissipation(truth)).norm();
  return off < 1e-5 ? 0 : 1;
}
