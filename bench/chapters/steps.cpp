// One step of each system: by hand, by the framework, by Ceres; and the derivatives alone.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/ceres_step.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include "../kernels/kepler.hpp"
#include "../kernels/plate_ball/plate_ball.hpp"
#include "../kernels/plate_ball/plate_ball_derivatives.hpp"
#include "../kernels/plate_ball/plate_ball_newton.hpp"
#include "../kernels/rigid_body_derivatives.hpp"
#include "../kernels/so3_cayley.hpp"
#include "../kernels/spherical_pendulum.hpp"
#include "../report/comparison.hpp"

#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>

#include <memory>
#include <utility>

namespace bench {

using namespace lagroid;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using kernels::HandPlateBall;
using kernels::HandRigidBody;

namespace {

constexpr const char* by_framework = "framework";
constexpr const char* by_framework_with_hand = "framework, derivatives by hand";
constexpr const char* by_ceres = "Ceres, problem reused";

/// A hand-written kernel; its constructor has done what comes before the first step.
template <class Kernel> Subject kernel(std::string group, std::string name, Kernel start, bool reference = false) {
  auto kernel = std::make_shared<Kernel>(std::move(start));
  return {std::move(group), std::move(name),
          [kernel](benchmark::State& state) {
            timed(state, [&](long steps) {
              for (long k = 0; k < steps; ++k) kernel->step();
            });
          },
          reference};
}

/// The framework's step through a solver; it goes on from where the repetition before ended.
template <class Solver, class Sys>
Subject steps(std::string group, std::string name, const Sys& system, const State<typename Sys::GroupoidType>& start,
              const ArrowOf<typename Sys::GroupoidType>& configuration) {
  auto integrator =
      std::make_shared<FixedStepIntegrator<Sys>>(system, start, configuration, std::make_unique<Solver>());
  return {std::move(group), std::move(name), [integrator](benchmark::State& state) {
            bool good = true;
            timed(state, [&](long steps) {
              for (long k = 0; k < steps && good; ++k) good = integrator->advance().converged();
            });
            if (!good) state.SkipWithError("a step failed");
          }};
}

/// One evaluation of the derivatives. The arrow passes through memory, so that each one is made.
template <class F, class A>
Subject derivatives(std::string group, std::string name, F evaluate, A arrow, bool reference = false) {
  return {std::move(group), std::move(name),
          [evaluate, arrow](benchmark::State& state) {
            timed(state, [&](long steps) {
              for (long k = 0; k < steps; ++k) {
                const A* input = &arrow;
                benchmark::DoNotOptimize(input);
                const auto result = evaluate(*input);
                benchmark::DoNotOptimize(&result);
              }
            });
          },
          reference};
}

constexpr const char* body = "SO(3), Cayley, h = 0.01";
constexpr const char* ball = "plate-ball, trace form, h = 0.05";
constexpr const char* kepler_orbit = "Kepler, midpoint, h = 0.01";
constexpr const char* pendulum = "spherical pendulum, SHAKE, h = 0.01";
constexpr const char* body_derivatives = "SO(3), two-sided derivative alone";
constexpr const char* ball_derivatives = "plate-ball, two-sided derivative alone";
constexpr const char* by_hand = "by hand";
constexpr const char* by_hand_on_paper = "by hand, the momentum relation inverted on paper";
constexpr const char* by_hand_newton = "by hand, Newton on the same unknowns";

void add_body(std::vector<Subject>& out) {
  HandRigidBody hand;
  hand.h = 0.01;
  hand.rotation = RotationMap::cayley;
  const RigidBody& system = hand;
  State<SO3> start;
  start.momentum << 0.4, 1.9, -1.1;
  const Matrix3d one = Matrix3d::Identity();
  out.push_back(
      kernel(body, by_hand, kernels::So3Cayley<1>(system.h, system.inertia, start.momentum, one), /*reference=*/true));
  out.push_back(steps<NewtonStep<RigidBody>>(body, by_framework, system, start, one));
  out.push_back(steps<NewtonStep<HandRigidBody>>(body, by_framework_with_hand, hand, start, one));
  out.push_back(steps<CeresStep<RigidBody>>(body, by_ceres, system, start, one));
  const Matrix3d turn = SO3::exp(Vector3d(0.01, -0.02, 0.03));
  const auto by = [&](const auto& s) { return [s](const Matrix3d& g) { return two_sided(s, g, {}); }; };
  out.push_back(derivatives(body_derivatives, by_hand, by(hand), turn, /*reference=*/true));
  out.push_back(derivatives(body_derivatives, "automatic", by(system), turn));
}

void add_ball(std::vector<Subject>& out) {
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
  out.push_back(kernel(ball, by_hand_newton, kernels::PlateBallNewton<4>(parameters, at), /*reference=*/true));
  out.push_back(kernel(ball, by_hand_on_paper, kernels::PlateBall<4>(parameters, at)));
  out.push_back(steps<NewtonStep<PlateBall>>(ball, by_framework, system, start, configuration));
  out.push_back(steps<NewtonStep<HandPlateBall>>(ball, by_framework_with_hand, hand, start, configuration));
  out.push_back(steps<CeresStep<PlateBall>>(ball, by_ceres, system, start, configuration));
  const ArrowOf<PlateBall::GroupoidType> roll{PairArrow<double, 2>{at.position, Vector2d(0.31, -0.18)},
                                              SO3::exp(Vector3d(0.01, -0.02, 0.03))};
  const Vector3d lambda(0.6, 0.4, -0.8);
  const auto by = [&](const auto& s) { return [s, lambda](const auto& g) { return two_sided(s, g, lambda); }; };
  out.push_back(derivatives(ball_derivatives, by_hand, by(hand), roll, /*reference=*/true));
  out.push_back(derivatives(ball_derivatives, "automatic", by(system), roll));
}

void add_points(std::vector<Subject>& out) {
  Kepler kepler;
  kepler.quadrature = Quadrature::midpoint;
  const State<Pair<2>> orbit{Vector2d(0.8, 0), Vector2d(0, 1.2)};
  out.push_back(kernel(kepler_orbit, by_hand, kernels::Kepler<1>(kepler.h, 1, orbit.object, orbit.momentum), true));
  out.push_back(steps<NewtonStep<Kepler>>(kepler_orbit, by_framework, kepler, orbit, {orbit.object, orbit.object}));
  out.push_back(steps<CeresStep<Kepler>>(kepler_orbit, by_ceres, kepler, orbit, {orbit.object, orbit.object}));

  const SphericalPendulum rod;
  const State<Pair<3>> swing{Vector3d(0.6, 0, -0.8), Vector3d(0.4, 0.9, 0.3)};
  out.push_back(kernel(
      pendulum, by_hand,
      kernels::SphericalPendulum(rod.h, rod.bob_mass, rod.length, rod.gravity, swing.object, swing.momentum), true));
  out.push_back(steps<NewtonStep<SphericalPendulum>>(pendulum, by_framework, rod, swing, {swing.object, swing.object}));
  out.push_back(steps<CeresStep<SphericalPendulum>>(pendulum, by_ceres, rod, swing, {swing.object, swing.object}));
}

}  // namespace

std::vector<Subject> step_subjects() {
  std::vector<Subject> out;
  add_body(out);
  add_ball(out);
  add_points(out);
  return out;
}

std::vector<Goal> step_goals() {
  return {{body, by_framework, by_framework_with_hand, 1.2},
          {ball, by_framework, by_framework_with_hand, 1.2},
          {body, by_framework, by_hand, 2},
          {ball, by_framework, by_hand_newton, 2},
          {ball, by_framework, by_hand_on_paper, 2},
          {pendulum, by_framework, by_hand, 3},
          {kepler_orbit, by_framework, by_hand, 1.5},
          {ball, by_ceres, by_framework, 40, /*at_least=*/true},
          {body, by_ceres, by_framework, 80, /*at_least=*/true}};
}

}  // namespace bench
