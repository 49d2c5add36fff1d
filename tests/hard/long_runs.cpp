// A million steps, and with the nightly label a hundred million: errors that grow no faster than random walks.
#include "support/hard_case.hpp"
#include "support/naive.hpp"

#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace lagroid::hard {
namespace {

using V2 = Vector<double, 2>;
using V3 = Vector<double, 3>;
using M3 = Matrix<double, 3, 3>;
constexpr double eps = std::numeric_limits<double>::epsilon();

/// The largest defect of a run in units of eps sqrt(n), n the steps so far: of a random walk of round-off it is a few
/// at all times, of a drift it grows with sqrt(n). Looked at ever more rarely, from a thousand steps on.
template <class Advance, class Defect> double walks(long steps, const Advance& advance, const Defect& defect) {
  double worst = 0;
  long next = 1000;
  for (long k = 1; k <= steps; ++k) {
    if (!advance()) return not_a_number;
    if (k < next && k != steps) continue;
    worst = worse(worst, defect() / (eps * std::sqrt(double(k))));
    next += std::max(1L, next / 50);
  }
  return worst;
}

const V3 inertia(1, 2, 3);
const V3 momentum(0.3, 1.5, 0.4);
State<SO3> start() {
  State<SO3> out;
  out.momentum = momentum;
  return out;
}
constexpr double step = 0.1;

enum class Seen { spatial, energy, casimir };
double defect_of(Seen seen, const V3& m, const M3& attitude) {
  if (seen == Seen::spatial) return (attitude * m - momentum).norm() / momentum.norm();
  if (seen == Seen::casimir) return std::abs(m.norm() / momentum.norm() - 1);
  return std::abs(m.cwiseQuotient(inertia).dot(m) / momentum.cwiseQuotient(inertia).dot(momentum) - 1);
}

double moser_veselov(long steps, Seen seen) {
  const auto system = MoserVeselov::preprocessed(inertia, momentum, step, 10);
  const auto integrator = make_integrator(system, start(), M3::Identity(), {});
  return walks(
      steps, [&] { return integrator->advance().converged(); },
      [&] { return defect_of(seen, integrator->point().state.momentum, integrator->point().configuration); });
}
/// The free body by Runge and Kutta in the same steps.
double by_runge_kutta(long steps, Seen seen) {
  Eigen::VectorXd y = free_body_state(momentum);
  const Field equations = free_body(inertia);
  return walks(
      steps,
      [&] {
        y = runge_kutta_step(equations, y, step);
        return true;
      },
      [&] { return defect_of(seen, y.head<3>(), y.tail<9>().reshaped(3, 3)); });
}

double newton(long steps, Seen seen) {
  RigidBody system;
  system.h = step;
  const auto integrator = make_integrator(system, start(), M3::Identity(), {});
  return walks(
      steps, [&] { return integrator->advance().converged(); },
      [&] { return defect_of(seen, integrator->point().state.momentum, integrator->point().configuration); });
}
/// The arrows of Newton's iteration, but M' = F+ anew at every step, the residual of the solve with it.
double newton_by_recomputing(long steps, Seen seen) {
  RigidBody system;
  system.h = step;
  V3 m = momentum;
  M3 attitude = M3::Identity();
  NewtonOptions options;
  options.tolerance = 1e-10;
  NewtonStep<RigidBody> solver(options);
  StepSolution<RigidBody> solution;
  State<SO3> state = start();
  return walks(
      steps,
      [&] {
        state.momentum = m;
        solution.step = system.first_guess(state);
        if (!solver.solve(system, state, solution).converged()) return false;
        const V3 xi = SO3::log(solution.step.arrow);
        m = SO3::dexp_inverse(xi).transpose() * V3(inertia.cwiseProduct(xi) / step);
        attitude = (attitude * solution.step.arrow).eval();
        return true;
      },
      [&] { return defect_of(seen, m, attitude); });
}

/// Kepler by Stormer and Verlet, e = 0.6: the angular momentum.
double kepler(long steps) {
  Kepler system;
  system.h = 0.01;
  const State<Pair<2>> begin{V2(0.4, 0), V2(0, 2)};
  IntegratorOptions options;
  options.fixed = StepKind::splitting;
  const auto integrator = make_integrator(system, begin, system.groupoid.unit(begin.object), options);
  return walks(
      steps, [&] { return integrator->advance().converged(); },
      [&] {
        const auto& s = integrator->point().state;
        return std::abs((s.object(0) * s.momentum(1) - s.object(1) * s.momentum(0)) / 0.8 - 1);
      });
}
/// The same by Runge and Kutta.
double kepler_by_runge_kutta(long steps) {
  std::array<double, 4> y{0.4, 0, 0, 2};
  const auto rate = [](const std::array<double, 4>& at) {
    const double r = std::hypot(at[0], at[1]);
    return std::array<double, 4>{at[2], at[3], -at[0] / (r * r * r), -at[1] / (r * r * r)};
  };
  const auto along = [](const std::array<double, 4>& a, double t, const std::array<double, 4>& b) {
    std::array<double, 4> out{};
    for (std::size_t i = 0; i < 4; ++i) out[i] = a[i] + t * b[i];
    return out;
  };
  constexpr double h = 0.01;
  return walks(
      steps,
      [&] {
        const auto a = rate(y);
        const auto b = rate(along(y, 0.5 * h, a));
        const auto c = rate(along(y, 0.5 * h, b));
        const auto d = rate(along(y, h, c));
        for (std::size_t i = 0; i < 4; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
        return true;
      },
      [&] { return std::abs((y[0] * y[3] - y[1] * y[2]) / 0.8 - 1); });
}

/// The rotation of a body by splitting, which is explicit: A M.
double splitting(long steps, Seen seen) {
  RigidBody system;
  system.h = step;
  IntegratorOptions options;
  options.fixed = StepKind::splitting;
  const auto integrator = make_integrator(system, start(), M3::Identity(), options);
  return walks(
      steps, [&] { return integrator->advance().converged(); },
      [&] { return defect_of(seen, integrator->point().state.momentum, integrator->point().configuration); });
}

constexpr long million = 1'000'000;

}  // namespace

std::vector<HardCase> long_runs() {
  const char* const walk = "in units of eps sqrt(n), at all times from 1000 steps on";
  std::vector<HardCase> out{
      {"MoserVeselovMomentum", "Moser-Veselov of order 10, 1e6 steps", "relative error of A M, ",
       "Runge-Kutta of order 4, 1e5 of these steps", 20, [] { return moser_veselov(million, Seen::spatial); },
       [] { return by_runge_kutta(million / 10, Seen::spatial); }},
      {"MoserVeselovEnergy", "the same", "relative error of the energy, ", "Runge-Kutta of order 4, 1e5 of these steps",
       20, [] { return moser_veselov(million, Seen::energy); },
       [] { return by_runge_kutta(million / 10, Seen::energy); }},
      {"NewtonMomentum", "rigid body by Newton's iteration, 1e6 steps", "relative error of A M, ",
       "F+ recomputed from arrows solved to 1e-10", 20, [] { return newton(million, Seen::spatial); },
       [] { return newton_by_recomputing(million, Seen::spatial); }},
      {"NewtonCasimir", "the same", "relative error of |M|, ", "F+ recomputed from arrows solved to 1e-10", 20,
       [] { return newton(million, Seen::casimir); }, [] { return newton_by_recomputing(million, Seen::casimir); }},
      {"SplittingMomentum", "rigid body by splitting, 1e6 steps", "relative error of A M, ",
       "Runge-Kutta of order 4, 1e5 of these steps", 20, [] { return splitting(million, Seen::spatial); },
       [] { return by_runge_kutta(million / 10, Seen::spatial); }},
      {"KeplerMomentum", "Kepler, e = 0.6, by Stormer and Verlet, 1e6 steps",
       "relative error of the angular momentum, ", "Runge-Kutta of order 4 in the same steps", 20,
       [] { return kepler(million); }, [] { return kepler_by_runge_kutta(million); }},
      {"MoserVeselovMomentumNightly", "Moser-Veselov of order 10, 1e8 steps",
       "relative error of A M (a drift far below one round-off a step shows through), ",
       "Runge-Kutta of order 4, 1e6 of these steps", 50, [] { return moser_veselov(100 * million, Seen::spatial); },
       [] { return by_runge_kutta(million, Seen::spatial); }, true},
      {"MoserVeselovEnergyNightly", "the same", "relative error of the energy, ",
       "Runge-Kutta of order 4, 1e6 of these steps", 20, [] { return moser_veselov(100 * million, Seen::energy); },
       [] { return by_runge_kutta(million, Seen::energy); }, true},
      {"KeplerMomentumNightly", "Kepler, e = 0.6, by Stormer and Verlet, 1e8 steps",
       "relative error of the angular momentum, ", "Runge-Kutta of order 4, 1e7 steps", 20,
       [] { return kepler(100 * million); }, [] { return kepler_by_runge_kutta(10 * million); }, true},
  };
  for (HardCase& hard : out) hard.promise += walk;
  return out;
}

}  // namespace lagroid::hard
