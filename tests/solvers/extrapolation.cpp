// Extrapolation on homogeneous spaces: its tables, its orders, its lanes, and what breaks them.
#include <lagroid/core/scalars/batch.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/groups/translations.hpp>
#include <lagroid/groupoids/spheres.hpp>
#include <lagroid/solvers/extrapolation/extrapolation_integrator.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "../support/allocation_counter.hpp"

using namespace lagroid;

namespace solvers_extrapolation_tests {
namespace {

using Table = ExtrapolationTable;

/// Two spheres with a vector each, or two points of T*S^2: depends on time, and does not commute with itself.
struct Swirl {
  template <class S, class Z> void operator()(const S& t, const Z& z, Z& u) const {
    using std::cos, std::sin;
    for (int i = 0; i < z.cols(); ++i) {
      const int j = (i + 1) % int(z.cols());
      for (int r = 0; r < z.rows(); ++r)
        u(r, i) = cos(z(r, i) + t * (0.2 * (r + 1))) + 0.7 * sin(z((r + 1) % int(z.rows()), i) * z(r, j));
    }
  }
};

Eigen::Matrix<double, 6, 2> swirl_start() {
  Eigen::Matrix<double, 6, 2> z;
  z.col(0) << 0.6, 0, 0.8, 0.8, 0.5, -0.6;
  z.col(1) << 0, 1, 0, -0.3, 0, 0.9;
  return z;
}

/// A body turned by a rate that depends on where it is.
struct Turning {
  void operator()(double t, const Translations<SO3>::Point& r, Vector<double, 3>& w) const {
    w << std::sin(2 * t) + r(0, 1), 1 + r(2, 0), std::cos(3 * t) * r(1, 1);
  }
};

TEST(ExtrapolationTables, HoldEachRowOnceWholeAndInOrder) {
  EXPECT_THROW(Table::of(Table::most_rows + 1, 4, 2), std::invalid_argument);
  for (const int unit : {1, 2})
    for (const int lanes : {1, 2, 4, 8})
      for (int rows = 1; rows <= Table::most_rows; ++rows) {
        const Table table = Table::of(rows, lanes, unit);
        std::map<int, int> ended;
        std::vector<int> steps(std::size_t(lanes), 0);
        int all = 0;
        for (const Table::Slot& slot : table.slots) {
          for (std::size_t lane = 0; lane < steps.size(); ++lane) {
            if (slot.step[lane] == 0) continue;
            ++all;
            EXPECT_EQ(slot.first[lane], steps[lane] == 0);
            EXPECT_NEAR(slot.time[lane], slot.step[lane] * steps[lane], 1e-15);
            ++steps[lane];
            EXPECT_EQ(slot.last[lane], std::lround(1 / slot.step[lane]) == steps[lane]);
          }
          for (const Table::End& end : slot.ends) {
            const auto lane = std::size_t(end.lane);
            ++ended[end.row];
            EXPECT_EQ(steps[lane], unit * end.row);
            EXPECT_EQ(slot.last[lane], 1);
            const bool more = &slot != &table.slots.back() && (&slot + 1)->step[lane] > 0;
            EXPECT_EQ(!slot.others.empty() && slot.others[lane] == 1, more);
            steps[lane] = 0;
          }
        }
        EXPECT_EQ(all, unit * rows * (rows + 1) / 2);
        EXPECT_EQ(int(ended.size()), rows);
        for (const auto& [row, times] : ended) EXPECT_EQ(times, 1) << row;
        EXPECT_GE(int(table.slots.size()), std::max(unit * rows, (all + lanes - 1) / lanes));
        EXPECT_LE(int(table.slots.size()), std::max(unit * rows, all / lanes + 2));
      }
}

TEST(ExtrapolationTables, AreExactOnPolynomialsInTheSquareOfTheStep) {
  for (int rows = 2; rows <= Table::most_rows; ++rows) {
    const Table table = Table::of(rows, 4, 2);
    for (int power = 0; power <= rows; ++power) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int j = 1; j <= rows; ++j) sum += table.weights.row(j - 1).transpose() * std::pow(2.0 / j, 2 * power);
      const double round_off = 1e-15 * table.growth * std::pow(4.0, power);
      EXPECT_NEAR(sum(0), power == 0 ? 1 : 0, power < rows ? round_off : 1e300);
      // Both estimates see the highest power that their value, of one row less, does not.
      EXPECT_NEAR(sum(1), 0, power < rows - 1 ? round_off : 1e300);
      EXPECT_NEAR(sum(2), 0, power < rows - 2 ? round_off : 1e300);
      EXPECT_GT(std::abs(sum(1)), power == rows - 1 ? 1e-6 : -1);
    }
  }
}

template <class M, class F>
laws::OrderProblem problem(const M& space, F field, typename M::Point start, int rows, int coarsest) {
  const auto flat = [](const auto& z) { return Eigen::VectorXd(z.reshaped()); };
  const auto end = [=](int steps) {
    constexpr double horizon = 2;
    ExtrapolationStep<M> step(space, 1e-10);
    F f = field;
    auto z = start;
    for (int n = 0; n < steps; ++n) step.step(f, n * horizon / steps, horizon / steps, rows, typename M::Point(z), z);
    return flat(z);
  };
  ControlledLieGroupIntegrator exact(space, field, lie_group_methods::munthe_kaas_54, start, {.tolerance = 1e-15});
  EXPECT_TRUE(exact.advance_to(2).converged());
  // Round-off, 1e-14 of both, is no part of the slope above this.
  return {end, flat(exact.point()), coarsest, rows == 2 ? 1e-11 : 3e-13};
}

TEST(Extrapolation, HasTheOrderOfItsRows) {
  const auto holds = [](int rows, const auto& space, const auto& field, const auto& start, int coarsest) {
    const MethodTraits traits{"extrapolation", 2 * rows, false, false, true};
    const auto report = laws::order_laws(traits, problem(space, field, start, rows, coarsest), rows == 4 ? 0.2 : 0.1);
    EXPECT_TRUE(report.holds()) << rows << " rows, " << report;
  };
  for (int rows = 2; rows <= 4; ++rows) {
    const int coarsest = rows == 2 ? 24 : 12;
    holds(rows, Translations<SO3>{}, Turning{}, Translations<SO3>::Point(Translations<SO3>::Point::Identity()),
          coarsest);
    if (rows == 4) continue;  // of which on spheres two halvings come down to round-off
    holds(rows, SpheresAndVectors<2>{}, Swirl{}, swirl_start(), 24);
    holds(rows, CotangentSpheres<2>{}, Swirl{}, swirl_start(), coarsest);
  }
  const auto four = problem(SpheresAndVectors<2>{}, Swirl{}, swirl_start(), 4, 12);
  const auto error = [&](int steps) { return (four.end(steps) - four.exact).norm(); };
  EXPECT_NEAR(std::log2(error(12) / error(24)), 8, 0.25);
}

/// Cayley's map in place of the exponential: it moves by the algebra, but twice by half is not once by the whole.
struct NoSubgroup : Spheres<1> {
  void act(const Algebra& u, Point& z) const {
    const Vector<double, 3> a = u / 2;
    const Vector<double, 3> q = z;
    z = 2 * (q + cross(a, q) + a * a.dot(q)) / (1 + a.squaredNorm()) - q;
  }
};

TEST(BrokenExtrapolation, MovesThatAreNoSubgroupsAreCaughtByTheOrder) {
  const auto field = [](double t, const auto& z, auto& u) { u << 1 + z(1) * z(2), std::cos(2 * t) + z(0), z(2); };
  const Spheres<1>::Point start(0.6, 0, 0.8);
  const MethodTraits traits{"extrapolation", 6, false, false, true};
  EXPECT_TRUE(laws::order_laws(traits, problem(Spheres<1>{}, field, start, 3, 12)).holds());
  auto asked = problem(NoSubgroup{}, field, start, 3, 12);
  asked.exact = problem(Spheres<1>{}, field, start, 3, 12).exact;
  EXPECT_FALSE(laws::order_laws(traits, asked).holds());
}

/// On a vector space it is the midpoint rule of Gragg.
TEST(Extrapolation, LeapsAreTheirHalvesDoneTwice) {
  const SpheresAndVectors<2> space;
  const auto start = swirl_start();
  SpheresAndVectors<2>::Algebra u;
  u << 0.3, -0.7, 0.5, 0.2, -1.1, 0.4, 0.6, 0.1, -0.2, 0.9, 0.3, -0.5;
  for (const double h : {1e-9, 0.1, 1.0, 30.0}) {
    auto whole = start, halves = start, mixed = start;
    space.leap(h, u, whole);
    space.leap(h, 1.0, u, halves);
    space.leap(h, 1.0, u, halves);
    space.leap(h, 0.0, u, mixed);
    EXPECT_LT((whole - halves).cwiseAbs().maxCoeff(), 1e-14 * (1 + h)) << h;
    EXPECT_LT((whole - mixed).cwiseAbs().maxCoeff(), 1e-15 * (1 + h)) << h;
    EXPECT_NEAR(whole.col(1).head<3>().norm(), 1, 1e-15);
    space.leap(-h, u, whole);
    EXPECT_LT((whole - start).cwiseAbs().maxCoeff(), 1e-14 * (1 + h)) << h;
  }
  // To second order it is the exponential.
  auto leapt = start, turned = start;
  space.leap(5e-4, u, leapt);
  space.act(u * 1e-3, turned);
  EXPECT_LT((leapt - turned).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Extrapolation, OnVectorSpacesIsTheClassicalOne) {
  using Point = EuclideanSpace<2>::Point;
  const auto rate = [](double t, const Point& y) { return Point(y(1), -std::sin(y(0)) + 0.3 * std::cos(t)); };
  auto field = [&](double t, const Point& y, Point& u) { u = rate(t, y); };
  const Point start(1, 0.2);
  constexpr double h = 0.3;
  const auto midpoint = [&](int steps) {
    Point before = start;
    Point now = start + h / steps * rate(0, start);
    for (int i = 1; i < steps; ++i) {
      const Point next = before + 2 * h / steps * rate(i * h / steps, now);
      before = now;
      now = next;
    }
    return now;
  };
  // Weights of three rows: 1/24, -16/15, 81/40.
  const Point extrapolated = midpoint(2) / 24 - 16.0 / 15 * midpoint(4) + 81.0 / 40 * midpoint(6);
  Point end = start;
  ExtrapolationStep<EuclideanSpace<2>> step({}, 1e-10);
  step.step(field, 0, h, 3, start, end);
  EXPECT_LT((end - extrapolated).norm(), 1e-15);
}

TEST(Extrapolation, LanesHoldWhatOneLaneWould) {
  const auto end = []<class S>(S) {
    ExtrapolationIntegrator integrator(SpheresAndVectors<2, S>{}, Swirl{}, swirl_start(), {.tolerance = 1e-11});
    EXPECT_TRUE(integrator.advance_to(2).converged());
    return integrator.point();
  };
  ExtrapolationStep<SpheresAndVectors<2>> one({}, 1e-10);
  const auto start = swirl_start();
  auto by_one = start;
  Swirl field;
  one.step(field, 0.4, 0.2, 7, start, by_one);
  const auto compare = [&]<class S>(S) {
    ExtrapolationStep<SpheresAndVectors<2, S>> many({}, 1e-10);
    auto by_many = start;
    many.step(field, 0.4, 0.2, 7, start, by_many);
    EXPECT_LT((by_many - by_one).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((end(S()) - end(0.0)).cwiseAbs().maxCoeff(), 1e-10);
  };
  compare(Batch<2>());
  compare(Batch<widest_batch>());
}

TEST(Extrapolation, ReachesTheEndWithinItsTolerance) {
  const auto exact = problem(CotangentSpheres<2>{}, Swirl{}, swirl_start(), 2, 24).exact;
  double last = 1;
  for (const double tolerance : {1e-4, 1e-7, 1e-10, 1e-13}) {
    ExtrapolationIntegrator integrator(CotangentSpheres<2>{}, Swirl{}, swirl_start(), {.tolerance = tolerance});
    ASSERT_TRUE(integrator.advance_to(1).converged());
    EXPECT_EQ(integrator.time(), 1);
    ASSERT_TRUE(integrator.advance_to(2).converged());
    const double error = (integrator.point().reshaped() - exact).norm();
    EXPECT_LT(error, 100 * tolerance + 1e-13);
    EXPECT_LT(error, last);
    last = error;
    EXPECT_LT(integrator.rejected(), integrator.steps());
  }
  // A tolerance below round-off is that of round-off.
  ExtrapolationIntegrator finest(CotangentSpheres<2>{}, Swirl{}, swirl_start(), {.tolerance = 1e-300});
  ASSERT_TRUE(finest.advance_to(2).converged());
  EXPECT_LT((finest.point().reshaped() - exact).norm(), 1e-12);
  EXPECT_LT(finest.steps(), 100);
}

/// Many digits for fewer evaluations than a method of order five takes.
TEST(Extrapolation, TakesFewEvaluationsForManyDigits) {
  ExtrapolationIntegrator ours(CotangentSpheres<2>{}, Swirl{}, swirl_start(), {.tolerance = 1e-12});
  ControlledLieGroupIntegrator theirs(CotangentSpheres<2>{}, Swirl{}, lie_group_methods::munthe_kaas_54, swirl_start(),
                                      {.tolerance = 1e-12});
  ASSERT_TRUE(ours.advance_to(10).converged());
  ASSERT_TRUE(theirs.advance_to(10).converged());
  EXPECT_LT(3 * ours.evaluations(), 2 * theirs.evaluations());
}

TEST(Extrapolation, SaysWhyItStops) {
  using Point = Spheres<1>::Point;
  const auto begin = [](const auto& field, double tolerance) {
    return ExtrapolationIntegrator(Spheres<1>{}, field, Point(0, 0, 1), {.tolerance = tolerance});
  };
  // A field that turns: of a constant one there are no errors but round-off, which would choose the steps.
  const auto undefined = [](double t, const Point& z, Point& u) {
    u << 1 + z(1) * z(2), std::cos(2 * t) + z(0), z(2);
    if (t >= 1) u.setConstant(std::nan(""));
  };
  auto stopped = begin(undefined, 1e-12);
  EXPECT_EQ(to_string(stopped.advance_to(2).status), to_string(SolveStatus::not_finite));
  // The last value of a row that is used is at its last step but one.
  EXPECT_NEAR(stopped.time(), 1, 0.01);
  EXPECT_TRUE(stopped.point().allFinite());
  const auto singular = [](double t, const Point&, Point& u) { u.setConstant(1 / (1 - t)); };
  auto integrator = begin(singular, 1e-12);
  EXPECT_FALSE(integrator.advance_to(2).converged());
  EXPECT_LE(integrator.time(), 1);
  EXPECT_THROW(begin(undefined, 0), std::invalid_argument);
  EXPECT_THROW(begin(undefined, std::nan("")), std::invalid_argument);
  const auto still = [](double, const auto&, auto& u) { u.setZero(); };
  constexpr int any = Eigen::Dynamic;
  EXPECT_THROW(ExtrapolationIntegrator(Spheres<any>{3}, still, Spheres<any>{2}.zero_point(), {}),
               std::invalid_argument);
}

TEST(Extrapolation, AllocatesNothingInAStep) {
  if (allocation_count() < 0) GTEST_SKIP() << "allocations are not counted here";
  const auto count = []<class S>(S) {
    ExtrapolationIntegrator integrator(SpheresAndVectors<Eigen::Dynamic, S>{{2}}, Swirl{}, swirl_start(),
                                       {.tolerance = 1e-9});
    EXPECT_TRUE(integrator.advance_to(1).converged());
    auto place = integrator.place();
    const long before = allocation_count();
    EXPECT_TRUE(integrator.advance_to(3).converged());
    integrator.keep(place);
    integrator.go_back_to(place);
    EXPECT_EQ(allocation_count(), before);
  };
  count(0.0);
  count(Batch<2>());
}

}  // namespace
}  // namespace solvers_extrapolation_tests
