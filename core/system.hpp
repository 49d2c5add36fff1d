#pragma once
/// Discrete constrained Lagrangian systems (G, N, L): a groupoid G => Q, a discrete Lagrangian L : G -> R, and the
/// arrows N = { phi(g) = 0, C(alpha(g)) = 0, C(beta(g)) = 0 } that the constraints allow. [G] Def. 3.2
///
/// A mechanical system or a control problem is stated by one class; its derivatives are automatic, and steps, boundary
/// values and ledgers follow from it.
///
///     struct Oscillator : System<Oscillator, Pair<1>> {
///       double h = 0.1;
///       template <class S> S lagrangian(const Arrow<S>& g) const {
///         const Vector<S, 1> middle = (g.source + g.target) * 0.5;
///         return (g.target - g.source).squaredNorm() * (0.5 / h) - middle.squaredNorm() * (0.5 * h);
///       }
///     };
///
/// Requires functions that are smooth, const, and templates on the scalar; the type of an intermediate vector must be
/// written out (`Vector<S, 1>`, not `auto`, which would keep an expression of Eigen that refers to numbers no longer
/// there).
///
/// Errors: a member that does not fit what `System` names does not compile, and the message names it. At run time
/// nothing here throws.

#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/member_name.hpp>
#include <lagroid/core/types.hpp>

#include <concepts>
#include <type_traits>
#include <vector>

namespace lagroid {

/// What arrow constraints phi(g) = 0 restrict, beside the trajectory itself. The two differ unless the constraints are
/// integrable (Lewis & Murray, Int. J. Non-Linear Mech. 30, 1995).
enum class Principle {
  /// The paths that compete: the action is critical among those with phi = 0. Optimal control ([G] section 3).
  vakonomic,
  /// The virtual displacements, to a distribution D: the action is critical to first order along them. Rolling and
  /// sliding bodies (Cortes & Martinez, Nonlinearity 14, 2001; on groupoids Iglesias, Marrero, Martin de Diego,
  /// Martinez, J. Nonlinear Sci. 18, 2008).
  nonholonomic
};

/// Discrete forces on an arrow: f-(g) in the dual of A_{alpha(g)}G and f+(g) in the dual of A_{beta(g)}G, half of the
/// force's impulse each. They do the virtual work <f-, v> + <f+, w> in the displacement (v, w) of the ends, so that
///
///     F- = -df/dv - f-,    F+ = df/dw + f+
///
/// (Marsden & West, Acta Numerica 2001, part 3). The method keeps order two when f-(g) with step h is -f+(g^{-1})
/// with step -h: the same quadrature seen from either end. Half the impulse at one end alone is order one.
template <class S, int N> struct Forces {
  Vector<S, N> source;
  Vector<S, N> target;
};

/// Requires that the members of a system have the arguments and results that `System` names, and that there are as many
/// constraints as its template arguments count. Does not compile otherwise: methods look for optional members by name
/// and form, and would ignore one that does not fit.
template <class Sys> void require_members_to_fit();

/// Base of every system: a groupoid G, a discrete Lagrangian L : G -> R and constraints that cut out N.
///
/// The derived class writes, as templates on the scalar S,
///
///     S lagrangian(const Arrow<S>& g) const
///     Vector<S, ArrowConstraints> constraint(const Arrow<S>& g) const            phi(g) = 0, if there are any
///     Vector<S, ObjectConstraints> object_constraint(const Object<S>& q) const   C(q) = 0, if there are any
///
/// Arrow constraints phi are the non-integrable (vakonomic) ones of [G] section 3; their multipliers live on arrows.
/// Object constraints C restrict to the full subgroupoid over C^{-1}(0) (holonomic constraints); their multipliers live
/// on the objects between arrows. Multipliers enter as L + <lambda, phi> + <lambda, C> ([G]'s sign).
///
/// A system that is not variational declares it (docs/nonholonomic.md):
///
///     static constexpr auto principle = Principle::nonholonomic      what phi restricts; vakonomic by default
///     Forces<S, n> forces(const Arrow<S>& g) const                   a template: discrete forces, see Forces
///
/// Optional members, used where present:
///
///     Matrix<double, n, ArrowConstraints> annihilator(const Object<double>& q) const
///         the distribution of a nonholonomic system, in place of the one deduced from phi (annihilator.hpp)
///     bool admissible(const ArrowOf<G>& g) const         whether g lies on the discretisation's own branch
///     Step<System> first_guess(const State<G>&) const    where the solve of a step without predecessor starts
///     TwoSided<...> two_sided(g, lambda) const           analytic derivatives, in place of the automatic ones; forces
///                                                        and reactions included
///     Gradients<...> gradients(g, lambda) const          analytic first derivatives alone, likewise
///     double h                                           the time step, if there is one
template <class Derived, class G, int ArrowConstraints = 0, int ObjectConstraints = 0> class System {
 public:
  static constexpr Principle principle = Principle::vakonomic;
  using GroupoidType = G;
  template <class S> using Arrow = typename G::template Arrow<S>;
  template <class S> using Object = typename G::template Object<S>;

  static constexpr int dimension = G::dimension;
  static constexpr int arrow_constraints = ArrowConstraints;
  static constexpr int object_constraints = ObjectConstraints;
  static constexpr int constraints = ArrowConstraints + ObjectConstraints;

  using Multipliers = Vector<double, constraints>;

  /// Here Derived is complete, so that its members can be checked. (Derivatives check them again, for classes derived
  /// from systems.)
  System() { require_members_to_fit<Derived>(); }

  [[no_unique_address]] G groupoid;
};

/// A point (q, mu) of A*G: an object and a momentum in the dual of the fibre A_qG, in the basis fixed by the
/// retraction.
template <class G, class S = double> struct State {
  ObjectOf<G, S> object;
  AlgebroidVector<G, S> momentum;
};

/// An arrow and its multipliers: first those of the arrow constraints, then those of the object constraints at the
/// arrow's source. For arrow constraints alone, a point of Sigma_L ([G] 3.3).
template <class System, class S = double> struct Step {
  ArrowOf<typename System::GroupoidType, S> arrow;
  Vector<S, System::constraints> multipliers;
};

/// Gradients of the augmented function f = L + <lambda, phi> + <lambda, C o alpha> in the two-sided displacement
/// (v, w) -> f(tau(v)^{-1} g tau(w)) at v = w = 0.
///
/// The discrete Legendre transforms are F- = -source_gradient and F+ = target_gradient ([G] Def. 3.3). Discrete forces
/// are part of both gradients. The reaction of nonholonomic constraints, <lambda, omega(alpha(g))>, is part of
/// source_gradient in place of what <lambda, phi> adds to f, as that of object constraints is.
template <int N, int M, class S = double> struct Gradients {
  S value;                       ///< f(g), which is L(g) where the constraints hold
  Vector<S, N> source_gradient;  ///< df/dv
  Vector<S, N> target_gradient;  ///< df/dw
  Vector<S, M> constraint;       ///< (phi(g), C(beta(g)))
};

/// The gradients with the mixed second derivative: the derivative of F- along the source fibre is -mixed.
template <int N, int M> struct TwoSided : Gradients<N, M> {
  Matrix<double, N, N> mixed;              ///< d2f / dv dw
  Matrix<double, N, M> constraint_source;  ///< d(phi, C o alpha)/dv, column by column; omega for nonholonomic phi
  Matrix<double, M, N> constraint_target;  ///< d(phi, C o beta)/dw, row by row
};

template <class Sys, class S = double> using GradientsOf = Gradients<Sys::dimension, Sys::constraints, S>;
template <class Sys> using TwoSidedOf = TwoSided<Sys::dimension, Sys::constraints>;

/// A vector of N doubles, or an expression that becomes one. (The count is looked at first: Eigen's constructors do not
/// fail softly.)
template <class V, int N>
concept ColumnOf = std::remove_cvref_t<V>::RowsAtCompileTime == N&& std::convertible_to<V, Vector<double, N>>;

/// What the solvers require of a system. Build one by deriving from `System`.
template <class Sys>
concept DiscreteSystem = Groupoid<typename Sys::GroupoidType> &&
    requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g,
             const ObjectOf<typename Sys::GroupoidType>& q) {
  { system.lagrangian(g) } -> std::convertible_to<double>;
  requires Sys::arrow_constraints == 0 || requires {
    { system.constraint(g) } -> ColumnOf<Sys::arrow_constraints>;
  };
  requires Sys::object_constraints == 0 || requires {
    { system.object_constraint(q) } -> ColumnOf<Sys::object_constraints>;
  };
};

template <class Sys>
concept Nonholonomic = Sys::principle == Principle::nonholonomic;

template <class Sys>
concept Forced = requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g) {
  { system.forces(g) } -> std::convertible_to<Forces<double, Sys::dimension>>;
};

/// Whether the dynamics is that of an action principle: Poisson on A*G, or symplectic on T*C^{-1}(0).
template <class Sys>
concept Variational = !Nonholonomic<Sys> && !Forced<Sys>;

template <class Sys>
concept HasAnnihilator = requires(const Sys& system, const ObjectOf<typename Sys::GroupoidType>& q) {
  { system.annihilator(q) } -> std::convertible_to<Matrix<double, Sys::dimension, Sys::arrow_constraints>>;
};

template <class Sys>
concept HasAnalyticDerivatives = requires(const Sys& system, const Step<Sys>& step) {
  { system.two_sided(step.arrow, step.multipliers) } -> std::convertible_to<TwoSidedOf<Sys>>;
};

template <class Sys>
concept HasAnalyticGradients = requires(const Sys& system, const Step<Sys>& step) {
  { system.gradients(step.arrow, step.multipliers) } -> std::convertible_to<GradientsOf<Sys>>;
};

template <class Sys>
concept HasBranch = requires(const Sys& system, const Step<Sys>& step) {
  { system.admissible(step.arrow) } -> std::convertible_to<bool>;
};

template <class Sys>
concept HasFirstGuess = requires(const Sys& system, const State<typename Sys::GroupoidType>& state) {
  { system.first_guess(state) } -> std::convertible_to<Step<Sys>>;
};

template <class Sys>
concept HasTimeStep = requires(Sys& system) {
  { system.h } -> std::convertible_to<double>;
  system.h = 1.0;
};

/// Whether there is a time step: a member h or, for a SizedSystem, that of the system it stands for.
template <class Sys> bool has_time_step(const Sys& system) {
  if constexpr (requires { system.has_time_step(); }) {
    return system.has_time_step();
  } else {
    return HasTimeStep<Sys>;
  }
}
/// The time step; one where there is none.
template <class Sys> double time_step(const Sys& system) {
  if constexpr (HasTimeStep<Sys>) {
    return system.h;
  } else if constexpr (requires { system.time_step(); }) {
    return system.time_step();
  } else {
    return 1;
  }
}
/// Another time step, where there is one.
template <class Sys> void set_time_step(Sys& system, double h) {
  if constexpr (HasTimeStep<Sys>) {
    system.h = h;
  } else if constexpr (requires { system.set_time_step(h); }) {
    system.set_time_step(h);
  }
}

/// A system that writes paths near its constraints, from which solvers of boundary values start in place of straight
/// lines:
///
///     std::vector<Arrow<double>> path(const Arrow<double>& boundary, long steps) const
///
/// returns `steps` arrows whose product is `boundary`, or an empty vector where it has no such path.
template <class Sys>
concept HasPath = requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& boundary) {
  { system.path(boundary, 1L) } -> std::same_as<std::vector<ArrowOf<typename Sys::GroupoidType>>>;
};
namespace detail {

LAGROID_MEMBER_NAME(NamesPath, path);
LAGROID_MEMBER_NAME(NamesForces, forces);
LAGROID_MEMBER_NAME(NamesTwoSided, two_sided);
LAGROID_MEMBER_NAME(NamesGradients, gradients);
LAGROID_MEMBER_NAME(NamesBranch, admissible);
LAGROID_MEMBER_NAME(NamesFirstGuess, first_guess);
LAGROID_MEMBER_NAME(NamesTimeStep, h);
LAGROID_MEMBER_NAME(NamesAnnihilator, annihilator);

/// Constraints that can be called at all, const or not, whatever comes of it.
template <class Sys>
concept SpeaksOfConstraint = requires(Sys& system, const ArrowOf<typename Sys::GroupoidType>& g) {
  system.constraint(g);
};
template <class Sys>
concept SpeaksOfObjectConstraint = requires(Sys& system, const ObjectOf<typename Sys::GroupoidType>& q) {
  system.object_constraint(q);
};
/// `force` that returns what only `forces` does. (A `force` of another kind is the user's own affair.)
template <class Sys>
concept SpeaksOfForce = requires(Sys& system, const ArrowOf<typename Sys::GroupoidType>& g) {
  { system.force(g) } -> std::convertible_to<Forces<double, Sys::dimension>>;
};

template <class Sys>
concept HasLagrangian = requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g) {
  { system.lagrangian(g) } -> std::convertible_to<double>;
};
template <class Sys>
concept HasConstraint = requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g) {
  { system.constraint(g) } -> ColumnOf<Sys::arrow_constraints>;
};
template <class Sys>
concept HasObjectConstraint = requires(const Sys& system, const ObjectOf<typename Sys::GroupoidType>& q) {
  { system.object_constraint(q) } -> ColumnOf<Sys::object_constraints>;
};

/// Whether the numbers that `System` counts are still there, under their names.
template <class Sys>
concept CountsAreNumbers = requires {
  requires std::same_as<decltype(Sys::constraints), const int>;
  requires std::same_as<decltype(Sys::arrow_constraints), const int>;
  requires std::same_as<decltype(Sys::object_constraints), const int>;
};

}  // namespace detail

/// Whether there is a constraint, of either kind, exactly where `System` counts one, with as many components.
template <class Sys>
inline constexpr bool arrow_constraint_fits =
    Sys::arrow_constraints == 0 ? !detail::SpeaksOfConstraint<Sys> : detail::HasConstraint<Sys>;
template <class Sys>
inline constexpr bool object_constraint_fits =
    Sys::object_constraints == 0 ? !detail::SpeaksOfObjectConstraint<Sys> : detail::HasObjectConstraint<Sys>;
template <class Sys>
inline constexpr bool forces_fit = !detail::SpeaksOfForce<Sys> && (Forced<Sys> || !detail::NamesForces<Sys>);
/// Whether `path`, where there is one, is that of HasPath.
template <class Sys> inline constexpr bool path_fits = HasPath<Sys> || !detail::NamesPath<Sys>;

/// Whether every optional member that the system has is one that will be used: a member of the right name that is not
/// const, or does not take or return what it should, would otherwise be ignored.
template <class Sys>
inline constexpr bool optional_members_fit = (HasAnalyticDerivatives<Sys> || !detail::NamesTwoSided<Sys>)&&(
    HasAnalyticGradients<Sys> ||
    !detail::NamesGradients<Sys>)&&(HasBranch<Sys> ||
                                    !detail::NamesBranch<Sys>)&&(HasFirstGuess<Sys> ||
                                                                 !detail::NamesFirstGuess<
                                                                     Sys>)&&(HasTimeStep<Sys> ||
                                                                             !detail::NamesTimeStep<
                                                                                 Sys>)&&(HasAnnihilator<Sys> ||
                                                                                         !detail::NamesAnnihilator<
                                                                                             Sys>)&&forces_fit<Sys>;

template <class Sys> void require_members_to_fit() {
  static_assert(
      detail::CountsAreNumbers<Sys>,
      "constraints, arrow_constraints and object_constraints are the numbers that System counts: the functions "
      "are called constraint(g) and object_constraint(q)");
  if constexpr (detail::CountsAreNumbers<Sys>) {
    static_assert(detail::HasLagrangian<Sys>,
                  "lagrangian(g) is missing, or not a const template that returns the scalar of g (see System)");
    static_assert(arrow_constraint_fits<Sys>,
                  "constraint(g) does not fit ArrowConstraints, the third argument of System<Derived, G, "
                  "ArrowConstraints, ObjectConstraints>: a const template on the scalar that returns a vector of so "
                  "many components, and is there exactly when there are any");
    static_assert(object_constraint_fits<Sys>,
                  "object_constraint(q) does not fit ObjectConstraints, the fourth argument of System<Derived, G, "
                  "ArrowConstraints, ObjectConstraints>: a const template on the scalar that returns a vector of so "
                  "many components, and is there exactly when there are any");
    static_assert(forces_fit<Sys>,
                  "discrete forces are a const template forces(g) on the scalar that returns Forces<S, dimension> (see "
                  "Forces); one called force, or of another kind, would not act");
    static_assert(optional_members_fit<Sys> || !forces_fit<Sys>,
                  "two_sided, gradients, admissible, first_guess, h or annihilator is there but does not fit (see "
                  "System): is it const, with the right arguments and result?");
    static_assert(!Nonholonomic<Sys> || Sys::arrow_constraints > 0, "a nonholonomic system has arrow constraints");
  }
}

}  // namespace lagroid
