#pragma once
/// Every second derivative of f = L + <lambda, phi> + <lambda, C> at an arrow: d2f/dv dw of `TwoSided`, and the
/// symmetric Hessians of v -> f(tau(v)^{-1} g) and w -> f(g tau(w)).
///
/// Newton's method for boundary values needs them at every arrow; on a group one pass along the arrow's frame gives all
/// three.
///
///     const auto d = second_derivatives(system, g, lambda);
///     const auto curvature = d.source_hessian;  // and d.target_hessian, d.mixed, d.value, ...
///
/// Requires a variational system: forces and nonholonomic reactions have no Hessian. Returns the system's own second
/// derivatives where it has them.
///
/// Errors: a `second_derivatives` of another form does not compile. Nothing throws.

#include <lagroid/core/derivatives/arrow_frame.hpp>
#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/scalars/second_jet.hpp>

namespace lagroid {

/// The two-sided derivative with the symmetric Hessians of v -> f(tau(v)^{-1} g) and w -> f(g tau(w)) at 0.
template <int N, int M> struct SecondDerivatives : TwoSided<N, M> {
  Matrix<double, N, N> source_hessian;
  Matrix<double, N, N> target_hessian;
};

template <class Sys> using SecondDerivativesOf = SecondDerivatives<Sys::dimension, Sys::constraints>;

/// In three passes, one for each second derivative: on any groupoid.
template <DiscreteSystem Sys>
SecondDerivativesOf<Sys> second_derivatives_in_three_passes(const Sys& system,
                                                            const ArrowOf<typename Sys::GroupoidType>& g,
                                                            const typename Sys::Multipliers& lambda) {
  return {two_sided(system, g, lambda), one_sided_hessian(system, g, lambda, End::source),
          one_sided_hessian(system, g, lambda, End::target)};
}

/// In one pass along the arrow's frame, pushed to its ends.
template <DiscreteSystem Sys>
requires HasArrowFrame<typename Sys::GroupoidType> LAGROID_FLATTEN SecondDerivativesOf<Sys>
second_derivatives_in_one_pass(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g,
                               const typename Sys::Multipliers& lambda) {
  constexpr int n = Sys::dimension;
  constexpr int d = Sys::GroupoidType::arrow_dimension;
  constexpr int phis = Sys::arrow_constraints;
  using J = SecondJet<double, d>;
  const auto& groupoid = system.groupoid;
  const auto jet = groupoid.template frame_jet<J>(g);
  SecondDerivativesOf<Sys> out;
  Matrix<double, d, Sys::constraints> at_source;
  Matrix<double, d, Sys::constraints> at_target;
  J f = system.lagrangian(jet);
  if constexpr (phis > 0) {
    const Vector<J, phis> phi = system.constraint(jet);
    for (int a = 0; a < phis; ++a) {
      f += phi(a) * lambda(a);
      out.constraint(a) = phi(a).value;
      at_source.col(a) = at_target.col(a) = phi(a).gradient();
    }
  }
  if constexpr (Sys::object_constraints > 0) {
    const Vector<J, Sys::object_constraints> source = system.object_constraint(groupoid.source(jet));
    const Vector<J, Sys::object_constraints> target = system.object_constraint(groupoid.target(jet));
    for (int a = 0; a < Sys::object_constraints; ++a) {
      f += source(a) * lambda(phis + a);
      out.constraint(phis + a) = target(a).value;
      at_source.col(phis + a) = source(a).gradient();
      at_target.col(phis + a) = target(a).gradient();
    }
  }
  const Vector<double, d> gradient = f.gradient();
  const Matrix<double, d, d> hessian = f.hessian();
  const Matrix<double, d, d> skewed = hessian + 0.5 * groupoid.frame_bracket(gradient);
  const auto pushed = [&]<End First, End Second>(const Matrix<double, d, d>& form) -> Matrix<double, n, n> {
    const Matrix<double, n, d> rows = groupoid.template frame_to_end<First>(g, form);
    const Matrix<double, d, n> columns = rows.transpose();
    return groupoid.template frame_to_end<Second>(g, columns).transpose();
  };
  out.value = f.value;
  out.source_gradient = groupoid.template frame_to_end<End::source>(g, gradient);
  out.target_gradient = groupoid.template frame_to_end<End::target>(g, gradient);
  out.mixed = pushed.template operator()<End::source, End::target>(skewed);
  out.source_hessian = pushed.template operator()<End::source, End::source>(hessian);
  out.target_hessian = pushed.template operator()<End::target, End::target>(hessian);
  if constexpr (Sys::constraints > 0) {
    out.constraint_source = groupoid.template frame_to_end<End::source>(g, at_source);
    out.constraint_target = groupoid.template frame_to_end<End::target>(g, at_target).transpose();
  }
  return out;
}

/// A system that writes all its second derivatives itself.
template <class Sys>
concept HasSecondDerivatives = requires(const Sys& system, const Step<Sys>& step) {
  { system.second_derivatives(step.arrow, step.multipliers) } -> std::convertible_to<SecondDerivativesOf<Sys>>;
};

/// Every second derivative: the system's own, or in one pass where the ends of an arrow share displacements (d < 2n),
/// else in three.
template <DiscreteSystem Sys>
SecondDerivativesOf<Sys> second_derivatives(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g,
                                            const typename Sys::Multipliers& lambda) {
  static_assert(
      HasSecondDerivatives<Sys> || !requires { &Sys::second_derivatives; },
      "second_derivatives is there but does not fit (see HasSecondDerivatives)");
  constexpr int d = arrow_dimension_of<typename Sys::GroupoidType>();
  if constexpr (HasSecondDerivatives<Sys>) {
    return system.second_derivatives(g, lambda);
  } else if constexpr (d > 0 && d < 2 * Sys::dimension && !HasAnalyticDerivatives<Sys>) {
    return second_derivatives_in_one_pass(system, g, lambda);
  } else {
    return second_derivatives_in_three_passes(system, g, lambda);
  }
}

}  // namespace lagroid
