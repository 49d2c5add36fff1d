// Orders of Hamiltonian maps.
#include "examples.hpp"

#include <lagroid/solvers/generating/chord_lagrangian.hpp>
#include <lagroid/solvers/generating/exact_generating_function.hpp>
#include <lagroid/solvers/generating/hamiltonian_map.hpp>
#include <lagroid/solvers/generating/taylor_hamiltonian.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lagroid::hamiltonian_map_tests::orders_tests {
namespace {

double slope(const std::function<double(int)>& error, int coarse, int fine) {
  return std::log(error(coarse) / error(fine)) / std::log(double(fine) / coarse);
}

struct Orders {
  double q = 0;
  double p = 0;        ///< as it arrives
  double tangent = 0;  ///< projected
};

template <class M, class Map, class Move>
Orders orders_of(const M& system, const typename Map::Point& start, const Map& map, int coarse, const Move& move) {
  using Point = typename Map::Point;
  const double T = 1;
  const auto exact = exact_arc(system, start.q, start.p, T);
  const auto end = [&](int steps) {
    Point point = start;
    for (int k = 0; k < steps; ++k) EXPECT_EQ(move(map, point, T / steps), SolveStatus::converged);
    return point;
  };
  const Point a = end(coarse);
  const Point b = end(2 * coarse);
  const auto rate = [&](const auto& defect) { return std::log2(defect(a) / defect(b)); };
  return {rate([&](const Point& z) { return (z.q - exact.q1).norm(); }),
          rate([&](const Point& z) { return (z.p - exact.p1).norm(); }),
          rate([&](const Point& z) { return (project_momentum(system, z.q, z.p) - exact.p1).norm(); })};
}

const auto one_step = [](const auto& map, auto& point, double h) { return map.step(point, h); };

TEST(Orders, OfTheUnconstrainedAreTheLesserOfRPlusOneAndTheQuadrature) {
  const Phase<1, 0> start{Vector<double, 1>(0.4), Vector<double, 1>(0.9)};
  const double T = 2;
  const auto exact = exact_arc(Swing{}, start.q, start.p, T);
  const auto order = [&]<int R>(std::integral_constant<int, R>, const QuadratureRule& rule, int coarse) {
    const auto measured = [&](const auto& f) {
      return slope(
          [&](int steps) {
            const auto end = end_of(HamiltonianMap(f), start, T, steps);
            return std::hypot((end.q - exact.q1).norm(), (end.p - exact.p1).norm());
          },
          coarse, 2 * coarse);
    };
    const TaylorHamiltonian<Swing, R> right{{}, rule};
    const double expected = std::min(R + 1, rule.order);
    EXPECT_NEAR(measured(right), expected, 0.1) << "type II, r = " << R << ", " << rule.name;
    EXPECT_NEAR(measured(adjoint_of(right)), expected, 0.1) << "type III, r = " << R << ", " << rule.name;
  };
  using namespace quadrature_rules;
  order(std::integral_constant<int, 0>{}, gauss_3, 200);
  order(std::integral_constant<int, 1>{}, gauss_3, 100);
  order(std::integral_constant<int, 1>{}, rectangle, 400);
  order(std::integral_constant<int, 2>{}, gauss_3, 60);
  order(std::integral_constant<int, 2>{}, trapezoid, 100);
  order(std::integral_constant<int, 3>{}, gauss_3, 40);
  order(std::integral_constant<int, 3>{}, simpson, 40);
  order(std::integral_constant<int, 3>{}, midpoint, 100);
  order(std::integral_constant<int, 4>{}, gauss_3, 30);
  order(std::integral_constant<int, 4>{}, lobatto_4, 30);
  order(std::integral_constant<int, 4>{}, gauss_2, 60);
}

TEST(Orders, OfTheConstrainedSaturateAtTwo) {
  const auto orders = [](const auto& system, const auto& start, const auto& f, int expected) {
    const Orders o = orders_of(system, start, HamiltonianMap(f), 80, one_step);
    EXPECT_NEAR(o.q, expected, 0.1);
    EXPECT_NEAR(o.tangent, expected, 0.1);
    EXPECT_NEAR(o.p, 1, 0.1);
  };
  using quadrature_rules::gauss_2;
  const auto bob = [&](const auto& f, int expected) { orders(Bob{}, bob_start, f, expected); };
  bob(ChordLagrangian<Bob>{{}}, 2);
  bob(TaylorHamiltonian<Bob, 0>{{}}, 1);
  bob(adjoint_of(TaylorHamiltonian<Bob, 0>{{}}), 1);
  bob(TaylorHamiltonian<Bob, 1>{{}}, 2);
  const auto plane = [&](const auto& f, int expected) { orders(Plane<1>{}, plane_start<1>(), f, expected); };
  plane(ChordLagrangian<Plane<1>>{{}}, 2);
  plane(TaylorHamiltonian<Plane<1>, 0>{{}}, 1);
  plane(TaylorHamiltonian<Plane<1>, 1>{{}}, 2);
  plane(TaylorHamiltonian<Plane<1>, 2>{{}, gauss_2}, 2);
  plane(TaylorHamiltonian<Plane<1>, 3>{{}, gauss_2}, 2);
  plane(adjoint_of(TaylorHamiltonian<Plane<1>, 3>{{}, gauss_2}), 2);
}

TEST(Orders, OfComposedSymmetricMapsAreFour) {
  const auto composed = [](const Composition& composition) {
    return [&composition](const auto& map, auto& point, double h) { return composed_step(map, point, h, composition); };
  };
  const auto four = [](const Orders& o) {
    EXPECT_NEAR(o.q, 4, 0.2);
    EXPECT_NEAR(o.tangent, 4, 0.2);
    EXPECT_NEAR(o.p, 1, 0.2);
  };
  const HamiltonianMap trapezoid(ChordLagrangian<Bob>{{}});
  const HamiltonianMap euler(TaylorHamiltonian<Bob, 0>{{}});
  four(orders_of(Bob{}, bob_start, trapezoid, 20, composed(compositions::triple_jump)));
  four(orders_of(Bob{}, bob_start, trapezoid, 20, composed(compositions::suzuki)));
  four(orders_of(Bob{}, bob_start, SymmetrisedMap(euler.function()), 20, composed(compositions::suzuki)));
  const SymmetrisedMap plane(TaylorHamiltonian<Plane<1>, 1>{{}});
  four(orders_of(Plane<1>{}, plane_start<1>(), plane, 20, composed(compositions::suzuki)));
  // Of a map that is not symmetric they gain less.
  EXPECT_LT(orders_of(Bob{}, bob_start, euler, 20, composed(compositions::suzuki)).q, 2.5);
}

}  // namespace
}  // namespace lagroid::hamiltonian_map_tests::orders_tests
