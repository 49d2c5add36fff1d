// Time per step of the hand-written kernels and of the framework, interleaved: minimum and median in nanoseconds.
#include <lagroid/solvers/integrator.hpp>
#include <lagroid/solvers/newton_step.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/spherical_pendulum.hpp>

#include "kernels/kepler.hpp"
#include "kernels/plate_ball.hpp"
#include "kernels/plate_ball_derivatives.hpp"
#include "kernels/rigid_body_derivatives.hpp"
#include "kernels/so3_cayley.hpp"
#include "kernels/spherical_pendulum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

using namespace lagroid;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using kernels::HandPlateBall;
using kernels::HandRigidBody;

namespace {

struct Subject {
  std::string name;
  std::function<void(int)> run;  // so many steps
  std::vector<double> times;
};

template <class Kernel> Subject subject(std::string name, Kernel kernel) {
  return {std::move(name),
          [kernel](int steps) mutable {
            for (int k = 0; k < steps; ++k) kernel.step();
          },
          {}};
}

template <class Sys>
Subject framework(std::string name, const Sys& system, const State<typename Sys::GroupoidType>& start,
                  const ArrowOf<typename Sys::GroupoidType>& configuration) {
  auto integrator =
      std::make_shared<Integrator<Sys>>(system, start, configuration, std::make_unique<NewtonStep<Sys>>());
  return {std::move(name),
          [integrator](int steps) {
            for (int k = 0; k < steps; ++k)
              if (!integrator->advance().converged()) throw std::runtime_error("a step failed");
          },
          {}};
}

/// One evaluation of the derivatives per step. The arrow passes through memory, so that each one is made.
template <class F, class A> Subject derivatives(std::string name, F evaluate, A arrow) {
  return {std::move(name),
          [evaluate, arrow](int steps) {
            for (int k = 0; k < steps; ++k) {
              const A* input = &arrow;
              asm volatile("" : "+r"(input) : : "memory");
              const auto result = evaluate(*input);
              asm volatile("" : : "r"(&result) : "memory");
            }
          },
          {}};
}

}  // namespace

int main() {
  std::vector<Subject> subjects;
  {
    HandRigidBody hand;
    hand.h = 0.01;
    hand.rotation = RotationMap::cayley;
    const RigidBody& system = hand;
    State<SO3> start;
    start.momentum << 0.4, 1.9, -1.1;
    const Matrix3d one = Matrix3d::Identity();
    subjects.push_back(
        subject("SO(3) kernel, last", kernels::So3Cayley<0>(system.h, system.inertia, start.momentum, one)));
    subjects.push_back(
        subject("SO(3) kernel, degree 1", kernels::So3Cayley<1>(system.h, system.inertia, start.momentum, one)));
    subjects.push_back(
        subject("SO(3) kernel, degree 2", kernels::So3Cayley<2>(system.h, system.inertia, start.momentum, one)));
    subjects.push_back(
        subject("SO(3) kernel, degree 3", kernels::So3Cayley<3>(system.h, system.inertia, start.momentum, one)));
    subjects.push_back(
        subject("SO(3) kernel, degree 4", kernels::So3Cayley<4>(system.h, system.inertia, start.momentum, one)));
    const Matrix3d turn = SO3::exp(Vector3d(0.01, -0.02, 0.03));
    subjects.push_back(derivatives(
        "SO(3) derivatives by hand", [hand](const Matrix3d& g) { return hand.two_sided(g, {}); }, turn));
    subjects.push_back(derivatives(
        "SO(3) derivatives, automatic", [system](const Matrix3d& g) { return automatic_two_sided(system, g, {}); },
        turn));
    subjects.push_back(framework("SO(3) framework", system, start, one));
    subjects.push_back(framework("SO(3) framework, hand derivatives", hand, start, one));
  }
  {
    HandPlateBall hand;
    hand.h = 0.05;
    hand.spin = 0.4;
    const PlateBall& system = hand;
    const kernels::PlateBallParameters parameters{hand.h, hand.radius, hand.plate_rate, hand.spin};
    const kernels::PlateBallState at{Vector2d(0.3, -0.2), Vector2d(0.9, 0.2), Vector3d(0.6, -0.4, 0.8),
                                     Matrix3d::Identity()};
    State<PlateBall::GroupoidType> start;
    std::get<0>(start.object) = at.position;
    start.momentum << at.linear_momentum, at.body_momentum;
    const ArrowOf<PlateBall::GroupoidType> configuration{PairArrow<double, 2>{at.position, at.position}, at.attitude};
    subjects.push_back(subject("plate-ball kernel, last", kernels::PlateBall<0>(parameters, at)));
    subjects.push_back(subject("plate-ball kernel, degree 1", kernels::PlateBall<1>(parameters, at)));
    subjects.push_back(subject("plate-ball kernel, degree 2", kernels::PlateBall<2>(parameters, at)));
    subjects.push_back(subject("plate-ball kernel, degree 3", kernels::PlateBall<3>(parameters, at)));
    subjects.push_back(subject("plate-ball kernel, degree 4", kernels::PlateBall<4>(parameters, at)));
    const ArrowOf<PlateBall::GroupoidType> roll{PairArrow<double, 2>{at.position, Vector2d(0.31, -0.18)},
                                                SO3::exp(Vector3d(0.01, -0.02, 0.03))};
    const Vector3d lambda(0.6, 0.4, -0.8);
    subjects.push_back(derivatives(
        "plate-ball derivatives by hand", [=](const auto& g) { return hand.two_sided(g, lambda); }, roll));
    subjects.push_back(derivatives(
        "plate-ball derivatives, automatic",
        [=](const auto& g) { return automatic_two_sided<PlateBall>(hand, g, lambda); }, roll));
    subjects.push_back(framework("plate-ball framework", system, start, configuration));
    subjects.push_back(framework("plate-ball framework, hand derivatives", hand, start, configuration));
  }
  {
    Kepler system;
    const State<Pair<2>> start{Vector2d(0.8, 0), Vector2d(0, 1.2)};
    subjects.push_back(subject("Kepler kernel, last", kernels::Kepler<0>(system.h, 1, start.object, start.momentum)));
    subjects.push_back(
        subject("Kepler kernel, degree 1", kernels::Kepler<1>(system.h, 1, start.object, start.momentum)));
    subjects.push_back(
        subject("Kepler kernel, degree 2", kernels::Kepler<2>(system.h, 1, start.object, start.momentum)));
    subjects.push_back(
        subject("Kepler kernel, degree 3", kernels::Kepler<3>(system.h, 1, start.object, start.momentum)));
    subjects.push_back(framework("Kepler framework", system, start, {start.object, start.object}));
  }
  {
    SphericalPendulum system;
    const State<Pair<3>> start{Vector3d(0.6, 0, -0.8), Vector3d(0.4, 0.9, 0.3)};
    subjects.push_back(subject("spherical pendulum kernel",
                               kernels::SphericalPendulum(system.h, 1, 1, 1, start.object, start.momentum)));
    subjects.push_back(framework("spherical pendulum framework", system, start, {start.object, start.object}));
  }

  using Clock = std::chrono::steady_clock;
  constexpr int rounds = 201;
  constexpr int steps = 500;
  for (int round = -5; round < rounds; ++round)
    for (Subject& s : subjects) {
      const auto begin = Clock::now();
      s.run(steps);
      const double ns = std::chrono::duration<double, std::nano>(Clock::now() - begin).count() / steps;
      if (round >= 0) s.times.push_back(ns);
    }
  fmt::print("{:<42}{:>10}{:>10}\n", "ns per step", "minimum", "median");
  for (Subject& s : subjects) {
    std::sort(s.times.begin(), s.times.end());
    fmt::print("{:<42}{:>10.1f}{:>10.1f}\n", s.name, s.times.front(), s.times[s.times.size() / 2]);
  }
}
