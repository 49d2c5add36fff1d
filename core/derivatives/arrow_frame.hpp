#pragma once
/// Frames e_1 ... e_d of the tangent space T_gG of a whole arrow, d <= 2n, from which derivatives at both ends follow
/// by a matrix product.
///
/// Displacing both ends of an arrow costs 2n infinitesimals; on a group they are displacements of one another, and a
/// frame of n does.
///
///     if constexpr (HasArrowFrame<G>) {
///       const auto jet = groupoid.template frame_jet<Jet<double, G::arrow_dimension>>(g);  // one pass for both ends
///     }
///
/// Requires nothing of a groupoid: a frame is optional, and `arrow_dimension_of` is 0 without one. laws::groupoid_laws
/// tests it to second order.

#include <lagroid/core/groupoid.hpp>

namespace lagroid {

/// An arrow has two ends, each displaced along a fibre of dimension n, but its displacements span T_gG alone, of
/// dimension d <= 2n: for a group the source displacement v is the target displacement -Ad_{g^{-1}} v, so d = n; the
/// ends of a pair are independent, d = 2n. A groupoid **may** supply a frame e_1 ... e_d of T_gG with curves through g
/// along it:
///
///     static constexpr int arrow_dimension = d;
///     Arrow<J> frame_jet<J, Offset>(g)        g displaced by sum_i u_i e_i, u_i the infinitesimals Offset + i of J: to
///                                             first order for a Jet, to second for a SecondJet
///     Matrix<double, n, K> frame_to_end<Which>(g, rows)     P^T rows, where P (d x n) turns a displacement of that end
///                                             of g alone into one of the frame; exact to second order
///     Matrix<double, d, d> frame_bracket(p)   C(i, j) = <p, [e_i, e_j]>, with [ , ] such that displacing by u, then by
///                                             w is displacing by u + w + [u, w] / 2
///
/// Then f with gradient p and Hessian H along the frame has the one-sided Hessians P^T H P and, with v at the source
/// and w at the target, d2f/dv dw = P_source^T (H + C(p) / 2) P_target.
template <class G> constexpr int arrow_dimension_of() {
  if constexpr (requires { G::arrow_dimension; }) {
    return G::arrow_dimension;
  } else {
    return 0;
  }
}
template <class G>
concept HasArrowFrame = arrow_dimension_of<G>()
> 0;

}  // namespace lagroid
