// The cotangent groupoid: a groupoid, and a symplectic one; others are not.
#include <lagroid/core/testing/cotangent_laws.hpp>
#include <lagroid/groupoids/groups/se2.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/groupoids/rotated.hpp>

#include "../support/affine.hpp"
#include "../support/broken.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace groupoids_laws_cotangent_tests {
namespace {

TEST(CotangentGroupoid, IsAGroupoid) {
  const auto affine = laws::groupoid_laws<CotangentGroupoid<Affine>>({}, moderate());
  EXPECT_TRUE(affine.holds()) << affine;
  const auto rotations = laws::groupoid_laws<CotangentGroupoid<SO3>>({}, moderate());
  EXPECT_TRUE(rotations.holds()) << rotations;
}

template <class G> class SymplecticLaws : public testing::Test {};
using Groupoids = testing::Types<Affine, SE2, Product<Pair<1>, SO3>, Action<SO3, RotatedVectors>>;
TYPED_TEST_SUITE(SymplecticLaws, Groupoids);

TYPED_TEST(SymplecticLaws, Hold) {
  const auto report = laws::cotangent_laws<TypeParam>({}, moderate());
  EXPECT_TRUE(report.holds()) << report;
}

TEST(CotangentGroupoid, OfAPairIsTheDifferenceOfItsEnds) {
  // T*(Q x Q): covectors (-p0, p1); (p0, p1) and (p1, p2) compose to (p0, p2).
  const CotangentGroupoid<Pair<1>> cotangent;
  const auto covector = [](double q0, double q1, double p0, double p1) {
    // Basis: the target alone; both ends together.
    return Covector<PairArrow<double, 1>, double, 2>{{Vector<double, 1>(q0), Vector<double, 1>(q1)}, {p1, p1 - p0}};
  };
  const auto product = cotangent.multiply(covector(1, 3, 0.25, 0.5), covector(3, -1, 0.5, 4));
  EXPECT_DOUBLE_EQ(cotangent.source(product).momentum(0), 0.25);
  EXPECT_DOUBLE_EQ(cotangent.target(product).momentum(0), 4);
  EXPECT_DOUBLE_EQ(product.arrow.source(0), 1);
  EXPECT_DOUBLE_EQ(product.arrow.target(0), -1);
}

TEST(CotangentGroupoid, OfAGroupCarriesBodyToBodyMomenta) {
  // T*SO(3): source and target of a covector are related by the coadjoint action, mu' = g^T mu.
  const CotangentGroupoid<SO3> cotangent;
  const Covector<Matrix<double, 3, 3>, double, 3> p{SO3::exp(Vector<double, 3>(0.3, -1, 0.5)), {1, 2, 3}};
  EXPECT_LT((cotangent.source(p).momentum - p.arrow * p.values).norm(), 1e-14);
}

TEST(PoissonBracket, OfMomentaOnTheSphere) {
  // {m_i, m_j} = -eps_ijk m_k, {x_i, m_j} = -eps_ijk x_k for the action of SO(3) on R^3.
  using G = Action<SO3, RotatedVectors>;
  const G groupoid;
  const PoissonAlgebra<G> algebra(groupoid);
  const PoissonAlgebra<G>::Point<double> z{Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(-1, 0.5, 2)};
  const auto momentum = [](int i) { return [i](const auto& p) { return p.momentum(i); }; };
  const auto object = [](int i) { return [i](const auto& p) { return p.object(i); }; };
  EXPECT_NEAR(algebra.bracket(z, momentum(0), momentum(1)), -2, 1e-14);
  EXPECT_NEAR(algebra.bracket(z, object(0), momentum(1)), -3, 1e-14);
  EXPECT_NEAR(algebra.bracket(z, object(0), object(1)), 0, 1e-14);
  // Its Casimirs: x.x and x.m.
  const auto square = [](const auto& p) { return p.object.dot(p.object); };
  const auto projection = [](const auto& p) { return p.object.dot(p.momentum); };
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(algebra.bracket(z, square, momentum(i)), 0, 1e-13);
    EXPECT_NEAR(algebra.bracket(z, projection, momentum(i)), 0, 1e-13);
    EXPECT_NEAR(algebra.bracket(z, projection, object(i)), 0, 1e-13);
  }
}

/// T*G with one operation changed.
enum class CotangentFault { product, source, ends, unit };
template <CotangentFault Fault> struct BrokenCotangent : CotangentGroupoid<Affine> {
  using Base = CotangentGroupoid<Affine>;
  using Base::Base;
  // Forgets that momenta are carried: the values of both factors are those of the product's basis.
  template <class P> P multiply(const P& p1, const P& p2) const {
    P p = Base::multiply(p1, p2);
    if (Fault == CotangentFault::product) p.values += p1.values - p2.values;
    return p;
  }
  template <class P> auto source(const P& p) const {
    auto z = Fault == CotangentFault::ends ? Base::target(p) : Base::source(p);
    if (Fault == CotangentFault::source) z.momentum = -z.momentum;
    return z;
  }
  template <class P> auto target(const P& p) const {
    return Fault == CotangentFault::ends ? Base::source(p) : Base::target(p);
  }
  template <class Z> auto unit(const Z& z) const {
    auto p = Base::unit(z);
    if (Fault == CotangentFault::unit) p.values(2) += p.values(0) * z.momentum(1);
    return p;
  }
};

template <CotangentFault Fault> void expect_broken(const std::vector<std::string>& names) {
  const auto report = laws::cotangent_laws(
      Affine{}, [] { return Vector<double, 1>(laws::draw_vector<1>(2.0)); }, moderate(), BrokenCotangent<Fault>());
  for (const auto& law : names) EXPECT_TRUE(laws::seen_broken(report.law(law))) << law << '\n' << report;
}

TEST(BrokenCotangentGroupoid, Product) {
  expect_broken<CotangentFault::product>({"graph of the product is Lagrangian"});
}
TEST(BrokenCotangentGroupoid, Source) { expect_broken<CotangentFault::source>({"source is anti-Poisson"}); }
TEST(BrokenCotangentGroupoid, SwappedEnds) {
  expect_broken<CotangentFault::ends>({"source is anti-Poisson", "target is Poisson"});
}
TEST(BrokenCotangentGroupoid, Unit) { expect_broken<CotangentFault::unit>({"units are Lagrangian"}); }
TEST(BrokenCotangentGroupoid, OfAGroupoidWhoseBisectionsMissTheirArrows) {
  Affine groupoid;
  groupoid.fault = Fault::bisection;
  const auto report = laws::cotangent_laws(groupoid, moderate());
  for (const char* law : {"tangent of the product (A.1)", "fibres of source and target are orthogonal"})
    EXPECT_TRUE(laws::seen_broken(report.law(law))) << report;
}

}  // namespace
}  // namespace groupoids_laws_cotangent_tests
