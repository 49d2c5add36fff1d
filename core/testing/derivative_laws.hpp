#pragma once
/// The derivatives of a system against nested dual numbers, an independent and slow way to compute them.
///
/// Run it before a trajectory: a Lagrangian that keeps an Eigen expression in `auto` has wrong derivatives, and steps
/// still converge.
///
///     const auto draw = [&] { return laws::step_from(system, a_random_state()); };  // momentum_laws.hpp
///     EXPECT_TRUE(lagroid::laws::derivative_laws(system, draw).holds());
///
/// Requires RapidCheck, and a `draw` that returns a random Step of the system. Returns a LawReport of the laws
/// "automatic derivatives", "gradients" and, where the system has its own, "analytic derivatives".

#include <lagroid/core/derivatives/second_derivatives.hpp>
#include <lagroid/core/testing/property.hpp>

namespace lagroid::laws {

/// The two-sided derivative from nested first-order dual numbers and the groupoid's own product and retraction,
/// direction by direction: slow, and sharing neither `HyperDual` nor closed-form translations with the fast one.
template <DiscreteSystem Sys>
TwoSidedOf<Sys> nested_two_sided(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g,
                                 const typename Sys::Multipliers& lambda) {
  using D = Dual<Dual<double>>;
  constexpr int n = Sys::dimension;
  TwoSidedOf<Sys> out;
  Vector<double, n> force_source = Vector<double, n>::Zero();
  Vector<double, n> force_target = Vector<double, n>::Zero();
  const auto gd = system.groupoid.template cast<D>(g);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      Vector<D, n> v = Vector<D, n>::Constant(D(0.0));
      Vector<D, n> w = v;
      v(i).derivative = Dual<double>(1.0);  // outer infinitesimal: the source
      w(j).value.derivative = 1.0;          // inner infinitesimal: the target
      const auto moved = system.groupoid.translate(v, gd, w);
      const D f = lagroid::detail::augmented_lagrangian<D>(system, moved, lambda);
      out.value = f.value.value;
      out.source_gradient(i) = f.derivative.value;
      out.target_gradient(j) = f.value.derivative;
      out.mixed(i, j) = f.derivative.derivative;
      const auto record = [&](int k, const D& at_source, const D& at_target) {
        out.constraint(k) = at_target.value.value;
        out.constraint_source(i, k) = at_source.derivative.value;
        out.constraint_target(k, j) = at_target.value.derivative;
      };
      if constexpr (Sys::arrow_constraints > 0) {
        const auto phi = system.constraint(moved);
        for (int a = 0; a < Sys::arrow_constraints; ++a) record(a, phi(a), phi(a));
      }
      if constexpr (Sys::object_constraints > 0) {
        const auto at_source = system.object_constraint(system.groupoid.source(moved));
        const auto at_target = system.object_constraint(system.groupoid.target(moved));
        for (int a = 0; a < Sys::object_constraints; ++a)
          record(Sys::arrow_constraints + a, at_source(a), at_target(a));
      }
      if constexpr (Forced<Sys>) {
        const auto force = system.forces(moved);
        force_source(i) = force.source(i).value.value;
        force_target(j) = force.target(j).value.value;
        out.mixed(i, j) += force.source(i).value.derivative;
      }
    }
  out.source_gradient += force_source;
  out.target_gradient += force_target;
  if constexpr (Nonholonomic<Sys>) {
    constexpr int k = Sys::arrow_constraints;
    out.constraint_source.template leftCols<k>() = annihilator(system, system.groupoid.source(g));
    for (int a = 0; a < k; ++a) out.source_gradient += lambda(a) * out.constraint_source.col(a);
  }
  return out;
}

/// The largest difference between two derivatives, relative to the largest entry of each part.
template <int N, int M> double derivative_defect(const TwoSided<N, M>& a, const TwoSided<N, M>& b) {
  const auto part = [](const auto& x, const auto& y) {
    if constexpr (std::decay_t<decltype(x)>::SizeAtCompileTime == 0) {
      return 0.0;
    } else {
      if (!x.allFinite() || !y.allFinite()) return std::numeric_limits<double>::infinity();
      return (x - y).cwiseAbs().maxCoeff() / (1 + y.cwiseAbs().maxCoeff());
    }
  };
  return worst({std::abs(a.value - b.value) / (1 + std::abs(b.value)), part(a.source_gradient, b.source_gradient),
                part(a.target_gradient, b.target_gradient), part(a.mixed, b.mixed), part(a.constraint, b.constraint),
                part(a.constraint_source, b.constraint_source), part(a.constraint_target, b.constraint_target)});
}

/// The same for the gradients alone.
template <int N, int M> double gradient_defect(const Gradients<N, M>& a, const Gradients<N, M>& b) {
  TwoSided<N, M> x{};
  TwoSided<N, M> y{};
  static_cast<Gradients<N, M>&>(x) = a;
  static_cast<Gradients<N, M>&>(y) = b;
  for (auto* d : {&x, &y}) {
    d->mixed.setZero();
    d->constraint_source.setZero();
    d->constraint_target.setZero();
  }
  return derivative_defect(x, y);
}

/// `draw()` returns a random Step of the system. The laws: the derivatives the solvers use (analytic where the system
/// has them) and the automatic ones both agree with nested dual numbers.
template <DiscreteSystem Sys, class Draw>
LawReport derivative_laws(const Sys& system, const Draw& draw, double tolerance = 1e-9) {
  LawReport report{"derivatives", {}};
  report.laws.push_back(check_law("automatic derivatives", tolerance, [&] {
    const Step<Sys> s = draw();
    return derivative_defect(automatic_two_sided(system, s.arrow, s.multipliers),
                             nested_two_sided(system, s.arrow, s.multipliers));
  }));
  report.laws.push_back(check_law("gradients", tolerance, [&] {
    const Step<Sys> s = draw();
    return worst({gradient_defect<Sys::dimension, Sys::constraints>(automatic_gradients(system, s.arrow, s.multipliers),
                                                                    nested_two_sided(system, s.arrow, s.multipliers)),
                  gradient_defect<Sys::dimension, Sys::constraints>(gradients(system, s.arrow, s.multipliers),
                                                                    nested_two_sided(system, s.arrow, s.multipliers))});
  }));
  if constexpr (HasAnalyticDerivatives<Sys>)
    report.laws.push_back(check_law("analytic derivatives", tolerance, [&] {
      const Step<Sys> s = draw();
      return derivative_defect(two_sided(system, s.arrow, s.multipliers),
                               nested_two_sided(system, s.arrow, s.multipliers));
    }));
  return report;
}

/// For a groupoid that supplies an arrow frame: second derivatives in one pass along it are those of three passes.
template <DiscreteSystem Sys, class Draw>
requires HasArrowFrame<typename Sys::GroupoidType> LawReport second_derivative_law(const Sys& system, const Draw& draw,
                                                                                   double tolerance = 1e-9) {
  return {
      "second derivatives", {check_law("one pass is three", tolerance, [&] {
        const Step<Sys> s = draw();
        const auto one = second_derivatives_in_one_pass(system, s.arrow, s.multipliers);
        const auto three = second_derivatives_in_three_passes(system, s.arrow, s.multipliers);
        const auto gap = [](const auto& a, const auto& b) {
          if (!a.allFinite() || !b.allFinite()) return std::numeric_limits<double>::infinity();
          return (a - b).cwiseAbs().maxCoeff() / (1 + b.cwiseAbs().maxCoeff());
        };
        return worst({derivative_defect<Sys::dimension, Sys::constraints>(one, three),
                      gap(one.source_hessian, three.source_hessian), gap(one.target_hessian, three.target_hessian)});
      })}};
}

}  // namespace lagroid::laws
