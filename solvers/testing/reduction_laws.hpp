#pragma once
/// Reduced dynamics as laws of a morphism Phi of groupoids: stepping then reducing is reducing then stepping, and the
/// trajectory is reconstructed from the reduced one. Requires a Phi with `object` and `algebroid`, and pairs of an
/// object and a reduced momentum from `draw`. [G] Corollary 4.6, Remark 4.7

#include <lagroid/core/morphism.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>

#include <vector>

namespace lagroid::laws {

/// Along `steps` steps from related states, stepping then reducing is reducing then stepping: arrows have equal images,
/// momenta stay A*Phi-related; and where Phi can lift, the trajectory is reconstructed from the reduced one.
///
/// `draw()` returns a pair of an object of the system and a momentum of the reduced one.
template <class Phi, DiscreteSystem Sys, DiscreteSystem Reduced, class Draw>
LawReport reduction_laws(const Phi& phi, const Sys& system, const Reduced& reduced, const Draw& draw, int steps = 20,
                         double tolerance = 1e-11) {
  using G = typename Phi::Domain;
  using H = typename Phi::Codomain;
  struct Pair {
    std::vector<ArrowOf<G>> full;
    std::vector<ArrowOf<H>> reduced;
    double momentum = 0;  // worst defect of the relation between momenta
  };
  const auto run = [&](const auto& start) {
    const auto& [q, momentum] = start;
    auto above = detail::newton_integrator(system, phi.related(q, momentum));
    auto below = detail::newton_integrator(reduced, State<H>{phi.object(q), momentum});
    Pair out;
    for (int k = 0; k < steps; ++k) {
      if (const auto report = above.advance(); !report.converged()) throw detail::no_step(report);
      if (const auto report = below.advance(); !report.converged()) throw detail::no_step(report);
      out.full.push_back(above.point().step.arrow);
      out.reduced.push_back(below.point().step.arrow);
      const auto& z = above.point().state;
      out.momentum =
          worst({out.momentum,
                 detail::relative_defect(z.momentum, phi.related(z.object, below.point().state.momentum).momentum)});
    }
    return out;
  };
  LawReport report{"reduction", {}};
  report.laws.push_back(check_law("images of arrows", tolerance, [&] {
    const Pair p = run(draw());
    double largest = 0;
    for (int k = 0; k < steps; ++k)
      largest = worst({largest, detail::relative_defect(phi.to.coordinates_of_arrow(phi(p.full[std::size_t(k)])),
                                                        phi.to.coordinates_of_arrow(p.reduced[std::size_t(k)]))});
    return largest;
  }));
  report.laws.push_back(check_law("related momenta", tolerance, [&] { return run(draw()).momentum; }));
  if constexpr (requires(const ObjectOf<G>& q, const ArrowOf<H>& g) { phi.lift(q, g); })
    report.laws.push_back(check_law("reconstruction", tolerance, [&] {
      const auto start = draw();
      const Pair p = run(start);
      const auto rebuilt = phi.reconstruct(start.first, p.reduced);
      double largest = 0;
      for (int k = 0; k < steps; ++k)
        largest = worst({largest, detail::relative_defect(phi.from.coordinates_of_arrow(rebuilt[std::size_t(k)]),
                                                          phi.from.coordinates_of_arrow(p.full[std::size_t(k)]))});
      return largest;
    }));
  return report;
}

}  // namespace lagroid::laws
