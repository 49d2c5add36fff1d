#include <lagroid/systems/optimisation/instances.hpp>

#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>
#include <lagroid/systems/optimisation/procrustes.hpp>
#include <lagroid/systems/optimisation/random.hpp>
#include <lagroid/systems/optimisation/rayleigh.hpp>

#include <stdexcept>

namespace lagroid::optimisation {

namespace {

constexpr const char* by_lanczos = "eigenvalues (Eigen; of large matrices Spectra)";

}  // namespace

Instance rayleigh_instance(const SymmetricOperator& a) {
  Instance out;
  out.manifold = std::make_unique<Sphere>(a.size);
  out.objective = std::make_unique<Rayleigh>(a);
  out.rows = a.size;
  out.least = [a](const Point&) {
    const SymmetricOperator negative{a.size,
                                     [&a](const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::Ref<Eigen::MatrixXd> y) {
                                       a.apply(x, y);
                                       y = -y;
                                     }};
    return smallest_eigenvalues(negative, 1)(0);
  };
  out.least_by = by_lanczos;
  return out;
}

Instance brockett_instance(const SymmetricOperator& a, const Eigen::VectorXd& weights) {
  Instance out;
  out.objective = std::make_unique<Brockett>(a, weights);
  out.manifold = std::make_unique<Stiefel>(a.size, weights.size());
  out.rows = a.size;
  out.columns = weights.size();
  out.least = [a, weights](const Point&) { return smallest_eigenvalues(a, weights.size()).dot(weights.reverse()); };
  out.least_by = by_lanczos;
  return out;
}

Instance procrustes_instance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Instance out;
  out.objective = std::make_unique<Procrustes>(a, b);
  out.manifold = std::make_unique<Stiefel>(a.cols(), b.cols());
  out.rows = a.cols();
  out.columns = b.cols();
  if (out.rows == out.columns) {
    out.least = [a, b](const Point& start) {
      const Eigen::Map<const Eigen::MatrixXd> x(start.data(), a.cols(), b.cols());
      return (a * balanced_procrustes(a, b, component(x)) - b).squaredNorm();
    };
    out.least_by = "singular values (Eigen), in the component of the start";
  }
  return out;
}

Point random_start(const Manifold& manifold, unsigned seed) {
  Point x = random_matrix(manifold.size(), 1, seed);
  if (!manifold.nearest(x)) throw std::runtime_error("a random matrix has no nearest point; take another seed");
  return x;
}

}  // namespace lagroid::optimisation
