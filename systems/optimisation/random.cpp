#include <lagroid/systems/optimisation/random.hpp>

#include <random>

namespace lagroid::optimisation {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 generator(seed);
  constexpr double range = 4294967296.0;
  Eigen::MatrixXd a(rows, columns);
  for (double& x : a.reshaped()) {
    x = -6;
    for (int k = 0; k < 12; ++k) x += double(generator()) / range;
  }
  return a;
}

Eigen::MatrixXd random_symmetric(Eigen::Index size, unsigned seed) {
  const Eigen::MatrixXd a = random_matrix(size, size, seed);
  return 0.5 * (a + a.transpose());
}

}  // namespace lagroid::optimisation
