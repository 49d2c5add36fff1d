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
/// Requires `flow` and `running_cost`, const templates on the scalar. Order 2 in h. [G] section 6.1 for groups.

#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/control/control_system.hpp>

#include <tuple>
#include <utility>

namespace lagroid {

namespace detail {

/// beta(tau(q, v)), factor by factor of a product, so that no retraction is evaluated where a group has but one object.
template <class G, class Q, class S>
auto moved_object(const G& groupoid, const Q& q, const Vector<S, G::dimension>& v) {
  if constexpr (G::object_coordinate_count() == 0) {
    return q;
  } else {
    return groupoid.target(groupoid.tau(q, v));
  }
}
template <class... Gs, class Q, class S>
auto moved_object(const Product<Gs...>& groupoid, const Q& q, const Vector<S, Product<Gs...>::dimension>& v) {
  int at = 0;
  const auto moved = [&]<class F, class P>(const F& factor, const P& point) {
    Vector<S, F::dimension> part;
    for (int i = 0; i < F::dimension; ++i) part(i) = v(at + i);
    at += F::dimension;
    return moved_object(factor, point, part);
  };
  return [&]<std::size_t... I>(std::index_sequence<I...>) {
    return std::tuple{moved(std::get<I>(groupoid.factor), std::get<I>(q))...};  // braces: in their order
  }
  (std::index_sequence_for<Gs...>());
}

}  // namespace detail

template <class Derived, class G, int ControlCount, int Inequalities = 0>
struct ControlledFlow : ControlSystem<Derived, G, ControlCount, G::dimension, Inequalities> {
  static constexpr int rank = G::dimension;

  template <class A, class V, class S> S cost(const A& g, const V& u, const S& h) const {
    return self().running_cost(midpoint<S>(g, this->groupoid.tau_inverse(g)), u) * h;
  }
  template <class A, class V, class S> Vector<S, rank> constraint(const A& g, const V& u, const S& h) const {
    Vector<S, rank> out = this->groupoid.tau_inverse(g);
    const Vector<S, rank> velocity = self().flow(midpoint<S>(g, out), u);
    for (int i = 0; i < rank; ++i) out(i) -= h * velocity(i);
    return out;
  }

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }
  template <class S, class A> auto midpoint(const A& g, Vector<S, rank> displacement) const {
    for (int i = 0; i < rank; ++i) displacement(i) = displacement(i) * 0.5;
    return detail::moved_object(this->groupoid, this->groupoid.source(g), displacement);
  }
};

}  // namespace lagroid
