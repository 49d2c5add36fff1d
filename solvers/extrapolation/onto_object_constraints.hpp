#pragma once
/// Takes off what extrapolation leaves across object constraints, an error of the step: the arrow is led on to the
/// nearest object with C = 0, to first order.
///
///     onto_object_constraints<double>(system, arrow);
///
/// Requires constraints that are a template on the scalar, which is double or a number with derivatives, and are
/// regular there: else the arrow is not finite. Nothing throws.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/matrices/small_elimination.hpp>
#include <lagroid/core/system.hpp>

namespace lagroid {

template <class S, DiscreteSystem Sys>
void onto_object_constraints(const Sys& system, ArrowOf<typename Sys::GroupoidType, S>& arrow) {
  using D = Dual<S>;
  constexpr int n = Sys::dimension;
  constexpr int k = Sys::object_constraints;
  const auto& groupoid = system.groupoid;
  const auto reached = groupoid.target(arrow);
  Matrix<S, n, k> gradients;
  for (int i = 0; i < n; ++i) {
    Vector<D, n> along = Vector<D, n>::Constant(D(0.0));
    along(i).derivative = S(1.0);
    const auto moved = groupoid.tau(groupoid.template cast_object<D>(reached), along);
    const Vector<D, k> there = system.object_constraint(groupoid.target(moved));
    for (int a = 0; a < k; ++a) gradients(i, a) = there(a).derivative;
  }
  Matrix<S, k, k> products = gradients.transpose() * gradients;
  Matrix<S, k, 1> multipliers = -system.object_constraint(reached);
  eliminate(products, multipliers);
  arrow = groupoid.compose(arrow, groupoid.tau(reached, Vector<S, n>(gradients * multipliers)));
}

}  // namespace lagroid
