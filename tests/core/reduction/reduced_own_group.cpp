// A system on pairs of elements of a user's own group, reduced by left translations.

#include <lagroid/groupoids/morphisms.hpp>

#include "../../support/reduced_runs.hpp"

#include <gtest/gtest.h>

using namespace lagroid;

namespace reduction_reduced_own_group_tests {
namespace {

constexpr int steps = 1000;

/// The Heisenberg group, a user's own: (x, y, z)(x', y', z') = (x + x', y + y', z + z' + (x y' - y x') / 2).
struct Heisenberg : LieGroupoid<Heisenberg, 3> {
  template <class S> using Arrow = Vector<S, 3>;
  template <class S> using Object = Vector<S, 0>;
  template <class S> static Object<S> source(const Vector<S, 3>&) { return {}; }
  template <class S> static Object<S> target(const Vector<S, 3>&) { return {}; }
  template <class S> static Vector<S, 3> unit(const Vector<S, 0>&) { return Vector<S, 3>::Constant(S(0.0)); }
  template <class S> static Vector<S, 3> inverse(const Vector<S, 3>& g) { return -g; }
  template <class S> static Vector<S, 3> multiply(const Vector<S, 3>& g, const Vector<S, 3>& h) {
    return {g(0) + h(0), g(1) + h(1), g(2) + h(2) + (g(0) * h(1) - g(1) * h(0)) * 0.5};
  }
  template <class S> static Vector<S, 3> tau(const Vector<S, 0>&, const Vector<S, 3>& v) { return v; }
  template <class S> static Vector<S, 3> tau_inverse(const Vector<S, 3>& g) { return g; }
  static std::string name() { return "Heisenberg"; }
};
/// A charge in a homogeneous field, on pairs of points of the group, by the left-invariant metric.
struct Charge : System<Charge, PairOf<Heisenberg>> {
  double h = 0.1;
  double pull = 0;
  template <class A> auto lagrangian(const A& g) const {
    const auto d = groupoid.quotient(g);
    using S = typename std::remove_cvref_t<decltype(d)>::Scalar;
    return S(d.squaredNorm() * (0.5 / h) + g.target(0) * pull);
  }
};

TEST(Reduction, OfASystemOnAGroupOfTheUsersOwn) {
  Charge full;
  const Vector<double, 3> origin = Vector<double, 3>::Zero();
  const auto arrows = arrows_about(full.groupoid, origin, 1);
  const auto reduced = reduce(LeftQuotient<Heisenberg>{}, full, arrows);
  const ElementPair<Vector<double, 3>> start{origin, Vector<double, 3>(1, -2, 0.5)};
  EXPECT_TRUE(agree(run_side_by_side(reduced, reduced, start, Vector<double, 3>(1, 0.2, 0.7), steps)));
  full.pull = 1e-3;
  EXPECT_THROW(reduce(LeftQuotient<Heisenberg>{}, full, arrows), DoesNotDescend);
}

/// a^{-1} b with the order of its factors confused.
struct WrongQuotient : Morphism<WrongQuotient, PairOf<Heisenberg>, Heisenberg> {
  template <class V> V operator()(const ElementPair<V>& g) const {
    return this->to.multiply(g.target, this->to.inverse(g.source));
  }
  template <class V> ElementPair<V> lift(const V& a, const V& g) const { return {a, this->to.multiply(g, a)}; }
  template <class V> ElementPair<V> representative(const V& g) const { return {g * 0, g}; }
};
TEST(BrokenReduction, ByAMapThatIsNoMorphism) {
  const Charge full;
  const auto arrows = arrows_about(full.groupoid, Vector<double, 3>(0.3, 0.1, 0.2).eval(), 1);
  try {
    reduce(WrongQuotient{}, full, arrows);
    FAIL() << "b a^{-1} reverses products";
  } catch (const DoesNotDescend& refused) {
    EXPECT_EQ(refused.report.worst()->ingredient, Ingredient::morphism);
    EXPECT_EQ(refused.report.worst()->sample.size(), 6U);
    EXPECT_NE(std::string(refused.what()).find("the morphism is none: at the arrow ("), std::string::npos);
  }
}

}  // namespace
}  // namespace reduction_reduced_own_group_tests
