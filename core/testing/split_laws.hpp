#pragma once
/// Split gauge groupoids (groupoids/split_gauge.hpp) and discrete Lagrange-Poincare equations as properties that a
/// user's own connection and system run by naming themselves.
///
///     const laws::LawReport report = laws::splitting_laws(SplitGauge<Transport>{}, draw_shape);
///     const laws::LawReport equations = laws::lagrange_poincare_laws(Unsplit<Transport>{}, system, draw_step);
///
/// Requires draw_object(), objects of the base, and draw(), a Step of the system on the gauge groupoid. Returns a
/// report with one entry a law; throws nothing.

#include <lagroid/core/morphism.hpp>
#include <lagroid/core/reduction/lagrange_poincare.hpp>
#include <lagroid/core/testing/groupoid_laws.hpp>

#include <cmath>

namespace lagroid::laws {

/// Arrows and pairs (b, gamma) determine each other; elements multiply along the fibre at the source; units are
/// horizontal.
template <class Split, class DrawObject>
LawReport splitting_laws(const Split& split, const DrawObject& draw_object, const GroupoidLawOptions& options = {}) {
  using detail::relative_defect;
  const auto& gauge = split.connection.from;
  const auto arrow = [&] {
    return ArrowOf<Split>(
        split.tau(draw_object(), Vector<double, Split::rank>(draw_vector<Split::rank>(options.large))));
  };
  const auto element = [&] {
    return ArrowOf<typename Split::Group>(
        split.group.tau({}, Vector<double, Split::fibre_rank>(draw_vector<Split::fibre_rank>(options.large))));
  };
  LawReport report{Split::name(), {}};
  const auto law = [&](const char* name, const auto& defect) {
    report.laws.push_back(check_law(name, options.tolerance, defect));
  };
  law("base and element determine the arrow", [&] {
    const auto g = arrow();
    return relative_defect(split.coordinates_of_arrow(split.split(split.join(g))), split.coordinates_of_arrow(g));
  });
  law("elements multiply along the fibre", [&] {
    const auto g = arrow();
    const auto k = element();
    const auto product = split.split(gauge.multiply(split.vertical(split.source(g), k), split.join(g)));
    return relative_defect(split.group.coordinates_of_arrow(product.element),
                           split.group.coordinates_of_arrow(split.group.multiply(k, g.element)));
  });
  law("units are horizontal", [&] {
    const auto g = split.join(split.unit(draw_object()));
    return relative_defect(gauge.coordinates_of_arrow(g), gauge.coordinates_of_arrow(gauge.unit(gauge.source(g))));
  });
  return report;
}

/// The equations of Lagrange and Poincare, written out, are those of the unsplit system: at every arrow both Legendre
/// transforms of the system are, along horizontal and vertical directions, what `entering` and `leaving` say. Along an
/// arrow vertical momenta are carried by Ad*.
template <class Phi, DiscreteSystem Sys, class Draw>
LawReport lagrange_poincare_laws(const Phi& phi, const Sys& system, const Draw& draw, double tolerance = 1e-11) {
  using Split = typename Phi::Domain;
  using detail::relative_defect;
  using Below = PulledBack<Phi, Sys>;
  constexpr int n = Split::base_rank;
  constexpr int k = Split::fibre_rank;
  const Below below(system, phi);
  const Split& split = below.groupoid;
  const auto& gauge = split.connection.from;
  const auto apart = [&](const Step<Sys>& s) { return Step<Below>{split.split(s.arrow), s.multipliers}; };
  // The momentum of the unsplit system along the basis of the split one at s.
  const auto along_split_basis = [&](const auto& s, const State<typename Sys::GroupoidType>& z) {
    return Vector<double, n + k>(phi.algebroid(s).transpose() * z.momentum);
  };
  LawReport report{"Lagrange-Poincare equations on " + Split::name(), {}};
  const auto law = [&](const char* name, const auto& defect) {
    report.laws.push_back(check_law(name, tolerance, defect));
  };
  law("horizontal equations are those of the unsplit system", [&] {
    const Step<Sys> step = draw();
    const auto x = apart(step);
    const auto minus = along_split_basis(split.source(x.arrow), legendre_minus(system, step));
    const auto plus = along_split_basis(split.target(x.arrow), legendre_plus(system, step));
    return worst({relative_defect(entering(below, x).horizontal, Vector<double, n>(minus.template head<n>())),
                  relative_defect(leaving(below, x).horizontal, Vector<double, n>(plus.template head<n>()))});
  });
  law("vertical equations are those of the unsplit system", [&] {
    const Step<Sys> step = draw();
    const auto x = apart(step);
    const auto minus = along_split_basis(split.source(x.arrow), legendre_minus(system, step));
    const auto plus = along_split_basis(split.target(x.arrow), legendre_plus(system, step));
    return worst({relative_defect(entering(below, x).vertical, Vector<double, k>(minus.template tail<k>())),
                  relative_defect(leaving(below, x).vertical, Vector<double, k>(plus.template tail<k>()))});
  });
  law("vertical momenta are carried along arrows", [&] {
    const auto x = apart(draw());
    // Ad of the arrow: exp(e_a) at its target, as an element at its source.
    using D = Dual<double>;
    const auto g = gauge.template cast<D>(split.join(x.arrow));
    const auto end = split.base().template cast_object<D>(split.target(x.arrow));
    Matrix<double, k, k> carried;
    for (int a = 0; a < k; ++a) {
      const auto turn = split.group.tau(ObjectOf<typename Split::Group, D>(), infinitesimal(unit_vector<double, k>(a)));
      const auto back = gauge.multiply(gauge.multiply(g, split.vertical(end, turn)), gauge.inverse(g));
      carried.col(a) = derivative_of(split.group.tau_inverse(split.split(back).element));
    }
    return relative_defect(leaving(below, x).vertical,
                           Vector<double, k>(carried.transpose() * entering(below, x).vertical));
  });
  return report;
}

}  // namespace lagroid::laws
