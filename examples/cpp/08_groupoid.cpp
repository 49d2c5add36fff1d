// 08  A groupoid of one's own, and its laws.
//
// One learns: that a groupoid is two types and seven operations, and how to know that they are right. Here an arrow is
// (x, s, d), a camera that zooms by e^s and pans by d: what it showed at x it then shows at y = e^s x + d. One after
// another such moves are
//
//     (x, s, d)(y, s', d') = (x, s + s', e^{s'} d + d')
//
// The suite puts the axioms ([G] Def. 2.1), the retraction and the invariant fields ([G] (1) to (3)) to random arrows.
// A product that forgets to zoom the pan before it is found out, and the laws that it breaks are named. What else is
// needed, as the bracket of the Lie algebroid ([G] Def. 2.9), is deduced from the seven by differentiation.
//
// Run: ninja -C build/release 08_groupoid && build/release/bin/08_groupoid
#include <lagroid/core/algebroid.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/core/testing/sampling.hpp>

#include <fmt/format.h>

#include <cmath>
#include <string>

using namespace lagroid;
using std::exp;  // beside those of scalars that carry derivatives

template <bool Forgetful> struct Cameras : LieGroupoid<Cameras<Forgetful>, /*dimension of fibres*/ 2> {
  template <class S> using Arrow = Vector<S, 3>;
  template <class S> using Object = Vector<S, 1>;
  template <class S> static Object<S> source(const Arrow<S>& g) { return Object<S>(g(0)); }
  template <class S> static Object<S> target(const Arrow<S>& g) { return Object<S>(exp(g(1)) * g(0) + g(2)); }
  template <class S> static Arrow<S> unit(const Object<S>& x) { return {x(0), S(0), S(0)}; }
  template <class S> static Arrow<S> inverse(const Arrow<S>& g) { return {target(g)(0), -g(1), -exp(-g(1)) * g(2)}; }
  template <class S> static Arrow<S> multiply(const Arrow<S>& g, const Arrow<S>& h) {
    return {g(0), g(1) + h(1), (Forgetful ? S(1) : exp(h(1))) * g(2) + h(2)};
  }
  template <class S> static Arrow<S> tau(const Object<S>& x, const Vector<S, 2>& v) { return {x(0), v(0), v(1)}; }
  template <class S> static Vector<S, 2> tau_inverse(const Arrow<S>& g) { return {g(1), g(2)}; }
  static std::string name() { return Forgetful ? "forgetful cameras" : "cameras"; }
};

template <class G> void ask() {
  const laws::Sampling quietly(/*samples=*/100, /*seed=*/1);
  const laws::LawReport report = laws::groupoid_laws<G>();
  fmt::print("{}: {} laws, {}\n", report.subject, report.laws.size(), report.holds() ? "all hold" : "broken are");
  for (const laws::Law& law : report.laws)
    if (!law.holds()) fmt::print("  {}\n", law.name);
}

int main() {
  ask<Cameras<false>>();
  ask<Cameras<true>>();
  const Cameras<false> cameras;
  const Vector<double, 2> zoom(1, 0), pan(0, 1);
  const auto bracket = LieAlgebroid(cameras).frame_bracket(Vector<double, 1>(0.7), zoom, pan);
  fmt::print("[zoom, pan] = ({:.0f}, {:.0f})\n", bracket(0), bracket(1));
  return 0;
}
