#pragma once
/// A test that the gradient which a solver is about to use is that of L + <lambda, phi> + <lambda, C>, by central
/// differences.
///
/// Derivatives are automatic, so they are wrong where the function that is differentiated is not the one that was
/// meant: above all where a Lagrangian keeps an Eigen expression in `auto`, which refers to numbers that are gone when
/// it is evaluated. Solvers then converge, to nonsense.
///
///     check_gradient(system, step);  // checked builds do this at the first step of an integrator
///
/// Errors: WrongGradient where the two disagree. laws::derivative_laws is the sharper test, at many samples.

#include <lagroid/core/derivatives/two_sided.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace lagroid {

/// Thrown in checked builds (LAGROID_CHECKED) where the gradient of the first step is not that of the Lagrangian.
class WrongGradient : public std::domain_error {
  using std::domain_error::domain_error;
};

/// Compares the gradients at a step with central differences of L + <lambda, phi> + <lambda, C>, to three digits and to
/// the uncertainty of the differences themselves. Throws WrongGradient where they disagree; where the differences are
/// not finite, nothing is compared.
template <DiscreteSystem Sys> void check_gradient(const Sys& system, const Step<Sys>& step) {
  using V = AlgebroidVector<typename Sys::GroupoidType>;
  constexpr int n = Sys::dimension;
  const auto& groupoid = system.groupoid;
  const auto d = gradients(system, step.arrow, step.multipliers);
  const auto acting = impulses<Sys>(system, step.arrow, step.multipliers);
  const double length = groupoid.tau_inverse(step.arrow).norm();
  const double unit = 1e-4 * (length > 0 ? length : 1);
  const auto difference = [&](End end, int i, double size) {
    const auto at = [&](double x) {
      const V moved = x * V::Unit(i);
      const V still = V::Zero();
      return detail::augmented_lagrangian<double>(system,
                                                  end == End::source ? groupoid.translate(moved, step.arrow, still)
                                                                     : groupoid.translate(still, step.arrow, moved),
                                                  step.multipliers);
    };
    return (at(size) - at(-size)) / (2 * size);
  };
  for (const End end : {End::source, End::target}) {
    const V gradient = end == End::source ? V(d.source_gradient - acting.source) : V(d.target_gradient - acting.target);
    V coarse;
    V fine;
    for (int i = 0; i < n; ++i) {
      coarse(i) = difference(end, i, unit);
      fine(i) = difference(end, i, 0.5 * unit);
    }
    const double uncertain =
        10 * (coarse - fine).norm() + 100 * std::numeric_limits<double>::epsilon() * std::abs(d.value) / unit;
    const double size = std::max(gradient.norm(), fine.norm());
    if ((gradient - fine).norm() <= 1e-3 * size + uncertain || !std::isfinite(uncertain)) continue;
    std::ostringstream message;
    message << "the gradient of L at the " << (end == End::source ? "source" : "target") << " of the first step is ("
            << gradient.transpose() << "), by differences of L (" << fine.transpose()
            << "): does lagrangian() keep an Eigen expression in auto (write its type instead), or are derivatives "
               "written by hand wrong? laws::derivative_laws tells more";
    throw WrongGradient(message.str());
  }
}

}  // namespace lagroid
