// The table of methods: what it says is consistent, and what it refuses is told in a sentence.
#include <lagroid/solvers/boundary/boundary_words.hpp>
#include <lagroid/solvers/methods/methods.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rolling/rolling_disk.hpp>
#include <lagroid/systems/rotations/moser_veselov_method.hpp>

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>

namespace solvers_declared_methods_tests {
namespace {

using namespace lagroid;

TEST(DeclaredMethods, WordsLeadToMethodsAndBack) {
  std::set<std::string> names;
  for (const IntegrationMethod& method : declared_methods) {
    EXPECT_TRUE(names.emplace(method.name).second) << method.name;
    EXPECT_EQ(&integration_method(options_of(method)), &method);
  }
  for (const std::string& mode : mode_words())
    for (const std::string& word : method_words()) {
      const IntegrationMethod& method = integration_method(mode, word);
      EXPECT_EQ(method.name, mode == mode_of_equal_steps ? word : mode);
    }
  EXPECT_THROW(integration_method("adaptve", ""), std::invalid_argument);
  EXPECT_THROW(integration_method(mode_of_equal_steps, "adaptive"), std::invalid_argument);
}

TEST(DeclaredMethods, TheFirstOfEachIsWhatOptionsAreByDefault) {
  const IntegratorOptions options;
  EXPECT_EQ(&integration_method(mode_words().front(), method_words().front()), &integration_method(options));
  EXPECT_EQ(without_root_words.front().choice, options.without_root);
  EXPECT_EQ(solver_words.front().choice, options.method);
  EXPECT_EQ(boundary_words.front().choice, BoundaryMethod::newton);
  EXPECT_EQ(usual_composition(integration_method(options).order)->name, options.composition.name);
}

TEST(DeclaredMethods, EveryOrderHasItsComposition) {
  for (const Composition& usual : usual_compositions) {
    ASSERT_NE(usual_composition(usual.order), nullptr);
    EXPECT_EQ(usual_composition(usual.order)->name, usual.name);
  }
  EXPECT_EQ(usual_composition(5), nullptr);
  EXPECT_EQ(usual_orders(), "2, 4, 6 or 8");
  for (const OtherOrders orders : {OtherOrders::composed_steps, OtherOrders::composed_flows})
    for (const Composition& usual : usual_compositions)
      EXPECT_NE(composition_named(compositions_of(orders), usual.name), nullptr) << usual.name;
  EXPECT_TRUE(compositions_of(OtherOrders::preprocessed).empty());
}

TEST(DeclaredMethods, WhatASystemLacksIsToldInASentence) {
  const Capabilities orbit = capabilities_of(Kepler{}), disk = capabilities_of(RollingDisk{});
  for (const IntegrationMethod& method : declared_methods) {
    IntegratorOptions options = options_of(method);
    if (method.by_tolerance()) {
      EXPECT_NE(why_not(options, orbit).find("a tolerance"), std::string::npos);
      options.tolerance = 1e-6;
    }
    EXPECT_EQ(why_not(options, orbit), "") << method.name;
    const std::string why = why_not(options, disk);
    if (method.needs.empty()) {
      EXPECT_EQ(why, "");
    } else {
      EXPECT_EQ(why.find(std::string(method.name) + ": this system has no "), 0U) << why;
    }
  }
  EXPECT_EQ(why_not({.composition = compositions::suzuki}, orbit), "");
  EXPECT_EQ(why_not({.composition = compositions::suzuki}, disk),
            "orders above two: this system has no action principle");
  Capabilities fixed = orbit;
  fixed.has_step = false;
  EXPECT_NE(why_not({.composition = compositions::suzuki}, fixed).find("step that can be changed, h"),
            std::string::npos);
  Capabilities hasty = orbit;
  hasty.time_scale = false;
  const IntegratorOptions controlled{.mode = TimeMode::adaptive, .without_root = WithoutRoot::controlled};
  EXPECT_EQ(why_not(controlled, orbit), "");
  EXPECT_NE(why_not(controlled, hasty).find("time_scale_rate"), std::string::npos);
}

TEST(DeclaredMethods, NamedOnesAreThoseWhoseNeedsAreMet) {
  std::set<std::string> of_disk;
  for (const NamedMethod& m : named_methods(capabilities_of(RollingDisk{}))) of_disk.insert(m.name);
  EXPECT_EQ(of_disk, std::set<std::string>{"variational"});
  std::set<std::string> of_orbit;
  for (const NamedMethod& m : named_methods(capabilities_of(Kepler{}))) {
    of_orbit.insert(m.name);
    const IntegrationMethod& method = integration_method(m.options);
    EXPECT_EQ(m.equal_steps, method.equal_steps() && !method.by_tolerance()) << m.name;
    EXPECT_EQ(m.options.tolerance > 0, method.by_tolerance()) << m.name;
    EXPECT_TRUE(!integration_method(m.options).composed() || m.order == m.options.composition.order) << m.name;
  }
  for (const IntegrationMethod& method : declared_methods)
    EXPECT_TRUE(of_orbit.contains(std::string(method.name) + (method.by_tolerance() ? "/1e-9" : ""))) << method.name;
  for (const char* composed : {"variational/suzuki", "splitting/nystrom-6", "transformed/kahan-li-8"})
    EXPECT_TRUE(of_orbit.contains(composed)) << composed;
}

TEST(DeclaredMethods, CoefficientsHaveTheirPapers) {
  for (const Composition& each : compositions_of(OtherOrders::composed_flows))
    EXPECT_EQ(source_of(each).key.empty(), each.stages() == 1) << each.name;
  for (const LieGroupMethod& each : lie_group_methods::all)
    EXPECT_EQ(source_of(each).key.empty(), each.scheme == LieGroupScheme::classical) << each.name;
}

TEST(DeclaredMethods, MoserVeselovGoesByItsHighestOrder) {
  EXPECT_EQ(moser_veselov_method.order, moser_veselov_orders.back());
  EXPECT_EQ(any_of_these(moser_veselov_orders), "2, 4, 6, 8 or 10");
}

}  // namespace
}  // namespace solvers_declared_methods_tests
