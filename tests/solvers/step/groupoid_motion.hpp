#pragma once
/// A motion on any groupoid.

#include <lagroid/core/system.hpp>
#include <lagroid/core/testing/property.hpp>

#include <utility>

namespace lagroid {

/// L(g) = |w|^2_I / (2 h) - h (U(alpha(g)) + U(beta(g))) / 2 with w = tau^{-1}(g), unequal weights I_i = 1 + i / 2 and
/// U the sum of x^2 / 2 + x^4 / 8 over the coordinates x of an object.
template <class G> struct Motion : System<Motion<G>, G> {
  double h = 0.05;

  template <class A> auto lagrangian(const A& g) const {
    const auto w = this->groupoid.tau_inverse(g);
    auto kinetic = w(0) * w(0);
    for (int i = 1; i < w.size(); ++i) kinetic = kinetic + w(i) * w(i) * (1 + 0.5 * i);
    return kinetic * (0.5 / h) - (potential<decltype(kinetic)>(this->groupoid.source(g)) +
                                  potential<decltype(kinetic)>(this->groupoid.target(g))) *
                                     (0.5 * h);
  }

 private:
  template <class S, class Q> S potential(const Q& q) const {
    const auto x = this->groupoid.coordinates_of_object(q);
    S sum(0.0);
    for (int i = 0; i < x.size(); ++i) {
      const S square = x(i) * x(i);
      sum = sum + square * 0.5 + square * square * 0.125;
    }
    return sum;
  }
};

/// A state of size `momentum` near the object at the end of tau(q, v) for |v| < 1 from `object`.
template <class G> State<G> draw_motion(const G& groupoid, const ObjectOf<G>& object, double momentum) {
  State<G> s;
  AlgebroidVector<G> v;
  for (double& x : v) x = laws::draw_uniform();
  s.object = groupoid.target(groupoid.tau(object, v));
  for (double& x : s.momentum) x = momentum * laws::draw_uniform();
  return s;
}

}  // namespace lagroid
