#pragma once
/// Discrete connections (groupoids/connections.hpp) as properties that a user's own runs by naming itself.
///
///     const LawReport report = laws::connection_laws(ShortestRotation{}, draw_direction);
///
/// Requires draw_object(), objects of the gauge groupoid. Returns a report with one entry a law; throws nothing.

#include <lagroid/core/testing/groupoid_laws.hpp>

#include <cmath>
#include <numbers>

namespace lagroid::laws {

/// Arrows and pairs (b, theta) determine each other; angles add along the fibres, at either end (the group is Abelian
/// and central), and along all arrows where the connection says that it is flat. Its adapted basis, where it supplies
/// one, is that of its horizontal lifts.
template <class Connection, class DrawObject>
LawReport connection_laws(const Connection& connection, const DrawObject& draw_object,
                          const GroupoidLawOptions& options = {}) {
  using G = typename Connection::Domain;
  using Angles = Vector<double, Connection::angles>;
  using detail::relative_defect;
  const G& from = connection.from;
  const auto arrow_from = [&](const ObjectOf<G>& q) {
    return ArrowOf<G>(from.tau(q, Vector<double, G::dimension>(draw_vector<G::dimension>(options.large))));
  };
  const auto along_the_fibre = [&](const ObjectOf<G>& q, const Angles& theta) {
    return connection.attach(connection.to.unit(connection.object(q)), theta);
  };
  // Up to full turns, which angles may have and lengths along a fibre do not reach.
  const auto differ = [&](const Angles& x, const Angles& y) {
    double most = 0;
    for (int i = 0; i < Connection::angles; ++i)
      most = std::max(most, std::abs(std::remainder(x(i) - y(i), 2 * std::numbers::pi)));
    return most;
  };

  LawReport report{"connection of " + G::name(), {}};
  const auto law = [&](const char* name, const auto& defect) {
    report.laws.push_back(check_law(name, options.tolerance, defect));
  };
  law("base and angle determine the arrow", [&] {
    const auto g = arrow_from(draw_object());
    const Angles theta = draw_vector<Connection::angles>(1.0);
    const auto moved = connection.attach(connection(g), theta);
    return worst({relative_defect(from.coordinates_of_arrow(connection.attach(connection(g), connection.angle(g))),
                                  from.coordinates_of_arrow(g)),
                  differ(connection.angle(moved), theta),
                  relative_defect(connection.to.coordinates_of_arrow(connection(moved)),
                                  connection.to.coordinates_of_arrow(connection(g)))});
  });
  law("angles add along the fibres", [&] {
    const auto g = arrow_from(draw_object());
    const Angles theta = draw_vector<Connection::angles>(0.5);
    const Angles sum = connection.angle(g) + theta;
    return worst({differ(connection.angle(from.multiply(along_the_fibre(from.source(g), theta), g)), sum),
                  differ(connection.angle(from.multiply(g, along_the_fibre(from.target(g), theta))), sum)});
  });
  if constexpr (requires(const ObjectOf<typename Connection::Codomain>& m) { connection.adapted_basis(m); })
    law("adapted basis", [&] {
      using D = Dual<double>;
      constexpr int n = Connection::Codomain::dimension;
      const auto m = connection.object(draw_object());
      const auto over = connection.to.template cast_object<D>(m);
      Matrix<double, G::dimension, G::dimension> basis;
      for (int i = 0; i < G::dimension; ++i) {
        Vector<D, n> v = Vector<D, n>::Constant(D(0.0));
        Vector<D, Connection::angles> theta = Vector<D, Connection::angles>::Constant(D(0.0));
        (i < n ? v(i) : theta(i - n)).derivative = 1;
        basis.col(i) = derivative_of(from.tau_inverse(connection.attach(connection.to.tau(over, v), theta)));
      }
      return relative_defect(connection.adapted_basis(m), basis);
    });
  if constexpr (Connection::flat)
    law("a flat connection is a morphism", [&] {
      const auto g = arrow_from(draw_object());
      const auto h = arrow_from(from.target(g));
      return differ(connection.angle(from.multiply(g, h)), connection.angle(g) + connection.angle(h));
    });
  return report;
}

}  // namespace lagroid::laws
