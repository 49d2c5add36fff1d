// 06  Adaptive time: the step as an unknown, on R x R x G.
//
// One learns: that a step may change its size and stay symplectic, where its size is part of the arrow. On (t0, t1, g)
// the action L(g, t1 - t0) varies with the times too, and what meets at t1 is the discrete energy,
//
//     E_d = -dL/dh (g, h),    E_d(g_k, h_k) = E_d(g_{k+1}, h_{k+1})            [G] Example 6.1
//
// so that there are as many equations as unknowns. Steps become short near the sun and long far from it, nobody saying
// when, and E_d is kept to round-off. It is no cure-all: with the potential taken at the ends of the arrow, in place of
// its middle, no step of any size keeps E_d all the way round, and the integrator stops and says `no_step`.
//
// Run: ninja -C build/release 06_adaptive_time && build/release/bin/06_adaptive_time
#include <lagroid/core/capabilities/discrete_energy.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/integrators/adaptive.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

using namespace lagroid;

struct Orbit : System<Orbit, Pair<2>> {
  double h = 0.05;
  template <class S, class T> S lagrangian(const PairArrow<S, 2>& g, const T& step) const {
    using std::sqrt;
    const Vector<S, 2> move = g.target - g.source;
    const Vector<S, 2> middle = (g.source + g.target) * 0.5;
    return move.squaredNorm() * (0.5 / step) + step / sqrt(middle.squaredNorm());
  }
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const { return lagrangian(g, h); }
};

int main() {
  const Orbit orbit;
  const State<Pair<2>> start{{0.4, 0}, {0, 2}};  // the perihelion of eccentricity 0.6
  AdaptiveIntegrator<Orbit> adaptive(orbit, start, orbit.groupoid.unit(start.object),
                                     std::make_unique<NewtonStep<Orbit>>(),
                                     std::make_unique<NewtonStep<FreeTime<Orbit>>>());
  double shortest = 1, longest = 0, first = 0, drift = 0;
  const auto& point = adaptive.point();
  for (int k = 0; k < 1000; ++k) {
    if (!adaptive.advance().converged()) return 1;
    const double energy = discrete_energy(orbit, point.step, 0, point.step_size);
    if (k == 0) first = energy;
    drift = std::max(drift, std::abs(energy - first));
    shortest = std::min(shortest, point.step_size);
    longest = std::max(longest, point.step_size);
  }
  fmt::print("{} steps to t = {:.0f}, from {:.3f} to {:.3f}\n", point.index, point.time, shortest, longest);
  fmt::print("E_d = {:.4f}, kept {}\n", first, drift < 1e-12 ? "to round-off" : "not at all");
  return 0;
}
