#pragma once
/// Laws of integrators on Poisson manifolds, for your own: the step is a Poisson map, or as nearly as it says, it has
/// its order, keeps Casimirs, and goes back the way it came.
///
///     laws::PoissonSubject subject{"two populations", {.step = 0.1}, {2, 0.5}, begin};
///     EXPECT_TRUE(laws::poisson_step_laws(subject).holds());
///
/// Requires RapidCheck and a start beside which the system is smooth. Returns a LawReport; a law that does not hold is
/// no exception. Steps that do not converge are passed over.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::laws {

/// A motion that can be begun anywhere by any of its methods.
struct PoissonSubject {
  using Point = std::vector<double>;

  std::string name;
  PoissonOptions options;  ///< the method in question, and its step
  Point start;
  std::function<std::unique_ptr<PoissonIntegrator>(const Point& start, const PoissonOptions& options)> begin;
  /// Values at a point, and of each the size to which its rounding is relative.
  using Values = std::function<std::vector<std::pair<double, double>>(const Point& x)>;
  Values casimirs = nullptr;  ///< null: none are known
  double spread = 0.05;       ///< points are drawn from the start times 1 + so much
  Values energy = nullptr;
};

namespace detail {

inline std::vector<double> integrated(PoissonIntegrator& integrator, long steps) {
  for (long k = 0; k < steps; ++k)
    if (const auto report = integrator.advance(); !report.converged())
      throw NotSampled("a step from here ends " + std::string(to_string(report.status)));
  return integrator.point();
}
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0;
  double size = 1;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = worst({largest, std::abs(a[i] - b[i])});
    size = std::max(size, std::abs(b[i]));
  }
  return largest / size;
}

}  // namespace detail

/// "the step is a Poisson map", or "the Poisson defect falls as declared"; "the step has the order declared"; of
/// methods that keep them "steps keep Casimirs", "steps keep the energy"; of symmetric ones "steps return to where they
/// began". Of motions that noise drives, and of steps by a tolerance, no order is asked.
inline LawReport poisson_step_laws(const PoissonSubject& subject) {
  using Point = PoissonSubject::Point;
  LawReport report{subject.name + " by " + subject.options.method, {}};
  const auto begun = [&](const Point& x, double step) {
    PoissonOptions options = subject.options;
    options.step = step;
    return subject.begin(x, options);
  };
  const double h = subject.options.step;
  const auto first = begun(subject.start, h);
  const KeptStructure kept = first->kept();
  const MethodTraits traits = first->traits();
  const auto drawn = [&] {
    Point x = subject.start;
    for (double& each : x) each *= 1 + subject.spread * draw_uniform();
    return x;
  };
  const auto law = [&](const char* name, double tolerance, const std::function<double()>& defect) {
    report.laws.push_back(check_law(name, tolerance, defect));
  };
  const auto once = [&](const char* name, double tolerance, const std::function<double()>& defect) {
    Law asked;
    asked.name = name;
    asked.tolerance = tolerance;
    asked.samples = 1;
    try {
      asked.worst = worst({defect()});
    } catch (const std::exception& error) {
      asked.first_failure = error.what();
    }
    report.laws.push_back(asked);
  };

  if (kept.bracket == 0) {
    law("the step is a Poisson map", 1e-11, [&] { return begun(drawn(), h)->poisson_defect(); });
  } else if (std::isfinite(first->poisson_defect())) {
    once("the Poisson defect falls as declared", 0.3, [&] {
      double coarse = h;
      for (int halving = 0; halving < 8; ++halving, coarse *= 0.5)
        if (begun(subject.start, coarse)->poisson_defect() < 1e-7) break;
      const double large = begun(subject.start, coarse)->poisson_defect();
      const double small = begun(subject.start, 0.5 * coarse)->poisson_defect();
      return small < 1e-14 ? 0.0 : std::max(0.0, kept.bracket - std::log2(large / small));
    });
  }
  // Of noise the orders are those of means over paths, and of no single one.
  const auto order_law = [&](const auto& defect) {
    if (!subject.options.noise.present() && kept.bracket != KeptStructure::to_the_tolerance)
      once("the step has the order declared", 0.15, defect);
  };
  order_law([&] {
    // Over a time in which a few steps leave an error to speak of.
    constexpr int few = 8;
    PoissonOptions fine = subject.options;
    fine.method = "hamilton-jacobi-6";
    fine.composition = compositions::single;
    for (double horizon = h; horizon < 1e4 * h; horizon *= 1.5) {
      fine.step = horizon / 400;
      const Point end = detail::integrated(*subject.begin(subject.start, fine), 400);
      const auto error = [&](int steps) {
        return detail::largest_difference(detail::integrated(*begun(subject.start, horizon / steps), steps), end);
      };
      if (error(few) > 1e-4) return std::max(0.0, traits.order - measured_order(error, 2 * few));
    }
    return 0.0;  // the method is exact here
  });
  const auto keeps = [&](const char* name, const PoissonSubject::Values& values) {
    law(name, 1e-12, [&] {
      const Point x = drawn();
      const auto before = values(x);
      const auto after = values(detail::integrated(*begun(x, h), 20));
      double largest = 0;
      for (std::size_t i = 0; i < before.size(); ++i)
        largest = worst({largest, std::abs(after[i].first - before[i].first) /
                                      std::max({before[i].second, after[i].second, 1e-300})});
      return largest;
    });
  };
  if (kept.casimirs == 0 && subject.casimirs) keeps("steps keep Casimirs", subject.casimirs);
  if (kept.energy && subject.energy) keeps("steps keep the energy", subject.energy);
  if (traits.symmetric) {
    law("steps return to where they began", 1e-10, [&] {
      const Point x = drawn();
      const Point there = detail::integrated(*begun(x, h), 5);
      return detail::largest_difference(detail::integrated(*begun(there, -h), 5), x);
    });
  }
  return report;
}

}  // namespace lagroid::laws
