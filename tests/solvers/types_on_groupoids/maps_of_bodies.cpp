// Types I, II and III of bodies: which are one map, and what a step of type II says.
#include <lagroid/solvers/galerkin/rules_of_order_two.hpp>

#include "subjects.hpp"

using namespace lagroid;
using namespace lagroid::subjects;

namespace types_on_groupoids_maps_of_bodies_tests {
namespace {

constexpr double h = 0.1;

TEST(TypesOnGroupoids, OfATopAreRectanglesOfTypeOne) { expect_rectangles<Top, TopByMomentum>(top_start, false); }
// Both ends are alike, and the midpoint too.
TEST(TypesOnGroupoids, OfAFreeBodyAreOneMap) {
  const State<SO3> start{{}, {0.3, 1.5, 0.4}};
  expect_rectangles<FreeBody<SO3>, FreeBodyByMomentum<SO3>>(start, true);
  const HamiltonianTaylor<FreeBodyByMomentum<SO3>, 0> second{{}, h};
  EXPECT_LT(difference(second, Midpoint<FreeBody<SO3>>{{}, h}, start), agreement);
  EXPECT_GT(difference(second, HamiltonianTaylor<FreeBodyByMomentum<SO3>, 1>{{}, h}, start), 1e-5);
}

// With x = h H'(p), the momenta at the ends of the arrow tau(x) are those of p seen from either side: this is the exact
// chart of the symplectic groupoid over so(3)*.
TEST(TypesOnGroupoids, OnADualOfAnAlgebraArePointsOfTheExactChart) {
  const HamiltonianTaylor<FreeBodyByMomentum<SO3>, 0> system{{}, h};
  const Vector<double, 3> p(0.4, -0.9, 1.3);
  const Vector<double, 3> x = h * Vector<double, 3>(p(0), p(1) / 2, p(2) / 3);
  const auto side = [&](const Vector<double, 3>& at) -> Vector<double, 3> {
    return SO3::dexp_inverse<double>(at).transpose() * p;
  };
  auto run = make(system, {{}, side(-x)});
  ASSERT_TRUE(run.advance().converged());
  EXPECT_LT((run.point().state.momentum - side(x)).norm(), 1e-14);
  EXPECT_GT((side(x) - side(-x)).norm(), 1e-3);
}

template <class H> double way_back(const State<typename H::GroupoidType>& start, double back) {
  auto ahead = make(HamiltonianTaylor<H, 1>{{}, h}, start);
  EXPECT_TRUE(ahead.advance().converged());
  const auto& there = ahead.point().state;
  HamiltonianTaylor<H, 1, GeneratingType::three> undone{{}, back};
  auto home = make(undone, there);
  EXPECT_TRUE(home.advance().converged());
  const auto& s = home.point().state;
  return (s.momentum - start.momentum).norm() +
         (undone.groupoid.coordinates_of_object(s.object) - undone.groupoid.coordinates_of_object(start.object)).norm();
}
TEST(TypesOnGroupoids, AreEachOthersAdjoints) {
  const State<SO3> body{{}, {0.3, 1.5, 0.4}};
  EXPECT_LT(way_back<FreeBodyByMomentum<SO3>>(body, -h), 1e-14);
  EXPECT_LT(way_back<TopByMomentum>(top_start, -h), 1e-14);
  EXPECT_GT(way_back<TopByMomentum>(top_start, -0.9 * h), 1e-3);
}

// A discrete Lagrangian as a function on A*G and back.
TEST(TypesOnGroupoids, AreChangedIntoTypeOneAndBack) {
  const Trapezoidal<Top> system{{}, h};
  const auto& groupoid = system.groupoid;
  const auto along = [&](const auto& q, const auto& x) { return system.lagrangian(groupoid.tau(q, x)); };
  const auto transformed = [&](const auto& q, const auto& p) { return detail::fibre_transform(groupoid, along, q, p); };
  const Vector<double, 3> q(0, 0.6, 0.8), x(0.1, -0.2, 0.15);
  const double back = detail::fibre_transform(groupoid, transformed, q, x);
  EXPECT_NEAR(back, along(q, x), 1e-14);
}

}  // namespace
}  // namespace types_on_groupoids_maps_of_bodies_tests
