#pragma once
/// Discrete Lagrangians of high order: the curve of a step is a polynomial of degree s with inner nodes,
///
///     L(q0, x, q1) = h sum_i b_i L(q(c_i), q'(c_i)),    b, c of Lobatto's quadrature,
///
/// of order 2 s, on R^n symmetric, and one step where compositions take several, some of them backwards.
///
///     const GalerkinMechanics<Kepler, 3> kepler{Kepler{}};  // order six
///     const auto start = kepler.extended({{1, 0}, {0, 1}});
///     const auto end = kepler.reduced(start);
///
/// Requires a variational system without constraints (it does not compile otherwise), one of point masses or on a
/// matrix group. States are extended by the nodes' momenta, which are zero. (Marsden and West 2001, 2.2.6; Hall and
/// Leok 2015.)

#include <lagroid/core/continuous/curve_point.hpp>
#include <lagroid/core/continuous/curve_rule.hpp>
#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/galerkin/inner_nodes.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <array>
#include <string>

namespace lagroid {

/// Lobatto's quadrature, and the derivatives of the curve at its points.
template <int Degree> using LobattoRule = CurveRule<Degree, CurveQuadrature::lobatto>;

/// What the Galerkin systems have in common. Their arrows are those of G beside the inner nodes of the curve, s - 1
/// vectors of R^n (WithInnerNodes): the step on G is that of the discrete Lagrangian with the nodes eliminated. Order
/// 2 s, implicit (Marsden and West 2001, 2.2.6; Hall and Leok 2015).
template <class Derived, class Base, int Degree>
struct GalerkinSystem : System<Derived, typename WithInnerNodes<typename Base::GroupoidType, Degree>::Extended>,
                        WithInnerNodes<typename Base::GroupoidType, Degree> {
  static_assert(Base::constraints == 0,
                "a curve with inner nodes would keep the constraints of its system at its ends alone: Galerkin systems "
                "are made of systems without constraints (for higher order with constraints compose steps)");
  static_assert(Variational<Base>, "Galerkin systems are made of systems without forces");
  using Nodes = WithInnerNodes<typename Base::GroupoidType, Degree>;
  using Extended = typename Nodes::Extended;
  static constexpr int n = Base::dimension;
  static constexpr int inner = Degree - 1;

  Base base;
  double h;

  explicit GalerkinSystem(Base system) : base(std::move(system)), h(base.h) {
    std::get<0>(this->groupoid.factor) = base.groupoid;
  }

  /// A polynomial in the chart at one end of a step is one in the chart at the other in the abelian case alone.
  static constexpr bool symmetric = retraction_kind_of<typename Base::GroupoidType>() == RetractionKind::translation;
  static MethodTraits traits() { return {"Lobatto " + std::to_string(Degree + 1), 2 * Degree, symmetric, true, false}; }

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
