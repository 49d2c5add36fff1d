// Boundary values whose step sizes are part of the path: [G] Example 6.1 with the energy equation that has the
// multiplier's term, against a transcription and a solve of our own.
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/solvers/boundary/times/free_steps.hpp>
#include <lagroid/systems/control/group_control.hpp>

#include "paths.hpp"
#include "root.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace lagroid;

namespace free_steps_control_tests {
namespace {

using Vector3 = Vector<double, 3>;
using Vector4 = Vector<double, 4>;
using Matrix3 = Matrix<double, 3, 3>;

/// [G] Example 6.1 on SO(3): l = (w1^2 + 2 w2^2) / 2 and w3 = spin, so that psi is not homogeneous.
struct SpinningControl : GroupControl<SpinningControl, SO3, 1> {
  double spin = 0.7;
  template <class S> S l(const Vector<S, 3>& w) const { return (w(0) * w(0) + w(1) * w(1) * 2.0) * 0.5; }
  template <class S> Vector<S, 1> psi(const Vector<S, 3>& w) const { return Vector<S, 1>(w(2) - spin); }
};
const Vector3 turn(0.9, 0.6, 0.8);  // from end to end, in unit time

SpinningControl control(std::size_t steps, double duration, Retraction map) {
  SpinningControl system;
  system.map = map;
  system.h = duration / double(steps);
  return system;
}

TimedSolution<SpinningControl> free_control(std::size_t steps, Retraction map = Retraction::exponential,
                                            double duration = 1) {
  return free_steps(control(steps, duration, map), SO3::retract(Retraction::exponential, turn), steps);
}

/// Transcription of the same problem that shares nothing with the library: unit quaternions by the implicit midpoint
/// rule, controls constant on each of `count` equal intervals, and the conditions of a stationary cost. With Omega(w) p
/// = p (0, w) the defects q' - q = (h / 2) Omega(w) m, m = (q + q') / 2, have costates lambda, and with r the costates
/// of the nodes lambda = (1 - h Omega / 4)^{-1} r, r' = (1 + h Omega / 4) lambda, W_i w_i = lambda.Omega_i m / 2.
struct Transcription {
  static Vector4 omega(const Vector3& w, const Vector4& p) {
    Vector4 out;
    out(0) = -p.tail<3>().dot(w);
    out.tail<3>() = p(0) * w + p.tail<3>().cross(w);
    return out;
  }
  static Vector4 half(const Vector3& w, double h, const Vector4& p) {  // (1 - h Omega / 4)^{-1} p: Omega^2 = -|w|^2
    const double a = h / 4;
    return (p + a * omega(w, p)) / (1 + a * a * w.squaredNorm());
  }

  /// Cost and energy, -d(cost)/dT.
  static Vector<double, 2> solve(int count) {
    const double h = 1.0 / count;
    const Vector3 weights(1, 2, 0);
    const Eigen::Quaterniond goal(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    double cost = 0;
    double energy = 0;
    const auto miss = [&](const Vector3& costate) -> Vector3 {
      Vector4 q(1, 0, 0, 0);
      Vector4 r(0, 2 * costate(0), 2 * costate(1), 2 * costate(2));
      Vector3 w(costate(0), costate(1) / 2, 0.7);
      cost = energy = 0;
      for (int k = 0; k < count; ++k) {
        Vector4 m;
        Vector4 lambda;
        for (int iteration = 0; iteration < 8; ++iteration) {
          m = half(w, h, q);
          lambda = half(w, h, r);
          for (int i = 0; i < 2; ++i) w(i) = lambda.dot(omega(Vector3::Unit(i), m)) / 2 / weights(i);
        }
        const double l = 0.5 * w.dot(weights.cwiseProduct(w));
        cost += h * l;
        energy += h * (lambda.dot(omega(w, m)) / 2 - l);
        q = 2 * half(w, h, q) - q;
        r = 2 * half(w, h, r) - r;
      }
      return (goal.conjugate() * Eigen::Quaterniond(q(0), q(1), q(2), q(3))).vec();
    };
    const Vector3 costate = root<3>(miss, Vector3(0.9, 1.2, 0.5));
    EXPECT_LT(miss(costate).norm(), 1e-13);
    return {cost, energy};
  }
};

// Against forty times as many nodes and more, extrapolated.
TEST(FreeSteps, CostAndEnergyAreThoseOfAnIndependentTranscriptionToOrderTwo) {
  std::vector<Vector<double, 2>> transcribed;
  for (const int count : {400, 800, 1600}) transcribed.push_back(Transcription::solve(count));
  const Vector<double, 2> exact = extrapolated(transcribed);
  ASSERT_LT((transcribed[2] - transcribed[0]).norm(), 1e-4);
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    std::vector<Vector<double, 2>> found;
    std::vector<Vector<double, 2>> errors;
    for (const std::size_t steps : {10, 20, 40, 80, 160}) {
      const auto path = free_control(steps, map);
      ASSERT_TRUE(path.converged()) << path.message;
      found.emplace_back(path.cost, path.energy);
      errors.push_back((found.back() - exact).cwiseAbs());
    }
    const Vector<double, 2> limit = extrapolated(found);
    for (int i = 0; i < 2; ++i) {
      EXPECT_LT(errors[2](i), 3e-3);
      EXPECT_NEAR(limit(i), exact(i), 1e-10);
      EXPECT_NEAR(std::log2(errors[0](i) / errors[1](i)), 2, 0.1);
      EXPECT_NEAR(std::log2(errors[1](i) / errors[2](i)), 2, 0.05);
    }
  }
}

/// The discrete equations of the Cayley map by hand: F-+ = mu +- (h / 2) w x mu + (h^2 / 4) (w.mu) w with
/// mu = W w + lambda e3, and E_d = l(w) + lambda spin. From a momentum and E_d, arrow by arrow.
struct ByHand {
  struct Arrow {
    Vector3 w;
    double lambda;
    double h;
  };
  static Vector3 momentum(const Arrow& a, double sign) {
    const Vector3 mu(a.w(0), 2 * a.w(1), a.lambda);
    return mu + sign * a.h / 2 * a.w.cross(mu) + a.h * a.h / 4 * a.w.dot(mu) * a.w;
  }
  static Matrix3 hat(const Vector3& w) {
    Matrix3 out;
    out << 0, -w(2), w(1), w(2), 0, -w(0), -w(1), w(0), 0;
    return out;
  }

  /// The arrows that start with this momentum and have this energy; the steps are near `h`.
  static std::vector<Arrow> march(const Vector4& from, std::size_t steps, double h) {
    Vector3 m = from.head<3>();
    Vector4 x(m(0), m(1) / 2, m(2), h);
    std::vector<Arrow> out;
    for (std::size_t k = 0; k < steps; ++k) {
      x = root<4>(
          [&](const Vector4& y) {
            const Arrow a{{y(0), y(1), 0.7}, y(2), y(3)};
            Vector4 off;
            off.head<3>() = momentum(a, 1) - m;
            off(3) = 0.5 * (a.w(0) * a.w(0) + 2 * a.w(1) * a.w(1)) + 0.7 * a.lambda - from(3);
            return off;
          },
          x);
      out.push_back({{x(0), x(1), 0.7}, x(2), x(3)});
      m = momentum(out.back(), -1);
    }
    return out;
  }
  /// What the end of the march misses of the rotation and of the time.
  static Vector4 miss(const std::vector<Arrow>& arrows) {
    Matrix3 at = Matrix3::Identity();
    double time = 0;
    for (const auto& a : arrows) {
      const Matrix3 x = a.h / 2 * hat(a.w);
      at = at * (Matrix3::Identity() - x).inverse() * (Matrix3::Identity() + x);
      time += a.h;
    }
    const Matrix3 off = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix().transpose() * at;
    return {off(2, 1) - off(1, 2), off(0, 2) - off(2, 0), off(1, 0) - off(0, 1), time - 1};
  }
};

TEST(FreeSteps, AreThoseOfAnIndependentSolveOfAsManyArrows) {
  constexpr std::size_t steps = 8;
  const auto path = free_control(steps, Retraction::cayley);
  ASSERT_TRUE(path.converged()) << path.message;
  const SpinningControl system = control(steps, path.times[1] * double(steps), Retraction::cayley);
  Vector4 start;
  start << legendre_minus(system, path.path.front()).momentum, path.energy;
  const Vector4 near = start + 1e-4 * Vector4(1, -1, 1, 1);
  const auto march = [&](const Vector4& from) { return ByHand::march(from, steps, path.times[1]); };
  const auto found = march(root<4>([&](const Vector4& from) { return ByHand::miss(march(from)); }, near));
  EXPECT_LT(ByHand::miss(found).norm(), 1e-12);
  EXPECT_GT(ByHand::miss(march(near)).norm(), 1e-6);
  double unequal = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    EXPECT_NEAR(path.times[k + 1] - path.times[k], found[k].h, 1e-9);
    EXPECT_NEAR(path.path[k].multipliers(0), found[k].lambda, 1e-9);
    unequal = std::max(unequal, std::abs(found[k].h - 1.0 / steps));
  }
  EXPECT_GT(unequal, 1e-3);
}

TEST(FreeSteps, HaveTheSameEnergyOnAllArrows) {
  const ArrowOf<SO3> goal = SO3::retract(Retraction::exponential, turn);
  for (const auto map : {Retraction::exponential, Retraction::cayley})
    for (const std::size_t steps : {10, 100}) {
      const SpinningControl system = control(steps, 1, map);
      const auto equal = equal_steps(system, goal, steps);
      const auto free = solve_free_steps(system, goal, equal);
      expect_one_energy(system, free);
      EXPECT_TRUE(free.kind.is_minimum);
      EXPECT_NEAR(free.times.back(), 1, 1e-14);
      // Equal steps have not, and the energy as the paper prints it, without <lambda, d phi / dh>, is not kept either.
      const auto [spread, size] = energy_spread(system, equal);
      EXPECT_GT(spread, 1e-6 * size);
      double least = std::numeric_limits<double>::infinity();
      double most = -least;
      for (const auto& step : free.path) {
        least = std::min(least, step.multipliers(0));
        most = std::max(most, step.multipliers(0));
      }
      EXPECT_GT(0.7 * (most - least), 1e-2);
    }
}

TEST(FreeSteps, EnergyIsTheCostateOfTheEndTime) {
  constexpr double by = 1e-3;
  const auto cost = [](double duration) { return free_control(16, Retraction::exponential, duration).cost; };
  const double energy = free_control(16).energy;
  EXPECT_NEAR((cost(1 + by) - cost(1 - by)) / (2 * by), -energy, 1e-4);
  EXPECT_NEAR((8 * (cost(1 + by) - cost(1 - by)) - (cost(1 + 2 * by) - cost(1 - 2 * by))) / (12 * by), -energy, 1e-8);
}

}  // namespace
}  // namespace free_steps_control_tests
