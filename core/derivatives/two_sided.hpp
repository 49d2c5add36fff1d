#pragma once
/// The two-sided derivative of f = L + <lambda, phi> + <lambda, C o alpha>: the first and mixed second derivatives of
/// (v, w) -> f(tau(v)^{-1} g tau(w)) at v = w = 0, by one evaluation over hyper-dual numbers.
///
/// The discrete Legendre transforms and the matrix of a step are made of it; a system writes L and the constraints
/// alone.
///
///     const TwoSidedOf<Sys> d = two_sided(system, g, lambda);
///     const auto mu = -d.source_gradient;      // F-(g, lambda)
///     const auto next_mu = d.target_gradient;  // F+(g, lambda)
///
/// Requires functions of the system that are templates on the scalar. Returns the system's own derivatives where it has
/// them, and includes discrete forces and reactions (see `Gradients`).
///
/// Errors: a function that takes doubles alone does not compile, and the message names it. Nothing throws.
///
/// Source: [G] Def. 3.3.

#include <lagroid/core/derivatives/annihilator.hpp>
#include <lagroid/core/derivatives/arrow_frame.hpp>
#include <lagroid/core/system.hpp>

namespace lagroid {

namespace detail {

/// f = L + <lambda, phi> + <lambda, C o alpha> over any scalar, without <lambda, phi> where phi is nonholonomic.
template <class S, class Sys, class A>
S augmented_lagrangian(const Sys& system, const A& g, const typename Sys::Multipliers& lambda) {
  S f = system.lagrangian(g);
  if constexpr (Sys::arrow_constraints > 0 && !Nonholonomic<Sys>) {
    const auto phi = system.constraint(g);
    for (int a = 0; a < Sys::arrow_constraints; ++a) f += phi(a) * lambda(a);
  }
  if constexpr (Sys::object_constraints > 0) {
    const auto at_source = system.object_constraint(system.groupoid.source(g));
    for (int a = 0; a < Sys::object_constraints; ++a) f += at_source(a) * lambda(Sys::arrow_constraints + a);
  }
  return f;
}

}  // namespace detail

template <class Sys> using HyperDualOf = HyperDual<double, Sys::dimension, Sys::dimension>;

/// Automatic derivatives evaluate a system over the scalar S. Does not compile where its functions do not take it.
template <class Sys, class S> constexpr void require_scalar() {
  using A = ArrowOf<typename Sys::GroupoidType, S>;
  using Q = ObjectOf<typename Sys::GroupoidType, S>;
  static_assert(
      requires(const Sys& system, const A& g) {
        { system.lagrangian(g) } -> std::convertible_to<S>;
      },
      "lagrangian(g) is there for doubles alone: its derivatives are automatic, and evaluate it as a const template on "
      "the scalar, S lagrangian(const Arrow<S>& g), that returns this scalar (see System)");
  static_assert(
      Sys::arrow_constraints == 0 || requires(const Sys& system, const A& g) { system.constraint(g); },
      "constraint(g) is there for doubles alone: it is a const template on the scalar (see System)");
  static_assert(
      Sys::object_constraints == 0 || requires(const Sys& system, const Q& q) { system.object_constraint(q); },
      "object_constraint(q) is there for doubles alone: it is a const template on the scalar (see System)");
  static_assert(
      !Forced<Sys> || requires(const Sys& system, const A& g) { system.forces(g); },
      "forces(g) is there for doubles alone: it is a const template on the scalar (see System)");
}

/// The impulses at the two ends of g beside those of the Lagrangian: discrete forces, and at the source the reaction
/// <lambda, omega>.
template <DiscreteSystem Sys, class S = double>
Forces<S, Sys::dimension> impulses(const Sys& system, const ArrowOf<typename Sys::GroupoidType, S>& g,
                                   const Vector<S, Sys::constraints>& lambda) {
  using V = Vector<S, Sys::dimension>;
  Forces<S, Sys::dimension> out{V::Zero(), V::Zero()};
  if constexpr (Forced<Sys>) out = system.forces(g);
  if constexpr (Nonholonomic<Sys>)
    out.source +=
        annihilator<Sys, S>(system, system.groupoid.source(g)) * lambda.template head<Sys::arrow_constraints>();
  return out;
}

/// The gradients by first-order dual numbers: one pass through L, phi and C, along the arrow's frame or, where the
/// groupoid supplies none, along the displacements of both ends. S: double, or a batch of them.
template <DiscreteSystem Sys, class S = double>
LAGROID_FLATTEN GradientsOf<Sys, S> automatic_gradients(const Sys& system,
                                                        const ArrowOf<typename Sys::GroupoidType, S>& g,
                                                        const Vector<S, Sys::constraints>& lambda) {
  constexpr int n = Sys::dimension;
  constexpr bool framed = HasArrowFrame<typename Sys::GroupoidType>;
  using J = Jet<S, framed ? arrow_dimension_of<typename Sys::GroupoidType>() : 2 * n>;
  const auto& groupoid = system.groupoid;
  const auto gj = [&] {
    if constexpr (framed) {
      return groupoid.template frame_jet<J>(g);
    } else {
      return groupoid.template seed<J, End::source, End::target, 0, n>(g);
    }
  }();
  require_scalar<Sys, J>();
  GradientsOf<Sys, S> out;
  J f = system.lagrangian(gj);
  if constexpr (Nonholonomic<Sys>) {
    out.constraint.template head<Sys::arrow_constraints>() = system.constraint(g);
  } else if constexpr (Sys::arrow_constraints > 0) {
    const Vector<J, Sys::arrow_constraints> phi = system.constraint(gj);
    for (int a = 0; a < Sys::arrow_constraints; ++a) {
      f += phi(a) * lambda(a);
      out.constraint(a) = phi(a).value;
    }
  }
  if constexpr (Sys::object_constraints > 0) {
    const auto at_source = system.object_constraint(groupoid.source(gj));
    const auto at_target = system.object_constraint(groupoid.target(g));
    for (int a = 0; a < Sys::object_constraints; ++a) {
      f += at_source(a) * lambda(Sys::arrow_constraints + a);
      out.constraint(Sys::arrow_constraints + a) = at_target(a);
    }
  }
  out.value = f.value;
  const auto gradient = f.gradient();
  if constexpr (framed) {
    out.source_gradient = groupoid.template frame_to_end<End::source>(g, gradient);
    out.target_gradient = groupoid.template frame_to_end<End::target>(g, gradient);
  } else {
    out.source_gradient = gradient.template head<n>();
    out.target_gradient = gradient.template tail<n>();
  }
  if constexpr (!Variational<Sys>) {
    const Forces<S, n> acting = impulses<Sys, S>(system, g, lambda);
    out.source_gradient += acting.source;
    out.target_gradient += acting.target;
  }
  return out;
}

/// The two-sided derivative by mixed dual numbers: one pass through L, phi and C.
template <DiscreteSystem Sys>
LAGROID_FLATTEN TwoSidedOf<Sys> automatic_two_sided(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g,
                                                    const typename Sys::Multipliers& lambda) {
  using M = HyperDualOf<Sys>;
  const auto gm = system.groupoid.template seed<M, End::source, End::target>(g);
  require_scalar<Sys, M>();
  TwoSidedOf<Sys> out;
  M f = system.lagrangian(gm);
  if constexpr (Sys::arrow_constraints > 0) {
    const Vector<M, Sys::arrow_constraints> phi = system.constraint(gm);
    for (int a = 0; a < Sys::arrow_constraints; ++a) {
      if constexpr (!Nonholonomic<Sys>) f += phi(a) * lambda(a);
      out.constraint(a) = phi(a).value;
      out.constraint_source.col(a) = phi(a).left();
      out.constraint_target.row(a) = phi(a).right().transpose();
    }
  }
  if constexpr (Sys::object_constraints > 0) {
    const auto at_source = system.object_constraint(system.groupoid.source(gm));
    const auto at_target = system.object_constraint(system.groupoid.target(gm));
    for (int a = 0; a < Sys::object_constraints; ++a) {
      const int k = Sys::arrow_constraints + a;
      f += at_source(a) * lambda(k);
      out.constraint(k) = at_target(a).value;
      out.constraint_source.col(k) = at_source(a).left();
      out.constraint_target.row(k) = at_target(a).right().transpose();
    }
  }
  out.value = f.value;
  out.source_gradient = f.left();
  out.target_gradient = f.right();
  out.mixed = f.mixed();
  if constexpr (Nonholonomic<Sys>) {
    constexpr int k = Sys::arrow_constraints;
    out.constraint_source.template leftCols<k>() = annihilator(system, system.groupoid.source(g));
    out.source_gradient += out.constraint_source.template leftCols<k>() * lambda.template head<k>();
  }
  if constexpr (Forced<Sys>) {
    const Forces<M, Sys::dimension> force = system.forces(gm);
    for (int i = 0; i < Sys::dimension; ++i) {
      out.source_gradient(i) += force.source(i).value;
      out.target_gradient(i) += force.target(i).value;
      out.mixed.row(i) += force.source(i).right().transpose();
    }
  }
  return out;
}

/// Whether a step calls the automatic derivatives of Sys, in place of having them inlined into each of its parts. The
/// call costs small systems a tenth to a quarter of a step, large ones nothing, and halves what their steps take to
/// compile (docs/decisions/72).
template <class Sys> inline constexpr bool derivatives_apart = 2 * Sys::dimension + Sys::constraints > 6;

/// The gradients: the system's analytic ones if it has them, alone or in its two-sided derivative; else the automatic
/// ones.
template <DiscreteSystem Sys>
GradientsOf<Sys> gradients(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g,
                           const typename Sys::Multipliers& lambda) {
  require_members_to_fit<Sys>();
  if constexpr (HasAnalyticGradients<Sys>) {
    return system.gradients(g, lambda);
  } else if constexpr (HasAnalyticDerivatives<Sys>) {
    return system.two_sided(g, lambda);
  } else if constexpr (derivatives_apart<Sys>) {
    return apart([&] { return automatic_gradients(system, g, lambda); });
  } else {
    return automatic_gradients(system, g, lambda);
  }
}

/// The two-sided derivative: the system's analytic one if it has one, else the automatic one.
template <DiscreteSystem Sys>
TwoSidedOf<Sys> two_sided(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g,
                          const typename Sys::Multipliers& lambda) {
  require_members_to_fit<Sys>();
  if constexpr (HasAnalyticDerivatives<Sys>) {
    return system.two_sided(g, lambda);
  } else if constexpr (derivatives_apart<Sys>) {
    return apart([&] { return automatic_two_sided(system, g, lambda); });
  } else {
    return automatic_two_sided(system, g, lambda);
  }
}

/// The symmetric second derivative of w -> f(g tau(w)) (end = target) or v -> f(tau(v)^{-1} g) (end = source) at 0.
template <DiscreteSystem Sys>
Matrix<double, Sys::dimension, Sys::dimension> one_sided_hessian(const Sys& system,
                                                                 const ArrowOf<typename Sys::GroupoidType>& g,
                                                                 const typename Sys::Multipliers& lambda, End end) {
  using M = HyperDualOf<Sys>;
  const auto at = [&]<End Which>() {
    return detail::augmented_lagrangian<M>(system, system.groupoid.template seed<M, Which, Which>(g), lambda).mixed();
  };
  return end == End::source ? at.template operator()<End::source>() : at.template operator()<End::target>();
}

/// The constraint values (phi(g), C(beta(g))).
template <DiscreteSystem Sys>
Vector<double, Sys::constraints> constraint_values(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g) {
  Vector<double, Sys::constraints> c;
  if constexpr (Sys::arrow_constraints > 0) c.template head<Sys::arrow_constraints>() = system.constraint(g);
  if constexpr (Sys::object_constraints > 0)
    c.template tail<Sys::object_constraints>() = system.object_constraint(system.groupoid.target(g));
  return c;
}

/// The discrete Legendre transform F-: the state at the source of g. [G] Def. 3.3
template <DiscreteSystem Sys>
State<typename Sys::GroupoidType> legendre_minus(const Sys& system, const Step<Sys>& step) {
  return {system.groupoid.source(step.arrow), -gradients(system, step.arrow, step.multipliers).source_gradient};
}

/// The discrete Legendre transform F+: the state at the target of g. [G] Def. 3.3
template <DiscreteSystem Sys>
State<typename Sys::GroupoidType> legendre_plus(const Sys& system, const Step<Sys>& step) {
  return {system.groupoid.target(step.arrow), gradients(system, step.arrow, step.multipliers).target_gradient};
}

/// F+ - F-, the change of the momentum over a step with gradients d. The part that is due to the Lagrangian is the
/// groupoid's `momentum_change`, which may know it without cancellation; impulses are added.
template <DiscreteSystem Sys, class S>
AlgebroidVector<typename Sys::GroupoidType, S> momentum_change(const Sys& system, const Step<Sys, S>& step,
                                                               const GradientsOf<Sys, S>& d) {
  using V = AlgebroidVector<typename Sys::GroupoidType, S>;
  if constexpr (Variational<Sys>) {
    return system.groupoid.momentum_change(step.arrow, d.source_gradient, d.target_gradient);
  } else {
    const auto acting = impulses<Sys, S>(system, step.arrow, step.multipliers);
    const V change = system.groupoid.momentum_change(step.arrow, V(d.source_gradient - acting.source),
                                                     V(d.target_gradient - acting.target));
    return change + acting.source + acting.target;
  }
}

}  // namespace lagroid
