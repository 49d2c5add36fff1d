#pragma once
/// Discrete Lagrangians of high order: the curve of a step is a polynomial of degree s with inner nodes,
///
///     L(q0, x, q1) = h sum_i b_i L(q(c_i), q'(c_i)),    b, c of Lobatto's quadrature,
///
/// of order 2 s, symmetric, and one step where compositions take several, some of them backwards.
///
///     const GalerkinMechanics<Kepler, 3> kepler{Kepler{}};  // order six
///     const auto start = kepler.extended({{1, 0}, {0, 1}});
///     const auto end = kepler.reduced(start);
///
/// Requires a variational system without constraints (it does not compile otherwise), one of point masses or on a
/// matrix group. States are extended by the nodes' momenta, which are zero. (Marsden and West 2001, 2.2.6; Hall and
/// Leok 2015.)

#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <array>
#include <cmath>
#include <string>

namespace lagroid {

/// Lobatto's quadrature on [0, 1] with s + 1 nodes, the ends among them: exact for degree 2 s - 1. And the derivatives
/// at the nodes of the polynomials of degree s through them.
template <int Degree> struct LobattoRule {
  static_assert(Degree >= 1 && Degree <= 4);
  static constexpr int nodes = Degree + 1;
  std::array<double, nodes> node;
  std::array<double, nodes> weight;
  std::array<std::array<double, nodes>, nodes> derivative;  ///< [i][j]: of the j-th Lagrange polynomial at node i

  LobattoRule() {
    if constexpr (Degree == 1) {
      node = {0, 1};
      weight = {0.5, 0.5};
    } else if constexpr (Degree == 2) {
      node = {0, 0.5, 1};
      weight = {1.0 / 6, 2.0 / 3, 1.0 / 6};
    } else if constexpr (Degree == 3) {
      const double r = std::sqrt(5.0) / 10;
      node = {0, 0.5 - r, 0.5 + r, 1};
      weight = {1.0 / 12, 5.0 / 12, 5.0 / 12, 1.0 / 12};
    } else {
      const double r = std::sqrt(21.0) / 14;
      node = {0, 0.5 - r, 0.5, 0.5 + r, 1};
      weight = {1.0 / 20, 49.0 / 180, 16.0 / 45, 49.0 / 180, 1.0 / 20};
    }
    const auto product_without = [&](std::size_t j) {
      double p = 1;
      for (std::size_t k = 0; k < nodes; ++k)
        if (k != j) p *= node[j] - node[k];
      return p;
    };
    for (std::size_t i = 0; i < nodes; ++i) {
      derivative[i][i] = 0;
      for (std::size_t j = 0; j < nodes; ++j) {
        if (i == j) continue;
        derivative[i][j] = product_without(i) / (product_without(j) * (node[i] - node[j]));
        derivative[i][i] -= derivative[i][j];
      }
    }
  }

  static const LobattoRule& rule() {
    static const LobattoRule the_rule;
    return the_rule;
  }
};

/// What the Galerkin systems have in common. Their arrows are those of G beside the inner nodes of the curve, s - 1
/// vectors of R^n: G x R^{n (s - 1)}. On the vector group left and right translations agree, so the momentum of a node
/// is conserved, and with the value zero that it has in `extended` the nodes are where the action is stationary: the
/// step on G is that of the discrete Lagrangian with the nodes eliminated. Order 2 s, symmetric, implicit (Marsden and
/// West 2001, 2.2.6; Hall and Leok 2015).
template <class Derived, class Base, int Degree>
struct GalerkinSystem
    : System<Derived,
             Product<typename Base::GroupoidType, VectorGroup<Base::dimension*(Degree > 1 ? Degree - 1 : 1)>>> {
  static_assert(Degree >= 2, "without inner nodes it is the system itself, by the trapezoid");
  static_assert(Base::constraints == 0,
                "a curve with inner nodes would keep the constraints of its system at its ends alone: Galerkin systems "
                "are made of systems without constraints (for higher order with constraints compose steps)");
  static_assert(Variational<Base>, "Galerkin systems are made of systems without forces");
  static constexpr int n = Base::dimension;
  static constexpr int inner = Degree - 1;
  using Extended = Product<typename Base::GroupoidType, VectorGroup<n * inner>>;

  Base base;
  double h;

  explicit GalerkinSystem(Base system) : base(std::move(system)), h(base.h) {
    std::get<0>(this->groupoid.factor) = base.groupoid;
  }

  static MethodTraits traits() { return {"Lobatto " + std::to_string(Degree + 1), 2 * Degree, true, true, false}; }

  /// A state of `base`, the momentum of the nodes zero; and back.
  static State<Extended> extended(const State<typename Base::GroupoidType>& s) {
    State<Extended> out;
    std::get<0>(out.object) = s.object;
    out.momentum << s.momentum, Vector<double, n * inner>::Zero();
    return out;
  }
  static State<typename Base::GroupoidType> reduced(const State<Extended>& s) {
    return {std::get<0>(s.object), s.momentum.template head<n>()};
  }

 protected:
  /// The nodes of the curve from zero to `end`, in coordinates.
  template <class S>
  static std::array<Vector<S, n>, Degree + 1> nodes(const Vector<S, n>& end, const Vector<S, n * inner>& between) {
    std::array<Vector<S, n>, Degree + 1> x;
    x.front() = Vector<S, n>::Constant(S(0.0));
    for (int j = 0; j < inner; ++j) x[std::size_t(j + 1)] = between.template segment<n>(j * n);
    x.back() = end;
    return x;
  }
  /// The derivative of the curve at node i, for a unit of time.
  template <class S> static Vector<S, n> velocity(const std::array<Vector<S, n>, Degree + 1>& x, std::size_t i) {
    const auto& d = LobattoRule<Degree>::rule().derivative[i];
    Vector<S, n> v = x[1] * d[1];
    for (std::size_t j = 2; j < x.size(); ++j) v += x[j] * d[j];
    return v;
  }
};

/// L(q0, x, q1) = sum_i b_i (m |q'(c_i)|^2 / (2 h) - h U(q(c_i))), q the polynomial of degree s through the nodes.
template <class Base, int Degree>
struct GalerkinMechanics : GalerkinSystem<GalerkinMechanics<Base, Degree>, Base, Degree> {
  using Common = GalerkinSystem<GalerkinMechanics, Base, Degree>;
  static constexpr int n = Base::dimension;
  using Common::Common;

  template <class S, class T>
  S lagrangian(const std::tuple<PairArrow<S, n>, Vector<S, n * Common::inner>>& g, const T& step) const {
    const auto& rule = LobattoRule<Degree>::rule();
    const auto& [ends, between] = g;
    const auto x = Common::nodes(Vector<S, n>(ends.target - ends.source), between);
    S action(0.0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vector<S, n> v = Common::velocity(x, i);
      action += v.squaredNorm() * (0.5 * rule.weight[i] * this->base.mass() / step) -
                this->base.potential(Vector<S, n>(ends.source + x[i])) * (rule.weight[i] * step);
    }
    return action;
  }
  template <class A> auto lagrangian(const A& g) const { return lagrangian(g, this->h); }

  /// Nodes on a straight line.
  Step<GalerkinMechanics> first_guess(const State<typename Common::Extended>& s) const {
    const Vector<double, n> v = s.momentum.template head<n>() * (this->h / this->base.mass());
    Step<GalerkinMechanics> guess;
    auto& [ends, between] = guess.arrow;
    ends = {std::get<0>(s.object), std::get<0>(s.object) + v};
    for (int j = 0; j < Common::inner; ++j)
      between.template segment<n>(j * n) = v * LobattoRule<Degree>::rule().node[std::size_t(j + 1)];
    return guess;
  }
};

/// On a matrix group, for l(xi): L(g, x) = h sum_i b_i l(xi_i), the curve exp(eta(t)) with eta the polynomial of degree
/// s through the nodes, from zero to log g, and xi = dexp_eta(eta') / h its body velocity.
template <class Base, int Degree> struct GalerkinGroup : GalerkinSystem<GalerkinGroup<Base, Degree>, Base, Degree> {
  using Common = GalerkinSystem<GalerkinGroup, Base, Degree>;
  using Group = typename Base::GroupoidType;
  static constexpr int n = Base::dimension;
  using Common::Common;

  template <class S, class T>
  S lagrangian(const std::tuple<Matrix<S, Group::matrix_size, Group::matrix_size>, Vector<S, n * Common::inner>>& g,
               const T& step) const {
    const auto& rule = LobattoRule<Degree>::rule();
    const auto& [element, between] = g;
    const auto x = Common::nodes(Vector<S, n>(Group::log(element)), between);
    S action(0.0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Vector<S, n> v = Common::velocity(x, i) * (1 / step);
      const Vector<S, n> xi = Group::dexp(x[i]) * v;
      action += this->base.l(xi) * (rule.weight[i] * step);
    }
    return action;
  }
  template <class A> auto lagrangian(const A& g) const { return lagrangian(g, this->h); }

  /// Nodes along the guess of `base`.
  Step<GalerkinGroup> first_guess(const State<typename Common::Extended>& s) const {
    Base over = this->base;
    over.h = this->h;
    Step<GalerkinGroup> guess;
    auto& [element, between] = guess.arrow;
    element = over.first_guess(Common::reduced(s)).arrow;
    const Vector<double, n> v = Group::log(element);
    for (int j = 0; j < Common::inner; ++j)
      between.template segment<n>(j * n) = v * LobattoRule<Degree>::rule().node[std::size_t(j + 1)];
    return guess;
  }
};

}  // namespace lagroid
