// Sparse elimination against dense linear algebra.

#include <lagroid/solvers/linear_algebra/elimination.hpp>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace lagroid::solvers_elimination_tests {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

struct Filled {
  Elimination sparse;
  Eigen::MatrixXd dense;
};

/// A matrix of this pattern near a positive definite one.
Filled filled(int size, const Pairs& pairs, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Filled out{Elimination(size, pairs), Eigen::MatrixXd::Zero(size, size)};
  out.sparse.clear();
  const auto put = [&](int i, int j, double x) {
    out.sparse.value(out.sparse.index(i, j)) = x;
    out.dense(i, j) = x;
  };
  for (int i = 0; i < size; ++i) put(i, i, 10 + uniform(random));
  for (const auto& [i, j] : pairs) {
    const double x = uniform(random);
    put(i, j, x + 0.01 * uniform(random));
    put(j, i, x + 0.01 * uniform(random));
  }
  return out;
}

void expect_solves(Filled f) {
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(f.dense.rows(), -1, 2);
  Eigen::VectorXd x = b;
  ASSERT_TRUE(f.sparse.factorise());
  f.sparse.solve(x.data());
  EXPECT_LT((f.dense * x - b).norm(), 1e-13 * b.norm());
  // Several sides at once, and the transposed equations.
  const Eigen::MatrixXd sides = Eigen::MatrixXd::Random(f.dense.rows(), 3);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> y = sides, z = sides;
  f.sparse.solve(y.data(), 3);
  EXPECT_LT((f.dense * y - sides).norm(), 1e-13 * sides.norm());
  f.sparse.solve_transposed(z.data(), 3);
  EXPECT_LT((f.dense.transpose() * z - sides).norm(), 1e-13 * sides.norm());
}

TEST(Elimination, SolvesWhatDenseEliminationSolves) {
  Pairs chain;
  for (int i = 0; i + 1 < 50; ++i) chain.emplace_back(i, i + 1);
  expect_solves(filled(50, chain, 1));
  Pairs ring = chain;
  ring.emplace_back(0, 49);
  expect_solves(filled(50, ring, 2));
  std::mt19937 random(3);
  for (unsigned seed = 0; seed < 20; ++seed) {
    Pairs any;
    for (int k = 0; k < 60; ++k) {
      const int i = int(random() % 30);
      const int j = int(random() % 30);
      if (i < j) any.emplace_back(i, j);
    }
    std::sort(any.begin(), any.end());
    any.erase(std::unique(any.begin(), any.end()), any.end());
    expect_solves(filled(30, any, seed));
  }
  expect_solves(filled(1, {}, 4));
}

TEST(Elimination, FillsNothingInOnChainsAndTrees) {
  Pairs chain;
  Pairs tree;
  for (int i = 1; i < 1000; ++i) {
    chain.emplace_back(i - 1, i);
    tree.emplace_back((i - 1) / 3, i);
  }
  EXPECT_EQ(Elimination(1000, chain).entries(), 1000 + 2 * chain.size());
  EXPECT_EQ(Elimination(1000, tree).entries(), 1000 + 2 * tree.size());
}

TEST(Elimination, SaysWhatIsSingular) {
  Filled f = filled(3, {{0, 1}, {1, 2}}, 5);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::abs(i - j) <= 1) f.sparse.value(f.sparse.index(i, j)) = i == 1 || j == 1 ? 2 : 1;
  f.sparse.value(f.sparse.index(1, 1)) = 8;  // the second row is the sum of twice the others
  EXPECT_FALSE(f.sparse.factorise());
  f.sparse.clear();
  EXPECT_FALSE(f.sparse.factorise());
  for (const auto& [i, j] : {std::pair(0, 0), {1, 2}, {2, 2}}) {
    Filled spoilt = filled(3, {{0, 1}, {1, 2}}, 5);
    ASSERT_TRUE(Filled(spoilt).sparse.factorise());
    spoilt.sparse.value(spoilt.sparse.index(i, j)) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(spoilt.sparse.factorise()) << i << ' ' << j;
  }
}

TEST(Elimination, LeavesOutRowsThatDependOnOthers) {
  // D D^T of four rows, the last the sum of the first and the third.
  Eigen::MatrixXd d(4, 5);
  d << 1, 2, 0, 0, 1, 0, 1, 3, 0, 0, 0, 0, 1, 4, 1, 1, 2, 1, 4, 2;
  const Eigen::MatrixXd s = d * d.transpose();
  Pairs all;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) all.emplace_back(i, j);
  Elimination sparse(4, all);
  const auto fill = [&] {
    sparse.clear();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) sparse.value(sparse.index(i, j)) = s(i, j);
  };
  fill();
  const auto dependent = sparse.leave_out_dependent();
  ASSERT_EQ(dependent.size(), 1U);
  EXPECT_NE(dependent[0], 1);
  fill();
  ASSERT_TRUE(sparse.factorise());
  // A right side in the range: the solution without that row solves all of them.
  const Eigen::VectorXd b = s * Eigen::Vector4d(1, -2, 0.5, 3);
  Eigen::VectorXd x = b;
  sparse.solve(x.data());
  EXPECT_EQ(x(dependent[0]), 0);
  EXPECT_LT((s * x - b).norm(), 1e-12 * b.norm());
}

}  // namespace
}  // namespace lagroid::solvers_elimination_tests
