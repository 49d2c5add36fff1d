#include "poisson_laws.hpp"

#include "../../poisson/poisson_run.hpp"

#include <lagroid/solvers/testing/poisson_step_laws.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

/// Antisymmetry, Jacobi identity and Casimirs beside the start.
laws::LawReport bracket_laws(const PoissonEntry& entry, const AnyPoissonSystem& system,
                             const std::vector<double>& start) {
  laws::LawReport report{entry.name + ", bracket", {}};
  BracketDefect worst;
  laws::Law law = laws::check_law("a Poisson bracket with these Casimirs", 1e-12, [&] {
    std::vector<double> x = start;
    for (double& each : x) each *= 1 + 0.05 * laws::draw_uniform();
    const BracketDefect here = system.bracket_defect(x);
    worst.raise(here);
    return here.relative;
  });
  if (worst.relative > law.tolerance) law.first_failure = worst.sentence();
  report.laws.push_back(law);
  return report;
}

}  // namespace

Certificate PoissonFamilyLaws::certify(const Section& scene, const CheckCommandOptions& options) const {
  const PoissonEntry& entry = *family_.entry_of(scene);
  const PoissonToCheck asked = read_poisson(entry, scene, {}).to_check;
  const AnyPoissonSystem& system = *asked.system;
  laws::PoissonSubject subject{entry.name, asked.options, asked.start,
                               [&](const auto& start, const auto& by) { return system.begin(start, by); }};
  const auto measured = [&](const std::vector<double>& x, std::size_t first, std::size_t last) {
    std::vector<std::pair<double, double>> values;
    const auto all = system.measure(x);
    for (std::size_t i = first; i < last; ++i) values.emplace_back(all[i].value, all[i].size);
    return values;
  };
  subject.energy = [&](const auto& x) { return measured(x, 0, 1); };
  if (!entry.casimirs.empty())
    subject.casimirs = [&](const auto& x) { return measured(x, 1, 1 + entry.casimirs.size()); };
  Certificate certificate;
  certificate.system = entry.name;
  certificate.groupoid = "symplectic groupoid of " + entry.bracket;
  certificate.states = 1;
  certificate.samples = options.samples;
  certificate.seed = options.seed;
  certificate.suites.push_back(bracket_laws(entry, system, asked.start));
  certificate.suites.push_back(laws::poisson_step_laws(subject));
  return certificate;
}

}  // namespace lagroid::app
