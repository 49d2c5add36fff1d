// The inertia that the elimination of a boundary value's matrix counts is that of the matrix.
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/solvers/boundary/boundary_kkt.hpp>

#include "../boundary_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

using namespace lagroid;

namespace boundary_values_inertia_tests {
namespace {

long negative(const Eigen::VectorXd& eigenvalues) {
  return std::count_if(eigenvalues.begin(), eigenvalues.end(), [](double x) { return x < 0; });
}

/// Negative eigenvalues of the whole scaled KKT matrix, dense, against those its elimination counts.
template <class Sys> void expect_inertia(const Sys& system, const Path<Sys>& path) {
  using Kkt = BoundaryKkt<Sys>;
  Kkt kkt;
  kkt.evaluate(system, path);
  kkt.choose_scale();
  const int count = int(path.size());
  Eigen::MatrixXd dense(Kkt::size * count, Kkt::size * count);
  for (int column = 0; column < dense.cols(); ++column) {
    typename Kkt::Columns z(std::size_t(count), Kkt::Column::Zero());
    z[std::size_t(column / Kkt::size)](column % Kkt::size) = 1;
    const auto image = kkt.multiply(z);
    for (int k = 0; k < count; ++k) dense.block(Kkt::size * k, column, Kkt::size, 1) = image[std::size_t(k)];
  }
  EXPECT_LT((dense - dense.transpose()).norm(), 1e-13 * dense.norm());
  for (const double shift : {0.0, 0.3, -0.2}) {
    Eigen::MatrixXd shifted = dense;
    for (int k = 0; k < count; ++k)
      for (int i = 0; i < Sys::dimension; ++i)
        if (k + 1 < count) shifted(Kkt::size * k + Sys::constraints + i, Kkt::size * k + Sys::constraints + i) += shift;
    EXPECT_EQ(kkt.factor(shift, 0).negative, negative(symmetric_eigenvalues(shifted))) << shift;
  }
}

TEST(Inertia, IsThatOfTheDenseMatrix) {
  const PlateBall system = plate_ball(8);
  Path<PlateBall> path = straight(system, 8);
  for (std::size_t k = 0; k < path.size(); ++k) path[k].multipliers << 3 - double(k), -2.0, 5.0 * std::sin(double(k));
  expect_inertia(system, path);
  const auto sphere = known(spherical_pendulum(), {{0.6, 0, -0.8}, {0.2, 0.9, 0.15}}, 60);
  expect_inertia(sphere.problem.system, sphere.path);
  const auto orbit = known(kepler(), {{1, 0}, {0.1, 0.9}}, 200);
  expect_inertia(orbit.problem.system, orbit.path);
}

TEST(SymmetricFactor, SolvesAndCountsWhereDiagonalsVanish) {
  std::srand(5);
  for (int trial = 0; trial < 200; ++trial) {
    SymmetricFactor<8>::Square a = SymmetricFactor<8>::Square::Random();
    a = (a + a.transpose()).eval();
    if (trial % 2 == 0) a.topLeftCorner<3, 3>().setZero();
    if (trial % 3 == 0) a.diagonal().setZero();
    SymmetricFactor<8> factor;
    factor.compute(a);
    const Eigen::VectorXd eigenvalues = symmetric_eigenvalues(a);
    EXPECT_EQ(factor.negative(), negative(eigenvalues));
    const Vector<double, 8> b = Vector<double, 8>::Random();
    const double condition = eigenvalues.cwiseAbs().maxCoeff() / eigenvalues.cwiseAbs().minCoeff();
    EXPECT_LT((a * factor.solve(b) - b).norm(), 1e-13 * condition);
    SymmetricFactor<8>::Square s = SymmetricFactor<8>::Square::Zero();
    const SymmetricFactor<8>::Square r = SymmetricFactor<8>::Square::Random();
    const Eigen::MatrixXd solved = factor.subtract_from(s, r);
    EXPECT_LT((a * solved - r).norm(), 1e-12 * condition * r.norm());
    const Eigen::MatrixXd expected = -r.transpose() * inverse_of(a) * r;
    EXPECT_LT((s - expected).norm(), 1e-12 * condition * (1 + expected.norm()));
  }
}

TEST(SymmetricFactor, DoesNotHideANaN) {
  for (int place = 0; place < 4; ++place) {
    SymmetricFactor<4>::Square a = SymmetricFactor<4>::Square::Identity();
    a(place, 3) = a(3, place) = std::numeric_limits<double>::quiet_NaN();
    SymmetricFactor<4> factor;
    factor.compute(a);
    EXPECT_FALSE(factor.solve(Vector<double, 4>::Ones()).allFinite()) << place;
  }
}

}  // namespace
}  // namespace boundary_values_inertia_tests
