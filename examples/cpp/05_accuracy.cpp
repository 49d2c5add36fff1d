// 05  Accuracy against cost: steps of order two to eight.
//
// One learns: that an order is chosen, not given. A symmetric step of order two, made several times over with lengths
// gamma_i h, some of them negative, is a step of higher order that keeps whatever the short ones keep:
//
//     Psi_h = Phi_{gamma_s h} o ... o Phi_{gamma_1 h},  sum gamma_i = 1            Hairer, Lubich, Wanner II.4, V.3.2
//
// Kepler's problem, from the library, on an ellipse that closes after the time 2 pi: the error is how far from its
// start the body ends. Every line has the same number of short steps, hence of work; a column has one method. The more
// digits one wants, the higher the order that has them for the least. (`lagroid study` makes such a table of a scene,
// by time.)
//
// Run: ninja -C build/release 05_accuracy && build/release/bin/05_accuracy
#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/systems/kepler.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace lagroid;

// The distance from the start after one revolution made of so many short steps.
double miss(const Composition& composition, int short_steps) {
  const int steps = short_steps / composition.stages();
  Kepler kepler;
  kepler.h = 2 * std::numbers::pi / steps;
  const State<Pair<2>> start{{0.5, 0}, {0, std::sqrt(3.0)}};  // the perihelion of eccentricity 1/2
  const auto integrator =
      make_integrator(kepler, start, kepler.groupoid.unit(start.object), {.composition = composition});
  for (int k = 0; k < steps; ++k)
    if (!integrator->advance().converged()) return std::numeric_limits<double>::infinity();
  return (integrator->point().state.object - start.object).norm();
}

int main() {
  const std::vector<Composition> methods{compositions::single, compositions::suzuki, compositions::kahan_li_6,
                                         compositions::suzuki_umeno_8};
  fmt::print("short steps");
  for (const Composition& method : methods) fmt::print("   order {}", method.order);
  for (const int short_steps : {450, 900, 1800}) {
    fmt::print("\n{:11}", short_steps);
    for (const Composition& method : methods) fmt::print("{:10.0e}", miss(method, short_steps));
  }
  fmt::print("\n");
  return 0;
}
