// Certificates of systems that are not of the library: a wrong promise is found out, and nothing else is.
#include <lagroid/solvers/testing/certificate.hpp>
#include <lagroid/systems/pendulum.hpp>

#include "broken.hpp"
#include "on_a_sphere.hpp"

#include <gtest/gtest.h>

#include <vector>

using namespace lagroid;

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

TEST(Certificate, OfForcesAndSkatesOnASphere) {
  for (const auto& report : laws::certificate(Viscous{}, draw_on_the_sphere)) EXPECT_TRUE(report.holds()) << report;
  for (const auto& report : laws::certificate(SkateOnASphere{}, draw_skate)) EXPECT_TRUE(report.holds()) << report;
}

}  // namespace
