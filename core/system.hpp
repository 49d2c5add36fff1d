#pragma once
/// Discrete constrained Lagrangian systems (G, N, L). [G] Def. 3.2

#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/types.hpp>

namespace lagroid {

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
/// Optional members, used where present:
///
///     bool admissible(const ArrowOf<G>& g) const         whether g lies on the discretisation's own branch
///     Step<System> first_guess(const State<G>&) const    where the solve of a step without predecessor starts
///     TwoSided<...> two_sided(g, lambda) const           analytic derivatives, in place of the automatic ones
///     Gradients<...> gradients(g, lambda) const          analytic first derivatives alone, likewise
///     double h                                           the time step, if there is one
template <class Derived, class G, int ArrowConstraints = 0, int ObjectConstraints = 0> class System {
 public:
  using GroupoidType = G;
  template <class S> using Arrow = typename G::template Arrow<S>;
  template <class S> using Object = typename G::template Object<S>;

  static constexpr int dimension = G::dimension;
  static constexpr int arrow_constraints = ArrowConstraints;
  static constexpr int object_constraints = ObjectConstraints;
  static constexpr int constraints = ArrowConstraints + ObjectConstraints;

  using Multipliers = Vector<double, constraints>;

  [[no_unique_address]] G groupoid;
};

/// A point (q, mu) of A*G: an object and a momentum in the dual of the fibre A_qG, in the basis fixed by the
/// retraction.
template <class G> struct State {
  ObjectOf<G> object;
  AlgebroidVector<G> momentum;
};

/// An arrow and its multipliers: first those of the arrow constraints, then those of the object constraints at the
/// arrow's source. For arrow constraints alone, a point of Sigma_L ([G] 3.3).
template <class System> struct Step {
  ArrowOf<typename System::GroupoidType> arrow;
  typename System::Multipliers multipliers;
};

/// Gradients of the augmented function f = L + <lambda, phi> + <lambda, C o alpha> in the two-sided displacement
/// (v, w) -> f(tau(v)^{-1} g tau(w)) at v = w = 0.
///
/// The discrete Legendre transforms are F- = -source_gradient and F+ = target_gradient ([G] Def. 3.3).
template <int N, int M> struct Gradients {
  double value;                       ///< f(g), which is L(g) where the constraints hold
  Vector<double, N> source_gradient;  ///< df/dv
  Vector<double, N> target_gradient;  ///< df/dw
  Vector<double, M> constraint;       ///< (phi(g), C(beta(g)))
};

/// The gradients with the mixed second derivative: the derivative of F- along the alpha-fibre is -mixed.
template <int N, int M> struct TwoSided : Gradients<N, M> {
  Matrix<double, N, N> mixed;              ///< d2f / dv dw
  Matrix<double, N, M> constraint_source;  ///< d(phi, C o alpha)/dv, column by column
  Matrix<double, M, N> constraint_target;  ///< d(phi, C o beta)/dw, row by row
};

template <class Sys> using GradientsOf = Gradients<Sys::dimension, Sys::constraints>;
template <class Sys> using TwoSidedOf = TwoSided<Sys::dimension, Sys::constraints>;

/// What the solvers require of a system. Build one by deriving from `System`.
template <class Sys>
concept DiscreteSystem = Groupoid<typename Sys::GroupoidType> &&
    requires(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g,
             const ObjectOf<typename Sys::GroupoidType>& q) {
  { system.lagrangian(g) } -> std::convertible_to<double>;
  requires Sys::arrow_constraints == 0 || requires {
    { system.constraint(g) } -> std::convertible_to<Vector<double, Sys::arrow_constraints>>;
  };
  requires Sys::object_constraints == 0 || requires {
    { system.object_constraint(q) } -> std::convertible_to<Vector<double, Sys::object_constraints>>;
  };
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

/// Whether every optional member that the system has is one that will be used: a member of the right name that is not
/// const, or does not take or return what it should, would otherwise be passed over without a word.
template <class Sys>
inline constexpr bool optional_members_fit = (HasAnalyticDerivatives<Sys> || !requires { &Sys::two_sided; }) &&
                                             (HasAnalyticGradients<Sys> || !requires { &Sys::gradients; }) &&
                                             (HasBranch<Sys> || !requires { &Sys::admissible; }) &&
                                             (HasFirstGuess<Sys> || !requires { &Sys::first_guess; }) &&
                                             (HasTimeStep<Sys> || !requires { &Sys::h; });
template <class Sys> constexpr void require_optional_members_to_fit() {
  static_assert(
      optional_members_fit<Sys>,
      "two_sided, gradients, admissible, first_guess or h is there but does not fit (see System): is it const, "
      "with the right arguments and result?");
}

}  // namespace lagroid
