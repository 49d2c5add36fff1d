#pragma once
/// Noether symmetries, arrow by arrow. [G] Def. 4.8

#include <lagroid/core/two_sided.hpp>

#include <cmath>

namespace lagroid {

/// <F+(g, lambda), X(beta(g))> - <F-(g, lambda), X(alpha(g))>: zero on Sigma_L when the section X of AG is a Noether
/// symmetry with f = 0, and then <mu, X> is conserved by the dynamics ([G] Theorem 4.9).
/// `section(q)` returns X(q) in the basis of A_qG.
template <DiscreteSystem Sys, class Section>
double noether_defect(const Sys& system, const Step<Sys>& step, const Section& section) {
  const auto d = two_sided(system, step.arrow, step.multipliers);
  return d.target_gradient.dot(section(system.groupoid.target(step.arrow))) +
         d.source_gradient.dot(section(system.groupoid.source(step.arrow)));
}

}  // namespace lagroid
