// What Hamiltonian maps keep, reproduce and report.
#include "examples.hpp"

#include "../../support/allocation_counter.hpp"

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
#include <utility>
#include <vector>

namespace lagroid::hamiltonian_map_tests::maps_tests {
namespace {

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

TEST(Maps, AllocateNothing) {
  if (allocation_count() < 0) GTEST_SKIP() << "not counted under AddressSanitizer";
  const HamiltonianMap map(TaylorHamiltonian<Bob, 1>{{}, quadrature_rules::trapezoid});
  Point3 point = bob_start;
  const long before = allocation_count();
  for (int k = 0; k < 10; ++k) EXPECT_EQ(map.step(point, 0.1), SolveStatus::converged);
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace lagroid::hamiltonian_map_tests::maps_tests
