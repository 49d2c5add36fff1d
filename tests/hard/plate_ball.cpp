// The ball on a plate: turns of nearly a right angle, a very small ball, a very fast plate.
#include "support/hard_case.hpp"
#include "support/naive.hpp"
#include "support/refusal.hpp"

#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/rolling/rolling_ball.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace lagroid::hard {
namespace {

using V2 = Vector<double, 2>;
using V3 = Vector<double, 3>;
using M3 = Matrix<double, 3, 3>;
using G = PlateBall::GroupoidType;

State<G> ball(double radius = 1) {
  State<G> out;
  std::get<0>(out.object) << 0.3, -0.2;
  out.momentum << 0.9, 0.2, 0.6 * radius, -0.4 * radius, 0.8;
  return out;
}
std::unique_ptr<Integrator<PlateBall>> integrator_from(const PlateBall& system, const State<G>& start) {
  return make_integrator(system, start, system.groupoid.unit(start.object), {});
}

/// Spin times step just short of one and beyond it: the rolling constraints of each step, or a typed refusal; NaN where
/// a step that turns by a right angle or more was taken.
double near_the_right_angle(double product, int steps) {
  PlateBall system;
  system.rotation = RotationForm::trace;
  system.h = 0.5;
  system.spin = product / system.h;
  State<G> start = ball();
  start.momentum.head<2>() << 0.61, -0.39;  // slow: u = px - l2, v = py - l1
  const auto integrator = integrator_from(system, start);
  double worst = 0;
  for (int k = 0; k < steps; ++k) {
    const auto before = integrator->point();
    if (!integrator->advance().converged()) return unmoved(before, integrator->point()) ? worst : not_a_number;
    const auto& turn = std::get<1>(integrator->point().step.arrow);
    if (!(turn.trace() > 1)) return not_a_number;
    worst = worse(worst, system.constraint(integrator->point().step.arrow).norm());
  }
  return worst;
}
/// Newton's iteration for |vee g| = sine from a turn of 1.7 rad: the distance from the turn that is continuous in h.
double another_root(double sine) {
  double angle = 1.7;
  for (int k = 0; k < 50; ++k) angle -= (std::sin(angle) - sine) / std::cos(angle);
  return std::abs(angle - std::asin(sine));
}

struct Kept {
  double spatial = 0;  ///< A M
  double about = 0;    ///< x py - y px - M3
  double rolling = 0;  ///< the constraints
};
Kept run(const PlateBall& system, const State<G>& start, int steps) {
  const auto integrator = integrator_from(system, start);
  const V3 m = start.momentum.tail<3>();
  const auto about = [](const State<G>& s) {
    const V2& q = std::get<0>(s.object);
    return q(0) * s.momentum(1) - q(1) * s.momentum(0) - s.momentum(4);
  };
  Kept out;
  double size = 0;
  for (int k = 0; k < steps; ++k) {
    if (!integrator->advance().converged()) return {not_a_number, not_a_number, not_a_number};
    const auto& p = integrator->point();
    const V2& q = std::get<0>(p.state.object);
    size = std::max(size, q.norm() * p.state.momentum.head<2>().norm() + m.norm());
    out.spatial = worse(out.spatial, (std::get<1>(p.configuration) * p.state.momentum.tail<3>() - m).norm() / m.norm());
    out.about = worse(out.about, std::abs(about(p.state) - about(start)) / size);
    const auto& [move, turn] = p.step.arrow;
    out.rolling = worse(out.rolling, system.constraint(p.step.arrow).norm() / (system.radius + move.target.norm()));
  }
  return out;
}
/// The continuous extremal by explicit Euler: the error of A M.
double euler(const PlateBall& system, const State<G>& start, int steps) {
  V2 q = std::get<0>(start.object);
  V2 p = start.momentum.head<2>();
  V3 m = start.momentum.tail<3>();
  M3 attitude = M3::Identity();
  for (int k = 0; k < steps; ++k) {
    const double l1 = m(0) / system.radius;
    const double l2 = -m(1) / system.radius;
    const V2 v(p(0) - l2, p(1) - l1);
    const V3 w((system.plate_rate * q(0) - v(1)) / system.radius, (v(0) + system.plate_rate * q(1)) / system.radius,
               system.spin);
    attitude += system.h * attitude * SO3::hat(w);
    q += system.h * v;
    p += system.h * system.plate_rate * V2(-l1, l2);
    m += system.h * m.cross(w);
  }
  return (attitude * m - start.momentum.tail<3>()).norm() / start.momentum.tail<3>().norm();
}
PlateBall small() {
  PlateBall system;
  system.radius = 1e-3;
  system.h = 2e-4;
  system.rotation = RotationForm::exponential;
  return system;
}
PlateBall fast() {
  PlateBall system;
  system.plate_rate = 50;
  system.h = 1e-4;
  system.rotation = RotationForm::exponential;
  return system;
}

/// The rolling ball of mechanics goes round a circle at the rate (2 / h) atan(h k Omega / (2 (1 + k))): how far it
/// leaves that circle, over its radius.
double circle(double radius, double plate_rate, double h, bool naive) {
  RollingBall system;
  system.radius = radius;
  system.plate_rate = plate_rate;
  system.h = h;
  const double k = system.inertia_factor;
  const double rate = k * plate_rate / (1 + k);
  const V2 q(0.3, -0.2);
  const V2 v(0.4, 0.1);
  const V2 centre = q + V2(-v(1), v(0)) / rate;
  const double size = v.norm() / rate;
  const auto start = system.rolling(q, v, 0.7);
  const auto integrator = make_integrator(system, start, system.groupoid.unit(start.object), {});
  V2 at = q;
  V2 moving = v;
  double worst = 0;
  for (int n = 0; n < 10'000; ++n) {
    if (naive) {
      at += h * moving;
      moving += h * rate * V2(-moving(1), moving(0));
    } else {
      if (!integrator->advance().converged()) return not_a_number;
      at = std::get<0>(integrator->point().state.object);
    }
    worst = worse(worst, std::abs((at - centre).norm() / size - 1));
  }
  return worst;
}

}  // namespace

std::vector<HardCase> plate_ball() {
  return {
      {"TraceFormNearARightAngle", "trace form, spin times step 0.99 to 1 - 1e-9",
       "residual of rolling, or a typed refusal; never a root beyond a right angle",
       "Newton's iteration for the sine, from another guess: error of the turn, rad", 1e-12,
       [] {
         double worst = 0;
         for (const double product : {0.9, 0.99, 0.999, 1 - 1e-6, 1 - 1e-9})
           worst = worse(worst, near_the_right_angle(product, 100));
         return worst;
       },
       [] { return another_root(0.99); }},
      {"TraceFormBeyondARightAngle", "trace form, spin times step 1.001",
       "not supported: a typed status, and nothing moves (0: so)", "asin of the sine", 0,
       [] {
         PlateBall system;
         system.h = 0.5;
         system.spin = 1.001 / system.h;
         return refusal(*integrator_from(system, ball()));
       },
       [] { return std::asin(1.001); }},
      {"VerySmallBall", "plate-ball, r = 1e-3 m, 1e4 steps of 2e-4 s", "relative errors of A M and of x py - y px - M3",
       "explicit Euler in the same steps: A M", 1e-11,
       [] {
         const Kept kept = run(small(), ball(1e-3), 10'000);
         return worse(kept.spatial, kept.about);
       },
       [] { return euler(small(), ball(1e-3), 10'000); }},
      {"VerySmallBallRolls", "the same", "residual of rolling over lengths", "explicit Euler in the same steps: A M",
       1e-14, [] { return run(small(), ball(1e-3), 10'000).rolling; },
       [] { return euler(small(), ball(1e-3), 10'000); }},
      {"VeryFastPlate", "plate-ball, plate rate 50 rad/s, 1e4 steps of 1e-4 s",
       "relative errors of A M and of x py - y px - M3", "explicit Euler in the same steps: A M", 1e-11,
       [] {
         const Kept kept = run(fast(), ball(), 10'000);
         return worse(kept.spatial, kept.about);
       },
       [] { return euler(fast(), ball(), 10'000); }},
      {"RollingBallOnAFastPlate", "rolling ball, plate rate 50 rad/s, 1e4 steps of 0.01 s",
       "distance from the exact circle, over its radius", "explicit Euler in the same steps", 1e-11,
       [] { return circle(1, 50, 0.01, false); }, [] { return circle(1, 50, 0.01, true); }},
      {"VerySmallRollingBall", "rolling ball, r = 1e-3 m, plate rate 5 rad/s, 1e4 steps of 1e-3 s",
       "distance from the exact circle, over its radius", "explicit Euler in the same steps", 1e-11,
       [] { return circle(1e-3, 5, 1e-3, false); }, [] { return circle(1e-3, 5, 1e-3, true); }},
  };
}

}  // namespace lagroid::hard
