// The problems are the same for everybody: the best run of every method agrees with the reference, and the reference
// with itself.
#include "study.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace {

using namespace peers;

bool integrates_equations(const std::string& library) { return library == "odeint" || library == "SUNDIALS"; }

/// What integrators of equations must reach; those of variable order have a floor of their own.
double wanted_of(const Method& method) {
  const bool variable = method.name.starts_with("CVODE") || method.name == "Bulirsch-Stoer";
  return variable ? 1e-6 : 1e-9;
}

/// `we`: the error that our methods, of order two and up, must reach; `engines`: those of the first order.
void agree(const Problem& problem, double end, double we, double engines) {
  const Study found = study(problem, end, {.longest = 0.1, .repetitions = 1});
  EXPECT_LT(found.reference.uncertainty, 1e-14);
  for (std::size_t m = 0; m < problem.methods.size(); ++m) {
    const Method& method = problem.methods[m];
    double best = std::numeric_limits<double>::infinity();
    for (const Run& run : found.runs)
      if (run.method == m) best = std::min(best, run.error);
    const double wanted = integrates_equations(method.library) ? wanted_of(method)
                          : method.library == ours             ? we
                                                               : engines;
    EXPECT_LT(best, wanted) << problem.name << ", " << method.library << ", " << method.name;
  }
}

TEST(Peers, RigidBody) { agree(rigid_body(), 10, 1e-6, 1e-2); }
TEST(Peers, Kepler) { agree(kepler(), 10, 1e-6, 0); }
TEST(Peers, Pendulum) { agree(pendulum(), 10, 1e-6, 0); }
TEST(Peers, SphericalPendulum) { agree(spherical_pendulum(), 10, 1e-6, 0); }
TEST(Peers, Top) { agree(top(), 5, 1e-6, 0); }
TEST(Peers, Chain) { agree(chain(), 0.25, 1e-4, 5e-2); }

}  // namespace
