// Integrators on Poisson manifolds against recorded motions: orders, what is kept, outcomes, no allocation.
#include "../../support/allocation_counter.hpp"
#include "poisson_recorded.hpp"

#include <lagroid/solvers/poisson/poisson_methods.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::poisson_poisson_integrators_tests {
namespace {

TEST(PoissonIntegrators, EndWhereItIsRecordedByExtrapolation) {
  for (const Recorded& c : recorded()) {
    EXPECT_NEAR(c.hamiltonian(c.start), c.energy, 1e-14 * (1 + std::abs(c.energy))) << c.id;
    EXPECT_LT(distance(c.casimirs_at(c.start), c.casimirs), 1e-14) << c.id;
    const long steps = std::lround(c.duration * 16);
    const PoissonOptions sixth{.method = "hamilton-jacobi-6"};
    const Numbers coarse = end_of(c, sixth, steps);
    Numbers fine = end_of(c, sixth, 2 * steps);
    EXPECT_LT(distance(c.casimirs_at(fine), c.casimirs), 1e-13) << c.id;
    for (std::size_t i = 0; i < fine.size(); ++i) fine[i] += (fine[i] - coarse[i]) / 63;
    EXPECT_LT(distance(fine, c.end), 1e-10) << c.id;
  }
}

TEST(PoissonIntegrators, HaveTheirOrders) {
  struct Asked {
    PoissonOptions options;
    double order;
    double steps_per_time;
  };
  const std::vector<Asked> asked{{{.method = "symplectic-groupoid"}, 2, 40},
                                 {{.method = "karasev"}, 2, 40},
                                 {{.method = "splitting"}, 2, 40},
                                 {{.method = "truncated-groupoid"}, 2, 40},
                                 {{.method = "hamilton-jacobi-4"}, 4, 16},
                                 {{.method = "splitting", .composition = compositions::suzuki}, 4, 16},
                                 {{.method = "symplectic-groupoid", .composition = compositions::suzuki}, 4, 16},
                                 {{.method = "hamilton-jacobi-6"}, 6, 8},
                                 {{.method = "symplectic-groupoid", .composition = compositions::kahan_li_6}, 6, 12}};
  for (const Recorded& c : recorded())
    for (const Asked& each : asked) {
      if (std::find(c.methods.begin(), c.methods.end(), each.options.method) == c.methods.end()) continue;
      const long steps = std::lround(c.duration * each.steps_per_time);
      const double coarse = distance(end_of(c, each.options, steps), c.end);
      const double fine = distance(end_of(c, each.options, 2 * steps), c.end);
      if (fine < 1e-12 * c.amplification) continue;  // no more than rounding
      // Steps by Karasev's chart are exact for linear energies, and truncations of it then of order 4.
      const bool linear = c.id == "B-volterra-5" && each.options.method == "truncated-groupoid";
      EXPECT_NEAR(std::log2(coarse / fine), linear ? 4 : each.order, 0.1)
          << c.id << ' ' << each.options.method << ' ' << each.options.composition.name << ' ' << coarse << ' ' << fine;
    }
}

TEST(PoissonIntegrators, KeepTheBracketAsTheySay) {
  for (const Recorded& c : recorded())
    for (const std::string_view name : c.methods) {
      const auto defect = [&](double h) { return c.begin({.method = std::string(name), .step = h})->poisson_defect(); };
      const KeptStructure kept = c.begin({.method = std::string(name)})->kept();
      if (kept.bracket == 0) {
        EXPECT_LT(defect(0.1), 1e-13) << c.id << ' ' << name;
      } else {
        // At least: some brackets have no defect in some powers, a constant or linear one less of them.
        if (defect(0.1) > 1e-13) {
          EXPECT_GT(std::log2(defect(0.1) / defect(0.05)), kept.bracket - 0.5) << c.id << ' ' << name;
        }
      }
    }
}

TEST(PoissonIntegrators, ComposedStepsKeepTheBracketToo) {
  const Recorded& c = recorded()[1];
  EXPECT_GT(c.begin({.method = "midpoint", .step = 0.1})->poisson_defect(), 1e-5);
  const auto motion = c.begin({.method = "symplectic-groupoid", .step = 0.1, .composition = compositions::kahan_li_8});
  EXPECT_LT(motion->poisson_defect(), 1e-13);
  EXPECT_EQ(motion->traits().order, 8);
}

TEST(PoissonIntegrators, KeepCasimirsAndEnergiesOverLongRuns) {
  for (const Recorded& c : recorded()) {
    if (c.id.find("open") != std::string::npos) continue;  // its springs go to zero, and with them the motion
    const Drift found = drift(c, {.method = "symplectic-groupoid", .step = 0.05}, 20'000);
    EXPECT_LT(found.casimirs, 1e-12) << c.id;
    EXPECT_LT(found.energy_last, 1.5 * found.energy_first) << c.id;
  }
  // The midpoint rule, with the same equations but for the chart, lets the three species go.
  const Recorded& species = recorded()[1];
  const Drift midpoint = drift(species, {.method = "midpoint", .step = 0.05}, 20'000);
  EXPECT_GT(midpoint.casimirs, 1e-5);
  EXPECT_LT(drift(species, {.method = "projected-midpoint", .step = 0.05}, 2'000).casimirs, 1e-12);
}

TEST(PoissonIntegrators, GoBackTheWayTheyCame) {
  for (const Recorded& c : recorded())
    for (const char* method : {"symplectic-groupoid", "hamilton-jacobi-6", "splitting"}) {
      const auto there = c.begin({.method = method, .step = 0.1});
      ASSERT_TRUE(there->advance().converged()) << c.id;
      Recorded back = c;
      NumberArchive archive;
      there->serialize(archive);
      const auto motion = back.begin({.method = method, .step = -0.1});
      NumberArchive read(archive.numbers());
      motion->serialize(read);
      ASSERT_TRUE(motion->advance().converged()) << c.id;
      EXPECT_LT(distance(motion->point(), c.start), 1e-13) << c.id << ' ' << method;
    }
}

TEST(PoissonIntegrators, OutcomesAreTyped) {
  const EulerTop top;
  const Vector<double, 3> m(0.8, 0.6, 1.1);
  const auto status = [&](const char* method, double h) {
    const auto motion = make_poisson_integrator(top, m, {.method = method, .step = h});
    const StepReport report = motion->advance();
    if (!report.converged()) {
      EXPECT_EQ(motion->point(), Numbers({0.8, 0.6, 1.1}));
    }
    return report.status;
  };
  // Karasev's chart folds at |p| = 2 pi, Cayley's does not.
  EXPECT_EQ(status("symplectic-groupoid", 8), SolveStatus::converged);
  EXPECT_NE(status("karasev", 12), SolveStatus::converged);
  // Populations over a step in which the frozen flow explodes.
  const auto far = make_poisson_integrator(LotkaVolterra{}, {2, 0.5}, {.method = "karasev", .step = 40});
  EXPECT_EQ(far->advance().status, SolveStatus::left_domain);
  EXPECT_THROW(make_poisson_integrator(top, m, {.method = "no-such"}), std::invalid_argument);
  EXPECT_THROW(make_poisson_integrator(top, m, {.step = 0}), std::invalid_argument);
  EXPECT_THROW(make_poisson_integrator(top, m, {.method = "hamilton-jacobi-4", .composition = compositions::suzuki}),
               std::invalid_argument);
}

TEST(PoissonIntegrators, StepsAllocateNothing) {
  for (const Recorded& c : recorded())
    for (const std::string_view name : c.methods) {
      const auto motion = c.begin({.method = std::string(name), .step = 0.02});
      motion->advance();
      const auto before = allocation_count();
      for (int k = 0; k < 3; ++k) motion->advance();
      EXPECT_EQ(allocation_count(), before) << c.id << ' ' << name;
    }
}

}  // namespace
}  // namespace lagroid::poisson_poisson_integrators_tests
