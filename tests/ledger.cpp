// Verdicts of the ledger: kept, BROKEN, bounded, growing.
#include <ledger.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace lagroid;
using namespace lagroid::app;

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

TEST(Ledger, NaNIsNeverKept) {
  const auto e = judge(Promise::conserved, 100, [](long k) { return k < 50 ? 1.0 : std::nan(""); });
  EXPECT_EQ(e.verdict, "BROKEN");
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
}

}  // namespace
