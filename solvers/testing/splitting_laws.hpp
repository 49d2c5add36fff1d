#pragma once
/// The laws of a SplitSystem's flows: each is a one-parameter group and a Poisson map, and together they are the
/// system,
///
///     phi_{s+t} = phi_s o phi_t,    F-(g) = mu + O(h^2),  F+(g) = mu' + O(h^2)  for the arrow g of a short split step.
///
///     const auto draw = [] { return State<Pair<2>>{{1, 0}, {0, 1 + 0.1 * laws::draw_uniform()}}; };
///     std::cout << laws::splitting_laws(Kepler{}, draw);

#include <lagroid/core/derivatives/step_equations.hpp>
#include <lagroid/core/hamiltonian/lagrangian.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/integrators/splitting.hpp>

#include <string>

namespace lagroid::laws {

/// The map of a composed splitting step, for points of A*G over any scalar (`poisson_defect` takes it).
template <SplitSystem Sys> auto splitting_map(const Sys& system, const Composition& composition, double h) {
  return [&system, composition, h]<class Z>(const Z& z) {
    SplitMotion<Sys, typename decltype(z.momentum)::Scalar> motion(system, z.object, z.momentum);
    motion.step(composition, h);
    return Z{motion.object(), motion.momentum()};
  };
}

/// At random states: every part is a one-parameter group, with its arrows, and a Poisson map; and the parts add up to
/// the system: the discrete Legendre transforms of the arrow g of a short step are its momenta, F-(g) = mu and F+(g) =
/// mu' up to h^2. (A part that were missing or wrong would show at order h.) `draw()` returns a State, `t` is the
/// longest time to follow a part.
template <SplitSystem Sys, class Draw>
LawReport splitting_laws(const Sys& system, const Draw& draw, double t = 1, double tolerance = 1e-11) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = system.groupoid;
  LawReport report{"splitting", {}};
  unrolled<Sys::parts>([&]<int I>() {
    const std::string part = "part " + std::to_string(I);
    report.laws.push_back(check_law(part + " is a flow", tolerance, [&] {
      const State<G> z = draw();
      const double first = t * draw_uniform();
      const double second = t * draw_uniform();
      SplitMotion<Sys, double> in_two(system, z.object, z.momentum);
      in_two.template follow<I>(first);
      in_two.template follow<I>(second);
      const auto in_one = system.template flow<I>(first + second, z.object, z.momentum);
      return worst(
          {detail::relative_defect(groupoid.coordinates_of_object(groupoid.source(in_one.arrow)),
                                   groupoid.coordinates_of_object(z.object)),
           detail::relative_defect(groupoid.coordinates_of_arrow(in_two.arrow()),
                                   groupoid.coordinates_of_arrow(in_one.arrow)),
           detail::relative_defect(in_two.momentum(), AlgebroidVector<G>(z.momentum + in_one.momentum_change))});
    }));
    report.laws.push_back(check_law(part + " is Poisson", tolerance, [&] {
      const State<G> z = draw();
      const double time = t * draw_uniform();
      const auto map = [&]<class Z>(const Z& from) {
        SplitMotion<Sys, typename decltype(from.momentum)::Scalar> motion(system, from.object, from.momentum);
        motion.template follow<I>(time);
        return Z{motion.object(), motion.momentum()};
      };
      return poisson_defect(groupoid, {z.object, z.momentum}, map);
    }));
  });
  constexpr double h = 1e-4;
  report.laws.push_back(check_law("the parts add up to the system", 1e-2 * h, [&] {
    const State<G> z = draw();
    Sys brief = system;
    brief.h = h;
    SplitMotion<Sys, double> split(brief, z.object, z.momentum);
    split.step(compositions::single, h);
    const Step<Sys> step{split.arrow(), {}};
    return worst({detail::relative_defect(legendre_minus(brief, step).momentum, z.momentum),
                  detail::relative_defect(legendre_plus(brief, step).momentum, split.momentum())});
  }));
  return report;
}

}  // namespace lagroid::laws
