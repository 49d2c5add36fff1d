#pragma once
/// Arrows with the inner nodes of a curve beside them: systems on G x R^{n (s - 1)}, whose steps are steps on G with
/// the nodes where the action is stationary.
///
/// On the vector group left and right translations agree, so the momentum of a node is conserved, and with the value
/// zero that it has in `extended` each node is stationary: one Newton iteration finds arrow, nodes and multipliers
/// together, and constraints may hold at every point of the curve.
///
///     const auto start = WithInnerNodes<Pair<2>, 3>::extended({{1, 0}, {0, 1}});
///     const State<Pair<2>> back = WithInnerNodes<Pair<2>, 3>::reduced(start);
///
/// Nothing throws.
///
/// Source: Marsden and West, Acta Numerica 10 (2001), 2.2.6.

#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/product.hpp>

#include <tuple>

namespace lagroid {

/// The groupoid of arrows of G with the inner nodes of curves of degree `Degree`, and its states.
template <class G, int Degree> struct WithInnerNodes {
  static_assert(Degree >= 2, "without inner nodes it is the system itself, by the trapezoid");
  static constexpr int n = G::dimension;
  static constexpr int inner = n * (Degree - 1);
  using Extended = Product<G, VectorGroup<inner>>;

  /// A state of G, the momentum of the nodes zero; and back.
  static State<Extended> extended(const State<G>& s) {
    State<Extended> out;
    std::get<0>(out.object) = s.object;
    out.momentum << s.momentum, Vector<double, inner>::Zero();
    return out;
  }
  static State<G> reduced(const State<Extended>& s) { return {std::get<0>(s.object), s.momentum.template head<n>()}; }
};

}  // namespace lagroid
