// Verdicts of the ledger: kept, BROKEN, bounded, growing, and none on numbers that are none.

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/ledger/ledger.hpp>
#include <lagroid/run/motion/integrate_nodes.hpp>
#include <lagroid/run/motion/system_motion.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/integrators/integrator_of.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace lagroid;

namespace run_ledger_tests {
namespace {

template <class F> LedgerEntry judge(Promise promise, long samples, const F& value) {
  QuantityWatch watch("q", promise, 1);
  for (long k = 0; k < samples; ++k) {
    const double x = value(k);
    watch.observe(&x, std::abs(x));
  }
  return watch.entry();
}

TEST(Ledger, RoundOffIsKept) {
  const auto e = judge(Promise::conserved, 2000, [](long k) { return 1 + 1e-15 * std::sin(double(k)); });
  EXPECT_EQ(e.verdict, "kept");
  EXPECT_LE(e.drift, e.bound);
}

TEST(Ledger, ADriftIsBroken) {
  const auto e = judge(Promise::conserved, 2000, [](long k) { return 1 + 1e-14 * double(k); });
  EXPECT_EQ(e.verdict, "BROKEN");
  EXPECT_TRUE(e.broken());
}

TEST(Ledger, OscillationIsBoundedAndGrowthIsNot) {
  EXPECT_EQ(judge(Promise::bounded, 2000, [](long k) { return 1 + 0.1 * std::sin(0.1 * double(k)); }).verdict,
            "bounded");
  EXPECT_EQ(judge(Promise::bounded, 2000, [](long k) { return 1 + 1e-4 * double(k); }).verdict, "growing");
  EXPECT_EQ(judge(Promise::bounded, 50, [](long k) { return 1 + 1e-4 * double(k); }).verdict, "unjudged");
}

/// Chaotic motions have excursions of energy now and then, and the largest is in the second half as often as not.
TEST(Ledger, ExcursionsThatComeBackAreNoGrowth) {
  const auto with = [](const auto& more) {
    return judge(Promise::bounded, 20000, [&](long k) { return 1 + 1e-3 * std::sin(0.1 * double(k)) + more(k); })
        .verdict;
  };
  EXPECT_EQ(with([](long k) { return k >= 15000 && k < 15200 ? 1e-2 : 0; }), "bounded");
  EXPECT_EQ(with([](long k) { return k >= 15000 ? 1e-2 : 0; }), "growing");
  EXPECT_EQ(with([](long k) { return k >= 19900 ? 1e-2 : 0; }), "growing") << "late, and not back";
  // Excursions above a deviation that grows.
  EXPECT_EQ(with([](long k) { return 3e-7 * double(k) + (k % 5000 == 4000 ? 1e-3 + 6e-7 * double(k) : 0); }),
            "growing");
}

TEST(Ledger, NumbersThatAreNoneAreBrokenAndSaySo) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const Promise promise : {Promise::conserved, Promise::bounded})
    for (const double none : {std::nan(""), infinite, -infinite})
      for (const long from : {0L, 50L, 1999L})
        for (const long to : {from + 1, 2000L}) {
          const auto e = judge(promise, 2000, [&](long k) { return k >= from && k < to ? none : 1.0; });
          EXPECT_EQ(e.verdict, "BROKEN") << none << " from " << from << " to " << to;
          EXPECT_NE(e.reason, "");
        }
}

TEST(Ledger, TermsThatAreNoNumbersAreUnjudged) {
  for (const Promise promise : {Promise::conserved, Promise::bounded}) {
    QuantityWatch watch("q", promise, 1);
    for (long k = 0; k < 2000; ++k) {
      const double x = 1;
      watch.observe(&x, k == 1000 ? std::numeric_limits<double>::infinity() : 1);
    }
    EXPECT_EQ(watch.entry().verdict, "unjudged");
    EXPECT_NE(watch.entry().reason, "");
  }
}

/// Energies of a mass that falls through a centre of attraction: up to the passage right, and after it another one.
double fallen(long k) { return k < 300 ? -1 + 1e-3 * std::sin(0.3 * double(k)) : 286 + std::sin(0.3 * double(k)); }

TEST(Ledger, AnEnergyOffByMoreThanHalfOfItsTermsIsNotBounded) {
  const auto e = judge(Promise::bounded, 5000, fallen);
  EXPECT_EQ(e.verdict, "BROKEN");
  EXPECT_NE(e.reason, "");
  EXPECT_GT(e.drift, e.bound);
  EXPECT_EQ(judge(Promise::bounded, 400, fallen).verdict, "BROKEN") << "soon enough";
  const auto within = judge(Promise::bounded, 5000, [](long k) { return 1 + 0.3 * std::sin(0.1 * double(k)); });
  EXPECT_EQ(within.verdict, "bounded");
  EXPECT_LT(within.drift, within.bound);
}

/// A passage near a singularity, whose terms are large, widens the bound by no more than its share of the nodes.
TEST(Ledger, LargeTermsAtFewNodesExcuseNothing) {
  QuantityWatch watch("q", Promise::bounded, 1);
  for (long k = 0; k < 5000; ++k) {
    const double x = fallen(k);
    watch.observe(&x, k == 300 ? 1e9 : std::abs(x));
  }
  EXPECT_EQ(watch.entry().verdict, "BROKEN");
}

TEST(Ledger, WhereTermsAreNotKnownWhatExceedsTheValueIsUnjudged) {
  QuantityWatch watch("q", Promise::bounded, 1, SizeOf::value);
  for (long k = 0; k < 2000; ++k) {
    const double x = 1e-3 * std::sin(0.1 * double(k));  // an energy that happens to be zero
    watch.observe(&x, std::abs(x));
  }
  EXPECT_EQ(watch.entry().verdict, "unjudged");
  EXPECT_NE(watch.entry().reason, "");
}

TEST(Ledger, NothingIsNotBounded) {
  EXPECT_EQ(judge(Promise::bounded, 2000, [](long) { return 0.0; }).verdict, "unjudged");
  EXPECT_EQ(judge(Promise::conserved, 2000, [](long) { return 0.0; }).verdict, "kept");
}

/// Verdicts do not depend on units: a power of two on values and sizes changes none, until numbers leave the range in
/// which they have all digits; there the verdict is one that gives a reason, never kept and never bounded.
TEST(Ledger, VerdictsDoNotDependOnUnits) {
  struct Course {
    Promise promise;
    std::function<double(long)> value;
    const char* verdict;
  };
  const std::vector<Course> courses{
      {Promise::conserved, [](long k) { return 1 + 1e-15 * std::sin(double(k)); }, "kept"},
      {Promise::conserved, [](long k) { return 1 + 1e-14 * double(k); }, "BROKEN"},
      {Promise::bounded, [](long k) { return 1 + 0.1 * std::sin(0.1 * double(k)); }, "bounded"},
      {Promise::bounded, [](long k) { return 1 + 1e-4 * double(k); }, "growing"},
      {Promise::bounded, fallen, "BROKEN"}};
  for (const Course& course : courses) {
    const auto in_units = [&](double unit) {
      QuantityWatch watch("q", course.promise, 2);
      for (long k = 0; k < 2000; ++k) {
        const double x[2]{unit * course.value(k), unit};
        watch.observe(x, unit * (1 + std::abs(course.value(k))));
      }
      return watch.entry();
    };
    const LedgerEntry plain = in_units(1);
    ASSERT_EQ(plain.verdict, course.verdict);
    for (int power = -1073; power <= 1023; power += power < -950 || power > 990 ? 1 : 20) {
      const LedgerEntry e = in_units(std::ldexp(1.0, power));
      EXPECT_TRUE(e.verdict == plain.verdict || !e.reason.empty()) << power << ": " << e.verdict;
      if (power < -980) {
        EXPECT_TRUE(e.verdict == "unjudged" || e.verdict == "BROKEN") << power << ": " << e.verdict;
      }
      if (power < -960 || power > 1000) continue;
      EXPECT_EQ(e.verdict, plain.verdict) << power;
      EXPECT_NEAR(e.relative_drift, plain.relative_drift, 1e-12 * plain.relative_drift) << power;
    }
  }
}

TEST(Ledger, WhatItsTermsHaveOutgrownIsUnjudged) {
  const auto grown = [](double start, double end) {
    QuantityWatch watch("q", Promise::conserved, 1);
    double x = 1e-12;
    watch.observe(&x, start);
    x = 1;
    watch.observe(&x, end);
    return watch.entry().verdict;
  };
  EXPECT_EQ(grown(1e-12, 1e20), "unjudged");
  EXPECT_EQ(grown(1e-12, 1), "BROKEN");
  EXPECT_EQ(grown(1e10, 1e20), "kept");
  EXPECT_EQ(grown(0, 1e20), "kept") << "released from rest";
}

TEST(Ledger, ConstraintResidualIsJudgedByTheSizeOfItsTerms) {
  EXPECT_EQ(constraint_entry(1e-15, 1).verdict, "kept");
  EXPECT_EQ(constraint_entry(1e-12, 1).verdict, "BROKEN");
  EXPECT_EQ(constraint_entry(1e-12, 1000).verdict, "kept");
  EXPECT_EQ(constraint_entry(1e-18, 1e-3).verdict, "kept");
  EXPECT_EQ(constraint_entry(1e-12, 1e-3).verdict, "BROKEN");
  EXPECT_EQ(constraint_entry(std::nan(""), 1).verdict, "BROKEN");
  EXPECT_EQ(constraint_entry(1, std::numeric_limits<double>::infinity()).verdict, "unjudged");
  EXPECT_EQ(constraint_entry(1e-310, 1e-300).verdict, "unjudged") << "no round-off is left to compare with";
}

/// A user's own system: a pendulum, or with `attraction` a mass on a line that falls to a centre.
struct Own : System<Own, Pair<1>> {
  double h = 0.1;
  double mass = 1;
  bool attraction = false;

  template <class S> S potential(const S& q) const {
    using std::cos;
    using std::sqrt;
    return attraction ? S(-mass) / sqrt(q * q) : S(-mass) * cos(q);
  }
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    const S dq = g.target(0) - g.source(0);
    return dq * dq * (0.5 * mass / h) - (potential(g.source(0)) + potential(g.target(0))) * (0.5 * h);
  }
  /// The energy twice: with the size of its terms, and without.
  std::vector<Quantity<Own>> quantities() const {
    using Point = TrajectoryPoint<Own>;
    const auto kinetic = [m = mass](const Point& p) { return 0.5 * p.state.momentum(0) * (p.state.momentum(0) / m); };
    const auto energy = [kinetic, own = *this](const Point& p, double* out) {
      *out = kinetic(p) + own.potential(p.state.object(0));
    };
    const auto size = [kinetic, own = *this](const Point& p) {
      return kinetic(p) + std::abs(own.potential(p.state.object(0)));
    };
    return {{"energy", {"H"}, Promise::bounded, false, energy, size},
            {"energy of unknown terms", {"K"}, Promise::bounded, false, energy}};
  }
};

struct OwnRun {
  SolveStatus status = SolveStatus::converged;
  double position = 0;
  std::vector<LedgerEntry> ledger;
};

OwnRun integrate(const Own& system, double position, long steps) {
  const State<Pair<1>> start{Vector<double, 1>(position), Vector<double, 1>::Zero()};
  SystemMotion<Own> motion(system, "own", {}, quantities_of(system),
                           std::make_unique<detail::IntegratorOf<Own, FixedStepIntegrator<Own>>>(
                               system, start, system.groupoid.unit(start.object), std::make_unique<NewtonStep<Own>>()),
                           {});
  Judge judge(motion.look());
  WatchedMotion watched(motion, &judge, nullptr, 1);
  watched.observe();
  OwnRun run;
  const IntegrationEnd end = integrate_nodes(watched, steps, [](const StepReport&) { return true; });
  if (end.why != IntegrationEnd::Why::whole) run.status = end.report.status;
  run.position = motion.state().at(0).values.at(1);
  Ledger ledger;
  judge.report(ledger);
  run.ledger = ledger.entries;
  return run;
}

/// In any units of mass the motion is the same and so are its verdicts, or a step or a verdict says that numbers are
/// too small or too large.
TEST(OwnSystem, MovesAndIsJudgedAlikeInEveryUnit) {
  const OwnRun plain = integrate(Own{}, 1, 1500);
  ASSERT_EQ(plain.status, SolveStatus::converged);
  ASSERT_EQ(plain.ledger.at(0).verdict, "bounded");
  int moved = 0;
  for (int power = -1074; power <= 1023; power += power < -900 || power > 900 ? 1 : 50) {
    Own system;
    system.mass = std::ldexp(1.0, power);
    const OwnRun run = integrate(system, 1, 1500);
    if (run.status != SolveStatus::converged) {
      EXPECT_TRUE(run.status == SolveStatus::not_finite || run.status == SolveStatus::singular) << power;
      EXPECT_TRUE(power < -900 || power > 900) << power;
      continue;
    }
    ++moved;
    EXPECT_NEAR(run.position, plain.position, 1e-11) << power;
    for (const LedgerEntry& e : run.ledger) {
      if (e.verdict == "bounded") {
        EXPECT_NEAR(e.relative_drift, plain.ledger.at(0).relative_drift, 1e-10) << power;
      } else {
        EXPECT_NE(e.reason, "") << power << ": " << e.verdict;
        EXPECT_TRUE(power < -900 || power > 900) << power << ": " << e.verdict;
      }
    }
  }
  EXPECT_GT(moved, 36);
}

/// What falls through a centre of attraction comes out with another energy: that is not bounded.
TEST(OwnSystem, ThatFallsThroughACentreHasNoBoundedEnergy) {
  Own system;
  system.attraction = true;
  int far_off = 0;
  for (int k = 0; k < 40; ++k) {
    system.h = 0.01 * (1 + 0.01 * k);
    const OwnRun run = integrate(system, 1, 4000);
    for (const LedgerEntry& e : run.ledger) {
      if (!(e.relative_drift > 1)) continue;
      ++far_off;
      EXPECT_TRUE(e.verdict == "BROKEN" || e.verdict == "unjudged") << e.name << ": " << e.verdict;
      EXPECT_NE(e.reason, "");
    }
  }
  EXPECT_GT(far_off, 40);
}

}  // namespace
}  // namespace run_ledger_tests
