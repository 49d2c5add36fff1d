// [G] Example 6.2 as optimal control with steps that are part of its paths, against solves that share nothing with the
// library: the extremals of continuous time, and the discrete equations of the Cayley form by hand.
#include <lagroid/solvers/boundary/times/free_steps.hpp>
#include <lagroid/systems/control/plate_ball.hpp>

#include "paths.hpp"
#include "root.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace lagroid;

namespace free_steps_plate_ball_tests {
namespace {

using Vector2 = Vector<double, 2>;
using Vector3 = Vector<double, 3>;
using Vector5 = Vector<double, 5>;
using Vector6 = Vector<double, 6>;

constexpr double radius = 0.8;
constexpr double rate = 0.5;
constexpr double spin = 0.4;
constexpr double duration = 1.5;
const Vector2 from(0.2, -0.1);
const Vector2 to(1.0, 0.5);
const Vector3 turn(0.5, 0.6, 0.7);
const Eigen::Quaterniond goal(Eigen::AngleAxisd(turn.norm(), turn.normalized()));

PlateBall plate_ball(std::size_t steps) {
  PlateBall system;
  system.radius = radius;
  system.plate_rate = rate;
  system.spin = spin;
  system.rotation = RotationForm::cayley;
  system.h = duration / double(steps);
  return system;
}
TimedSolution<PlateBall> free_path(std::size_t steps) {
  return free_steps(plate_ball(steps), {PairArrow<double, 2>{from, to}, goal.toRotationMatrix()}, steps);
}

/// Pontryagin's equations in unit quaternions by the classical Runge-Kutta method.
struct Extremal {
  using State = Vector<double, 12>;  // x, y, px, py, M, quaternion, cost

  static Vector2 velocity(const State& s) { return {s(2) + s(5) / radius, s(3) - s(4) / radius}; }
  static double energy(const State& s) {
    return velocity(s).squaredNorm() / 2 + rate * (s(4) * s(0) + s(5) * s(1)) / radius + spin * s(6);
  }
  static State slope(const State& s) {
    const Vector2 v = velocity(s);
    const Vector3 w((rate * s(0) - v(1)) / radius, (v(0) + rate * s(1)) / radius, spin);
    const Vector3 axis = s.segment<3>(8);
    State out;
    out << v, -rate * s(4) / radius, -rate * s(5) / radius, s.segment<3>(4).cross(w), -axis.dot(w) / 2,
        (s(7) * w + axis.cross(w)) / 2, v.squaredNorm() / 2;
    return out;
  }
  static State end(const Vector5& momentum, int count) {
    State s;
    s << from, momentum, 1, 0, 0, 0, 0;
    const double h = duration / count;
    for (int k = 0; k < count; ++k) {
      const State a = slope(s);
      const State b = slope(s + h / 2 * a);
      const State c = slope(s + h / 2 * b);
      s += h / 6 * (a + 2 * b + 2 * c + slope(s + h * c));
    }
    return s;
  }
  static Vector5 miss(const State& end) {
    Vector5 out;
    out << end.head<2>() - to,
        (goal.conjugate() * Eigen::Quaterniond(end(7), end(8), end(9), end(10)).normalized()).vec();
    return out;
  }
  /// Cost and energy of the extremal near this momentum.
  static Vector2 solve(const Vector5& near) {
    constexpr int count = 2000;
    const Vector5 momentum = root<5>([](const Vector5& p) { return miss(end(p, count)); }, near);
    const State last = end(momentum, count);
    EXPECT_LT(miss(last).norm(), 1e-12);
    return {last(11), energy(last)};
  }
};

TEST(FreeStepsOfThePlateBall, HaveCostAndEnergyOfTheExtremalToOrderTwoAndExtrapolated) {
  std::vector<Vector2> found;
  Vector5 momentum;
  for (const std::size_t steps : {20, 40, 80, 160}) {
    const auto path = free_path(steps);
    expect_one_energy(plate_ball(steps), path);
    auto system = plate_ball(steps);
    system.h = path.times[1];
    momentum = legendre_minus(system, path.path.front()).momentum;
    found.emplace_back(path.cost, path.energy);
  }
  const Vector2 exact = Extremal::solve(momentum);
  const Vector2 limit = extrapolated(found);
  for (int i = 0; i < 2; ++i) {
    for (const std::size_t k : {1, 2})
      EXPECT_NEAR(std::log2(std::abs((found[k](i) - exact(i)) / (found[k + 1](i) - exact(i)))), 2, 0.1);
    EXPECT_GT(std::abs(found[3](i) - exact(i)), 1e-6);
    EXPECT_NEAR(limit(i), exact(i), 1e-9);
  }
}

/// The discrete equations with nu = (r l1, -r l2, -l3): M-+ = nu +- w x nu / 2 + (w.nu) w / 4.
struct ByHand {
  struct Arrow {
    Vector2 end;
    Vector3 lambda;
    double h;
    Vector3 w;
  };
  struct Node {
    Vector2 place;
    Vector2 p;
    Vector3 body;
  };
  static Vector3 momentum(const Arrow& a, double sign) {
    const Vector3 nu(radius * a.lambda(0), -radius * a.lambda(1), -a.lambda(2));
    return nu + sign / 2 * a.w.cross(nu) + a.w.dot(nu) / 4 * a.w;
  }

  static std::vector<Arrow> march(const Vector6& start, std::size_t steps, const TimedSolution<PlateBall>& near) {
    Node node{from, start.head<2>(), start.segment<3>(2)};
    std::vector<Arrow> out;
    for (std::size_t k = 0; k < steps; ++k) {
      const auto arrow_of = [&](const Vector6& y) {
        Arrow a{y.head<2>(), y.segment<3>(2), y(5), {}};
        const Vector2 move = a.end - node.place;
        const Vector2 middle = (a.end + node.place) / 2;
        a.w << (a.h * rate * middle(0) - move(1)) / radius, (move(0) + a.h * rate * middle(1)) / radius, a.h * spin;
        return a;
      };
      const auto off = [&](const Vector6& y) {
        const Arrow a = arrow_of(y);
        const Vector2 v = (a.end - node.place) / a.h;
        const Vector2 middle = (a.end + node.place) / 2;
        Vector6 rest;
        rest << v(0) + a.lambda(1) + a.h * rate / 2 * a.lambda(0) - node.p(0),
            v(1) + a.lambda(0) - a.h * rate / 2 * a.lambda(1) - node.p(1), momentum(a, 1) - node.body,
            v.squaredNorm() / 2 + rate * (a.lambda(0) * middle(0) - a.lambda(1) * middle(1)) - spin * a.lambda(2) -
                start(5);
        return rest;
      };
      Vector6 guess;
      guess << std::get<0>(near.path[k].arrow).target, near.path[k].multipliers, near.times[k + 1] - near.times[k];
      const Arrow a = arrow_of(root<6>(off, guess));
      node.p += a.h * rate * Vector2(-a.lambda(0), a.lambda(1));
      node.body = momentum(a, -1);
      node.place = a.end;
      out.push_back(a);
    }
    return out;
  }
  static Vector6 miss(const std::vector<Arrow>& arrows) {
    Eigen::Quaterniond at = goal.conjugate();
    double time = 0;
    for (const auto& a : arrows) {
      at = (at * Eigen::Quaterniond(1, a.w(0) / 2, a.w(1) / 2, a.w(2) / 2)).normalized();
      time += a.h;
    }
    Vector6 out;
    out << arrows.back().end - to, at.vec(), time - duration;
    return out;
  }
};

TEST(FreeStepsOfThePlateBall, AreThoseOfAnIndependentSolveOfAsManyArrows) {
  constexpr std::size_t steps = 10;
  const auto path = free_path(steps);
  ASSERT_TRUE(path.converged()) << path.message;
  PlateBall first = plate_ball(steps);
  first.h = path.times[1];
  Vector6 start;
  start << legendre_minus(first, path.path.front()).momentum, path.energy;
  Vector6 near = start;
  near += 1e-4 * Vector6(1, -1, 1, 1, -1, 1);
  const auto march = [&](const Vector6& momenta) { return ByHand::march(momenta, steps, path); };
  const auto found = march(root<6>([&](const Vector6& momenta) { return ByHand::miss(march(momenta)); }, near));
  EXPECT_LT(ByHand::miss(found).norm(), 1e-11);
  EXPECT_GT(ByHand::miss(march(near)).norm(), 1e-6);
  double unequal = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    EXPECT_NEAR(path.times[k + 1] - path.times[k], found[k].h, 1e-9);
    EXPECT_LT((path.path[k].multipliers - found[k].lambda).norm(), 1e-8);
    unequal = std::max(unequal, std::abs(found[k].h * steps / duration - 1));
  }
  EXPECT_GT(unequal, 1e-2);
}

}  // namespace
}  // namespace free_steps_plate_ball_tests
