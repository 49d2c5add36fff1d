// A satellite with reaction wheels, reduced: by the rotations of space and of its wheels, then to its body alone. See
// docs/tutorial_reduction.md.

#include <lagroid/core/reduction/descent.hpp>
#include <lagroid/core/reduction/phase.hpp>
#include <lagroid/core/reduction/reconstruct.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/morphisms.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/rotations/gyrostat.hpp>

#include <fmt/format.h>

#include <memory>
#include <string>

namespace {

using namespace lagroid;

// Attitude and wheel angles at both ends of a step.
using Placement = Gyrostat::GroupoidType;

struct Satellite : System<Satellite, PairOf<Placement>> {
  double h = 0.05;
  Gyrostat body;
  double tilt = 0;  // torque of a magnet fixed in space: no symmetry of all rotations
  template <class A> auto lagrangian(const A& g) const {
    const auto step = groupoid.quotient(g);
    using S = typename std::remove_cvref_t<decltype(std::get<0>(step))>::Scalar;
    return S(body.lagrangian(step, h) + std::get<0>(g.target)(2, 2) * tilt);
  }
};

template <class Sys>
FixedStepIntegrator<Sys> integrator(const Sys& system, const State<typename Sys::GroupoidType>& z) {
  return {system, z, system.groupoid.unit(z.object), std::make_unique<NewtonStep<Sys>>()};
}

}  // namespace

int main() {
  // 1. The reduced system, and what does not reduce.
  const Satellite satellite;
  const auto start = Placement{}.unit(ObjectOf<Placement>{});
  const auto samples = arrows_about(satellite.groupoid, start);
  const auto reduced = reduce(LeftQuotient<Placement>{}, satellite, samples);
  try {
    Satellite tilted;
    tilted.tilt = 1e-3;
    reduce(LeftQuotient<Placement>{}, tilted, samples);
  } catch (const DoesNotDescend& refused) {
    const std::string sentence = refused.what();
    fmt::print("{}\n", sentence.substr(0, sentence.find(": at the arrow")));
  }

  // 2. Its run, and the full motion back.
  Vector<double, 6> momentum;
  momentum << 1.2, 0.3, -0.5, 0.2, -0.1, 0.3;
  auto run = integrator(reduced, reduced.state_below({start, momentum}));
  double drift = 0;
  for (int k = 0; k < 1000; ++k) {
    if (!run.advance().converged()) return 1;
    const auto& [placement, mu] = full_point(reduced, run.point()).state;
    const Vector<double, 3> in_space = std::get<0>(placement) * mu.head<3>();
    drift = std::max(drift, (in_space - momentum.head<3>()).norm());
  }
  fmt::print("over 1000 steps the momentum in space moves by {:.1e}\n", drift);

  // 3. The wheels' momenta are conserved: the body alone, and how far its wheels turned.
  const FactorConnection<Factors<1, 2, 3>, SO3, SO2, SO2, SO2> wheels;
  const MomentumLevel level(wheels, reduced, momentum.tail<3>());
  auto body = integrator(level, level.state_below({{}, momentum}));
  PhaseTally phase(level, HorizontalArrows::zero_momentum);
  for (int k = 0; k < 1000; ++k) {
    if (!body.advance().converged()) return 1;
    phase.add(body.point().step.arrow);
  }
  fmt::print("the wheels turned by {:.4f} {:.4f} {:.4f}\n", phase.total()(0), phase.total()(1), phase.total()(2));
  fmt::print("of that geometric    {:.4f} {:.4f} {:.4f}\n", phase.geometric()(0), phase.geometric()(1),
             phase.geometric()(2));
  return drift < 1e-12 ? 0 : 1;
}
