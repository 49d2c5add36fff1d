// Linear steps against their definition, small and large; steps of few entries against the same steps as dense
// matrices, and the colours of their columns.
#include "../../support/allocation_counter.hpp"

#include <lagroid/core/matrices/scaling.hpp>
#include <lagroid/solvers/sensitivity/sparse/colouring.hpp>
#include <lagroid/solvers/sensitivity/sparse/sparse_step.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <random>

namespace lagroid::sensitivity_sparse_tests {
namespace {

struct Both {
  SparseStep sparse;
  LinearStep dense;
};

/// A step of which each entry is value(row, column), where it is not zero.
Both step_of(int leading, int multipliers, int states, int parameters,
             const std::function<double(int row, int column)>& value) {
  const int equations = leading + multipliers;
  auto pattern = std::make_shared<StepPattern>();
  pattern->equations = equations;
  pattern->leading = leading;
  pattern->states = states;
  std::vector<double> values;
  LinearStep dense(equations, states, parameters);
  for (int j = 0; j < equations + states + parameters; ++j) {
    for (int i = 0; i < equations + states; ++i) {
      const double x = value(i, j);
      if (x == 0) continue;
      pattern->rows.push_back(i);
      values.push_back(x);
      auto& of = j < equations ? (i < equations ? dense.equations_by_unknowns : dense.end_by_unknowns)
                               : (i < equations ? dense.equations_by_start : dense.end_by_start);
      of(i < equations ? i : i - equations, j < equations ? j : j - equations) = x;
    }
    pattern->begins.push_back(int(pattern->rows.size()));
  }
  Both out{SparseStep(pattern), std::move(dense)};
  out.sparse.values = values;
  return out;
}

/// Of bodies of three numbers in a row, the neighbours tied by one multiplier each.
Both chain(int bodies, unsigned seed, double of_leading = 4) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int leading = 3 * bodies, states = leading;
  return step_of(leading, bodies - 1, states, 2, [&, leading, of_leading](int i, int j) {
    const int equations = leading + bodies - 1;
    const double x = uniform(random);
    const auto ties = [](int row, int unknown) { return unknown / 3 == row || unknown / 3 == row + 1; };
    if (i < leading && j < leading) return i / 3 != j / 3 ? 0 : i == j ? of_leading + x : of_leading == 0 ? 0 : x;
    if (i < leading && j < equations) return ties(j - leading, i) ? x : 0;
    if (i < equations && j < leading) return ties(i - leading, j) ? x : 0;
    if (i < equations && j < equations) return i == j ? -4 + x : 0;
    return (i + 2 * j) % 7 == 0 ? x : 0;
  });
}

void expect_same(Both step) {
  ASSERT_TRUE(step.dense.factor());
  ASSERT_TRUE(step.sparse.factor());
  const Eigen::Index all = step.dense.end_by_start.cols();
  for (const Eigen::Index sides : {1, 5, 40}) {
    const Eigen::MatrixXd x = Eigen::MatrixXd::Random(all, sides);
    const auto near = [&](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
      EXPECT_LT((a - b).norm(), 1e-13 * b.norm()) << sides;
    };
    near(step.sparse.forward(x), step.dense.forward(x));
    near(step.sparse.backward(x), step.dense.backward(x));
    near(step.dense.equations_by_unknowns * step.sparse.unknowns(x), -step.dense.equations_by_start * x);
  }
}

/// Equations in units that are far apart, as momenta and constraints are.
LinearStep random_step(int equations, int states, int parameters, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  LinearStep out(equations, states, parameters);
  const auto fill = [&](Eigen::MatrixXd& x) {
    for (double& entry : x.reshaped()) entry = uniform(random);
  };
  for (Eigen::MatrixXd* x :
       {&out.equations_by_unknowns, &out.equations_by_start, &out.end_by_unknowns, &out.end_by_start})
    fill(*x);
  for (int i = 0; i < equations; ++i) {
    out.equations_by_unknowns(i, (i + 1) % equations) += 3;  // pivots are not on the diagonal
    const double row = std::pow(10, 8 * uniform(random)), column = std::pow(10, 8 * uniform(random));
    out.equations_by_unknowns.row(i) *= row;
    out.equations_by_start.row(i) *= row;
    out.equations_by_unknowns.col(i) *= column;
    out.end_by_unknowns.col(i) *= column;
  }
  return out;
}

TEST(LinearStep, IsTheDerivativeOfAnImplicitFunction) {
  unsigned seed = 1;
  for (const int equations : {0, 1, 2, 3, 4, 5, 7, 16, 17, 24})
    for (const int states : {2, 4, 5, 6, 12, 32, 33})
      for (const int parameters : {0, 1, 6}) {
        LinearStep step = random_step(equations, states, parameters, ++seed);
        ASSERT_TRUE(step.factor()) << equations;
        Eigen::MatrixXd matrix = step.end_by_start;
        if (equations > 0) {
          const auto scaling = Scaling<Eigen::Dynamic>::equilibrate(step.equations_by_unknowns);
          const Eigen::MatrixXd right = scaling.row.asDiagonal() * step.equations_by_start;
          matrix -= step.end_by_unknowns *
                    (scaling.column.asDiagonal() * scaling.apply(step.equations_by_unknowns).fullPivLu().solve(right));
        }
        const Eigen::MatrixXd x = Eigen::MatrixXd::Random(states + parameters, 3);
        Eigen::MatrixXd forward = x, backward = x;
        forward.topRows(states) = matrix * x;
        backward.topRows(states).setZero();
        backward += matrix.transpose() * x.topRows(states);
        const double rounding = 1e-13 * (1 + equations) * (1 + matrix.norm());
        EXPECT_LT((step.forward(x) - forward).norm(), rounding) << equations << " " << states;
        EXPECT_LT((step.backward(x) - backward).norm(), rounding) << equations << " " << states;
      }
}

TEST(LinearStep, SmallOnesTakeNoMemoryButAtFirst) {
  LinearStep step = random_step(3, 6, 2, 7);
  Eigen::MatrixXd directions = Eigen::MatrixXd::Identity(8, 8), gradients = Eigen::MatrixXd::Ones(8, 2);
  const auto go = [&] {
    EXPECT_TRUE(step.factor());
    step.go_forward(directions);
    step.go_back(gradients);
  };
  go();
  const long count = allocation_count();
  if (count < 0) GTEST_SKIP() << "allocations cannot be counted here";
  go();
  EXPECT_EQ(allocation_count(), count);
}

TEST(LinearStep, SaysWhatIsSingularOrNoNumber) {
  const LinearStep regular = random_step(4, 6, 1, 3);
  for (const int equations : {4, 20}) {
    LinearStep step = random_step(equations, 6, 1, 5);
    // Twice the same equation, up to its unit and to rounding.
    step.equations_by_unknowns.row(1) = step.equations_by_unknowns.row(0) * 1.7e9;
    EXPECT_FALSE(step.factor()) << equations;
  }
  // By integers; of one pivot rounding is left, and of the other nothing.
  LinearStep exactly = regular;
  exactly.equations_by_unknowns = Eigen::Matrix4d{{1, 0, -1, 1}, {1, 1, -1, 1}, {-2, 2, -2, -1}, {-2, 6, -6, 0}};
  EXPECT_FALSE(exactly.factor());
  // No two pivots are far apart, and the condition is 1e24.
  for (const int equations : {8, 20}) {
    LinearStep step = random_step(equations, 6, 1, 5);
    step.equations_by_unknowns.setZero();
    step.equations_by_unknowns.diagonal().setConstant(1e-4);
    step.equations_by_unknowns.diagonal(1).setOnes();
    step.equations_by_unknowns(0, 0) = step.equations_by_unknowns(equations - 1, equations - 1) = 1;
    EXPECT_FALSE(step.factor()) << equations;
  }
  // Far from regular, and not singular.
  LinearStep near(2, 4, 0);
  near.equations_by_unknowns = Eigen::Matrix2d{{1, 1}, {1, 1 + 1e-8}};
  EXPECT_TRUE(near.factor());
  using Part = Eigen::MatrixXd LinearStep::*;
  for (const Part part : {&LinearStep::equations_by_unknowns, &LinearStep::equations_by_start,
                          &LinearStep::end_by_unknowns, &LinearStep::end_by_start})
    for (const double none : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      LinearStep step = regular;
      (step.*part)(1, 0) = none;
      EXPECT_FALSE(step.factor());
    }
}

TEST(SparseStep, IsTheSameStepAsDense) {
  for (unsigned seed = 1; seed < 10; ++seed) expect_same(chain(2 + int(seed), seed));
}

TEST(SparseStep, IsFactoredDenselyWhereTheLeadingUnknownsAloneAreSingular) {
  // Two unknowns that multipliers alone determine.
  expect_same(step_of(2, 2, 2, 0, [](int i, int j) {
    if (i < 4 && j < 4) return i / 2 != j / 2 ? 1.0 + (i == j + 2 || j == i + 2) : 0.0;
    return 1.0 + i - 0.5 * j;
  }));
}

TEST(SparseStep, SaysWhatIsSingular) {
  Both regular = chain(6, 3);
  Both step = regular;
  for (int k = step.sparse.pattern()->begins[4]; k < step.sparse.pattern()->begins[5]; ++k)
    step.sparse.values[std::size_t(k)] = 0;
  EXPECT_FALSE(step.sparse.factor());
  step = regular;
  step.sparse.values.back() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(step.sparse.factor());
  EXPECT_TRUE(regular.sparse.factor());
}

TEST(SparseStep, NumbersKeptGrowAsTheChain) {
  const auto entries = [](int bodies) {
    const Both step = step_of(3 * bodies, bodies - 1, 1, 0, [&](int i, int j) {
      const auto body = [&](int k) { return k < 3 * bodies ? double(k / 3) : k - 3 * bodies + 0.5; };
      return i < 4 * bodies - 1 && j < 4 * bodies - 1 && std::abs(body(i) - body(j)) < 0.6 ? 1.0 : 0.0;
    });
    return long(step.sparse.entries());
  };
  EXPECT_EQ(entries(40) - entries(20), 2 * (entries(20) - entries(10)));
}

TEST(Colouring, ColumnsOfOneColourShareNoRow) {
  std::mt19937 random(1);
  std::vector<std::vector<int>> columns(60);
  for (auto& column : columns)
    for (int row = 0; row < 40; ++row)
      if (random() % 9 == 0) column.push_back(row);
  std::vector<int> order(columns.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  const std::vector<int> colours = coloured(columns, order, 40);
  for (std::size_t a = 0; a < columns.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      std::vector<int> shared;
      std::set_intersection(columns[a].begin(), columns[a].end(), columns[b].begin(), columns[b].end(),
                            std::back_inserter(shared));
      EXPECT_TRUE(shared.empty() || colours[a] != colours[b]) << a << ' ' << b;
    }
  EXPECT_EQ(coloured({{0, 1}, {1, 2}, {2, 3}}, {0, 1, 2}, 4), (std::vector<int>{0, 1, 0}));
}

}  // namespace
}  // namespace lagroid::sensitivity_sparse_tests
