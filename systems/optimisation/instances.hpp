#pragma once
/// Problems with their manifold and, where it is known without optimisation, their minimum: what optimisation is
/// measured on.
///
///     const Eigen::MatrixXd a = optimisation::random_symmetric(100, 1);  // size, seed
///     const auto problem = optimisation::rayleigh_instance(optimisation::SymmetricOperator::of(a));
///     const optimisation::Point start = optimisation::random_start(*problem.manifold, 1);
///
/// Weights and sizes that do not fit throw std::invalid_argument; `random_start` throws std::runtime_error where a
/// random matrix has no nearest point. [V] 5.3

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>
#include <lagroid/solvers/optimisation/objective.hpp>
#include <lagroid/systems/optimisation/operators.hpp>

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace lagroid::optimisation {

/// Points are `rows` x `columns` matrices, by columns.
struct Instance {
  std::unique_ptr<Manifold> manifold;
  std::unique_ptr<Objective> objective;
  Eigen::Index rows = 0;
  Eigen::Index columns = 1;
  /// The least value that can be reached from a start, without optimisation; empty where nobody knows it.
  std::function<double(const Point& start)> least;
  std::string least_by;  ///< how
  /// Where to begin unless told otherwise; without it at a random point.
  std::optional<Point> start = {};
};

/// The largest eigenvalue of A ([V] 5.3.1).
Instance rayleigh_instance(const SymmetricOperator& a);
/// Brockett's function ([V] (5.7)) for the weights mu. Throws std::invalid_argument as `Brockett` does.
Instance brockett_instance(const SymmetricOperator& a, const Eigen::VectorXd& weights);
/// |A X - B|^2 ([V] (5.9)), balanced where B has as many columns as A. Throws std::invalid_argument as `Procrustes`
/// does.
Instance procrustes_instance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The Frechet mean in hyperbolic space; each row is the space part of a point. Throws std::invalid_argument as
/// `FrechetMean` and `HyperbolicSpace` do.
Instance hyperbolic_mean_instance(const Eigen::MatrixXd& points);
/// The Frechet mean of positive definite matrices, one below the other. Throws std::invalid_argument where they are not
/// such.
Instance positive_definite_mean_instance(const Eigen::MatrixXd& matrices);

/// The point of the manifold nearest to a random matrix.
Point random_start(const Manifold& manifold, unsigned seed);

}  // namespace lagroid::optimisation
