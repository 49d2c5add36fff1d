#pragma once
/// Morphisms of groupoids and of systems as properties that a user's own run by naming themselves.

#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/morphism.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>

namespace lagroid::laws {

/// [G] Def. 4.1 and what follows from it: Phi keeps products, units, inverses, sources and targets, A Phi commutes with
/// the anchors and takes left- and right-invariant fields to such; a lift is one. What a morphism says for reduction
/// downward (`representative`, `over`, `keeps_basis`, `reduced_momentum`) is what it should be.
template <class Phi, class DrawObject>
LawReport morphism_laws(const Phi& phi, const DrawObject& draw_object, const GroupoidLawOptions& options = {}) {
  using G = typename Phi::Domain;
  using H = typename Phi::Codomain;
  constexpr int n = G::dimension;
  using V = Vector<double, n>;
  using D = Dual<double>;
  using detail::relative_defect;
  const G& from = phi.from;
  const H& to = phi.to;
  const auto vector = [&] { return V(draw_vector<n>(options.large)); };
  const auto arrow_from = [&](const ObjectOf<G>& q) {
    const ArrowOf<G> g = from.tau(q, vector());
    return ArrowOf<G>(from.project(from.multiply(g, from.tau(from.target(g), vector()))));
  };
  const auto arrow = [&] { return arrow_from(draw_object()); };
  const auto arrows = [&](const auto& x, const auto& y) {
    return relative_defect(to.coordinates_of_arrow(x), to.coordinates_of_arrow(y));
  };
  const auto objects = [&](const auto& x, const auto& y) {
    return relative_defect(to.coordinates_of_object(x), to.coordinates_of_object(y));
  };
  // T Phi of a tangent vector in arrow coordinates.
  const auto pushed = [&](const ArrowOf<G>& g, const auto& tangent) {
    return derivative_of(to.coordinates_of_arrow(phi(from.with_tangent(g, tangent))));
  };

  LawReport report{G::name() + " -> " + H::name(), {}};
  const auto law = [&](const char* name, double tolerance, const auto& defect) {
    report.laws.push_back(check_law(name, tolerance, defect));
  };
  law("products", options.tolerance, [&] {
    const auto g = arrow();
    const auto h = arrow_from(from.target(g));
    return arrows(phi(from.compose(g, h)), to.compose(phi(g), phi(h)));
  });
  law("units and inverses", options.tolerance, [&] {
    const auto g = arrow();
    const auto q = from.source(g);
    return worst({arrows(phi(from.unit(q)), to.unit(phi.object(q))), arrows(phi(from.inverse(g)), to.inverse(phi(g)))});
  });
  law("sources and targets", options.tolerance, [&] {
    const auto g = arrow();
    return worst({objects(to.source(phi(g)), phi.object(from.source(g))),
                  objects(to.target(phi(g)), phi.object(from.target(g)))});
  });
  law("anchors", options.derivative, [&] {
    const auto q = draw_object();
    const V x = vector();
    Vector<D, n> e;
    for (int i = 0; i < n; ++i) e(i) = D(0.0, x(i));
    const auto moved = from.target(from.tau(from.template cast_object<D>(q), e));
    return relative_defect(derivative_of(to.coordinates_of_object(phi.object(moved))),
                           to.anchor(phi.object(q), (phi.algebroid(q) * x).eval()));
  });
  law("left-invariant fields", options.derivative, [&] {
    const auto g = arrow();
    const V x = vector();
    return relative_defect(pushed(g, from.left_invariant(g, x)),
                           to.left_invariant(phi(g), (phi.algebroid(from.target(g)) * x).eval()));
  });
  law("right-invariant fields", options.derivative, [&] {
    const auto g = arrow();
    const V x = vector();
    return relative_defect(pushed(g, from.right_invariant(g, x)),
                           to.right_invariant(phi(g), (phi.algebroid(from.source(g)) * x).eval()));
  });
  if constexpr (requires(const ObjectOf<G>& q, const ArrowOf<H>& g) { phi.lift(q, g); })
    law("lift", options.tolerance, [&] {
      const auto g = arrow();
      const auto lifted = phi.lift(from.source(g), phi(g));
      return relative_defect(from.coordinates_of_arrow(lifted), from.coordinates_of_arrow(g));
    });
  if constexpr (RepresentsArrows<Phi>) {
    law("representatives", options.tolerance, [&] {
      const auto image = phi(arrow());
      const ArrowOf<G> stands = representative_of(phi, image);
      return worst(
          {arrows(phi(stands), image), objects(phi.object(object_over(phi, to.source(image))), to.source(image))});
    });
  }
  if constexpr (G::dimension == H::dimension) {
    law("momenta go down and up", options.derivative, [&] {
      const auto q = draw_object();
      const V mu = vector();
      const V below = phi.reduced_momentum(q, mu);
      return worst(
          {relative_defect(phi.related(q, below).momentum, mu),
           Phi::keeps_basis ? relative_defect(phi.algebroid(q), Matrix<double, n, n>::Identity().eval()) : 0.0});
    });
  }
  return report;
}

/// The same for groupoids whose objects are vectors of R^n (or tuples of such), drawn at random.
template <class Phi> LawReport morphism_laws(const Phi& phi = {}, const GroupoidLawOptions& options = {}) {
  using G = typename Phi::Domain;
  constexpr int size = G::object_coordinate_count();
  return morphism_laws(
      phi, [&] { return ObjectOf<G>(phi.from.template object_at<double>(draw_vector<size>(options.large))); }, options);
}

/// [G] Def. 4.2, Example 4.3 and Theorem 4.5: L = L' o Phi, phi = phi' o Phi, and at every arrow and multiplier the
/// discrete Legendre transforms are A*Phi-related. `draw()` returns a Step of the unreduced system.
template <class Phi, DiscreteSystem Sys, DiscreteSystem Reduced, class Draw>
LawReport system_morphism_laws(const Phi& phi, const Sys& system, const Reduced& reduced, const Draw& draw,
                               double tolerance = 1e-11) {
  static_assert(Sys::arrow_constraints == Reduced::arrow_constraints && Sys::object_constraints == 0 &&
                Reduced::object_constraints == 0);
  LawReport report{"morphism of systems", {}};
  report.laws.push_back(check_law("Lagrangians and constraints", tolerance, [&] {
    const Step<Sys> s = draw();
    const double full = system.lagrangian(s.arrow);
    const double gap = std::abs(full - reduced.lagrangian(phi(s.arrow))) / (1 + std::abs(full));
    return worst(
        {gap, detail::relative_defect(constraint_values(system, s.arrow), constraint_values(reduced, phi(s.arrow)))});
  }));
  report.laws.push_back(check_law("Legendre transforms are related", tolerance, [&] {
    const Step<Sys> s = draw();
    const Step<Reduced> image{phi(s.arrow), s.multipliers};
    const auto minus = legendre_minus(system, s);
    const auto plus = legendre_plus(system, s);
    return worst({detail::relative_defect(minus.momentum,
                                          phi.related(minus.object, legendre_minus(reduced, image).momentum).momentum),
                  detail::relative_defect(plus.momentum,
                                          phi.related(plus.object, legendre_plus(reduced, image).momentum).momentum)});
  }));
  return report;
}

}  // namespace lagroid::laws
