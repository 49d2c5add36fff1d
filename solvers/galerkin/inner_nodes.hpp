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

#include <lagroid/core/continuous/discretised_lagrangian.hpp>
#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/product.hpp>

#include <tuple>
#include <utility>

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

/// Base of the discretisations of a continuous Lagrangian L on arrows with inner nodes: as DiscretisedLagrangian is of
/// those on its own groupoid. The derived class writes lagrangian(g, step), constraint(g, step) if there are
/// `ArrowConstraints`, and first_guess(s).
template <class Derived, class L, int Degree, int ArrowConstraints>
struct DiscretisedOnNodes
    : System<Derived, typename WithInnerNodes<typename L::GroupoidType, Degree>::Extended, ArrowConstraints>,
      L,
      WithInnerNodes<typename L::GroupoidType, Degree> {
  static_assert(L::object_constraints == 0,
                "curves with inner nodes beside the arrow would leave the objects that are "
                "allowed: for object constraints take Galerkin by lobatto_pair");
  using BaseGroupoid = typename L::GroupoidType;
  using Nodes = WithInnerNodes<BaseGroupoid, Degree>;
  using GroupoidType = typename Nodes::Extended;
  using Base = System<Derived, GroupoidType, ArrowConstraints>;
  using MembersVary = void;  // constraint, where there are any
  using Continuous = L;
  template <class S> using Arrow = typename Base::template Arrow<S>;
  template <class S> using Object = typename Base::template Object<S>;
  template <class A> using ScalarOf = ArrowScalar<GroupoidType, A>;
  static constexpr int n = L::dimension;
  static constexpr int inner = Nodes::inner;
  static constexpr int dimension = Base::dimension;
  static constexpr int arrow_constraints = Base::arrow_constraints;
  static constexpr int object_constraints = 0;
  static constexpr int constraints = Base::constraints;

  double h = 0.01;

  explicit DiscretisedOnNodes(L continuous = {}, double step = 0.01) : L(std::move(continuous)), h(step) {
    require_continuous<L>();
  }

  const L& continuous() const { return *this; }
  /// The groupoid of L.
  const BaseGroupoid& base() const { return std::get<0>(this->groupoid.factor); }

  template <class A> ScalarOf<A> lagrangian(const A& g) const { return self().lagrangian(g, h); }
  template <class A> Vector<ScalarOf<A>, ArrowConstraints> constraint(const A& g) const requires(ArrowConstraints > 0) {
    return self().constraint(g, h);
  }

  /// E = <mu, xi> - l(q, xi) at mu = dl/dxi + <lambda, dpsi/dxi>: the energy of the continuous system.
  double energy(const State<GroupoidType>& s) const {
    const State<BaseGroupoid> z = Nodes::reduced(s);
    const auto [xi, lambda] = velocity_of(continuous(), base(), z);
    return z.momentum.dot(xi) - this->l(z.object, xi);
  }

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }
};

}  // namespace lagroid
