// Steps of few entries against the same steps as dense matrices, and the colours of their columns.
#include <lagroid/solvers/sensitivity/sparse/colouring.hpp>
#include <lagroid/solvers/sensitivity/sparse/sparse_step.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
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
