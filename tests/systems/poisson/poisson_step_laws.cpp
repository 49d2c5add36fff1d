// Laws of steps on Poisson manifolds hold for every method, and not for methods that promise more than they keep.
#include "../../support/broken.hpp"

#include <lagroid/core/testing/sampling.hpp>
#include <lagroid/solvers/testing/poisson_step_laws.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/rotations.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace lagroid::poisson_poisson_step_laws_tests {
namespace {

template <class Sys> laws::PoissonSubject subject_of(const char* name, std::vector<double> start, const char* method) {
  using X = Vector<double, Sys::dimension>;
  const auto at = [](const std::vector<double>& x) { return X(Eigen::Map<const X>(x.data())); };
  laws::PoissonSubject subject{
      name, {.method = method, .step = 0.1}, std::move(start), [=](const auto& x, const auto& by) {
        return make_poisson_integrator(Sys{}, at(x), by);
      }};
  subject.energy = [=](const auto& x) {
    return std::vector<std::pair<double, double>>{{Sys{}.hamiltonian(at(x)), 5.0}};
  };
  if constexpr (casimir_count<Sys>() > 0) {
    subject.casimirs = [=](const auto& x) {
      return std::vector<std::pair<double, double>>{{Sys{}.casimirs(at(x))(0), 1.0}};
    };
  }
  return subject;
}

TEST(PoissonStepLaws, HoldForEveryMethod) {
  const laws::Sampling few(10, 6);
  for (const std::string_view method : poisson_methods_of<ThreeSpecies>()) {
    const auto found =
        laws::poisson_step_laws(subject_of<ThreeSpecies>("three species", {1, 1.9, 0.5}, std::string(method).c_str()));
    EXPECT_TRUE(found.holds()) << found;
  }
  for (const std::string_view method : poisson_methods_of<EulerTop>()) {
    const auto found =
        laws::poisson_step_laws(subject_of<EulerTop>("Euler top", {0.8, 0.6, 1.1}, std::string(method).c_str()));
    EXPECT_TRUE(found.holds()) << found;
  }
}

TEST(PoissonStepLaws, HoldForNoiseWithAndWithoutFriction) {
  const laws::Sampling few(10, 6);
  for (const double temperature : {0.0, 0.5})
    for (const char* method : {"symplectic-groupoid", "karasev"}) {
      auto subject = subject_of<EulerTop>("Euler top", {0.8, 0.6, 1.1}, method);
      subject.options.noise = {.strength = {0.3, 0.3, 0.3}, .temperature = temperature};
      const auto found = laws::poisson_step_laws(subject);
      EXPECT_TRUE(found.holds()) << found;
      EXPECT_EQ(found.laws.size(), 2U) << found;
    }
}

/// A method that promises more than it keeps.
class Boaster final : public PoissonIntegrator {
 public:
  Boaster(std::unique_ptr<PoissonIntegrator> made, KeptStructure kept, int order)
      : made_(std::move(made)), kept_(kept), order_(order) {}
  StepReport advance() override { return made_->advance(); }
  std::vector<double> point() const override { return made_->point(); }
  void go_on_from(const std::vector<double>& point) override { made_->go_on_from(point); }
  double time() const override { return made_->time(); }
  MethodTraits traits() const override {
    MethodTraits traits = made_->traits();
    traits.order = order_;
    traits.symmetric = true;
    return traits;
  }
  KeptStructure kept() const override { return kept_; }
  Eigen::MatrixXd slope(const std::vector<std::string>& parameters) const override { return made_->slope(parameters); }
  double poisson_defect() const override { return made_->poisson_defect(); }
  void serialize(NumberArchive& archive) override { made_->serialize(archive); }

 private:
  std::unique_ptr<PoissonIntegrator> made_;
  KeptStructure kept_;
  int order_;
};

laws::LawReport report_of_boaster(const char* method, KeptStructure kept, int order) {
  laws::PoissonSubject subject = subject_of<ThreeSpecies>("three species", {1, 1.9, 0.5}, method);
  subject.begin = [=, begin = subject.begin](const auto& x, const PoissonOptions& by) {
    auto made = begin(x, by);
    if (by.method != method) return made;  // what ends are compared with
    return std::unique_ptr<PoissonIntegrator>(std::make_unique<Boaster>(std::move(made), kept, order));
  };
  return laws::poisson_step_laws(subject);
}

TEST(BrokenPoissonStep, MidpointThatClaimsToBeAPoissonMapOfOrderFour) {
  const laws::Sampling few(10, 7);
  const auto found = report_of_boaster("midpoint", {}, 4);
  EXPECT_TRUE(laws::seen_broken(found.law("the step is a Poisson map"))) << found;
  EXPECT_TRUE(laws::seen_broken(found.law("steps keep Casimirs"))) << found;
  EXPECT_TRUE(laws::seen_broken(found.law("the step has the order declared"))) << found;
}

TEST(BrokenPoissonStep, RungeKuttaThatClaimsToBeSymmetricAndNearerToAPoissonMap) {
  const laws::Sampling few(10, 8);
  const auto found = report_of_boaster("runge-kutta", {7, 7}, 4);
  EXPECT_TRUE(laws::seen_broken(found.law("the Poisson defect falls as declared"))) << found;
  EXPECT_TRUE(laws::seen_broken(found.law("steps return to where they began"))) << found;
}

TEST(BrokenPoissonStep, AMethodThatClaimsToKeepTheEnergy) {
  const laws::Sampling few(10, 9);
  const auto found = report_of_boaster("symplectic-groupoid", {.energy = true}, 2);
  EXPECT_TRUE(laws::seen_broken(found.law("steps keep the energy"))) << found;
  EXPECT_TRUE(found.law("steps keep Casimirs").holds()) << found;
}

}  // namespace
}  // namespace lagroid::poisson_poisson_step_laws_tests
