// Integrators of chains by every method: their laws, what breaks them, and the bits of one that is taken up.

#include <lagroid/systems/pendulums/pendulum_chain.hpp>
#include <lagroid/systems/spheres/sphere_integrator.hpp>
#include <lagroid/systems/testing/sphere_laws.hpp>

#include "../support/broken.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

using namespace lagroid;

namespace systems_sphere_integrators_tests {
namespace {

using Chain = PendulumChain<Eigen::Dynamic>;
using Points = SphereIntegrator::Points;

Chain chain(double gravity = 9.81) { return {Eigen::Vector3d(1, 0.5, 2), Eigen::Vector3d(1, 0.7, 0.4), gravity}; }

/// Any state, in that form.
Points start(SphereForm form) {
  const Chain of = chain();
  Points z(6, 3);
  z.col(0) << 0.9, 0.1, -0.3, 0.1, 0.5, 0.3;
  z.col(1) << 0.6, 0.8, 0.2, 0.4, -0.3, 0.6;
  z.col(2) << -0.2, -0.5, -0.9, 0.1, 1, -0.5;
  for (int i = 0; i < 5; ++i) of.space().project(z);
  return form == SphereForm::momenta ? of.to_momenta(z) : z;
}

Points in_form(const Points& z, SphereForm from, SphereForm to) {
  if (from == to) return z;
  return to == SphereForm::momenta ? chain().to_momenta(z) : chain().to_velocities(z);
}

laws::SphereSubject subject(const std::string& method, SphereForm form) {
  laws::SphereSubject out{
      "three pendula",
      {.method = method, .form = form, .step = 0.01},
      start(form),
      [](const Points& z, const SphereIntegratorOptions& by) { return make_chain_integrator(chain(), z, by); },
      in_form,
      {SphereForm::velocities, SphereForm::momenta}};
  out.conserved = [form](const Points& z) {
    const Points at = in_form(z, form, SphereForm::velocities);
    return std::pair(chain().vertical_momentum(at), chain().momentum_size(at));
  };
  return out;
}

TEST(SphereIntegrators, KeepTheirLaws) {
  for (const SphereForm form : {SphereForm::velocities, SphereForm::momenta}) {
    const auto report = laws::sphere_laws(subject("rattle", form));
    EXPECT_TRUE(report.holds()) << report;
    EXPECT_EQ(report.laws.size(), 6U);
    for (const LieGroupMethod& method : lie_group_methods::all) {
      auto by = subject(std::string(method.name), form);
      by.keeps_spheres = method.scheme != LieGroupScheme::classical;
      const auto laws = laws::sphere_laws(by);
      EXPECT_TRUE(laws.holds()) << laws;
    }
    auto extrapolated = subject("extrapolation", form);
    extrapolated.options.tolerance = 1e-10;
    const auto laws = laws::sphere_laws(extrapolated);
    EXPECT_TRUE(laws.holds()) << laws;
    EXPECT_TRUE(laws.law("errors fall with the tolerance").holds());
  }
}

/// An integrator that says of itself what another does.
class Boaster final : public SphereIntegrator {
 public:
  Boaster(std::unique_ptr<SphereIntegrator> integrator, MethodTraits traits)
      : integrator_(std::move(integrator)), traits_(std::move(traits)) {}
  StepReport advance() override { return integrator_->advance(); }
  Points point() const override { return integrator_->point(); }
  double time() const override { return integrator_->time(); }
  MethodTraits traits() const override { return traits_; }
  void serialize(NumberArchive& archive) override { integrator_->serialize(archive); }

 private:
  std::unique_ptr<SphereIntegrator> integrator_;
  MethodTraits traits_;
};

TEST(SphereIntegrators, WhatLieEulerIsNot) {
  auto boasts = subject("lie-euler", SphereForm::velocities);
  boasts.begin = [](const Points& z, const SphereIntegratorOptions& by) {
    return std::make_unique<Boaster>(make_chain_integrator(chain(), z, by),
                                     MethodTraits{"rattle", 2, true, true, false});
  };
  const auto report = laws::sphere_laws(boasts);
  for (const char* law :
       {"at least the order declared", "steps go back the way they came", "symplectic", "what symmetries give is kept"})
    EXPECT_TRUE(laws::seen_broken(report.law(law))) << law;
  EXPECT_TRUE(report.law("points stay on the spheres").holds());
}

/// One that does not listen to its tolerance.
TEST(SphereIntegrators, WhatATolerancePromises) {
  auto deaf = subject("extrapolation", SphereForm::velocities);
  deaf.options.tolerance = 1e-10;
  deaf.begin = [](const Points& z, SphereIntegratorOptions by) {
    if (by.method == "extrapolation") by.tolerance = 1e-5;
    return make_chain_integrator(chain(), z, by);
  };
  EXPECT_TRUE(laws::seen_broken(laws::sphere_laws(deaf).law("errors fall with the tolerance")));
}

TEST(SphereIntegrators, WhatClassicalMethodsLeave) {
  const auto report = laws::sphere_laws(subject("runge-kutta-4", SphereForm::velocities));
  EXPECT_TRUE(laws::seen_broken(report.law("points stay on the spheres")));
}

/// One of the forms in another gravity.
TEST(SphereIntegrators, FormsThatDisagree) {
  auto apart = subject("munthe-kaas-4", SphereForm::velocities);
  apart.begin = [](const Points& z, const SphereIntegratorOptions& by) {
    return make_chain_integrator(chain(by.form == SphereForm::momenta ? 9.80 : 9.81), z, by);
  };
  EXPECT_TRUE(laws::seen_broken(laws::sphere_laws(apart).law("all forms are one motion")));
}

TEST(SphereIntegrators, AreTakenUpWithTheSameBits) {
  for (const SphereForm form : {SphereForm::velocities, SphereForm::momenta}) {
    for (const char* method :
         {"rattle", "lie-euler", "commutator-free-4", "munthe-kaas-54", "runge-kutta-4", "extrapolation"}) {
      const bool controlled = std::string(method) == "extrapolation";
      for (const double tolerance : {0.0, 1e-8}) {
        if (tolerance > 0 ? !controlled && std::string(method) != "munthe-kaas-54" : controlled) continue;
        const SphereIntegratorOptions by{.method = method, .form = form, .step = 0.01, .tolerance = tolerance};
        const auto whole = make_chain_integrator(chain(), start(form), by);
        laws::detail::integrated(*whole, 37);
        NumberArchive kept;
        whole->serialize(kept);
        const auto taken_up = make_chain_integrator(chain(), start(form), by);
        NumberArchive read(kept.numbers());
        taken_up->serialize(read);
        EXPECT_TRUE(read.at_end());
        EXPECT_EQ(taken_up->time(), whole->time());
        EXPECT_TRUE(taken_up->point() == whole->point()) << method;
        EXPECT_TRUE(laws::detail::integrated(*taken_up, 50) == laws::detail::integrated(*whole, 50)) << method;
      }
    }
  }
}

TEST(SphereIntegrators, RefuseWhatThereIsNot) {
  const Points z = start(SphereForm::velocities);
  EXPECT_THROW(make_chain_integrator(chain(), z, {.method = "leapfrog"}), std::invalid_argument);
  EXPECT_THROW(make_chain_integrator(chain(), z, {.method = "rattle", .tolerance = 1e-6}), std::invalid_argument);
  EXPECT_THROW(make_chain_integrator(chain(), z, {.method = "lie-euler", .tolerance = 1e-6}), std::invalid_argument);
  EXPECT_THROW(make_chain_integrator(chain(), z, {.method = "munthe-kaas-54", .tolerance = -1}), std::invalid_argument);
  EXPECT_THROW(make_chain_integrator(chain(), z, {.method = "lie-euler", .composition = compositions::suzuki}),
               std::invalid_argument);
  EXPECT_THROW(make_chain_integrator(chain(), z, {.method = "extrapolation"}), std::invalid_argument);
  EXPECT_THROW(make_chain_integrator(chain(), z, {.method = "extrapolation", .step = -1, .tolerance = 1e-6}),
               std::invalid_argument);
  EXPECT_THROW(make_chain_integrator(chain(), z, {.method = "rattle", .step = 0}), std::invalid_argument);
  EXPECT_THROW(make_chain_integrator(chain(), z.leftCols(2), {.method = "rattle"}), std::invalid_argument);
}

/// A node is given up where one asks for it, and gone to from the node before.
TEST(SphereIntegrators, StopInTheMiddleOfANode) {
  const Points z = start(SphereForm::velocities);
  SphereIntegratorOptions by{.method = "munthe-kaas-54", .step = 0.5, .tolerance = 1e-10};
  const auto whole = make_chain_integrator(chain(), z, by);
  int left = 7;
  by.stop = [&left] { return left-- == 0; };
  const auto stopped = make_chain_integrator(chain(), z, by);
  EXPECT_FALSE(stopped->advance().converged());
  EXPECT_EQ(stopped->time(), 0);
  EXPECT_TRUE(stopped->point() == z);
  EXPECT_TRUE(laws::detail::integrated(*stopped, 3) == laws::detail::integrated(*whole, 3));
}

/// Nodes are reached or not: an integrator that cannot go on stays where it was.
TEST(SphereIntegrators, StayWhereAStepFails) {
  const Points z = start(SphereForm::velocities);
  const auto check = [&](SphereIntegratorOptions by, double gravity, SolveStatus status) {
    const auto integrator = make_chain_integrator(chain(gravity), z, by);
    EXPECT_EQ(integrator->advance().status, status);
    EXPECT_EQ(integrator->time(), 0);
    EXPECT_TRUE(integrator->point().bottomRows<3>().isApprox(z.bottomRows<3>(), 1e-15));
  };
  check({.method = "rattle", .step = 3}, 9.81, SolveStatus::left_domain);
  check({.method = "rattle", .step = 1e-310}, 9.81, SolveStatus::not_finite);
  check({.method = "lie-euler", .step = 1e300}, 1e300, SolveStatus::not_finite);
  check({.method = "munthe-kaas-54", .step = 1, .tolerance = 1e-10, .most_inner = 5}, 9.81, SolveStatus::not_converged);
}

}  // namespace
}  // namespace systems_sphere_integrators_tests
