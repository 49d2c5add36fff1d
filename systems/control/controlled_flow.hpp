#pragma once
/// Optimal control of a differential equation on an algebroid by the midpoint rule on its groupoid,
///
///     q' = rho(f(q, u)),    minimise the integral of l(q, u):    tau^{-1}(g) = h f(q, u),    cost h l(q, u),
///
/// q = beta(tau(alpha(g), tau^{-1}(g) / 2)) the midpoint of the arrow. Dynamics are written once, in the words of a
/// textbook, and live on any groupoid: velocities of a body on SE(2), momenta beside it on Pair<n>.
///
///     struct Cart : ControlledFlow<Cart, Pair<2>, /*controls*/ 1> {
///       template <class S> Vector<S, 2> flow(const Object<S>& q, const Controls<S>& u) const { return {q(1), u(0)}; }
///       template <class S> S running_cost(const Object<S>&, const Controls<S>& u) const { return u(0) * u(0); }
///     };
///
/// Requires `flow` and `running_cost`, const templates on the scalar. Where they read the objects of some factors of a
/// product only, `static constexpr std::array flow_reads{false, true}` says of which: the others are not evaluated, and
/// a flow that reads one does not compile. Order 2 in h. [G] section 6.1 for groups.

#include <lagroid/solvers/control/control_system.hpp>
#include <lagroid/systems/control/flow_derivatives.hpp>

#include <cstddef>
#include <type_traits>

namespace lagroid {

template <class Derived, class G, int ControlCount, int Inequalities = 0>
struct ControlledFlow : ControlSystem<Derived, G, ControlCount, G::dimension, Inequalities>,
                        WeighedCost<Derived, ControlCount> {
  static constexpr int rank = G::dimension;

  template <class A, class V, class S, class Value>
  using Member = Value (ControlledFlow::*)(const A&, const V&, const S&) const;
  /// Whether cost and constraint are those of this class.
  template <class A, class V, class S> static constexpr bool inherits = requires {
    requires std::is_same_v<decltype(&Derived::template cost<A, V, S>), Member<A, V, S, S>>;
    requires std::is_same_v<decltype(&Derived::template constraint<A, V, S>), Member<A, V, S, Vector<S, rank>>>;
  };

  /// Whether flow and running cost read the object of a factor of a product.
  static constexpr bool reads(std::size_t factor) {
    if constexpr (requires { Derived::flow_reads; }) {
      return Derived::flow_reads[factor];
    } else {
      return true;
    }
  }

  template <class A, class V, class S> S cost(const A& g, const V& u, const S& h) const {
    return this->cost_rate(midpoint<S>(g, this->groupoid.tau_inverse(g)), u) * h;
  }
  template <class A, class V, class S> Vector<S, rank> constraint(const A& g, const V& u, const S& h) const {
    S cost;
    Vector<S, rank> out;
    evaluate(g, u, h, cost, out);
    return out;
  }
  /// Both, from one midpoint. Not of a class that writes one of them anew.
  template <class A, class V, class S>
  requires inherits<A, V, S>
  void cost_and_constraint(const A& g, const V& u, const S& h, S& cost, Vector<S, rank>& constraint) const {
    evaluate(g, u, h, cost, constraint);
  }
  /// Their derivatives, of cost + <lambda, constraint> the second ones (transcription_of.hpp).
  template <class A, class V>
  requires inherits<A, V, double>
  void stage_derivatives(const A& g, const V& u, double h, const double* lambda, const StagePlaces& out) const {
    FlowDerivatives<Derived>::evaluate(self(), g, u, h, lambda, out);
  }

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }
  template <class A, class V, class S>
  void evaluate(const A& g, const V& u, const S& h, S& cost, Vector<S, rank>& constraint) const {
    constraint = this->groupoid.tau_inverse(g);
    const auto q = midpoint<S>(g, constraint);
    cost = this->cost_rate(q, u) * h;
    const Vector<S, rank> velocity = self().flow(q, u);
    for (int i = 0; i < rank; ++i) constraint(i) -= h * velocity(i);
  }
  template <class S, class A> auto midpoint(const A& g, const Vector<S, rank>& displacement) const {
    Vector<S, rank> half;
    for (int i = 0; i < rank; ++i) half(i) = displacement(i) * 0.5;
    return detail::moved_target<ControlledFlow>(this->groupoid, g, half);
  }
};

}  // namespace lagroid
