#include "poisson_periods.hpp"

#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/processor_time.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>

#include <fmt/format.h>
#include <boost/numeric/odeint.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace lagroid::app {

namespace {

namespace odeint = boost::numeric::odeint;

using Numbers = std::array<double, 2>;
constexpr Numbers start_of_cycle{2, 0.5};
constexpr double period = 6.8170540474472894;  // from the start back to it, by Taylor series in long double
constexpr double wanted = 1e-6;

/// x' = x - x y, y' = x y - y.
void rate(const Numbers& x, Numbers& dx, double) {
  const double eaten = x[0] * x[1];
  dx = {x[0] - eaten, eaten - x[1]};
}

struct Run {
  std::string setting;
  std::function<Numbers()> end;  ///< runs; not numbers where it fails
};

Run ours(const std::string& method, const Composition& composition, double tolerance, double steps_a_period,
         long periods) {
  // By a tolerance in nodes a hundred periods apart.
  const double step = tolerance > 0 ? 100 * period : period / steps_a_period;
  const long count = std::lround(double(periods) * period / step);
  const PoissonOptions options{.method = method,
                               .step = double(periods) * period / double(count),
                               .composition = composition,
                               .tolerance = tolerance};
  return {
      tolerance > 0 ? fmt::format("tolerance {:.0e}", tolerance) : fmt::format("{} steps a period", steps_a_period),
      [=] {
        const auto motion = make_poisson_integrator(LotkaVolterra{}, {start_of_cycle[0], start_of_cycle[1]}, options);
        for (long k = 0; k < count; ++k)
          if (!motion->advance().converged()) return Numbers{NAN, NAN};
        const std::vector<double> x = motion->point();
        return Numbers{x[0], x[1]};
      }};
}

template <class Way> Run theirs(const std::function<Way(double tolerance)>& make, double tolerance, long periods) {
  return {fmt::format("tolerance {:.0e}", tolerance), [=] {
            Numbers x = start_of_cycle;
            odeint::integrate_adaptive(make(tolerance), rate, x, 0.0, double(periods) * period, 0.1);
            return x;
          }};
}

/// Of runs from coarse to fine the first with the error wanted.
PeriodsRow first_within(std::string library, std::string method, const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    double seconds = std::numeric_limits<double>::infinity();
    double error = 0;
    for (int repeat = 0; repeat < 3; ++repeat) {
      const double begun = processor_time();
      const Numbers end = run.end();
      seconds = std::min(seconds, processor_time() - begun);
      error = std::hypot(end[0] - start_of_cycle[0], end[1] - start_of_cycle[1]);
      if (!(error <= wanted)) break;
    }
    if (error <= wanted) return {std::move(library), std::move(method), run.setting, error, seconds};
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return {std::move(library), std::move(method), "", none, none};
}

}  // namespace

std::vector<PeriodsRow> run_periods(long periods) {
  constexpr const char* own = "Lagroid";
  constexpr const char* peer = "odeint";
  std::vector<PeriodsRow> rows;
  const auto by_tolerance = [](double coarsest, const auto& run) {
    std::vector<Run> runs;
    for (double tolerance = coarsest; tolerance > 3e-17; tolerance /= std::sqrt(10.0)) runs.push_back(run(tolerance));
    return runs;
  };
  rows.push_back(first_within(own, "extrapolation", by_tolerance(1e-7, [&](double tolerance) {
                                return ours("extrapolation", compositions::single, tolerance, 0, periods);
                              })));
  for (const Composition& composition : {compositions::suzuki_umeno_8, compositions::kahan_li_8}) {
    std::vector<Run> runs;
    for (double steps = 16; steps < 500; steps *= std::sqrt(2.0))
      runs.push_back(ours("splitting", composition, 0, std::round(steps), periods));
    rows.push_back(first_within(own, composed_name("splitting", composition), runs));
  }
  using Fehlberg = odeint::runge_kutta_fehlberg78<Numbers>;
  using Dormand = odeint::runge_kutta_dopri5<Numbers>;
  const auto controlled = [&]<class Way>(const char* name, Way) {
    rows.push_back(first_within(peer, name, by_tolerance(1e-10, [&](double tolerance) {
                                  return theirs<decltype(odeint::make_controlled(tolerance, tolerance, Way()))>(
                                      [](double t) { return odeint::make_controlled(t, t, Way()); }, tolerance,
                                      periods);
                                })));
  };
  rows.push_back(first_within(peer, "Bulirsch-Stoer", by_tolerance(1e-10, [&](double tolerance) {
                                return theirs<odeint::bulirsch_stoer<Numbers>>(
                                    [](double t) { return odeint::bulirsch_stoer<Numbers>(t, t, 1.0, 1.0); }, tolerance,
                                    periods);
                              })));
  controlled("Fehlberg 78", Fehlberg());
  controlled("Dormand-Prince 5", Dormand());
  std::vector<Run> equal;
  for (double steps = 60; steps < 1000; steps *= std::sqrt(std::sqrt(2.0))) {
    const long count = std::lround(steps) * periods;
    equal.push_back({fmt::format("{} steps a period", std::lround(steps)), [=] {
                       Numbers x = start_of_cycle;
                       Fehlberg way;
                       for (long k = 0; k < count; ++k)
                         way.do_step(rate, x, 0.0, double(periods) * period / double(count));
                       return x;
                     }});
  }
  rows.push_back(first_within(peer, "Fehlberg 78, equal steps", equal));
  return rows;
}

std::string periods_table(const std::vector<PeriodsRow>& rows, long periods) {
  const auto best = [&](const char* library) {
    double least = std::numeric_limits<double>::infinity();
    for (const PeriodsRow& row : rows)
      if (row.library == library && std::isfinite(row.seconds)) least = std::min(least, row.seconds);
    return least;
  };
  std::string out = fmt::format(
      "\n## Predator and prey over {} periods\n\nThe coarsest step or tolerance with an error of {:g} at most, from "
      "(2, "
      "1/2) back to it, and its processor seconds; a dash where there was none. The best of odeint's takes {:.2f} "
      "times "
      "as long as the best here.\n\n| | method | setting | error | s |\n|---|---|---|---|---|\n",
      periods, wanted, best("odeint") / best("Lagroid"));
  for (const PeriodsRow& row : rows)
    out += std::isfinite(row.seconds) ? fmt::format("| {} | {} | {} | {:.1e} | {:.3f} |\n", row.library, row.method,
                                                    row.setting, row.error, row.seconds)
                                      : fmt::format("| {} | {} | - | - | - |\n", row.library, row.method);
  return out;
}

std::string periods_csv(const std::vector<PeriodsRow>& rows) {
  std::string out = "library,method,setting,error,seconds\n";
  for (const PeriodsRow& row : rows)
    out += fmt::format("{},\"{}\",{},{},{}\n", row.library, row.method, row.setting, row.error, row.seconds);
  return out;
}

}  // namespace lagroid::app
