#pragma once
/// Laws of objectives that say how they change with their parameters, and of the minima that these lead to; and of how
/// the logarithms of a manifold change with their ends.
///
///     const optimisation::Sphere sphere(5);
///     const auto a = optimisation::random_symmetric(5, 1);
///     const optimisation::Rayleigh f(optimisation::SymmetricOperator::of(a));
///     std::cout << laws::parametric_objective_laws(sphere, f) << laws::minimum_laws(sphere, f, start, "A");
///
/// Requires what manifold_laws.hpp requires; of `minimum_laws` a start from which the trust region method finds a
/// strict minimum. An unknown name of parameters throws std::invalid_argument, a minimum that is not found
/// std::runtime_error.

#include <lagroid/core/derivatives/extrapolated_difference.hpp>
#include <lagroid/solvers/optimisation/methods/trust_region.hpp>
#include <lagroid/solvers/optimisation/sensitivity/minimum_derivatives.hpp>
#include <lagroid/solvers/optimisation/testing/manifold_laws.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::laws {

namespace detail {

inline optimisation::ParameterEntry draw_entry(const std::vector<optimisation::ParameterEntry>& all) {
  if (all.empty()) throw NotSampled("there are no parameters");
  return all[std::size_t(*rc::gen::inRange<int>(0, int(all.size())))];
}

inline std::vector<optimisation::ParameterEntry> all_entries(const optimisation::ParametricObjective& objective) {
  std::vector<optimisation::ParameterEntry> out;
  const auto tables = objective.parameters();
  for (const optimisation::ParameterTable& table : tables) {
    const auto more = entries_named(tables, table.name);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

/// The minimum that a method beside a given one finds, to round-off.
inline std::optional<optimisation::MinimumDerivatives> minimum_beside(
    const optimisation::Manifold& manifold, const optimisation::ParametricObjective& objective,
    const optimisation::Point& start, const std::vector<optimisation::ParameterEntry>& by = {}) {
  optimisation::TrustRegion method;
  const auto found = minimise(manifold, objective, start, method, {.relative_gradient = 1e-9, .iterations = 1000});
  auto out = minimum_derivatives(manifold, objective, found.x, by);
  return out.strict() ? std::optional(out) : std::nullopt;
}

}  // namespace detail

/// "derivatives by parameters are those of the value" and "derivatives by parameters are those of the gradient": by
/// parameters and at points that are drawn.
inline LawReport parametric_objective_laws(const optimisation::Manifold& manifold,
                                           const optimisation::ParametricObjective& objective,
                                           const PointDraw& draw = {}) {
  using namespace detail;
  using optimisation::Vector;
  LawReport report{objective.name(), {}};
  const auto entries = all_entries(objective);
  const auto law = [&](const std::string& name, const auto& defect_of) {
    report.laws.push_back(check_law(name, 1e-7, [&] {
      const auto which = draw_entry(entries);
      const optimisation::Point x = draw_point(manifold, draw);
      const double size = std::max(1e-2, std::abs(objective.parameter(which)));
      const auto there = objective.changed(which, 1e-5 * size);
      const auto back = objective.changed(which, -1e-5 * size);
      Vector by(x.size());
      const double value_by = objective.by_parameter(which, x, by);
      Vector above(x.size()), below(x.size());
      const double values = there->evaluate(x, above) - back->evaluate(x, below);
      return defect_of(value_by, values / (2e-5 * size), by, Vector((above - below) / (2e-5 * size)),
                       above.norm() / size + std::abs(there->value(x)) / size);
    }));
  };
  law("derivatives by parameters are those of the value",
      [](double exact, double difference, const Vector&, const Vector&, double scale) {
        return std::abs(exact - difference) / (std::abs(exact) + scale);
      });
  law("derivatives by parameters are those of the gradient",
      [](double, double, const Vector& exact, const Vector& difference, double scale) {
        return (exact - difference).norm() / (exact.norm() + scale);
      });
  return report;
}

/// "the least value changes by its derivative" and "the minimiser changes by its derivative": of the minimum that is
/// found from `start`, by parameters of that name, beside extrapolated differences of minima that are found from there.
inline LawReport minimum_laws(const optimisation::Manifold& manifold,
                              const optimisation::ParametricObjective& objective, const optimisation::Point& start,
                              const std::string& name) {
  using namespace detail;
  LawReport report{objective.name(), {}};
  const auto entries = entries_named(objective.parameters(), name);
  const auto found = minimum_beside(manifold, objective, start, entries);
  if (!found) throw std::runtime_error("the trust region method finds no strict minimum from there");
  const auto law = [&](const std::string& title, Eigen::Index first, Eigen::Index count) {
    Eigen::MatrixXd exact(1 + manifold.size(), Eigen::Index(entries.size()));
    exact << found->value_by, found->minimiser_by;
    report.laws.push_back(check_law(title, 1e-7, [&, exact] {
      const auto k = Eigen::Index(*rc::gen::inRange<int>(0, int(entries.size())));
      const auto which = entries[std::size_t(k)];
      const auto at = [&](double by) -> std::optional<Eigen::VectorXd> {
        const auto beside = minimum_beside(manifold, *objective.changed(which, by), found->x);
        if (!beside) return std::nullopt;
        Eigen::VectorXd out(1 + manifold.size());
        out << beside->value, beside->x;
        return out;
      };
      const auto rows = exact.middleRows(first, count);
      const double size = std::max(1e-2, std::abs(objective.parameter(which)));
      const auto difference = extrapolated_difference(at, 2e-3 * size);
      if (!difference) throw NotSampled("no strict minimum is found beside this one");
      const double off = (difference->value.segment(first, count) - rows.col(k)).norm();
      const double least = 1e-2 * (first == 0 ? std::abs(found->value) : found->x.norm()) / size;
      return off / (rows.colwise().norm().maxCoeff() + least);
    }));
  };
  law("the least value changes by its derivative", 0, 1);
  law("the minimiser changes by its derivative", 1, manifold.size());
  return report;
}

/// "logarithms change with their ends as is said" and "logarithms change with their starts as is said": of a manifold
/// that knows both in closed form.
inline LawReport logarithm_laws(const optimisation::Manifold& manifold, const PointDraw& draw = {}) {
  using namespace detail;
  using optimisation::Point, optimisation::Vector;
  LawReport report{manifold.name(), {}};
  constexpr double e = 1e-4;
  const auto logarithm = [&](const Point& x, const Point& y) {
    Vector v;
    if (!manifold.logarithm(x, y, v)) throw NotSampled("the logarithm is not known in closed form");
    return v;
  };
  const auto law = [&](const std::string& name, const auto& defect) {
    report.laws.push_back(check_law(name, 1e-6, [&] {
      const Point x = draw_point(manifold, draw);
      const double length = *rc::gen::element(0.0, 1e-6, 0.3, 1.0);
      const Point y = geodesic_end(manifold, x, draw_tangent(manifold, x, length));
      return defect(x, y);
    }));
  };
  law("logarithms change with their ends as is said", [&](const Point& x, const Point& y) {
    const Vector w = draw_tangent(manifold, y, 1);
    Vector exact = w;
    if (!manifold.logarithm_by_end(x, y, exact)) throw NotSampled("its derivative is not known in closed form");
    const Vector above = logarithm(x, geodesic_end(manifold, y, e * w));
    const Vector below = logarithm(x, geodesic_end(manifold, y, -e * w));
    return manifold.norm(x, (above - below) / (2 * e) - exact);
  });
  law("logarithms change with their starts as is said", [&](const Point& x, const Point& y) {
    const Vector w = draw_tangent(manifold, x, 1);
    Vector exact = w;
    if (!manifold.logarithm_by_start(x, y, exact)) throw NotSampled("its derivative is not known in closed form");
    const auto seen_from = [&](double t) {
      const Point there = geodesic_end(manifold, x, t * w);
      return transported(manifold, there, x, logarithm(there, y));
    };
    return manifold.norm(x, (seen_from(e) - seen_from(-e)) / (2 * e) - exact);
  });
  return report;
}

}  // namespace lagroid::laws
