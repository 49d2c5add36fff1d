// Pendulums that start near the top, and spherical ones that pass the poles.
#include "support/hard_case.hpp"
#include "support/naive.hpp"

#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/systems/pendulums/pendulum.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

namespace lagroid::hard {
namespace {

using V1 = Vector<double, 1>;
using V3 = Vector<double, 3>;

constexpr double gravity = 9.81;
const double near_top = std::numbers::pi - 1e-8;
/// How far from the top that is, in spite of the rounding of pi.
const double distance = double(std::numbers::pi_v<long double> - static_cast<long double>(near_top));

/// From rest at that distance from the top to the bottom: K(cos(d/2)) / w0, by the arithmetic-geometric mean of one and
/// the complementary modulus sin(d/2).
double exact_fall() {
  double a = 1;
  double b = std::sin(distance / 2);
  for (int k = 0; k < 20; ++k) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi / 2 / a / std::sqrt(gravity);
}

/// The fall by `advance`, which makes a step and gives (q, p): time at the bottom, by the cubic Hermite polynomial.
double fall_time(double h, const std::function<std::array<double, 2>()>& advance) {
  std::array<double, 2> before{near_top, 0};
  for (int k = 0; k < 10'000'000; ++k) {
    const auto now = advance();
    if (!std::isfinite(now[0]) || std::abs(now[0]) > 10) return not_a_number;
    if (now[0] <= 0) {
      const auto at = [&](double s) {
        return (1 + 2 * s) * (1 - s) * (1 - s) * before[0] + s * (1 - s) * (1 - s) * h * before[1] +
               s * s * (3 - 2 * s) * now[0] - s * s * (1 - s) * h * now[1];
      };
      double low = 0;
      double high = 1;
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (low + high);
        (at(middle) > 0 ? low : high) = middle;
      }
      return h * (k + low);
    }
    before = now;
  }
  return not_a_number;
}
std::function<std::array<double, 2>()> falling(double h, const IntegratorOptions& options) {
  Pendulum system;
  system.gravity = gravity;
  system.h = h;
  const State<Pair<1>> start{V1(near_top), V1(0.0)};
  std::shared_ptr<Integrator<Pendulum>> integrator =
      make_integrator(system, start, system.groupoid.unit(start.object), options);
  return [integrator]() -> std::array<double, 2> {
    if (!integrator->advance().converged()) return {not_a_number, not_a_number};
    return {integrator->point().state.object(0), integrator->point().state.momentum(0)};
  };
}
double fall_error(double h, const std::function<std::array<double, 2>()>& advance) {
  return std::abs(fall_time(h, advance) / exact_fall() - 1);
}
/// q' = p, p' = -g sin q.
std::function<std::array<double, 2>()> explicit_euler(double h) {
  auto state = std::make_shared<std::array<double, 2>>(std::array<double, 2>{near_top, 0});
  return [state, h] {
    auto& [q, p] = *state;
    const double force = -gravity * std::sin(q);
    q += h * p;
    p += h * force;
    return *state;
  };
}

/// p^2 / 2 - 2 g sin^2(d/2), d the angle from the top: the energy above that of the top, without cancellation, while
/// the pendulum is within a thousandth of a radian; its largest change, relative to its terms.
double energy_near_top(double h, const std::function<std::array<double, 2>()>& advance) {
  const double first = -2 * gravity * std::pow(std::sin(distance / 2), 2);
  double worst = 0;
  for (int k = 0; k * h < 10; ++k) {
    const auto [q, p] = advance();
    const double d = double(std::numbers::pi_v<long double> - static_cast<long double>(q));
    if (!(d < 1e-3)) return worst;
    const double above = 0.5 * p * p - 2 * gravity * std::pow(std::sin(d / 2), 2);
    worst = worse(worst, std::abs(above - first) / (0.5 * p * p - first));
  }
  return not_a_number;
}

/// The bob of hard_k1_inverted of shared/cases/spherical-pendulum-chain.json: at rest 1e-8 from the top, after 5 s.
double inverted_bob(const Composition& composition, double h) {
  SphericalPendulum system;
  system.gravity = gravity;
  system.h = h;
  const State<Pair<3>> start{{9.55336489125606e-09, 2.955202066613396e-09, 1.0}, V3(0, 0, 0)};
  IntegratorOptions options;
  options.composition = composition;
  const auto integrator = make_integrator(system, start, system.groupoid.unit(start.object), options);
  for (long k = 0; k < std::lround(5 / h); ++k)
    if (!integrator->advance().converged()) return not_a_number;
  return (integrator->point().state.object - V3(0.03022011531581563, 0.00934817713456474, 0.9994995528836217)).norm();
}

/// A bob that passes a pole at about `miss`: the largest errors of the angular momentum about the vertical, relative to
/// l |p|, and of the rod.
double passing(double miss, bool upper) {
  SphericalPendulum system;
  system.gravity = gravity;
  system.h = 0.002;
  const V3 q(miss, 0.1, upper ? 1 : -1);
  const V3 at = q.normalized();
  const V3 along = V3(0, -1, 0) - V3(0, -1, 0).dot(at) * at;
  const State<Pair<3>> start{at, V3(8 * along.normalized())};
  const double j = at(0) * start.momentum(1) - at(1) * start.momentum(0);
  const auto integrator = make_integrator(system, start, system.groupoid.unit(start.object), {});
  double worst = 0;
  for (int k = 0; k < 20'000; ++k) {
    if (!integrator->advance().converged()) return not_a_number;
    const State<Pair<3>>& state = integrator->point().state;
    const V3 p = tangent_momentum(system, state);
    worst = worse(worst, std::abs(state.object(0) * p(1) - state.object(1) * p(0) - j) / p.norm());
    worst = worse(worst, std::abs(state.object.norm() - 1));
  }
  return worst;
}
/// The same by Runge-Kutta in the polar angle and the azimuth: theta'' = sin cos phi'^2 - g sin, phi' = J / sin^2;
/// error of the energy.
double passing_in_angles(double miss, bool upper) {
  const V3 at = V3(miss, 0.1, upper ? 1 : -1).normalized();
  const V3 along = V3(0, -1, 0) - V3(0, -1, 0).dot(at) * at;
  const V3 p = 8 * along.normalized();
  const double j = at(0) * p(1) - at(1) * p(0);
  const Field equations = [j](const Eigen::VectorXd& y) {
    const double s = std::sin(y(0));
    Eigen::VectorXd out(2);
    out << y(1), j * j * std::cos(y(0)) / (s * s * s) - gravity * s;
    return out;
  };
  const auto energy = [j](const Eigen::VectorXd& y) {
    const double s = std::sin(y(0));
    return 0.5 * y(1) * y(1) + 0.5 * j * j / (s * s) - gravity * std::cos(y(0));
  };
  Eigen::VectorXd y(2);  // from the bottom
  const double sine = at.head<2>().norm();
  y << std::atan2(sine, -at(2)), at.head<2>().dot(p.head<2>()) / sine / -at(2);
  const double first = energy(y);
  double worst = 0;
  for (int k = 0; k < 20'000; ++k) {
    y = runge_kutta_step(equations, y, 0.002);
    worst = worse(worst, std::abs(energy(y) / first - 1));
  }
  return worst;
}

IntegratorOptions composed(const Composition& composition, bool splitting) {
  IntegratorOptions options;
  options.composition = composition;
  options.fixed = splitting ? StepKind::splitting : StepKind::variational;
  return options;
}

}  // namespace

std::vector<HardCase> pendulums() {
  return {
      {"FallFromTheTop", "pendulum at rest 1e-8 from the top, order 8 by splitting and by composed implicit steps",
       "relative error of the time of fall, against K of its modulus", "explicit Euler with a tenth of the step", 1e-7,
       [] {
         return worse(fall_error(0.02, falling(0.02, composed(compositions::kahan_li_8, true))),
                      fall_error(0.02, falling(0.02, composed(compositions::kahan_li_8, false))));
       },
       [] { return fall_error(0.002, explicit_euler(0.002)); }},
      {"FallByPlainSteps", "the same by steps of order 2, h = 0.001", "relative error of the time of fall",
       "explicit Euler in the same steps", 2e-6, [] { return fall_error(0.001, falling(0.001, {})); },
       [] { return fall_error(0.001, explicit_euler(0.001)); }},
      {"EnergyNearTheTop", "the same, within 1e-3 of the top",
       "change of the energy above the top, relative to its terms", "explicit Euler with a tenth of the step", 2e-7,
       [] { return energy_near_top(0.02, falling(0.02, composed(compositions::kahan_li_8, true))); },
       [] { return energy_near_top(0.002, explicit_euler(0.002)); }},
      {"SphericalFromTheTop", "spherical pendulum 1e-8 from the top, 5 s, errors grown 1e7 times; order 8",
       "error of the bob, m, against 20 digits", "order 2 in the same steps", 1e-6,
       [] { return inverted_bob(compositions::kahan_li_8, 0.02); },
       [] { return inverted_bob(compositions::single, 0.02); }},
      {"PassingTheLowerPole", "spherical pendulum, 1e-6 from the lower pole, 2e4 steps",
       "errors of the vertical momentum over l |p| and of the rod",
       "Runge-Kutta of order 4 in polar angles: its energy", 1e-13, [] { return passing(1e-6, false); },
       [] { return passing_in_angles(1e-6, false); }},
      {"PassingTheUpperPole", "spherical pendulum, 1e-6 from the upper pole, 2e4 steps",
       "errors of the vertical momentum over l |p| and of the rod",
       "Runge-Kutta of order 4 in polar angles: its energy", 1e-13, [] { return passing(1e-6, true); },
       [] { return passing_in_angles(1e-6, false); }},
  };
}

}  // namespace lagroid::hard
