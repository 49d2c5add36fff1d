// A groupoid that lives only here passes the laws, as a user's would; broken ones fail the law they break.
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/groupoids/so3.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace lagroid;

namespace {

/// The affine group of the line acting on R: the action groupoid Aff(1) x R => R. Arrow (a, b, x) from x to
/// exp(a) x + b; objects are not a group's single point, arrows are a plain struct, and nothing but the required
/// operations is supplied.
template <class S> struct AffineArrow { S a, b, x; };

enum class Fault {
  none,
  unit,
  inverse,
  target,
  product,
  retraction,
  inverse_retraction,
  seed,
  momentum_change,
  not_a_number,
  moves_its_source
};

struct Affine : LieGroupoid<Affine, 2> {
  template <class S> using Arrow = AffineArrow<S>;
  template <class S> using Object = Vector<S, 1>;
  static constexpr int arrow_size = 3;
  Fault fault = Fault::none;
  bool has(Fault f) const { return fault == f; }

  template <class S> static Object<S> source(const Arrow<S>& g) { return Object<S>(g.x); }
  template <class S> Object<S> target(const Arrow<S>& g) const {
    using std::exp;
    return Object<S>(has(Fault::target) ? S(exp(g.a) * g.x + g.b * g.b) : S(exp(g.a) * g.x + g.b));
  }
  template <class S> Arrow<S> unit(const Vector<S, 1>& q) const { return {S(0), S(has(Fault::unit) ? 1e-6 : 0), q(0)}; }
  template <class S> Arrow<S> inverse(const Arrow<S>& g) const {
    using std::exp;
    return {-g.a, has(Fault::inverse) ? S(-g.b) : S(-(exp(-g.a) * g.b)), target(g)(0)};
  }
  template <class S> Arrow<S> multiply(const Arrow<S>& g, const Arrow<S>& h) const {
    using std::exp;
    return {g.a + h.a, has(Fault::product) ? S(g.b + h.b) : S(exp(h.a) * g.b + h.b), g.x};
  }
  template <class S> Arrow<S> tau(const Vector<S, 1>& q, const Vector<S, 2>& v) const {
    return {v(0), has(Fault::retraction) ? S(v(1) + S(1e-3)) : v(1),
            has(Fault::moves_its_source) ? S(q(0) + v(0)) : q(0)};
  }
  template <class S> Vector<S, 2> tau_inverse(const Arrow<S>& g) const {
    if (has(Fault::not_a_number)) return {g.a, S(std::numeric_limits<double>::quiet_NaN())};
    return {g.a, has(Fault::inverse_retraction) ? S(g.b * (S(1) + g.b)) : g.b};
  }
  template <class S> static Vector<S, 3> coordinates(const Arrow<S>& g) { return {g.a, g.b, g.x}; }
  template <class S, class V> static Arrow<S> arrow(const V& x) { return {x(0), x(1), x(2)}; }
  template <class M, End First, End Second, int LeftOffset = 0, int RightOffset = LeftOffset, class A>
  auto seed(const A& g) const {
    auto out = this->template seed_by_composition<M, First, Second, LeftOffset, RightOffset>(g);
    if constexpr (M::order == 2)
      for (int i = 0; i < 2 && has(Fault::seed); ++i)
        for (int j = 0; j < 2; ++j) out.b.set_mixed(i, j, -out.b.mixed(i, j));
    return out;
  }
  template <class A, class V> V momentum_change(const A&, const V& source_gradient, const V& target_gradient) const {
    return V((source_gradient + target_gradient) * (has(Fault::momentum_change) ? 1.001 : 1.0));
  }
  static std::string name() { return "Aff(1) x R"; }
};

laws::GroupoidLawOptions options() {
  laws::GroupoidLawOptions o;
  o.large = 2;
  return o;
}

TEST(ForeignGroupoid, PassesTheLaws) {
  const auto report = laws::groupoid_laws(Affine{}, options());
  EXPECT_TRUE(report.holds()) << report;
}

TEST(ForeignGroupoid, SatisfiesTheConcept) {
  static_assert(Groupoid<Affine>);
  static_assert(!Groupoid<AffineArrow<double>>);
}

TEST(ForeignGroupoid, AnchorIsTheInfinitesimalAction) {
  const Affine groupoid;
  EXPECT_NEAR(groupoid.anchor(Vector<double, 1>(3.0), Vector<double, 2>(0.5, 0.25))(0), 0.5 * 3 + 0.25, 1e-15);
}

void expect_broken(Fault fault, const std::vector<std::string>& names) {
  Affine groupoid;
  groupoid.fault = fault;
  const auto report = laws::groupoid_laws(groupoid, options());
  EXPECT_FALSE(report.holds());
  for (const auto& law : names) EXPECT_FALSE(report.law(law).holds()) << law << '\n' << report;
}

TEST(BrokenGroupoid, WrongUnit) { expect_broken(Fault::unit, {"units"}); }
TEST(BrokenGroupoid, WrongInverse) { expect_broken(Fault::inverse, {"inverses"}); }
TEST(BrokenGroupoid, WrongTarget) { expect_broken(Fault::target, {"source and target of products"}); }
TEST(BrokenGroupoid, WrongProduct) { expect_broken(Fault::product, {"source and target of products"}); }
TEST(BrokenGroupoid, WrongRetraction) { expect_broken(Fault::retraction, {"retraction"}); }
TEST(BrokenGroupoid, WrongInverseRetraction) { expect_broken(Fault::inverse_retraction, {"retraction"}); }
TEST(BrokenGroupoid, NotANumberInALaterComponent) { expect_broken(Fault::not_a_number, {"retraction"}); }
TEST(BrokenGroupoid, RetractionThatLeavesItsFibre) { expect_broken(Fault::moves_its_source, {"retraction"}); }
TEST(BrokenGroupoid, WrongMomentumChange) { expect_broken(Fault::momentum_change, {"change of momentum"}); }
TEST(BrokenGroupoid, WrongSeed) { expect_broken(Fault::seed, {"closed-form translations"}); }

/// SO(3) with the bracket of its frame reversed, or its curves straightened.
enum class FrameFault { bracket, curvature };
template <FrameFault Fault> struct BadlyFramed : SO3 {
  template <class T> static Matrix<T, 3, 3> frame_bracket(const Vector<T, 3>& p) {
    return Fault == FrameFault::bracket ? Matrix<T, 3, 3>(-SO3::frame_bracket(p)) : SO3::frame_bracket(p);
  }
  template <class J, int Offset = 0, class T> static Matrix<J, 3, 3> frame_jet(const Matrix<T, 3, 3>& g) {
    Matrix<J, 3, 3> out = SO3::frame_jet<J, Offset>(g);
    if constexpr (J::order == 2 && Fault == FrameFault::curvature)
      for (J& x : out.reshaped())
        for (int i = 0; i < 3; ++i) x.set_row(i, typename J::Row{});
    return out;
  }
};

TEST(BrokenGroupoid, WrongFrame) {
  const auto expect_curved = [](const auto& report) {
    EXPECT_TRUE(report.law("arrow frame").holds()) << report;
    EXPECT_FALSE(report.law("arrow frame, second order").holds()) << report;
  };
  expect_curved(laws::groupoid_laws<BadlyFramed<FrameFault::bracket>>());
  expect_curved(laws::groupoid_laws<BadlyFramed<FrameFault::curvature>>());
}

/// R^2 with a product that is not associative.
struct NotAssociative : LieGroupoid<NotAssociative, 1> {
  template <class S> using Arrow = Vector<S, 1>;
  template <class S> using Object = Vector<S, 0>;
  template <class S> static Object<S> source(const Vector<S, 1>&) { return {}; }
  template <class S> static Object<S> target(const Vector<S, 1>&) { return {}; }
  template <class S> static Vector<S, 1> unit(const Vector<S, 0>&) { return Vector<S, 1>(S(0)); }
  template <class S> static Vector<S, 1> inverse(const Vector<S, 1>& g) { return -g; }
  template <class S> static Vector<S, 1> multiply(const Vector<S, 1>& g, const Vector<S, 1>& h) {
    return Vector<S, 1>(g(0) + h(0) + g(0) * h(0) * (g(0) + h(0)));
  }
  template <class S> static Vector<S, 1> tau(const Vector<S, 0>&, const Vector<S, 1>& v) { return v; }
  template <class S> static Vector<S, 1> tau_inverse(const Vector<S, 1>& g) { return g; }
  static std::string name() { return "a loop"; }
};

TEST(BrokenGroupoid, NotAssociative) {
  const auto report = laws::groupoid_laws<NotAssociative>();
  EXPECT_FALSE(report.law("associativity").holds()) << report;
  EXPECT_FALSE(report.law("right-invariant fields are invariant (2)").holds()) << report;
  EXPECT_FALSE(report.law("tangent of the inversion (3)").holds() && report.law("inverses").holds() &&
               report.law("left-invariant fields are invariant (1)").holds());
}

}  // namespace
