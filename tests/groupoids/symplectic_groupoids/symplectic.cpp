// Symplectic laws of local groupoids, truncations, products of bisections, and broken subjects.
#include "../../support/broken.hpp"
#include "near_units.hpp"

#include <lagroid/core/bisection.hpp>
#include <lagroid/core/derivatives/implicit.hpp>
#include <lagroid/core/testing/sampling.hpp>
#include <lagroid/groupoids/poisson/tree_chart.hpp>
#include <lagroid/systems/poisson/fields.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/rotations.hpp>

#include <cmath>

namespace lagroid::symplectic_groupoids_symplectic_tests {
namespace {

TEST(SymplecticGroupoid, ByFrozenFlowsIsSymplecticWhateverTheBracket) {
  const laws::Sampling few(10, 4);
  const auto hold = [](const auto& groupoid) {
    const auto found = laws::symplectic_groupoid_laws(
        groupoid, draw_point<std::remove_cvref_t<decltype(groupoid)>::dimension>, near_units);
    EXPECT_TRUE(found.holds()) << found;
  };
  hold(SymplecticGroupoid<FrozenChart<Sklyanin>>());
}

TEST(SymplecticGroupoid, ByFrozenFlowsIsTheClosedFormOfRotations) {
  const FrozenChart<EulerTop> frozen;
  const RotationChart<EulerTop> closed;
  const Vector<double, 3> x(0.8, -0.6, 1.1), u(0.3, -0.5, 0.2), v(-0.4, 0.1, 0.6);
  EXPECT_LT((frozen.from(x, u).middle - closed.from(x, u).middle).norm(), 1e-15);
  EXPECT_LT((frozen.from(x, u).end - closed.from(x, u).end).norm(), 1e-15);
  EXPECT_LT((frozen.product(x, u, v) - closed.product(x, u, v)).norm(), 1e-14);
}

TEST(SymplecticGroupoid, FlowsBeyondTheSeriesAreTakenInParts) {
  // Karasev's chart has exact Casimirs whatever p is; this p is beyond the radius of the power series.
  const FrozenChart<ThreeSpecies> chart;
  const Vector<double, 3> x(1, 1.9, 0.5);
  const auto arc = chart.from(x, Vector<double, 3>(1.1, -0.9, 0.7));
  EXPECT_TRUE(arc.known);
  EXPECT_NEAR(chart.system.casimirs(arc.end)(0), chart.system.casimirs(x)(0), 1e-14);
  // These populations explode before the unit of time is over.
  const FrozenChart<LotkaVolterra> two;
  EXPECT_FALSE(two.from(Vector<double, 2>(2, 0.5), Vector<double, 2>(-3, 3)).known);
}

/// Products of bisections compose the maps, and Lagrangian ones stay Lagrangian.
template <class G, class Energy>
auto bisection_of(const G& groupoid, const Vector<double, G::dimension>& x, const Energy& energy) {
  constexpr int n = G::dimension;
  return Bisection(groupoid, x, [=](const auto& q) {
    using S = typename std::remove_cvref_t<decltype(q)>::Scalar;
    const auto residual = [&](const auto& u, const auto& at) {
      const auto middle = groupoid.darboux_chart().from(at, u).middle;
      const auto wanted = groupoid.darboux_chart().coordinate(middle, gradient_of(energy, middle));
      return (u - wanted).eval();
    };
    const auto u = solve_implicit<S, n, n>(residual, Vector<double, n>(Vector<double, n>::Zero()), q);
    return groupoid.tau(q, u);
  });
}
template <class G> double asymmetry_of_product(const G& groupoid, bool swapped) {
  constexpr int n = G::dimension;
  const auto first = [](const auto& x) { return x(0) * x(1) * 0.2 + x(n - 1) * x(n - 1) * 0.1; };
  const auto second = [](const auto& x) { return x(0) * x(0) * 0.15 - x(n - 1) * x(0) * 0.1; };
  const Vector<double, n> x = Vector<double, n>::Constant(0.9) + 0.2 * Vector<double, n>::Unit(0);
  const auto b1 = bisection_of(groupoid, x, first);
  const auto b2 = bisection_of(groupoid, b1.image(x), second);
  const auto product = b1 * b2;
  EXPECT_LT((product.image(x) - b2.image(b1.image(x))).norm(), 1e-12);
  // The product's (middle, p) as functions of its source: dp/dmiddle is symmetric.
  const auto canonical = jacobian(x, [&](const auto& q) {
    const auto g = b1(q);
    const auto h = b2(groupoid.target(g));
    return groupoid.darboux(
        swapped ? groupoid.tau(q, groupoid.darboux_chart().product(q, groupoid.tau_inverse(h), groupoid.tau_inverse(g)))
                : groupoid.multiply(g, h));
  });
  const Eigen::MatrixXd slope = canonical.bottomRows(n) * inverse_of(canonical.topRows(n));
  return (slope - slope.transpose()).cwiseAbs().maxCoeff();
}

TEST(SymplecticGroupoid, ProductsOfLagrangianBisectionsAreLagrangianAndComposeTheMaps) {
  EXPECT_LT(asymmetry_of_product(SymplecticGroupoid<RotationChart<EulerTop>>(), false), 1e-13);
  EXPECT_GT(asymmetry_of_product(SymplecticGroupoid<RotationChart<EulerTop>>(), true), 1e-3);
  EXPECT_LT(asymmetry_of_product(SymplecticGroupoid<FrozenChart<LotkaVolterra>>(), false), 1e-12);
}

/// A truncated chart as (x, p) -> source, target.
template <class Sys, int K> struct Truncated {
  TreeChart<Sys, K> chart;
  static constexpr int n = Sys::dimension;
  template <class S> Vector<S, n> source(const Vector<S, 2 * n>& y) const {
    return chart.source(part<0, n>(y), part<n, n>(y));
  }
  template <class S> Vector<S, n> target(const Vector<S, 2 * n>& y) const {
    return chart.target(part<0, n>(y), part<n, n>(y));
  }
  template <class S> Vector<S, 2 * n> darboux(const Vector<S, 2 * n>& y) const { return y; }
  Matrix<double, n, n> bivector(const Vector<double, n>& x) const { return chart.bivector(x); }
};
/// The largest defect of the sources of momenta of that size.
template <class Sys, int K> double defect_of_source(double size) {
  constexpr int n = Sys::dimension;
  Vector<double, 2 * n> y;
  for (int i = 0; i < n; ++i) {
    y(i) = 1 + 0.1 * i;
    y(n + i) = size * (i % 2 == 0 ? 0.8 : -0.5 - 0.1 * i);
  }
  const Truncated<Sys, K> subject{};
  const Eigen::MatrixXd slope = jacobian(y, [&](const auto& z) { return subject.source(z); });
  return (slope * canonical_tensor<n>() * slope.transpose() - subject.bivector(subject.source(y)))
      .cwiseAbs()
      .maxCoeff();
}

TEST(TruncatedGroupoid, DefectsAreOfTheStatedOrder) {
  const auto order = [](auto defect) { return std::log2(defect(0.02) / defect(0.01)); };
  // p^K: alpha is right to that order, and its bracket has one derivative by p.
  EXPECT_NEAR(order(defect_of_source<ThreeSpecies, 1>), 1, 0.05);
  EXPECT_NEAR(order(defect_of_source<ThreeSpecies, 3>), 3, 0.05);
  EXPECT_NEAR(order(defect_of_source<EulerTop, 1>), 1, 0.05);
  EXPECT_NEAR(order(defect_of_source<EulerTop, 3>), 3, 0.05);
}

TEST(BrokenSymplecticGroupoid, ATruncationIsNotPoissonToRoundOff) {
  const auto draw = [] {
    Vector<double, 6> y;
    for (int i = 0; i < 6; ++i) y(i) = i < 3 ? 1 + 0.3 * laws::draw_uniform() : 0.5 * laws::draw_uniform();
    return y;
  };
  const auto found = laws::symplectic_chart_laws<3>("truncated", Truncated<ThreeSpecies, 3>{}, draw, 1e-11);
  EXPECT_TRUE(laws::seen_broken(found.law("the source is Poisson"))) << found;
  EXPECT_TRUE(laws::seen_broken(found.law("the target is anti-Poisson"))) << found;
  EXPECT_TRUE(laws::seen_broken(found.law("source and target commute"))) << found;
}

/// Momenta add up, as if the bracket were constant.
struct AddingChart : RotationChart<EulerTop> {
  template <class S> Vector<S, 3> product(const Vector<S, 3>&, const Vector<S, 3>& u, const Vector<S, 3>& v) const {
    return u + v;
  }
};
/// The middle of the chord in place of the mean.
struct ChordChart : FrozenChart<LotkaVolterra> {
  template <class S> ChartArc<S, 2> from(const Vector<S, 2>& x, const Vector<S, 2>& p) const {
    auto arc = FrozenChart<LotkaVolterra>::from(x, p);
    for (int i = 0; i < 2; ++i) arc.middle(i) = (x(i) + arc.end(i)) * 0.5;
    return arc;
  }
};

TEST(BrokenSymplecticGroupoid, AProductThatAddsMomenta) {
  const SymplecticGroupoid<AddingChart> groupoid;
  const auto symplectic = laws::symplectic_groupoid_laws(groupoid, draw_point<3>, near_units);
  EXPECT_TRUE(laws::seen_broken(symplectic.law("the product's graph is Lagrangian"))) << symplectic;
}

TEST(BrokenSymplecticGroupoid, AMiddleThatIsNotTheMean) {
  const laws::Sampling few(10, 5);
  const auto found = laws::symplectic_groupoid_laws(SymplecticGroupoid<ChordChart>(), draw_point<2>, near_units);
  EXPECT_TRUE(laws::seen_broken(found.law("the source is Poisson"))) << found;
  EXPECT_TRUE(laws::seen_broken(found.law("the target is anti-Poisson"))) << found;
}

}  // namespace
}  // namespace lagroid::symplectic_groupoids_symplectic_tests
