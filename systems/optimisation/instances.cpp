#include <lagroid/systems/optimisation/instances.hpp>

#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/solvers/optimisation/manifolds/hyperbolic_space.hpp>
#include <lagroid/solvers/optimisation/manifolds/positive_definite.hpp>
#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>
#include <lagroid/systems/optimisation/frechet_mean.hpp>
#include <lagroid/systems/optimisation/procrustes.hpp>
#include <lagroid/systems/optimisation/random.hpp>
#include <lagroid/systems/optimisation/rayleigh.hpp>

#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <vector>

namespace lagroid::optimisation {

namespace {

constexpr const char* by_lanczos = "eigenvalues (Eigen; of large matrices Spectra)";

/// Their mean on the manifold of the instance, from the first of them.
void take_mean(Instance& instance, std::vector<Point> points) {
  const Manifold& manifold = *instance.manifold;
  instance.start = points.front();
  if (points.size() == 2) {
    Vector apart;
    if (manifold.logarithm(points[0], points[1], apart)) {
      const double square = manifold.inner(points[0], apart, apart);
      instance.least = [square](const Point&) { return square / 8; };
      instance.least_by = "the distance of the two points";
    }
  }
  instance.objective = std::make_unique<FrechetMean>(manifold, std::move(points));
}

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

Instance hyperbolic_mean_instance(const Eigen::MatrixXd& points) {
  Instance out;
  out.manifold = std::make_unique<HyperbolicSpace>(points.cols());
  out.rows = points.cols() + 1;
  std::vector<Point> each;
  for (const auto& row : points.rowwise()) {
    Point& point = each.emplace_back(out.rows);
    point << 1, row.transpose();
    if (!out.manifold->nearest(point)) throw std::invalid_argument("a mean is one of finite points");
  }
  take_mean(out, std::move(each));
  return out;
}

Instance positive_definite_mean_instance(const Eigen::MatrixXd& matrices) {
  const Eigen::Index n = matrices.cols();
  if (n < 1 || matrices.rows() < n || matrices.rows() % n != 0)
    throw std::invalid_argument(
        fmt::format("{} x {} numbers; give square matrices, one below the other", matrices.rows(), n));
  Instance out;
  out.manifold = std::make_unique<PositiveDefinite>(n);
  out.rows = out.columns = n;
  std::vector<Point> each;
  for (Eigen::Index i = 0; i < matrices.rows(); i += n) {
    constexpr double rounding = 1e-12;
    const Eigen::MatrixXd matrix = matrices.middleRows(i, n);
    const double skew = (matrix - matrix.transpose()).norm();
    if (!(skew <= rounding * matrix.norm()))
      throw std::invalid_argument(fmt::format("matrix {} is not symmetric, by {:.1e} of its size; give (A + A^T) / 2",
                                              i / n + 1, skew / matrix.norm()));
    Point& point = each.emplace_back(matrix.reshaped());
    if (!out.manifold->nearest(point))
      throw std::invalid_argument(
          fmt::format("matrix {} is not positive definite, its smallest eigenvalue is {:.1e}; leave it out, or add a "
                      "multiple of the identity to all",
                      i / n + 1, symmetric_eigenvalues(matrix)(0)));
  }
  take_mean(out, std::move(each));
  return out;
}

Point random_start(const Manifold& manifold, unsigned seed) {
  Point x = random_matrix(manifold.size(), 1, seed);
  if (!manifold.nearest(x))
    throw std::runtime_error("a random matrix has no nearest point; give a start, or take another seed");
  return x;
}

}  // namespace lagroid::optimisation
