#pragma once
/// The symplectic form of the dual of an algebroid along one fibre, in the frame of displacements and momenta,
///
///     Omega((v, dmu), (w, dnu)) = dmu.w - v.dnu - <mu, [v, w]>.
///
///     const Eigen::MatrixXd form = laws::detail::symplectic_form(groupoid, state);
///
/// Requires a state. Returns the matrix, allocated; nothing throws.

#include <lagroid/core/algebroid.hpp>
#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/system.hpp>

namespace lagroid::laws::detail {

/// Omega in the coordinates (displacement, momentum) of a state.
template <Groupoid G> Eigen::MatrixXd symplectic_form(const G& groupoid, const State<G>& state) {
  constexpr int n = G::dimension;
  const LieAlgebroid<G> algebroid(groupoid);
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (int i = 0; i < n; ++i) {
    form(i, n + i) = -1;
    form(n + i, i) = 1;
    for (int j = 0; j < n; ++j)
      form(i, j) = -state.momentum.dot(
          algebroid.frame_bracket(state.object, unit_vector<double, n>(i), unit_vector<double, n>(j)));
  }
  return form;
}

}  // namespace lagroid::laws::detail
