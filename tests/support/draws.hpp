#pragma once
/// Random arrows, multipliers and states for property tests (inside a RapidCheck property).

#include <lagroid/core/system.hpp>
#include <lagroid/core/testing/property.hpp>

namespace lagroid {

/// A step near the unit arrow of a random object: displacement of size `reach`, multipliers of size one.
template <class Sys> Step<Sys> draw_step(const Sys& system, double reach) {
  using G = typename Sys::GroupoidType;
  Vector<double, G::object_coordinate_count()> q;
  for (int i = 0; i < q.size(); ++i) q(i) = 2 + laws::draw_uniform();
  AlgebroidVector<G> v;
  for (int i = 0; i < v.size(); ++i) v(i) = reach * laws::draw_uniform();
  typename Sys::Multipliers lambda;
  for (int i = 0; i < lambda.size(); ++i) lambda(i) = laws::draw_uniform();
  return {system.groupoid.tau(system.groupoid.template object_at<double>(q), v), lambda};
}

}  // namespace lagroid
