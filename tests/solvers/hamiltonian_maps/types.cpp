// Types of generating functions, their action sums and momenta.
#include "examples.hpp"

#include <lagroid/solvers/generating/chord_lagrangian.hpp>
#include <lagroid/solvers/generating/hamiltonian_map.hpp>
#include <lagroid/solvers/generating/hidden_constraint.hpp>
#include <lagroid/solvers/generating/taylor_hamiltonian.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lagroid::hamiltonian_map_tests::types_tests {
namespace {

using enum GeneratingType;

// ---- Remark 3.3: one map, three generating functions

template <class A, class B>
double difference(const A& a, const B& b, typename HamiltonianMap<A>::Point start, double h, int steps) {
  auto first = start;
  auto second = start;
  double worst = 0;
  for (int k = 0; k < steps; ++k) {
    if (HamiltonianMap(a).step(first, h) != SolveStatus::converged) return INFINITY;
    if (HamiltonianMap(b).step(second, h) != SolveStatus::converged) return INFINITY;
    worst = std::max({worst, (first.q - second.q).norm(), (first.p - second.p).norm(),
                      (first.multipliers - second.multipliers).norm()});
  }
  return worst;
}

constexpr double agreement = 1e-12;

/// The trapezoid in other coordinates; r = 0 of types II and III, which are rectangles of type I.
template <class M> void types_agree(const M& system, const Phase<M::dimension, M::constraints>& start) {
  const double h = 0.1;
  const int steps = 20;
  const ChordLagrangian<M> trapezoid{system};
  EXPECT_LT(difference(trapezoid, in_coordinates<two>(trapezoid), start, h, steps), agreement);
  EXPECT_LT(difference(trapezoid, in_coordinates<three>(trapezoid), start, h, steps), agreement);
  const TaylorHamiltonian<M, 0> right{system};
  const ChordLagrangian<M> left_rectangle{system, quadrature_rules::rectangle};
  const ChordLagrangian<M> right_rectangle{system, quadrature_rules::right_rectangle};
  EXPECT_LT(difference(left_rectangle, right, start, h, steps), agreement);
  EXPECT_LT(difference(right_rectangle, adjoint_of(right), start, h, steps), agreement);
  // Those of different methods are not.
  EXPECT_GT(difference(left_rectangle, adjoint_of(right), start, h, steps), 1e-3);
  EXPECT_GT(difference(trapezoid, right, start, h, steps), 1e-3);
}

TEST(Types, OfOneMethodAreOneMap) {
  types_agree(Bob{}, bob_start);
  types_agree(Plane<1>{}, plane_start<1>());
  types_agree(Plane<0>{}, plane_start<0>());
}

TEST(Types, AreChangedIntoTypeOneToo) {
  const auto agree = [](const auto& f) {
    EXPECT_LT(difference(f, in_coordinates<one>(f), plane_start<1>(), 0.1, 20), agreement);
  };
  const TaylorHamiltonian<Plane<1>, 0> right{{}};
  agree(right);
  agree(adjoint_of(right));
  const ChordLagrangian<Plane<1>> trapezoid{{}};
  EXPECT_LT(difference(trapezoid, adjoint_of(trapezoid), plane_start<1>(), 0.1, 20), agreement);
}

TEST(Types, WithTheTrapezoidAndROneAreVerletInUniformGravityOnly) {
  const TaylorHamiltonian<Bob, 1> bob{{}};
  EXPECT_LT(difference(ChordLagrangian<Bob>{{}}, bob, bob_start, 0.1, 20), 1e-12);
  const TaylorHamiltonian<Plane<1>, 1> plane{{}};
  EXPECT_GT(difference(ChordLagrangian<Plane<1>>{{}}, plane, plane_start<1>(), 0.1, 20), 1e-6);
}

// ---- the sums (2.9), (2.10), (3.14), (3.15) and the representatives of the momentum

/// Steps from `start`: q_k, p_k as they arrive and leave, lambda_k of (2.13).
template <class F> struct Path {
  using Map = HamiltonianMap<F>;
  std::vector<Vector<double, Map::n>> q;
  std::vector<Vector<double, Map::n>> arriving;
  std::vector<Vector<double, Map::n>> leaving;
  std::vector<Vector<double, Map::d>> multipliers;

  Path(const F& function, typename Map::Point point, double h, int steps) {
    const Map map(function);
    for (int k = 0; k <= steps; ++k) {
      auto departing = point;
      EXPECT_EQ(map.leave(departing, h), SolveStatus::converged);
      q.push_back(point.q);
      arriving.push_back(point.p);
      leaving.push_back(departing.p);
      EXPECT_EQ(map.step(point, h), SolveStatus::converged);
      multipliers.push_back(point.multipliers);
    }
  }
};

/// The largest derivative of the sum with respect to inner q_k, and p_k where the type has them. The sums have the sign
/// of [V], so that its multipliers are ours with the other sign; `shift` spoils those.
template <class F>
double stationarity_defect(const F& f, const Path<F>& path, double h, bool at_end, double shift = 0) {
  constexpr int n = F::dimension;
  const int last = int(path.q.size()) - 1;
  const auto& p = F::type == three ? path.leaving : path.arriving;
  using D = Dual<double>;
  std::vector<Vector<D, n>> qs;
  std::vector<Vector<D, n>> ps;
  for (int k = 0; k <= last; ++k) {
    qs.push_back(path.q[std::size_t(k)].template cast<D>());
    ps.push_back(p[std::size_t(k)].template cast<D>());
  }
  const auto sum = [&] {
    D total = 0;
    for (std::size_t k = 0; k < std::size_t(last); ++k) {
      const std::size_t at = at_end ? k + 1 : k;
      D reaction = 0;
      for (int i = 0; i < F::constraints; ++i)
        reaction += D(-path.multipliers[at](i) + shift) * f.constraint(qs[at])(i);
      if constexpr (F::type == one) total += f.generating(qs[k], qs[k + 1], h) - reaction;
      if constexpr (F::type == two) total -= ps[k + 1].dot(qs[k + 1]) - f.generating(qs[k], ps[k + 1], h) - reaction;
      if constexpr (F::type == three) total -= -ps[k].dot(qs[k]) - f.generating(qs[k + 1], ps[k], h) - reaction;
    }
    if constexpr (F::type == two) total += ps[std::size_t(last)].dot(qs[std::size_t(last)]);
    if constexpr (F::type == three) total -= ps[0].dot(qs[0]);
    return total;
  };
  double worst = 0;
  const auto ask = [&](D& variable) {
    variable.derivative = 1;
    worst = std::max(worst, std::abs(sum().derivative));
    variable.derivative = 0;
  };
  for (std::size_t k = 1; k < std::size_t(last); ++k)
    for (int i = 0; i < n; ++i) {
      ask(qs[k](i));
      if (F::type != one) ask(ps[k](i));
    }
  return worst;
}

template <class F> void sums_are_stationary(const F& f, const typename HamiltonianMap<F>::Point& start) {
  const double h = 0.1;
  const Path<F> path(f, start, h, 8);
  for (const bool at_end : {false, true}) {
    EXPECT_LT(stationarity_defect(f, path, h, at_end), 1e-13);
    EXPECT_GT(stationarity_defect(f, path, h, at_end, 1e-3), 1e-4);
  }
}

TEST(ActionSums, OfAllTypesAreStationaryWithMultipliersAtEitherEnd) {
  sums_are_stationary(ChordLagrangian<Bob>{{}}, bob_start);
  sums_are_stationary(TaylorHamiltonian<Bob, 0>{{}}, bob_start);
  sums_are_stationary(adjoint_of(TaylorHamiltonian<Bob, 0>{{}}), bob_start);
  sums_are_stationary(ChordLagrangian<Plane<1>>{{}}, plane_start<1>());
  sums_are_stationary(TaylorHamiltonian<Plane<1>, 1>{{}}, plane_start<1>());
  sums_are_stationary(adjoint_of(TaylorHamiltonian<Plane<1>, 1>{{}}), plane_start<1>());
}

template <class F>
void representatives_are_of_one_path(const F& f, const typename HamiltonianMap<F>::Point& start, const auto& system) {
  const double h = 0.1;
  const HamiltonianMap map(f);
  auto arriving = start;
  auto leaving = start;
  auto tangent = start;
  ASSERT_EQ(map.leave(leaving, h), SolveStatus::converged);
  for (int k = 0; k < 20; ++k) {
    ASSERT_EQ(map.step(arriving, h), SolveStatus::converged);
    ASSERT_EQ(map.step(tangent, h), SolveStatus::converged);
    ASSERT_EQ(map.step(leaving, h), SolveStatus::converged);
    tangent.p = project_momentum(system, tangent.q, tangent.p);
    EXPECT_LT(leaving.multipliers.norm(), 1e-12);  // it has acted already
    ASSERT_EQ(map.leave(leaving, h), SolveStatus::converged);
    EXPECT_LT((arriving.q - leaving.q).norm(), 1e-12);
    EXPECT_LT((arriving.q - tangent.q).norm(), 1e-12);
    EXPECT_LT((project_momentum(system, arriving.q, arriving.p) - tangent.p).norm(), 1e-12);
    EXPECT_LT((project_momentum(system, leaving.q, leaving.p) - tangent.p).norm(), 1e-12);
    EXPECT_LT(hidden_constraint(system, tangent.q, tangent.p).norm(), 1e-14);
    EXPECT_GT((arriving.p - tangent.p).norm() + (leaving.p - tangent.p).norm(), 1e-3);
  }
}

TEST(Momenta, ThatArriveLeaveOrAreTangentAreOfOnePath) {
  representatives_are_of_one_path(ChordLagrangian<Bob>{{}}, bob_start, Bob{});
  representatives_are_of_one_path(TaylorHamiltonian<Bob, 0>{{}}, bob_start, Bob{});
  representatives_are_of_one_path(adjoint_of(TaylorHamiltonian<Plane<1>, 1>{{}}), plane_start<1>(), Plane<1>{});
}

TEST(Momenta, OfTypeThreeMustBeConsistentAtTheStart) {
  // (3.21) as it stands: q_1 depends on p_0 alone, and C(q_1) = 0 only where p_0 leaves q_0.
  const auto f = adjoint_of(TaylorHamiltonian<Bob, 0>{{}});
  const double h = 0.1;
  const auto literal = [&](const Vector<double, 3>& p) -> Vector<double, 3> { return bob_start.q + h * p; };
  EXPECT_GT(std::abs(Bob{}.constraint(literal(bob_start.p))(0)), 1e-3);
  auto point = bob_start;
  ASSERT_EQ(HamiltonianMap(f).leave(point, h), SolveStatus::converged);
  EXPECT_LT(std::abs(Bob{}.constraint(literal(point.p))(0)), 1e-15);
}

TEST(Momenta, ThatAreTangentStaySo) {
  Vector<double, 3> q = bob_start.q;
  Vector<double, 3> p = bob_start.p;
  for (int k = 1; k <= 2000; ++k) {
    q = Vector<double, 3>(std::sin(1.1 * k), std::cos(2.3 * k), std::sin(0.7 * k + 1)).normalized();
    p = project_momentum(Bob{}, q, Vector<double, 3>(std::cos(0.9 * k), std::sin(1.7 * k), std::cos(3.1 * k)));
    const Vector<double, 3> again = project_momentum(Bob{}, q, p);
    EXPECT_LT((again - p).norm(), 1e-15) << k;
    EXPECT_LT(std::abs(q.dot(again)), 1e-15) << k;
  }
}

}  // namespace
}  // namespace lagroid::hamiltonian_map_tests::types_tests
