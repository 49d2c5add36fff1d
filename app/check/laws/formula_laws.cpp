#include "../family_laws.hpp"

#include "../../formula/formula_scene.hpp"

#include <lagroid/solvers/galerkin/testing/sized_step_laws.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace lagroid::app {

namespace {

/// That what is declared a symmetry is one, and that steps keep the momenta of affine ones.
laws::LawReport symmetry_laws(const laws::SizedStepSubject& subject, const FormulaSystem& system, bool by_velocity) {
  laws::LawReport report{subject.name + ", symmetries", {}};
  const auto step = subject.make();
  const laws::detail::PhaseUnits units = laws::detail::units_of(subject, *step);
  for (std::size_t i = 0; i < system.symmetries().size(); ++i) {
    const ReadSymmetry& symmetry = system.symmetries()[i];
    report.laws.push_back(laws::check_law(symmetry.name + " is that of a symmetry", 1e-10, [&] {
      const auto z = laws::detail::drawn(subject, *step, units);
      TangentState tangent;
      step->find_velocity(z, subject.time, tangent);
      return system.symmetry_defect(i, subject.time, z.position.data(),
                                    (by_velocity ? tangent.velocity : tangent.momentum).data());
    }));
    if (!symmetry.affine) continue;
    report.laws.push_back(laws::check_law("a step keeps " + symmetry.name, 1e-11, [&] {
      const auto momentum = [&](const auto& z) {
        const std::size_t n = std::size_t(z.position.size());
        std::vector<double> fields(system.symmetries().size() * n);
        system.fields(z.position.data(), fields.data());
        return z.momentum.dot(Eigen::Map<const Eigen::VectorXd>(fields.data() + i * n, z.position.size()));
      };
      const auto z = laws::detail::drawn(subject, *step, units);
      const auto next = laws::detail::stepped(subject, *step, z, subject.step, subject.time);
      const double whole = std::abs(momentum(z)) + units.momentum * units.place;
      return std::abs(momentum(next) - momentum(z)) / whole;
    }));
  }
  return report;
}

class FormulaLaws final : public FamilyLaws {
 public:
  const SceneFamily& family() const override { return formula_family(); }
  Certificate certify(const Section& scene, const CheckCommandOptions& options) const override {
    const FormulaToCheck asked = read_formula(scene, {}).to_check;
    const FormulaSystem& system = *asked.system;
    laws::SizedStepSubject subject{.name = asked.name,
                                   .make = [&] { return asked.begun(system).step; },
                                   .traits = asked.begun(system).traits,
                                   .start = asked.start,
                                   .step = asked.step,
                                   .time = asked.begin};
    if (system.constraint_count() > 0)
      subject.constraint = [&](const Eigen::VectorXd& q) { return system.constraint_rows(q); };
    subject.exact = [&](double later) {
      constexpr int steps = 400;
      const FormulaMethod precise = asked.precise();
      SizedState z = asked.start;
      const double h = later / steps;
      for (int k = 0; k < steps; ++k) z = laws::detail::stepped(subject, *precise.step, z, h, asked.begin + k * h);
      Eigen::VectorXd both(2 * z.position.size());
      both << z.position, z.momentum;
      return both;
    };
    Certificate certificate;
    certificate.system = asked.name;
    certificate.groupoid = "pair groupoid of R^n";
    certificate.states = 1;
    certificate.samples = options.samples;
    certificate.seed = options.seed;
    const auto* lagrangian = dynamic_cast<const FormulaLagrangian*>(asked.system.get());
    if (lagrangian) certificate.suites.push_back(laws::sized_lagrangian_laws(*lagrangian, subject));
    certificate.suites.push_back(laws::sized_step_laws(subject));
    if (!system.symmetries().empty())
      certificate.suites.push_back(symmetry_laws(subject, system, lagrangian != nullptr));
    return certificate;
  }
};

}  // namespace

const FamilyLaws& formula_laws() {
  static const FormulaLaws laws;
  return laws;
}

}  // namespace lagroid::app
