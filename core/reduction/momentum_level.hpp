#pragma once
/// Reduction at a momentum level: the system of the base alone that moves as a full one with fixed momentum of an
/// Abelian symmetry (Routh).
///
///     R(b) = ext over theta of  L(b, theta) - <level, theta>
///     f-(b) = <level, da/dv>,  f+(b) = <level, da/dw>,    a(v, w) = angle(hor(v)^{-1} hor(b) hor(w))
///
/// with (b, theta) the arrow of the gauge groupoid that a discrete connection attaches (groupoids/connections.hpp), hor
/// = attach(., 0), and v, w displacements of the ends of b. The forces are the magnetic term: a is the connection's
/// holonomy round the two displaced arrows and vanishes where the connection is flat. (For sums over Pair(Q):
/// Jalnapurkar, Leok, Marsden & West, Discrete Routh reduction, J. Phys. A 39 (2006).)
///
///     const MomentumLevel level(FactorConnection<Factors<1>, Pair<1>, SO2>{}, polar_kepler, angular_momentum);
///     const auto start = level.state_below(z);                  // of the radius alone: where a run begins
///     const auto g = level.full_arrow(run.point().step.arrow);  // angle included
///
/// theta(b) is what Newton's method finds, or that of the closed form which the system has for R
/// (core/capabilities/routhian.hpp). R is stationary in theta, so that its gradients are those of L at a theta that
/// stands still; second derivatives, and all where there is a magnetic term, are those of the full system in bases
/// adapted to the connection.
///
/// Object constraints C(q) = 0 are constraints of the base as they are, since objects of a gauge groupoid are its
/// points, and their multipliers are the same. Constraints on arrows are refused by the compiler: phi(b, theta(b)) = 0
/// would constrain b, but theta then depends on the multipliers, so that R + <lambda, phi> is no function of b alone.
///
/// Required: a variational system without arrow constraints on the gauge groupoid, its step in a member h if it has
/// one, whose L(b, .) has one critical point with momentum `level` near theta = 0. Errors: where there is none R is not
/// a number, and the step's status tells it. NotFree where the symmetry leaves a point of the base where it is.

#include <lagroid/core/capabilities/routhian.hpp>
#include <lagroid/core/derivatives/implicit.hpp>
#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/matrices/scaling.hpp>
#include <lagroid/core/morphism.hpp>
#include <lagroid/core/reduction/full_system.hpp>
#include <lagroid/core/reduction/not_free.hpp>

#include <utility>

namespace lagroid {

template <class Connection, DiscreteSystem Sys>
struct MomentumLevel
    : detail::FullSystem<Sys>,
      System<MomentumLevel<Connection, Sys>, typename Connection::Codomain, 0, Sys::object_constraints> {
  static_assert(std::is_same_v<typename Sys::GroupoidType, typename Connection::Domain>,
                "a connection takes apart arrows of the groupoid that it starts from, its Domain");
  static_assert(Variational<Sys> && Sys::arrow_constraints == 0,
                "a momentum level is that of a variational system without constraints on arrows");
  using Full = Sys;
  using MembersVary = void;
  using Multipliers = Vector<double, Sys::object_constraints>;
  using G = typename Connection::Domain;
  using B = typename Connection::Codomain;
  using ConnectionType = Connection;
  static constexpr int angles = Connection::angles;
  static constexpr int n = B::dimension;
  static_assert(G::dimension == n + angles, "a connection splits arrows in those of the base and angles");
  /// Whether the system has R in closed form, and for all of its parameters.
  static constexpr bool closed = HasRouthian<Sys, Connection>;
  static constexpr bool always_closed = closed && !HasRouthianInPart<Sys>;
  template <class A>
  using ScalarOf = typename decltype(std::declval<B>().coordinates_of_arrow(std::declval<A>()))::Scalar;

  [[no_unique_address]] Connection connection;
  Vector<double, angles> level;  ///< the fixed momentum, in the units of L over those of the angles

  MomentumLevel(Connection c, Sys system, const Vector<double, angles>& momentum)
      : detail::FullSystem<Sys>{std::move(system)}, connection(std::move(c)), level(momentum) {
    connection.from = this->full.groupoid;
    this->groupoid = connection.to;
  }

  template <class A> auto lagrangian(const A& b) const {
    if constexpr (always_closed) {
      return ScalarOf<A>(this->full.routhian(connection, b, level));
    } else if constexpr (closed) {
      return has_closed_form() ? ScalarOf<A>(this->full.routhian(connection, b, level)) : routhian_by_solving(b);
    } else {
      return routhian_by_solving(b);
    }
  }
  template <class Q> auto object_constraint(const Q& m) const requires(Sys::object_constraints > 0) {
    return this->full.object_constraint(full_groupoid().source(horizontal(this->groupoid.unit(m))));
  }
  template <class A> auto forces(const A& b) const requires(!Connection::flat) {
    using S = ScalarOf<A>;
    using D = Dual<S>;
    const ArrowOf<B, D> bd = this->groupoid.template cast<D>(b);
    const ArrowOf<G, D> lifted = horizontal(bd);
    const auto work = [&](const ArrowOf<G, D>& moved) {
      const Vector<D, angles> a = connection.angle(moved);
      S sum(0.0);
      for (int i = 0; i < angles; ++i) sum += a(i).derivative * level(i);
      return sum;
    };
    Forces<S, n> f;
    for (int i = 0; i < n; ++i) {
      const auto displaced = [&](const ObjectOf<B, D>& m) {
        return horizontal(ArrowOf<B, D>(this->groupoid.tau(m, direction<D, n>(i))));
      };
      f.source(i) =
          work(full_groupoid().multiply(full_groupoid().inverse(displaced(this->groupoid.source(bd))), lifted));
      f.target(i) = work(full_groupoid().multiply(lifted, displaced(this->groupoid.target(bd))));
    }
    return f;
  }
  // A base arrow's displacements are those of the full arrow along the horizontal directions, while the angle keeps its
  // momentum: in adapted bases the full gradients' first part, magnetic term included, and the Schur complement of the
  // mixed derivative's last block.
  // (Compiled once, not into each place of a step that asks for it: there is little to win and much to compile.)
  [[gnu::noinline]] GradientsOf<MomentumLevel> gradients(const ArrowOf<B>& b, const Multipliers& lambda) const
      requires(!Connection::flat) {
    const Vector<double, angles> theta = angle_of(b, level);
    const auto d = lagroid::gradients(this->full, ArrowOf<G>(connection.attach(b, theta)), lambda);
    return {d.value - work_of(theta), along<0, n>(adapted_basis(this->groupoid.source(b)), d.source_gradient),
            along<0, n>(adapted_basis(this->groupoid.target(b)), d.target_gradient), d.constraint};
  }
  [[gnu::noinline]] TwoSidedOf<MomentumLevel> two_sided(const ArrowOf<B>& b, const Multipliers& lambda) const
      requires(!Connection::flat || !always_closed) {
    const Vector<double, angles> theta = angle_of(b, level);
    const auto d = lagroid::two_sided(this->full, ArrowOf<G>(connection.attach(b, theta)), lambda);
    const Basis source = adapted_basis(this->groupoid.source(b));
    const Basis target = adapted_basis(this->groupoid.target(b));
    Basis mixed;
    for (int j = 0; j < rank; ++j) {
      AlgebroidVector<G> column;
      for (int i = 0; i < rank; ++i) {
        column(i) = 0;
        for (int k = 0; k < rank; ++k) column(i) += d.mixed(i, k) * target(k, j);
      }
      const AlgebroidVector<G> there = along<0, rank>(source, column);
      for (int i = 0; i < rank; ++i) mixed(i, j) = there(i);
    }
    Matrix<double, angles, angles> fibre;
    for (int i = 0; i < angles; ++i)
      for (int j = 0; j < angles; ++j) fibre(i, j) = mixed(n + i, n + j);
    const Matrix<double, angles, angles> inverse = fibre.inverse();
    TwoSidedOf<MomentumLevel> out;
    out.value = d.value - work_of(theta);
    out.source_gradient = along<0, n>(source, d.source_gradient);
    out.target_gradient = along<0, n>(target, d.target_gradient);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        out.mixed(i, j) = mixed(i, j);
        for (int k = 0; k < angles; ++k)
          for (int l = 0; l < angles; ++l) out.mixed(i, j) -= mixed(i, n + k) * inverse(k, l) * mixed(n + l, j);
      }
    out.constraint = d.constraint;
    for (int a = 0; a < Sys::object_constraints; ++a)
      for (int i = 0; i < n; ++i) {
        out.constraint_source(i, a) = out.constraint_target(a, i) = 0;
        for (int k = 0; k < rank; ++k) {
          out.constraint_source(i, a) += source(k, i) * d.constraint_source(k, a);
          out.constraint_target(a, i) += d.constraint_target(a, k) * target(k, i);
        }
      }
    return out;
  }
  // Those of R, as the library takes them.
  [[gnu::noinline]] LAGROID_FLATTEN GradientsOf<MomentumLevel> gradients(const ArrowOf<B>& b,
                                                                         const Multipliers& lambda) const
      requires(Connection::flat && !always_closed) {
    return automatic_gradients(*this, b, lambda);
  }
  bool admissible(const ArrowOf<B>& b) const requires(HasBranch<Sys> || FreeInPart<Connection>) {
    if constexpr (FreeInPart<Connection>)
      if (!connection.free_at(this->groupoid.target(b))) return false;
    if constexpr (requires { this->full.free_at(full_groupoid().target(horizontal(b))); }) {
      return this->full.free_at(full_groupoid().target(horizontal(b)));
    } else if constexpr (HasBranch<Sys>) {
      return this->full.admissible(full_arrow(b));
    } else {
      return true;
    }
  }
  Step<MomentumLevel> first_guess(const State<B>& s) const requires HasFirstGuess<Sys> {
    return {connection(this->full.first_guess(state_over(s)).arrow), {}};
  }
  double energy(const State<B>& s) const requires requires(const Sys& f, const State<G>& z) { f.energy(z); }
  { return this->full.energy(state_over(s)); }

  /// theta(b): by how much the fibres move over b where the momentum is `momentum`. Over any scalar.
  template <class A> auto angle_of(const A& b, const Vector<double, angles>& momentum) const {
    constexpr int order = nilpotency<ScalarOf<A>>;
    if constexpr (always_closed) {
      return angle_in_closed_form(b, momentum);
    } else if constexpr (closed) {
      return has_closed_form() ? angle_in_closed_form(b, momentum) : angle_by_solving<order>(b, momentum);
    } else {
      return angle_by_solving<order>(b, momentum);
    }
  }
  /// The same by Newton's method, whatever else the system knows, with its infinitesimals to that order.
  template <int Order, class A> auto angle_by_solving(const A& b, const Vector<double, angles>& momentum) const {
    using S = ScalarOf<A>;
    const detail::Root<angles> root = root_of(value_of_arrow(b), momentum);
    if constexpr (Order == 0) {
      Vector<S, angles> theta;
      for (int i = 0; i < angles; ++i) theta(i) = S(root.x(i));
      return theta;
    } else {
      using D = Dual<S>;
      const ArrowOf<B, D> bd = this->groupoid.template cast<D>(b);
      const auto momentum_defect = [&](const Vector<S, angles>& theta) {
        Vector<S, angles> defect;
        for (int i = 0; i < angles; ++i) {
          Vector<D, angles> varied;
          for (int j = 0; j < angles; ++j) varied(j) = D(theta(j), S(i == j ? 1.0 : 0.0));
          defect(i) = D(this->full.lagrangian(connection.attach(bd, varied))).derivative - momentum(i);
        }
        return defect;
      };
      return detail::with_infinitesimals<S, angles>(root, momentum_defect, Order);
    }
  }
  /// R by Newton's method: it is stationary in theta, whose infinitesimals count to half of its order.
  template <class A> auto routhian_by_solving(const A& b) const {
    using S = ScalarOf<A>;
    const Vector<S, angles> theta = angle_by_solving<nilpotency<S> / 2>(b, level);
    S routhian = this->full.lagrangian(connection.attach(b, theta));
    for (int i = 0; i < angles; ++i) routhian -= theta(i) * level(i);
    return routhian;
  }
  /// Whether R, with the system's parameters, is one that was solved for on paper.
  bool has_closed_form() const {
    if constexpr (closed && HasRouthianInPart<Sys>) return this->full.has_routhian();
    return closed;
  }
  /// The full arrow over b, with the momentum of the level; and the one that the connection calls horizontal.
  ArrowOf<G> full_arrow(const ArrowOf<B>& b) const { return connection.attach(b, angle_of(b, level)); }
  template <class A> auto horizontal(const A& b) const {
    using S = ScalarOf<A>;
    Vector<S, angles> zero;
    for (int i = 0; i < angles; ++i) zero(i) = S(0.0);
    return ArrowOf<G, S>(connection.attach(b, zero));
  }

  /// The full state over one of the base: p = <mu, hor>, level = <mu, along the fibre>.
  State<G> state_over(const State<B>& s) const {
    AlgebroidVector<G> components;
    components << s.momentum, level;
    const Matrix<double, G::dimension, G::dimension> rows = adapted_basis(s.object).transpose();
    return {full_groupoid().source(horizontal(this->groupoid.unit(s.object))), solve_equilibrated(rows, components)};
  }
  /// The state of the base below a full one. Its momentum along the fibres is not looked at: `momentum_of` has it.
  State<B> state_below(const State<G>& z) const {
    const ObjectOf<B> m = connection.object(z.object);
    require_free(connection, m);
    return {m, along<0, n>(adapted_basis(m), z.momentum)};
  }
  /// The momentum of the symmetry at a full state.
  Vector<double, angles> momentum_of(const State<G>& z) const {
    return along<n, angles>(adapted_basis(connection.object(z.object)), z.momentum);
  }

 private:
  static constexpr int rank = G::dimension;
  using Basis = Matrix<double, rank, rank>;

  const G& full_groupoid() const { return this->full.groupoid; }
  /// <v, column i>, i = First ... First + Count - 1. (By entries: see
  /// docs/decisions/72_expressions_cost_their_square.md.)
  template <int First, int Count> static Vector<double, Count> along(const Basis& basis, const AlgebroidVector<G>& v) {
    Vector<double, Count> out;
    for (int i = 0; i < Count; ++i) {
      out(i) = 0;
      for (int j = 0; j < rank; ++j) out(i) += basis(j, First + i) * v(j);
    }
    return out;
  }
  /// <level, theta>
  double work_of(const Vector<double, angles>& theta) const {
    double sum = 0;
    for (int i = 0; i < angles; ++i) sum += theta(i) * level(i);
    return sum;
  }
  template <class D, int K> static Vector<D, K> direction(int i) {
    Vector<D, K> e;
    for (int j = 0; j < K; ++j) e(j) = D(0.0);
    e(i).derivative = 1.0;
    return e;
  }
  template <class A> auto angle_in_closed_form(const A& b, const Vector<double, angles>& momentum) const {
    using S = ScalarOf<A>;
    using D = Dual<S>;
    const ArrowOf<B, D> still = this->groupoid.template cast<D>(b);
    Vector<S, angles> theta;
    for (int i = 0; i < angles; ++i) {
      Vector<D, angles> varied;
      for (int j = 0; j < angles; ++j) varied(j) = D(S(momentum(j)), S(i == j ? 1.0 : 0.0));
      theta(i) = -D(this->full.routhian(connection, still, varied)).derivative;
    }
    return theta;
  }
  template <class A> ArrowOf<B> value_of_arrow(const A& b) const {
    if constexpr (std::is_same_v<ScalarOf<A>, double>) return b;
    const auto x = this->groupoid.coordinates_of_arrow(b);
    Vector<double, B::arrow_coordinate_count()> values;
    for (int i = 0; i < values.size(); ++i) values(i) = value_of(x(i));
    return this->groupoid.template arrow_at<double>(values);
  }
  /// theta with dL/dtheta = momentum over b, from theta = 0.
  [[gnu::noinline]] detail::Root<angles> root_of(const ArrowOf<B>& b, const Vector<double, angles>& momentum) const {
    using M = HyperDual<double, angles, angles>;
    const ArrowOf<B, M> over = this->groupoid.template cast<M>(b);
    const auto equations = [&](const Vector<double, angles>& theta) {
      Vector<M, angles> varied;
      for (int i = 0; i < angles; ++i) {
        varied(i) = M(theta(i));
        varied(i).set_left(i, 1);
        varied(i).set_right(i, 1);
      }
      const M value = this->full.lagrangian(connection.attach(over, varied));
      detail::EquationsAt<angles> at;
      at.value = value.left();
      at.jacobian = value.mixed();
      for (int i = 0; i < angles; ++i) {
        at.value(i) -= momentum(i);
        double terms = std::abs(momentum(i));
        for (int j = 0; j < angles; ++j) terms += std::abs(at.jacobian(i, j) * theta(j));
        at.measure(i, terms);
      }
      return at;
    };
    Vector<double, angles> zero;
    for (double& x : zero) x = 0;
    return detail::newton_iteration<angles>(equations, zero);
  }
  /// The horizontal lifts of the base's basis, then the angles' directions, as columns in A_qG.
  Basis adapted_basis(const ObjectOf<B>& m) const {
    if constexpr (requires { connection.adapted_basis(m); }) return connection.adapted_basis(m);
    using D = Dual<double>;
    const ObjectOf<B, D> md = this->groupoid.template cast_object<D>(m);
    Basis basis;
    const auto set = [&](int column, const auto& moved) {
      for (int j = 0; j < rank; ++j) basis(j, column) = moved(j).derivative;
    };
    for (int i = 0; i < n; ++i)
      set(i, full_groupoid().tau_inverse(horizontal(ArrowOf<B, D>(this->groupoid.tau(md, direction<D, n>(i))))));
    for (int i = 0; i < angles; ++i)
      set(n + i, full_groupoid().tau_inverse(
                     connection.attach(ArrowOf<B, D>(this->groupoid.unit(md)), direction<D, angles>(i))));
    return basis;
  }
};

}  // namespace lagroid
