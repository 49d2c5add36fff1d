// Fast rotation, steps that turn by nearly pi, flips about the intermediate axis.
#include "hard_case.hpp"
#include "naive.hpp"
#include "refusal.hpp"

#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>
#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

namespace lagroid::hard {
namespace {

using V3 = Vector<double, 3>;
using M3 = Matrix<double, 3, 3>;

const V3 inertia(1, 2, 3);

State<SO3> turning(const V3& momentum) {
  State<SO3> state;
  state.momentum = momentum;
  return state;
}
std::unique_ptr<Integrator<RigidBody>> body_integrator(const V3& momentum, double h, const V3& moments = inertia) {
  RigidBody body;
  body.inertia = moments;
  body.h = h;
  return make_integrator(body, turning(momentum), M3::Identity(), {});
}

/// What a run keeps: the largest relative errors of A M and of the energy.
struct Kept {
  double momentum = 0;
  double energy = 0;
};
double energy_of(const V3& m, const V3& moments) { return 0.5 * m.cwiseQuotient(moments).dot(m); }

template <class Integrating> Kept run_body(Integrating& integrator, const V3& moments, int steps) {
  const V3 first = integrator.point().state.momentum;
  const double energy = energy_of(first, moments);
  Kept out;
  for (int k = 0; k < steps; ++k) {
    if (!integrator.advance().converged()) return {not_a_number, not_a_number};
    const auto& p = integrator.point();
    out.momentum = worse(out.momentum, (p.configuration * p.state.momentum - first).norm() / first.norm());
    out.energy = worse(out.energy, std::abs(energy_of(p.state.momentum, moments) / energy - 1));
  }
  return out;
}
using OneStep = Eigen::VectorXd (*)(const Field&, const Eigen::VectorXd&, double);
Kept run_naive(OneStep step, const V3& momentum, double h, const V3& moments, int steps) {
  Eigen::VectorXd y = free_body_state(momentum);
  const double energy = energy_of(momentum, moments);
  Kept out;
  for (int k = 0; k < steps; ++k) {
    y = step(free_body(moments), y, h);
    out.momentum = worse(out.momentum, (spatial_momentum(y) - momentum).norm() / momentum.norm());
    out.energy = worse(out.energy, std::abs(energy_of(V3(y.head<3>()), moments) / energy - 1));
  }
  return out;
}

const std::initializer_list<double> spins{1e3, 1e4, 1e6};
/// About an axis between the first and the third, at that rate; steps of a tenth of a radian.
V3 fast(double rate) { return rate * V3(0.6, 0.2, 0.9); }
constexpr int fast_steps = 10'000;

/// A sleeping Lagrange top: upright but for `tilt`, spinning at `rate`.
HeavyTop top(double rate) {
  HeavyTop out;
  out.inertia = {1, 1, 0.5};
  out.weight = {0, 0, 9.81};
  out.h = 0.1 / rate;
  return out;
}
constexpr double tilt = 1e-3;
State<HeavyTop::GroupoidType> sleeping(double rate) {
  State<HeavyTop::GroupoidType> state;
  state.object = V3(tilt, 0, 1).normalized();
  state.momentum = {0, 0, 0.5 * rate};
  return state;
}

/// Of the fast top: how far its axis leaves the vertical, in tilts, and the errors of what is conserved.
struct TopKept {
  double tilts = 0;
  double vertical = 0;  ///< of M.v
  double axial = 0;     ///< of M3
};
TopKept run_top(double rate, int steps, bool naive) {
  const HeavyTop system = top(rate);
  const auto start = sleeping(rate);
  const auto integrator = make_integrator(system, start, system.groupoid.unit(start.object), {});
  Eigen::VectorXd y(6);
  y << start.object, start.momentum;
  const Field equations = [&](const Eigen::VectorXd& at) {
    const V3 v = at.head<3>();
    const V3 m = at.tail<3>();
    const V3 w = m.cwiseQuotient(system.inertia);
    Eigen::VectorXd out(6);
    out << v.cross(w), m.cross(w) + v.cross(system.weight);
    return out;
  };
  TopKept out;
  for (int k = 0; k < steps; ++k) {
    if (naive) {
      y = euler_step(equations, y, system.h);
    } else {
      if (!integrator->advance().converged()) return {not_a_number, not_a_number, not_a_number};
      y << integrator->point().state.object, integrator->point().state.momentum;
    }
    const V3 v = y.head<3>();
    const V3 m = y.tail<3>();
    out.tilts = worse(out.tilts, v.head<2>().norm() / tilt);
    out.vertical = worse(out.vertical, std::abs(m.dot(v) / start.momentum.dot(start.object) - 1));
    out.axial = worse(out.axial, std::abs(m(2) / start.momentum(2) - 1));
  }
  return out;
}

/// A body that spins about a principal axis by `angle` a step: the angle that its arrows turn by.
double steady_turn(double angle) {
  const auto integrator = body_integrator(V3(0, 0, 3 * angle), 1);
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    if (!integrator->advance().converged()) return not_a_number;
    worst = worse(worst, (SO3::log(integrator->point().step.arrow) - V3(0, 0, angle)).norm());
  }
  return worst;
}
/// The same with the angle recovered from the antisymmetric part, whose size is its sine.
double turn_by_sine(double angle) {
  const M3 g = SO3::exp(V3(0, 0, angle));
  return std::abs(std::asin(SO3::vee(g)(2)) - angle);
}

/// Steps that turn by 2.9 to 3.1 about axes in general: the defect of (dexp^{-1}_{-xi})^T (I xi / h) = mu at what is
/// taken for the solution. Ours may refuse instead, where it leaves everything as it was.
double large_turns(bool naive) {
  double worst = 0;
  for (int k = 0; k < 40; ++k) {
    const double angle = 2.9 + 0.005 * k;
    const V3 axis = V3(std::cos(1.0 * k), std::sin(2.0 * k), std::cos(3.0 * k + 1)).normalized();
    const V3 momentum = angle * inertia.cwiseProduct(axis);
    const auto defect = [&](const V3& xi) {
      return (SO3::dexp_inverse(V3(-xi)).transpose() * inertia.cwiseProduct(xi) - momentum).norm() / momentum.norm();
    };
    if (naive) {
      V3 xi = momentum.cwiseQuotient(inertia);
      for (int sweep = 0; sweep < 50; ++sweep)
        xi = (SO3::dexp(V3(-xi)).transpose() * momentum).eval().cwiseQuotient(inertia);
      worst = worse(worst, defect(xi));
      continue;
    }
    const auto integrator = body_integrator(momentum, 1);
    const auto before = integrator->point();
    if (integrator->advance().converged()) {
      worst = worse(worst, defect(SO3::log(integrator->point().step.arrow)));
    } else if (!unmoved(before, integrator->point())) {
      return not_a_number;
    }
  }
  return worst;
}

/// M starts `off` the intermediate axis towards the third: the time until it first points the other way along the
/// second, 2 K(k) / rate of Jacobi's elliptic functions (Landau and Lifshitz, Mechanics, section 37).
constexpr double off = 1e-8;
double exact_flip(double m) {
  const double i1 = inertia(0);
  const double i2 = inertia(1);
  const double i3 = inertia(2);
  const double square = m * m + off * off;
  const double twice_energy = m * m / i2 + off * off / i3;
  const double rate = std::sqrt((i3 - i2) * (square - twice_energy * i1) / (i1 * i2 * i3));
  // |M|^2 - 2 E I2 = off^2 (1 - I2 / I3), without cancellation.
  const double complement =
      std::sqrt((i3 - i1) * off * off * (1 - i2 / i3) / ((i3 - i2) * (square - twice_energy * i1)));
  double a = 1;
  double b = complement;
  for (int k = 0; k < 20; ++k) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi / a / rate;
}
/// From the first zero of M2, halfway, of the cubic through the four values around it; `advance` gives one after
/// another.
template <class Advance> double flip_by(double h, const Advance& advance) {
  std::array<double, 4> m{};
  for (int k = 1; k < 1'000'000; ++k) {
    std::rotate(m.begin(), m.begin() + 1, m.end());
    m[3] = advance();
    if (!std::isfinite(m[3])) return not_a_number;
    if (k < 4 || m[2] > 0) continue;
    const auto cubic = [&](double s) {  // Newton's, through s = -1, 0, 1, 2
      return m[0] + (s + 1) * (m[1] - m[0]) + (s + 1) * s / 2 * (m[2] - 2 * m[1] + m[0]) +
             (s + 1) * s * (s - 1) / 6 * (m[3] - 3 * m[2] + 3 * m[1] - m[0]);
    };
    double low = 0;
    double high = 1;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (cubic(middle) > 0 ? low : high) = middle;
    }
    return 2 * h * (k - 2 + low);
  }
  return not_a_number;
}
constexpr double flip_momentum = 2;

double flip_error_moser_veselov(int order) {
  const V3 start(0, flip_momentum, off);
  const double h = 0.02;
  const auto system = MoserVeselov::preprocessed(inertia, start, h, order);
  const auto integrator = make_integrator(system, turning(start), M3::Identity(), {});
  const double found = flip_by(
      h, [&] { return integrator->advance().converged() ? integrator->point().state.momentum(1) : not_a_number; });
  return std::abs(found / exact_flip(flip_momentum) - 1);
}
double flip_error_newton() {
  const double h = 0.002;
  const auto integrator = body_integrator(V3(0, flip_momentum, off), h);
  const double found = flip_by(
      h, [&] { return integrator->advance().converged() ? integrator->point().state.momentum(1) : not_a_number; });
  return std::abs(found / exact_flip(flip_momentum) - 1);
}
double flip_error_euler() {
  const double h = 0.002;
  Eigen::VectorXd y = free_body_state(V3(0, flip_momentum, off));
  const double found = flip_by(h, [&] {
    y = euler_step(free_body(inertia), y, h);
    return y(1);
  });
  return std::abs(found / exact_flip(flip_momentum) - 1);
}

/// Over some thirty flips.
constexpr int tumbling_steps = 40'000;
constexpr double tumbling_step = 0.02;
Kept tumbling_moser_veselov() {
  const V3 start(0, flip_momentum, off);
  const auto system = MoserVeselov::preprocessed(inertia, start, tumbling_step, 10);
  const auto integrator = make_integrator(system, turning(start), M3::Identity(), {});
  return run_body(*integrator, inertia, tumbling_steps);
}
Kept tumbling_newton() {
  const auto integrator = body_integrator(V3(0, flip_momentum, off), tumbling_step);
  return run_body(*integrator, inertia, tumbling_steps);
}
Kept tumbling_naive() {
  return run_naive(runge_kutta_step, V3(0, flip_momentum, off), tumbling_step, inertia, tumbling_steps);
}

template <class F> double over_spins(const F& f) {
  double worst = 0;
  for (const double rate : spins) worst = worse(worst, f(rate));
  return worst;
}

}  // namespace

std::vector<HardCase> spin() {
  return {
      {"FastBodyKeepsItsMomentum", "rigid body at 1e3, 1e4, 1e6 rad/s, 0.1 rad a step, 1e4 steps",
       "relative error of the spatial momentum A M", "Runge-Kutta of order 4 in the same steps", 1e-13,
       [] {
         return over_spins([](double rate) {
           return run_body(*body_integrator(fast(rate), 0.1 / rate), inertia, fast_steps).momentum;
         });
       },
       [] {
         return over_spins([](double rate) {
           return run_naive(runge_kutta_step, fast(rate), 0.1 / rate, inertia, fast_steps).momentum;
         });
       }},
      {"FastBodyKeepsItsEnergy", "the same", "relative error of the energy, which is bounded",
       "explicit Euler in the same steps", 1e-3,
       [] {
         return over_spins([](double rate) {
           return run_body(*body_integrator(fast(rate), 0.1 / rate), inertia, fast_steps).energy;
         });
       },
       [] {
         return over_spins(
             [](double rate) { return run_naive(euler_step, fast(rate), 0.1 / rate, inertia, fast_steps).energy; });
       }},
      {"SleepingTopStaysUpright", "Lagrange top at 1e3, 1e4, 1e6 rad/s, 1e-3 rad off the vertical, 1e4 steps",
       "largest tilt over the first, less one", "explicit Euler in the same steps", 1e-2,
       [] { return over_spins([](double rate) { return run_top(rate, fast_steps, false).tilts; }) - 1; },
       [] { return over_spins([](double rate) { return run_top(rate, fast_steps, true).tilts; }) - 1; }},
      {"FastTopKeepsItsMomenta", "the same", "relative errors of the vertical and the axial momentum",
       "explicit Euler in the same steps", 1e-12,
       [] {
         return over_spins([](double rate) {
           const TopKept kept = run_top(rate, fast_steps, false);
           return worse(kept.vertical, kept.axial);
         });
       },
       [] {
         return over_spins([](double rate) {
           const TopKept kept = run_top(rate, fast_steps, true);
           return worse(kept.vertical, kept.axial);
         });
       }},
      {"FastTopStepTooLarge", "Lagrange top at 1e6 rad/s, 1e3 rad a step",
       "not supported: a typed status, and nothing moves (0: so)", "a step of explicit Euler: error of |v|", 0,
       [] {
         HeavyTop system = top(1e6);
         system.h = 1e-3;
         const auto start = sleeping(1e6);
         return refusal(*make_integrator(system, start, system.groupoid.unit(start.object), {}));
       },
       [] {
         const auto start = sleeping(1e6);
         const V3 moved = start.object + 1e-3 * start.object.cross(V3(start.momentum / 0.5));
         return std::abs(moved.norm() - 1);
       }},
      {"SteadyTurnOfNearlyPi", "rigid body, 3.1 rad a step about a principal axis, 1000 steps",
       "error of each step's turn, rad", "the turn by the sine of the antisymmetric part", 1e-12,
       [] { return steady_turn(3.1); }, [] { return turn_by_sine(3.1); }},
      {"TurnsOfNearlyPi", "rigid body, 2.9 to 3.1 rad a step about axes in general",
       "defect of the step equations, or a typed refusal", "50 sweeps of a fixed-point iteration", 1e-13,
       [] { return large_turns(false); }, [] { return large_turns(true); }},
      {"TurnsBeyondPi", "rigid body, 3.5 rad a step about a principal axis",
       "not supported: a typed status, and nothing moves (0: so)",
       "the rotation itself, read back as a turn: its error", 0,
       [] { return refusal(*body_integrator(V3(0, 0, 10.5), 1)); },
       [] { return std::abs(SO3::log(SO3::exp(V3(0, 0, 3.5)))(2) - 3.5); }},
      {"MoserVeselovStepTooLarge", "Moser-Veselov, h |M| beyond the longest step",
       "not supported: a typed status, and nothing moves (0: so)", "asin of h |M| / I for the angle", 0,
       [] {
         MoserVeselov system;
         system.h = 3;
         return refusal(*make_integrator(system, turning(V3(0, 0, 1.2)), M3::Identity(), {}));
       },
       [] { return std::asin(3 * 1.2 / 3); }},
      {"FlipTimeByMoserVeselov", "1e-8 off the intermediate axis, order 10, h = 0.02",
       "relative error of the time of the flip, against elliptic functions", "the same steps without preprocessing",
       1e-8, [] { return flip_error_moser_veselov(10); }, [] { return flip_error_moser_veselov(2); }},
      {"FlipTimeBySteps", "1e-8 off the intermediate axis, order 2, h = 0.002",
       "relative error of the time of the flip", "explicit Euler in the same steps", 1e-6,
       [] { return flip_error_newton(); }, [] { return flip_error_euler(); }},
      {"FlipsKeepMomentum", "thirty flips from 1e-8 off the axis, h = 0.02",
       "relative error of A M, by Newton and by Moser-Veselov", "Runge-Kutta of order 4 in the same steps", 1e-12,
       [] { return worse(tumbling_moser_veselov().momentum, tumbling_newton().momentum); },
       [] { return tumbling_naive().momentum; }},
      {"FlipsKeepEnergy", "the same", "relative error of the energy, by Moser-Veselov of order 10",
       "Runge-Kutta of order 4 in the same steps", 1e-12, [] { return tumbling_moser_veselov().energy; },
       [] { return tumbling_naive().energy; }},
  };
}

}  // namespace lagroid::hard
