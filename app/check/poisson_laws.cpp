#include "family_laws.hpp"

#include "../poisson/poisson_run.hpp"

#include <lagroid/solvers/testing/poisson_step_laws.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

class PoissonFamilyLaws final : public FamilyLaws {
 public:
  const SceneFamily& family() const override { return poisson_family(); }
  Certificate certify(const Section& scene, const CheckCommandOptions& options) const override {
    const PoissonEntry& entry = *poisson_entry_of(scene);
    const PoissonToCheck asked = read_poisson(entry, scene, {}).to_check;
    const AnyPoissonSystem& system = *asked.system;
    laws::PoissonSubject subject{std::string(entry.name), asked.options, asked.start,
                                 [&](const auto& start, const auto& by) { return system.begin(start, by); }};
    if (!entry.casimirs.empty()) {
      subject.casimirs = [&](const auto& x) {
        std::vector<std::pair<double, double>> values;
        const auto measured = system.measure(x);
        for (std::size_t i = 1; i < measured.size(); ++i) values.emplace_back(measured[i].value, measured[i].size);
        return values;
      };
    }
    Certificate certificate;
    certificate.system = entry.name;
    certificate.groupoid = "symplectic groupoid of " + std::string(entry.bracket);
    certificate.states = 1;
    certificate.samples = options.samples;
    certificate.seed = options.seed;
    certificate.suites.push_back(bracket_laws(entry, system, asked.start));
    certificate.suites.push_back(laws::poisson_step_laws(subject));
    return certificate;
  }

 private:
  /// Antisymmetry, Jacobi identity and Casimirs beside the start.
  static laws::LawReport bracket_laws(const PoissonEntry& entry, const AnyPoissonSystem& system,
                                      const std::vector<double>& start) {
    laws::LawReport report{std::string(entry.name) + ", bracket", {}};
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
};

}  // namespace

const FamilyLaws& poisson_laws() {
  static const PoissonFamilyLaws laws;
  return laws;
}

}  // namespace lagroid::app
