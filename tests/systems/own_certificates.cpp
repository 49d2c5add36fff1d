// Certificates of systems that are not of the library: a wrong promise is found out, and nothing else is.
#include <lagroid/run/ledger/check_of.hpp>
#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>

#include "../support/broken.hpp"
#include "../support/on_a_sphere.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

using namespace lagroid;

namespace systems_own_certificates_tests {
namespace {

/// A pendulum that promises its energy, which is only bounded.
struct Boastful : Pendulum {
  std::vector<Quantity<Boastful>> quantities() const {
    return {
        {"energy", {"H"}, Promise::conserved, false, [system = *this](const TrajectoryPoint<Boastful>& p, double* out) {
           *out = system.energy(p.state);
         }}};
  }
};

TEST(Certificate, OfAWrongPromiseIsWithheld) {
  Boastful pendulum;
  pendulum.h = 0.1;
  int promises = 0;
  for (const auto& suite : laws::certificate<Boastful>(pendulum, [] {
         return State<Pair<1>>{Vector<double, 1>(1 + laws::draw_uniform()), laws::draw_vector<1>(1.0)};
       })) {
    const bool of_promises = suite.subject == "conserved quantities";
    promises += of_promises;
    EXPECT_TRUE(of_promises ? laws::seen_broken(suite.law("energy")) : suite.holds()) << suite;
  }
  EXPECT_EQ(promises, 1);
}

/// From C++ as by `lagroid check`, and the same each time.
TEST(Certificate, FromCheckNamesWhatIsBroken) {
  Boastful pendulum;
  pendulum.h = 0.1;
  const auto draw = [] {
    return State<Pair<1>>{Vector<double, 1>(1 + laws::draw_uniform()), laws::draw_vector<1>(1.0)};
  };
  const Certificate found = check<Boastful>(pendulum, draw, {.name = "boastful", .samples = 20});
  EXPECT_FALSE(found.holds());
  const std::string words = text_certificate(found);
  EXPECT_NE(words.find("boastful on Pair<1>: up to 20 samples a law, seed"), std::string::npos) << words;
  EXPECT_NE(words.find("NOT certified"), std::string::npos) << words;
  const Certificate again = check<Boastful>(pendulum, draw, {.samples = 20});
  ASSERT_EQ(again.suites.size(), found.suites.size());
  for (std::size_t i = 0; i < found.suites.size(); ++i)
    for (std::size_t k = 0; k < found.suites[i].laws.size(); ++k)
      EXPECT_EQ(again.suites[i].laws[k].worst, found.suites[i].laws[k].worst) << found.suites[i].laws[k].name;
  EXPECT_THROW(check<Boastful>(pendulum, draw, {.samples = 0}), std::invalid_argument);
}

TEST(Certificate, OfForcesAndSkatesOnASphere) {
  for (const auto& report : laws::certificate(Viscous{}, draw_on_the_sphere)) EXPECT_TRUE(report.holds()) << report;
  for (const auto& report : laws::certificate(SkateOnASphere{}, draw_skate)) EXPECT_TRUE(report.holds()) << report;
}

}  // namespace
}  // namespace systems_own_certificates_tests
