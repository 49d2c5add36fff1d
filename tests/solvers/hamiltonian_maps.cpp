// Constrained discrete Hamiltonian maps of types I, II and III: equality of types, sums, orders, exact generating
// functions, what the maps preserve, outcomes; the reference file's pendulum.
#include "../support/allocation_counter.hpp"

#include <lagroid/core/hamiltonian/legendre_transform.hpp>
#include <lagroid/solvers/generating/chord_lagrangian.hpp>
#include <lagroid/solvers/generating/exact_generating_function.hpp>
#include <lagroid/solvers/generating/hamiltonian_map.hpp>
#include <lagroid/solvers/generating/taylor_hamiltonian.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace lagroid;

namespace {

// ---- systems

/// Unit mass, length and gravity, e3 upwards.
struct Bob {
  static constexpr int dimension = 3;
  static constexpr int constraints = 1;
  template <class S> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    return p.squaredNorm() * 0.5 + q(2);
  }
  template <class S> S lagrangian(const Vector<S, 3>& q, const Vector<S, 3>& v) const {
    return v.squaredNorm() * 0.5 - q(2);
  }
  template <class S> Vector<S, 1> constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>((q.squaredNorm() - 1.0) * 0.5);
  }
};

/// In the plane, with a full mass matrix ((a, b), (b, c)) and a nonlinear potential; on an ellipse or free.
template <int D> struct Plane {
  static constexpr int dimension = 2;
  static constexpr int constraints = D;
  static constexpr double a = 1.5;
  static constexpr double b = 0.4;
  static constexpr double c = 0.8;
  template <class S> S potential(const Vector<S, 2>& q) const {
    using std::cos, std::exp;
    return cos(q(0)) * 0.7 + exp(q(1) * 0.5) * q(0) * 0.3;
  }
  template <class S> S hamiltonian(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    return (p(0) * p(0) * c - p(0) * p(1) * (2 * b) + p(1) * p(1) * a) * (0.5 / (a * c - b * b)) + potential(q);
  }
  template <class S> S lagrangian(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    return (v(0) * v(0) * a + v(0) * v(1) * (2 * b) + v(1) * v(1) * c) * 0.5 - potential(q);
  }
  template <class S> Vector<S, D> constraint(const Vector<S, 2>& q) const {
    return Vector<S, D>(q(0) * q(0) * 0.25 + q(1) * q(1) - 1.0);
  }
};

/// One degree of freedom, not separable.
struct Swing {
  static constexpr int dimension = 1;
  static constexpr int constraints = 0;
  template <class S> S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    using std::cos, std::sin;
    return p(0) * p(0) / (sin(q(0)) * 0.6 + 2.0) - cos(q(0)) + p(0) * q(0) * 0.1;
  }
};

using Point3 = Phase<3, 1>;

/// Angles from e3, p_theta and p_phi along unit vectors.
Point3 bob_at(double theta, double p_theta, double p_phi) {
  const double s = std::sin(theta);
  const double c = std::cos(theta);
  return {{s, 0, c}, {p_theta * c, p_phi, -p_theta * s}};
}
const Point3 bob_start = bob_at(1.0, 0.5, 0.7);

template <int D> Phase<2, D> plane_start() {
  Phase<2, D> out{{2 * std::cos(0.6), std::sin(0.6)}, {0.7, -0.2}};
  out.p = project_momentum(Plane<D>{}, out.q, out.p);
  return out;
}

// ---- integrating

/// The state after time T by that many steps; not a number from a step on that failed.
template <class F>
auto end_of(const HamiltonianMap<F>& map, typename HamiltonianMap<F>::Point point, double T, int steps) {
  for (int k = 0; k < steps; ++k)
    if (const auto status = map.step(point, T / steps); status != SolveStatus::converged) {
      ADD_FAILURE() << "step " << k << " of " << steps << ": " << to_string(status);
      point.q.setConstant(std::numeric_limits<double>::quiet_NaN());
      break;
    }
  return point;
}

double slope(const std::function<double(int)>& error, int coarse, int fine) {
  return std::log(error(coarse) / error(fine)) / std::log(double(fine) / coarse);
}

// ---- power series

template <class F> double series_defect(const F& f, double x, double t) {
  // f(x + t + t^2 / 2) by its series, against its value.
  Series<double, 24> s(x);
  s[1] = 1;
  s[2] = 0.5;
  return std::abs(f(s).at(t) - f(x + t + t * t / 2));
}

TEST(PowerSeries, OfElementaryFunctionsSumToThem) {
  using namespace std;
  const double t = 0.06;
  const auto defect = [&](const auto& f) { return series_defect(f, 0.4, t); };
  EXPECT_LT(defect([](auto x) { return sqrt(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return exp(x) / x; }), 2e-14);
  EXPECT_LT(defect([](auto x) { return log(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return pow(x, 1.7); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return pow(x, -3.0); }), 2e-14);
  EXPECT_LT(defect([](auto x) { return pow(x, 3.0); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return sin(x) * cos(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return tan(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return sinh(x) + cosh(x) - tanh(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return asin(x) - acos(x); }), 1e-14);
  EXPECT_LT(defect([](auto x) { return atan(x); }), 1e-15);
  EXPECT_LT(defect([](auto x) { return 2.0 / (1.0 + x) - x * 3.0; }), 1e-15);
  // At zero, where x^p has derivatives for natural p only.
  EXPECT_LT(series_defect([](auto x) { return pow(x, 2.0); }, 0, t), 1e-16);
  // Twelve terms do not: the check can fail.
  Series<double, 12> few(0.4);
  few[1] = 1;
  few[2] = 0.5;
  EXPECT_GT(std::abs(sqrt(few).at(0.06) - sqrt(0.4 + 0.0618)), 1e-15);
}

TEST(PowerSeries, GiveTheTaylorCoefficientsOfAFlow) {
  // z' = z^2: z = 1 / (1 - t).
  const auto z = taylor_solution<10>([](const auto& x) { return x.cwiseProduct(x).eval(); }, Vector<double, 1>(1.0));
  for (int k = 0; k < 10; ++k) EXPECT_DOUBLE_EQ(z(0)[k], 1);
}

// ---- implicit equations and the continuous Legendre transform

TEST(ImplicitFunctions, HaveExactFirstAndSecondDerivatives) {
  // x = sqrt(y) by x^2 = y.
  using J = SecondJet<double, 1>;
  const auto square = [](const auto& x, const auto& y) { return (x.cwiseProduct(x) - y).eval(); };
  const double y = 2.7;
  const auto at = [&]<class S>(const S& value) {
    return solve_implicit<S, 1, 1>(square, Vector<double, 1>(1.0), Vector<S, 1>(value))(0);
  };
  const J x = at(J::variable(y, 0));
  EXPECT_NEAR(x.value, std::sqrt(y), 1e-15);
  EXPECT_NEAR(x.gradient(0), 0.5 / std::sqrt(y), 1e-15);
  EXPECT_NEAR(x.hessian(0, 0), -0.25 / (y * std::sqrt(y)), 1e-15);
  using D3 = Dual<Dual<Dual<double>>>;
  const D3 cubed = at(D3({{y, 1.0}, {1.0, 0.0}}, {{1.0, 0.0}, {0.0, 0.0}}));
  EXPECT_NEAR(cubed.derivative.derivative.derivative, 0.375 / (y * y * std::sqrt(y)), 1e-15);
  // From there Newton's method does not reach a root: there is none.
  EXPECT_TRUE(std::isnan(at(-1.0)));
}

/// A particle in a magnetic potential, with relativistic kinetic energy: hyperregular, far from quadratic.
struct Fast {
  template <class S> S lagrangian(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    using std::sqrt;
    return -sqrt(1.0 - v.squaredNorm()) + q(0) * v(1) * 0.3 - q(1) * q(0);
  }
};

TEST(ContinuousLegendreTransform, IsTheHamiltonianAndBackAgain) {
  const HamiltonianOf<Fast> fast;
  const Vector<double, 2> q(0.3, -0.4);
  const Vector<double, 2> p(1.9, -2.2);
  const auto exact = [](const auto& x, const auto& y) {
    using std::sqrt;
    const auto k = y(1) - x(0) * 0.3;
    return sqrt(1.0 + y(0) * y(0) + k * k) + x(1) * x(0);
  };
  using J = SecondJet<double, 4>;
  Vector<J, 2> qs;
  Vector<J, 2> ps;
  for (int i = 0; i < 2; ++i) {
    qs(i) = J::variable(q(i), i);
    ps(i) = J::variable(p(i), 2 + i);
  }
  const J found = fast.hamiltonian(qs, ps);
  const J expected = exact(qs, ps);
  EXPECT_NEAR(found.value, expected.value, 1e-14);
  EXPECT_LT((found.gradient() - expected.gradient()).norm(), 1e-13);
  EXPECT_LT((found.hessian() - expected.hessian()).norm(), 1e-12);

  const LagrangianOf<HamiltonianOf<Fast>> back;
  const Vector<double, 2> v(0.5, -0.6);
  EXPECT_NEAR(back.lagrangian(q, v), Fast{}.lagrangian(q, v), 1e-14);
  const Vector<double, 2> momentum =
      gradient_of([&](const auto& x) { return Fast{}.lagrangian(q.cast<Dual<double>>().eval(), x); }, v);
  EXPECT_LT((fast.velocity(q, momentum) - v).norm(), 1e-14);
}

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

using enum GeneratingType;

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

// ---- orders

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

// ---- exact generating functions

/// The defects of the relations (2.8), (3.11) and (3.13) along a variation (dq, dp) of the start.
template <class M, int N>
std::vector<double> exact_defects(const M& system, const Vector<double, N>& q, const Vector<double, N>& p,
                                  const Vector<double, N>& dq, const Vector<double, N>& dp) {
  using D = Dual<double>;
  Vector<D, N> qs;
  Vector<D, N> ps;
  for (int i = 0; i < N; ++i) {
    qs(i) = D(q(i), dq(i));
    ps(i) = D(p(i), dp(i));
  }
  const auto arc = exact_arc(system, qs, ps, 1.3);
  const auto value = [](const auto& v) {
    return v.unaryExpr([](const D& x) { return x.value; }).template cast<double>().eval();
  };
  const auto pair = [&](const auto& a, const auto& b) { return value(a).dot(derivative_of(b)); };
  const double d1 = arc.generating(one).derivative;
  const double d2 = arc.generating(two).derivative;
  const double d3 = arc.generating(three).derivative;
  return {std::abs(d1 - (pair(arc.p1, arc.q1) - pair(arc.p0, arc.q0))),
          std::abs(d2 - (pair(arc.p0, arc.q0) + pair(arc.q1, arc.p1))),
          std::abs(d3 - (-pair(arc.p1, arc.q1) - pair(arc.q0, arc.p0)))};
}

TEST(ExactGeneratingFunctions, HaveTheFlowForTheirDerivatives) {
  const Vector<double, 3> dq(std::cos(1.0), 0.8, -std::sin(1.0));  // tangent to the sphere
  Vector<double, 3> dp(0.3, -0.5, 0.2);
  dp -= (dp.dot(bob_start.q) + bob_start.p.dot(dq)) * bob_start.q;  // q.p = 0 to first order
  for (const double defect : exact_defects(Bob{}, bob_start.q, bob_start.p, dq, dp)) EXPECT_LT(defect, 1e-13);
  // A variation that leaves the sphere is none of T*Q.
  for (const double defect :
       exact_defects(Bob{}, bob_start.q, bob_start.p, Vector<double, 3>(dq + 0.1 * bob_start.q), dp))
    EXPECT_GT(defect, 1e-3);

  const Vector<double, 1> q(0.4);
  const Vector<double, 1> p(0.9);
  for (const double defect : exact_defects(Swing{}, q, p, Vector<double, 1>(0.3), Vector<double, 1>(-0.8)))
    EXPECT_LT(defect, 1e-13);
}

TEST(ExactGeneratingFunctions, ArcsKeepEnergyAndConstraints) {
  const auto arc = exact_arc(Bob{}, bob_start.q, bob_start.p, 5.0);
  EXPECT_NEAR(Bob{}.hamiltonian(arc.q1, arc.p1), Bob{}.hamiltonian(arc.q0, arc.p0), 1e-13);
  EXPECT_LT(std::abs(Bob{}.constraint(arc.q1)(0)), 1e-13);
  EXPECT_LT(std::abs(arc.q1.dot(arc.p1)), 1e-13);
  const auto back = exact_arc(Bob{}, arc.q1, arc.p1, -5.0);
  EXPECT_LT((back.q1 - bob_start.q).norm() + (back.p1 - bob_start.p).norm(), 1e-12);
}

/// The exponent of h in |H_d+ - H_d^{+,E}| along the solution from a point.
template <class F> double approximation_order(const F& f, const typename HamiltonianMap<F>::Point& start, double h) {
  const auto error = [&](double step) {
    const auto arc = exact_arc(f.system, start.q, start.p, step);
    return std::abs(f.generating(arc.q0, arc.p1, step) - arc.generating(two));
  };
  return std::log2(error(h) / error(h / 2));
}

TEST(ExactGeneratingFunctions, AreApproximatedToTheOrderOfTheMap) {  // (4.4)
  const Phase<1, 0> start{Vector<double, 1>(0.4), Vector<double, 1>(0.9)};
  using quadrature_rules::gauss_3;
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 0>{{}, gauss_3}, start, 0.02), 2, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 1>{{}, gauss_3}, start, 0.02), 3, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 2>{{}, gauss_3}, start, 0.04), 4, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 3>{{}, gauss_3}, start, 0.08), 5, 0.15);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Swing, 4>{{}, gauss_3}, start, 0.1), 6, 0.2);
}

TEST(ExactGeneratingFunctions, OfTheConstrainedAreMissedByTheCubeOfTheStep) {  // (4.20) holds for order two and no more
  using quadrature_rules::gauss_2;
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Plane<1>, 1>{{}, gauss_2}, plane_start<1>(), 0.01), 3, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Plane<1>, 2>{{}, gauss_2}, plane_start<1>(), 0.01), 3, 0.1);
  EXPECT_NEAR(approximation_order(TaylorHamiltonian<Plane<1>, 3>{{}, gauss_2}, plane_start<1>(), 0.01), 3, 0.1);
}

/// No force, on the unit circle.
struct Circle {
  static constexpr int dimension = 2;
  static constexpr int constraints = 1;
  template <class S> S hamiltonian(const Vector<S, 2>&, const Vector<S, 2>& p) const { return p.squaredNorm() * 0.5; }
  template <class S> S lagrangian(const Vector<S, 2>&, const Vector<S, 2>& v) const { return v.squaredNorm() * 0.5; }
  template <class S> Vector<S, 1> constraint(const Vector<S, 2>& q) const {
    return Vector<S, 1>((q.squaredNorm() - 1.0) * 0.5);
  }
};

TEST(ExactGeneratingFunctions, OfChordAndArcDifferByTheCubeOfTheStep) {  // (4.12) likewise
  // (2 sin(v h / 2))^2 / (2 h) - v^2 h / 2 = -v^4 h^3 / 24 + ..., though without the circle the chord is exact.
  const double v = 1.3;
  for (const double h : {0.1, 0.05, 0.025}) {
    const auto arc = exact_arc(Circle{}, Vector<double, Circle::dimension>(1, 0), Vector<double, 2>(0, v), h);
    const double chord = ChordLagrangian<Circle>{{}}.generating(arc.q0, arc.q1, h);
    EXPECT_NEAR((chord - arc.generating(one)) / std::pow(h, 3), -std::pow(v, 4) / 24, 0.2 * h * h);
  }
}

// ---- what the maps preserve

/// A point of T*S^2 from (theta, phi) and the momenta along the coordinate directions, which are unit vectors.
Point3 in_chart(const Vector<double, 4>& x) {
  const double s = std::sin(x(0));
  const double c = std::cos(x(0));
  const double sp = std::sin(x(1));
  const double cp = std::cos(x(1));
  return {{s * cp, s * sp, c}, {x(2) * c * cp - x(3) * sp, x(2) * c * sp + x(3) * cp, -x(2) * s}};
}

/// The largest change of dq ^ dp on T*S^2 by a map of its points.
double symplectic_defect(const std::function<Point3(Point3)>& map) {
  const Vector<double, 4> x(1.0, 0.3, 0.5, 0.7);
  const double e = 2e-3;
  const auto derivative = [&](const std::function<Point3(Point3)>& f, int i) {
    Vector<double, 6> out = Vector<double, 6>::Zero();
    for (const auto& [m, weight] : {std::pair{1.0, 45.0}, {2.0, -9.0}, {3.0, 1.0}}) {
      Vector<double, 4> ahead = x;
      Vector<double, 4> behind = x;
      ahead(i) += m * e;
      behind(i) -= m * e;
      const Point3 a = f(in_chart(ahead));
      const Point3 b = f(in_chart(behind));
      out += weight / (60 * e) * joined(Vector<double, 3>(a.q - b.q), Vector<double, 3>(a.p - b.p));
    }
    return out;
  };
  const auto area = [](const Vector<double, 6>& u, const Vector<double, 6>& v) {
    return u.head<3>().dot(v.tail<3>()) - u.tail<3>().dot(v.head<3>());
  };
  const auto identity = [](const Point3& z) { return z; };
  double worst = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j)
      worst = std::max(worst, std::abs(area(derivative(map, i), derivative(map, j)) -
                                       area(derivative(identity, i), derivative(identity, j))));
  return worst;
}

template <class F> std::function<Point3(Point3)> projected(const F& f, double h) {
  return [map = HamiltonianMap(f), h](Point3 point) {
    EXPECT_EQ(map.step(point, h), SolveStatus::converged);
    point.p = project_momentum(Bob{}, point.q, point.p);
    return point;
  };
}

TEST(Maps, AreSymplecticOnTheConstrainedPhaseSpace) {
  const double h = 0.2;
  EXPECT_LT(symplectic_defect(projected(ChordLagrangian<Bob>{{}}, h)), 1e-11);
  EXPECT_LT(symplectic_defect(projected(TaylorHamiltonian<Bob, 0>{{}}, h)), 1e-11);
  EXPECT_LT(symplectic_defect(projected(adjoint_of(TaylorHamiltonian<Bob, 0>{{}}), h)), 1e-11);
  EXPECT_LT(symplectic_defect(projected(TaylorHamiltonian<Bob, 1>{{}}, h)), 1e-11);
  // Symplectic Euler with its end carried to the sphere is not.
  EXPECT_GT(symplectic_defect([h](Point3 z) {
              z.p(2) -= h;
              z.q = (z.q + h * z.p).normalized();
              z.p = project_momentum(Bob{}, z.q, z.p);
              return z;
            }),
            1e-3);
}

TEST(Maps, ReturnByStepsBackWhereTheyAreSymmetric) {
  const auto defect = [](const auto& map) {
    Point3 point = bob_start;
    for (const double h : {0.1, 0.2, -0.2, -0.1}) EXPECT_EQ(map.step(point, h), SolveStatus::converged);
    return (point.q - bob_start.q).norm() + (project_momentum(Bob{}, point.q, point.p) - bob_start.p).norm();
  };
  EXPECT_LT(defect(HamiltonianMap(ChordLagrangian<Bob>{{}})), 1e-14);
  EXPECT_LT(defect(SymmetrisedMap(TaylorHamiltonian<Bob, 0>{{}})), 1e-14);
  EXPECT_LT(defect(SymmetrisedMap(TaylorHamiltonian<Bob, 1>{{}})), 1e-13);
  EXPECT_GT(defect(HamiltonianMap(TaylorHamiltonian<Bob, 0>{{}})), 1e-3);
}

TEST(Maps, KeepTheirMomentumAndTheirConstraint) {
  const auto vertical = [](const Point3& z) { return z.q(0) * z.p(1) - z.q(1) * z.p(0); };
  const auto drift = [&](const auto& f) {
    const Point3 end = end_of(HamiltonianMap(f), bob_start, 100, 1000);
    EXPECT_LT(std::abs(Bob{}.constraint(end.q)(0)), 1e-15);
    return std::abs(vertical(end) - vertical(bob_start));
  };
  EXPECT_LT(drift(ChordLagrangian<Bob>{{}}), 1e-12);
  EXPECT_LT(drift(TaylorHamiltonian<Bob, 0>{{}}), 1e-12);
  EXPECT_LT(drift(adjoint_of(TaylorHamiltonian<Bob, 0>{{}})), 1e-12);
}

// ---- the reference file

TEST(PendulumRecords, AreReproduced) {
  const auto records = nlohmann::json::parse(std::ifstream(LAGROID_TEST_DATA "/constrained-maps.json"));
  ASSERT_FALSE(records.empty());
  for (const auto& record : records) {
    const Point3 start = bob_at(record.at("theta"), record.at("p_theta"), record.at("p_phi"));
    const double T = record.at("T");
    const auto q = record.at("qref").get<std::vector<double>>();
    const auto p = record.at("pref").get<std::vector<double>>();
    const Vector<double, 3> reference(q[0], q[1], q[2]);
    const auto exact = exact_arc(Bob{}, start.q, start.p, T);
    EXPECT_LT((exact.q1 - reference).norm(), 5e-13);
    EXPECT_LT((exact.p1 - Vector<double, 3>(p[0], p[1], p[2])).norm(), 5e-13);
    const auto compare = [&](const char* method, const auto& f) {
      for (const auto& row : record.at("err").at(method)) {
        const Point3 end = end_of(HamiltonianMap(f), start, T, 1 << row.at(0).get<int>());
        EXPECT_NEAR((end.q - reference).norm(), row.at(1).get<double>(), 3e-13) << method << ' ' << row;
      }
    };
    const TaylorHamiltonian<Bob, 0> right{{}};
    compare("typeII_r0", right);
    compare("typeIII_r0", adjoint_of(right));
    compare("rattle", ChordLagrangian<Bob>{{}});
    compare("typeII_r1_trap", TaylorHamiltonian<Bob, 1>{{}, quadrature_rules::trapezoid});
  }
}

// ---- the page's example

// A bead on a wire z = cosh x, with a spring that hardens.
struct Bead {
  static constexpr int dimension = 2;
  static constexpr int constraints = 1;
  template <class S> S hamiltonian(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    return 0.5 * p.squaredNorm() + q(1) + 0.1 * q.squaredNorm() * q.squaredNorm();
  }
  template <class S> Vector<S, 1> constraint(const Vector<S, 2>& q) const {
    using std::cosh;
    return Vector<S, 1>(q(1) - cosh(q(0)));
  }
};

TEST(Example, OfThePageRuns) {
  const HamiltonianMap map(TaylorHamiltonian<Bead, 1>{});
  Phase<2, 1> point{{0, 1}, {0.5, 0}};
  for (int k = 0; k < 1000; ++k)
    if (map.step(point, 0.01) != SolveStatus::converged) break;
  const auto p = project_momentum(Bead{}, point.q, point.p);

  EXPECT_NEAR(Bead{}.hamiltonian(point.q, p), Bead{}.hamiltonian<double>({0, 1}, {0.5, 0}), 1e-4);
  EXPECT_LT(std::abs(Bead{}.constraint(point.q)(0)), 1e-15);
  const auto exact = exact_arc(Bead{}, Vector<double, 2>(0, 1), Vector<double, 2>(0.5, 0), 10.0);
  EXPECT_LT((point.q - exact.q1).norm() + (p - exact.p1).norm(), 1e-3) << "after all of the thousand steps";
}

// ---- outcomes

/// Twice the same constraint, or one whose derivative vanishes where it holds.
template <int D> struct Degenerate : Bob {
  static constexpr int constraints = D;
  template <class S> Vector<S, D> constraint(const Vector<S, 3>& q) const {
    const S c = (q.squaredNorm() - 1.0) * 0.5;
    return Vector<S, D>::Constant(D == 1 ? S(c * c) : c);
  }
};

template <int D> Phase<3, D> degenerate_start() { return {bob_start.q, bob_start.p}; }

TEST(Outcomes, AreTypedAndLeaveThePointAlone) {
  const auto outcome = [](const auto& f, auto point, double h) {
    const auto before = point;
    const SolveStatus status = HamiltonianMap(f).step(point, h);
    if (status != SolveStatus::converged) {
      EXPECT_TRUE((point.p.array() == before.p.array()).all() || before.p.hasNaN());
      EXPECT_EQ(point.q, before.q);
      EXPECT_EQ(point.multipliers, before.multipliers);
    }
    return status;
  };
  const ChordLagrangian<Bob> trapezoid{{}};
  EXPECT_EQ(outcome(trapezoid, bob_start, 0.1), SolveStatus::converged);
  // A chord longer than the diameter: there is no solution.
  EXPECT_EQ(outcome(trapezoid, bob_start, 10), SolveStatus::not_converged);
  EXPECT_EQ(outcome(TaylorHamiltonian<Bob, 0>{{}}, bob_start, 10), SolveStatus::not_converged);
  // A normal part that Newton's method follows through the sphere.
  Point3 far = bob_start;
  far.p -= 30 * far.q;
  EXPECT_EQ(outcome(TaylorHamiltonian<Bob, 0>{{}}, far, 0.1), SolveStatus::left_domain);
  EXPECT_EQ(outcome(ChordLagrangian<Degenerate<1>>{{}}, degenerate_start<1>(), 0.1), SolveStatus::singular);
  EXPECT_EQ(outcome(ChordLagrangian<Degenerate<2>>{{}}, degenerate_start<2>(), 0.1), SolveStatus::singular);
  Point3 bad = bob_start;
  bad.p(1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(outcome(trapezoid, bad, 0.1), SolveStatus::not_finite);
  EXPECT_EQ(outcome(trapezoid, bob_start, 0.0), SolveStatus::not_finite);
  // Half a composed step is none.
  Point3 point = bob_start;
  EXPECT_NE(composed_step(HamiltonianMap(trapezoid), point, 2.0, compositions::triple_jump), SolveStatus::converged);
  EXPECT_EQ(point.q, bob_start.q);
}

/// Mass, length and gravity in any units, gravity in any direction, the sphere anywhere.
struct AnyBob {
  static constexpr int dimension = 3;
  static constexpr int constraints = 1;
  double mass = 1;
  double length = 1;
  Vector<double, 3> gravity = Vector<double, 3>(0, 0, -1);
  Vector<double, 3> centre = Vector<double, 3>::Zero();
  double scale = 1;  ///< of C
  template <class S> S height(const Vector<S, 3>& q) const {
    return q(0) * gravity(0) + q(1) * gravity(1) + q(2) * gravity(2);
  }
  template <class S> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    return p.squaredNorm() * (0.5 / mass) - height(q) * mass;
  }
  template <class S> S lagrangian(const Vector<S, 3>& q, const Vector<S, 3>& v) const {
    return v.squaredNorm() * (0.5 * mass) + height(q) * mass;
  }
  template <class S> Vector<S, 1> constraint(const Vector<S, 3>& q) const {
    S square(0.0);
    for (int i = 0; i < 3; ++i) square += (q(i) - centre(i)) * (q(i) - centre(i));
    return Vector<S, 1>((square - length * length) * (0.5 * scale));
  }
};

/// How many of 20 steps converge, by types I, II and III together.
int steps_done(const AnyBob& bob, const Point3& start, double h) {
  const auto count = [&](const auto& function) {
    Point3 point = start;
    const HamiltonianMap map(function);
    int done = 0;
    while (done < 20 && map.step(point, h) == SolveStatus::converged) ++done;
    return done;
  };
  return count(ChordLagrangian<AnyBob>{bob}) + count(TaylorHamiltonian<AnyBob, 0>{bob}) +
         count(adjoint_of(TaylorHamiltonian<AnyBob, 0>{bob}));
}

TEST(Maps, StepFromRestInAnyUnits) {
  const Vector<double, 3> along = Vector<double, 3>(0.48, -0.36, 0.8);
  for (const double speed : {0.0, 1e-12, 1e-8}) {
    const Vector<double, 3> velocity = speed * Vector<double, 3>(0, along(2), -along(1));
    // Hanging along gravity, and free.
    EXPECT_EQ(steps_done({.gravity = 9.81 * along}, {along, velocity}, 0.0137), 60) << speed;
    EXPECT_EQ(steps_done({.gravity = Vector<double, 3>::Zero()}, {along, velocity}, 0.0137), 60) << speed;
  }
  for (const double h : {1e-6, 1e-9, -1e-12}) EXPECT_EQ(steps_done({}, bob_start, h), 60) << h;
  for (const double mass : {1e-20, 1e-14, 1e20})
    EXPECT_EQ(steps_done({.mass = mass}, {bob_start.q, mass * bob_start.p}, 0.1), 60) << mass;
  for (const double scale : {1e-20, 1e13, 1e20}) EXPECT_EQ(steps_done({.scale = scale}, bob_start, 0.1), 60) << scale;
  const Vector<double, 3> far(1e8, 0, 0);
  EXPECT_EQ(steps_done({.centre = far}, {far + bob_start.q, bob_start.p}, 0.01), 60);
}

/// A pendulum of variable mass beside a free particle that may be heavy.
struct Beside {
  static constexpr int dimension = 2;
  static constexpr int constraints = 0;
  double mass = 1;
  template <class S> S hamiltonian(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    using std::cos, std::sin;
    return p(0) * p(0) * 0.5 / (sin(q(0)) * 0.5 + 1.0) - cos(q(0)) + p(1) * p(1) * (0.5 / mass);
  }
};

TEST(Maps, AreNotLessExactBesideWhatIsLarge) {
  const auto end = [](double mass) {
    Phase<2, 0> point{{0.4, 0}, {0.9, 0.5 * mass}};
    EXPECT_EQ(HamiltonianMap(TaylorHamiltonian<Beside, 1>{{mass}}).step(point, 0.5), SolveStatus::converged);
    return Vector<double, 2>(point.q(0), point.p(0));
  };
  for (const double mass : {1e8, 1e12}) EXPECT_LT((end(mass) - end(1)).norm(), 1e-14) << mass;
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

TEST(Maps, AllocateNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "not counted under AddressSanitizer";
  const HamiltonianMap map(TaylorHamiltonian<Bob, 1>{{}, quadrature_rules::trapezoid});
  Point3 point = bob_start;
  const long before = allocation_count();
  for (int k = 0; k < 10; ++k) EXPECT_EQ(map.step(point, 0.1), SolveStatus::converged);
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
