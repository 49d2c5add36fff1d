// Hamiltonian dynamics by projection: P and W, the sphere's own forms, and motions that are known otherwise.
#include <lagroid/core/hamiltonian/projected_hamiltonian.hpp>
#include <lagroid/core/testing/property.hpp>
#include <lagroid/groupoids/groups/translations.hpp>
#include <lagroid/groupoids/spheres.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/systems/pendulums/pendulum_chain.hpp>
#include <lagroid/systems/spheres/sphere_hamiltonian.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;

namespace solvers_projected_hamiltonian_tests {
namespace {

/// [H] (hameqpend): a spherical pendulum, as a user would write it.
struct Pendulum3 : ProjectedHamiltonian<Pendulum3, 3, 1> {
  template <class S> Vector<S, 1> constraint(const Vector<S, 3>& q) const { return Vector<S, 1>(q.dot(q) - 1.0); }
  template <class S> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    return p.dot(p) * 0.5 + q(2) * 9.81;
  }
};

/// Two links with the mass matrix of [H] (mmatrp), made symmetric: m_ij (I - q_i q_i^T)(I - q_j q_j^T) is the same on
/// tangent vectors.
struct TwoLinks : ProjectedHamiltonian<TwoLinks, 6, 2> {
  double m1 = 1.3, m2 = 0.4, l1 = 0.8, l2 = 1.1, g = 9.81;
  template <class S> Vector<S, 2> constraint(const Vector<S, 6>& q) const {
    const Vector<S, 3> a = q.template head<3>();
    const Vector<S, 3> b = q.template tail<3>();
    return Vector<S, 2>(a.dot(a) - 1.0, b.dot(b) - 1.0);
  }
  template <class S> Matrix<S, 6, 6> mass_matrix(const Vector<S, 6>& q) const {
    const Vector<S, 3> a = q.template head<3>();
    const Vector<S, 3> b = q.template tail<3>();
    Matrix<S, 3, 3> one = Matrix<S, 3, 3>::Zero();
    for (int i = 0; i < 3; ++i) one(i, i) = S(1.0);
    const Matrix<S, 3, 3> left = one - (a * a.transpose()).eval();
    const Matrix<S, 3, 3> right = one - (b * b.transpose()).eval();
    const Matrix<S, 3, 3> mixed = (left * right).eval() * (m2 * l1 * l2);
    Matrix<S, 6, 6> out;
    out.template topLeftCorner<3, 3>() = one * ((m1 + m2) * l1 * l1);
    out.template topRightCorner<3, 3>() = mixed;
    out.template bottomLeftCorner<3, 3>() = mixed.transpose();
    out.template bottomRightCorner<3, 3>() = one * (m2 * l2 * l2);
    return out;
  }
  template <class S> S potential(const Vector<S, 6>& q) const {
    return q(2) * (g * (m1 + m2) * l1) + q(5) * (g * m2 * l2);
  }
};

/// The energy of the same as one function, for F[H].
struct TwoLinksWhole {
  TwoLinks links;
  template <class S> S energy(const Eigen::Matrix<S, 6, 2>& z) const {
    const Vector<S, 3> q1 = z.col(0).template head<3>();
    const Vector<S, 3> q2 = z.col(1).template head<3>();
    Vector<S, 6> q, p;
    q << q1, q2;
    p << z.col(0).template tail<3>(), z.col(1).template tail<3>();
    Matrix<S, 6, 6> m = links.mass_matrix(q);
    Vector<S, 6> x = p;  // Gauss, without pivots
    for (int i = 0; i < 6; ++i)
      for (int r = i + 1; r < 6; ++r) {
        const S ratio = m(r, i) / m(i, i);
        for (int c = i; c < 6; ++c) m(r, c) -= ratio * m(i, c);
        x(r) -= ratio * x(i);
      }
    for (int i = 6; i-- > 0;) {
      for (int c = i + 1; c < 6; ++c) x(i) -= m(i, c) * x(c);
      x(i) = x(i) / m(i, i);
    }
    S kinetic(0.0);
    for (int i = 0; i < 6; ++i) kinetic += p(i) * x(i);
    return kinetic * 0.5 + links.potential(q);
  }
};

/// A particle on an ellipsoid, and one on a circle in space: two constraints.
struct Ellipsoid : ProjectedHamiltonian<Ellipsoid, 3, 1> {
  template <class S> Vector<S, 1> constraint(const Vector<S, 3>& q) const {
    return Vector<S, 1>(q(0) * q(0) + q(1) * q(1) * 0.5 + q(2) * q(2) * 0.25 - 1.0);
  }
  template <class S> S hamiltonian(const Vector<S, 3>&, const Vector<S, 3>& p) const { return p.dot(p) * 0.5; }
};
struct Circle : ProjectedHamiltonian<Circle, 3, 2> {
  template <class S> Vector<S, 2> constraint(const Vector<S, 3>& q) const {
    return Vector<S, 2>(q.dot(q) - 1.0, q(0) + q(1) + q(2));
  }
  template <class S> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    return p.dot(p) * 0.5 + q(0) * 2.0;
  }
};

using V = Vector<double, 3>;

/// Pendula that pull on each other, however many.
struct Coupled {
  template <class S, int K> S energy(const Eigen::Matrix<S, 6, K>& z) const {
    S sum(0.0);
    for (int i = 0; i < z.cols(); ++i) {
      for (int r = 3; r < 6; ++r) sum += 0.5 * z(r, i) * z(r, i);
      sum += z(2, i) * 9.81;
      if (i > 0)
        for (int r = 0; r < 3; ++r) sum += z(r, i) * z(r, i - 1) * (1.0 + 0.3 * i);
    }
    return sum;
  }
};

TEST(HamiltonianField, OfFixedAndRunTimeSizeAgree) {
  CotangentSpheres<3>::Point z;
  z << 1, 0, 0.6, 0, 1, 0, 0, 0, 0.8, 0, 0.4, 0.8, 0.5, 0, 0.2, 0.7, 1, -0.6;
  HamiltonianField<Coupled, 3> fixed{Coupled{}};
  HamiltonianField<Coupled, Eigen::Dynamic> dynamic{Coupled{}, 3};
  CotangentSpheres<3>::Point u;
  CotangentSpheres<Eigen::Dynamic>::Point w(6, 3);
  fixed(0, z, u);
  dynamic(0, z, w);
  EXPECT_LT((u - w).norm(), 1e-14);
}

TEST(ProjectedHamiltonian, OnTheSphereIsItsOwnForm) {
  const Pendulum3 pendulum;
  const auto law = laws::check_law("P, W and the motion on the sphere", 1e-13, [&] {
    V q(laws::draw_uniform(), laws::draw_uniform(), 1.5 + laws::draw_uniform());
    q.normalize();
    V p(laws::draw_uniform(), laws::draw_uniform(), laws::draw_uniform());
    p -= q * q.dot(p);
    const Matrix<double, 3, 3> plane = Matrix<double, 3, 3>::Identity() - q * q.transpose();
    const Matrix<double, 3, 3> w = p * q.transpose() - q * p.transpose();
    const auto rates = pendulum.rates(q, p);
    const V of_q(0, 0, 9.81);
    return laws::worst({(pendulum.projection(q) - plane).norm(), (pendulum.w(q, p) - w).norm(),
                        (rates.q - plane * p).norm(),
                        (rates.p - (-(plane * of_q) + cross(p, V(cross(p, q))))).norm() / 10});
  });
  EXPECT_TRUE(law.holds()) << law.worst;
}

TEST(ProjectedHamiltonian, IsTheChainsMotion) {
  const TwoLinks links;
  const PendulumChain<2> chain({links.m1, links.m2}, {links.l1, links.l2}, links.g);
  ChainMomentumField<2> field(chain);
  HamiltonianField<TwoLinksWhole, 2> whole{TwoLinksWhole{}};
  const CotangentSpheres<2> space;
  for (const double turn : {0.0, 0.9, 2.5}) {
    CotangentSpheres<2>::Point z;
    z << std::sin(1 + turn), 0.6, 0, 0, std::cos(1 + turn), 0.8, 0.3, 0.4, 1.2, -1.5, -0.7, 0.2;
    space.project(z);
    Vector<double, 6> q, p;
    q << z.col(0).head<3>(), z.col(1).head<3>();
    p << z.col(0).tail<3>(), z.col(1).tail<3>();
    const auto rates = links.rates(q, p);
    CotangentSpheres<2>::Point expected;
    expected.col(0) << rates.q.head<3>(), rates.p.head<3>();
    expected.col(1) << rates.q.tail<3>(), rates.p.tail<3>();
    CotangentSpheres<2>::Point u, by_chain, by_whole;
    field(0, z, u);
    space.generator(u, z, by_chain);
    whole(0, z, u);
    space.generator(u, z, by_whole);
    EXPECT_LT((by_chain - expected).norm(), 1e-12) << turn;
    EXPECT_LT((by_whole - expected).norm(), 1e-12) << turn;
  }
}

template <class System> void stays(const System& system, const V& q, const V& p) {
  Vector<double, 6> z;
  z << q, system.projection(q) * p;
  const double energy = system.energy(q, z.template tail<3>());
  ControlledLieGroupIntegrator integrator(EuclideanSpace<6>{}, system, lie_group_methods::munthe_kaas_54, z,
                                          {.tolerance = 1e-13});
  ASSERT_TRUE(integrator.advance_to(5).converged());
  const V q1 = integrator.point().template head<3>();
  const V p1 = integrator.point().template tail<3>();
  EXPECT_GT((q1 - q).norm(), 0.1);
  EXPECT_LT(system.constraint(q1).norm(), 1e-10);
  EXPECT_LT((system.constraint_jacobian(q1) * p1).norm(), 1e-10);
  EXPECT_NEAR(system.energy(q1, p1), energy, 1e-10);
}

TEST(ProjectedHamiltonian, StaysOnTheCotangentBundle) {
  stays(Ellipsoid{}, V(1, 0, 0), V(0.3, 0.7, 1.1));
  stays(Circle{}, V(1, -1, 0).normalized(), V(0.5, 0.1, -2));
  stays(Pendulum3{}, V(0.6, 0, 0.8), V(0.5, 1, -2));
}

TEST(ProjectedHamiltonian, OnACircleIsThePendulum) {
  // q = a cos s + b sin s in the plane x + y + z = 0, V = 2 a_0 cos s + 2 b_0 sin s: s'' = 2 a_0 sin s - 2 b_0 cos s.
  const V a = V(1, -1, 0).normalized();
  const V b = V(1, 1, -2).normalized();
  struct Angle {
    double along, across;
    void operator()(double, const Vector<double, 2>& y, Vector<double, 2>& out) const {
      out << y(1), 2 * along * std::sin(y(0)) - 2 * across * std::cos(y(0));
    }
  };
  Vector<double, 6> z;
  z << a, 1.5 * b;
  LieGroupIntegrator on_circle(EuclideanSpace<6>{}, Circle{}, lie_group_methods::munthe_kaas_54, z, 1e-3);
  LieGroupIntegrator angle(EuclideanSpace<2>{}, Angle{a(0), b(0)}, lie_group_methods::munthe_kaas_54,
                           Vector<double, 2>(0, 1.5), 1e-3);
  for (int n = 0; n < 3000; ++n) {
    on_circle.advance();
    angle.advance();
  }
  const double s = angle.point()(0);
  EXPECT_LT((on_circle.point().head<3>() - (a * std::cos(s) + b * std::sin(s))).norm(), 1e-12);
}

}  // namespace
}  // namespace solvers_projected_hamiltonian_tests
