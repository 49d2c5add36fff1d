#pragma once
/// What tests hold orders of noise to.

#include <lagroid/systems/poisson/noise_study.hpp>

#include <gtest/gtest.h>

#include <string>

namespace lagroid {

/// Holds an order to what is promised, within two standard errors that are at most `most`.
inline void expect_order(const char* what, const Estimate& order, double promised, double most) {
  EXPECT_NEAR(order.value, promised, 2 * order.error) << what;
  EXPECT_LT(order.error, most) << what;
  testing::Test::RecordProperty(what, std::to_string(order.value) + " +- " + std::to_string(order.error));
}

}  // namespace lagroid
