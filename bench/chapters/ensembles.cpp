// One step of one member of an ensemble: by Ensemble on one core and on two, by one integrator after another,
// by hand.
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include "../kernels/so3_cayley.hpp"
#include "../report/comparison.hpp"

#include <lagroid/systems/ensembles.hpp>

#include <array>
#include <memory>
#include <random>
#include <utility>

namespace bench {

using namespace lagroid;

namespace {

constexpr const char* in_batches = "Ensemble, one thread";
constexpr const char* on_two_threads = "Ensemble, two threads";
constexpr const char* one_by_one = "one integrator after another";
constexpr const char* by_hand = "one kernel by hand after another";
constexpr const char* cayley_bodies = "ensembles: 100000 rigid bodies, Cayley, h = 0.01";
constexpr const char* bodies = "ensembles: 100000 rigid bodies, exp, h = 0.01";
constexpr const char* balls = "ensembles: 10000 plate-balls, trace form, h = 0.05";
constexpr const char* pendulums = "ensembles: 100000 pendulums, midpoint, h = 0.01";

constexpr long at_once = 64;        ///< steps of an advance
constexpr std::size_t sample = 64;  ///< members that are integrated one by one: few, which favours them

std::mt19937_64& random_bits() {
  static std::mt19937_64 bits(20261123);
  return bits;
}
double normal() { return std::normal_distribution<double>()(random_bits()); }

/// `advance` takes `members` members through `at_once` steps; a unit of time is one step of one member.
Subject per_step(std::string group, std::string name, long members, std::function<bool()> advance,
                 bool reference = false) {
  return {std::move(group), std::move(name),
          [members, advance = std::move(advance)](benchmark::State& state) {
            bool good = true;
            while (state.KeepRunningBatch(members * at_once)) good = advance() && good;
            if (!good) state.SkipWithError("a step failed");
          },
          reference};
}

template <class Sys>
void add(std::vector<Subject>& out, const char* group, const Sys& system,
         const std::vector<State<typename Sys::GroupoidType>>& initial) {
  struct Late {  // made when it is first measured
    std::unique_ptr<Ensemble<Sys>> ensemble;
    long index = at_once;
  };
  const auto ensemble = std::make_shared<Late>();
  for (const int threads : {1, 2})
    out.push_back(per_step(group, threads == 1 ? in_batches : on_two_threads, long(initial.size()), [=] {
      EnsembleOptions<Sys> options;
      options.threads = threads;
      if (!ensemble->ensemble) {
        ensemble->ensemble = std::make_unique<Ensemble<Sys>>(system, initial);
        ensemble->ensemble->advance_to(ensemble->index, options);
      }
      return ensemble->ensemble->advance_to(ensemble->index += at_once, options) && ensemble->ensemble->failures() == 0;
    }));
  const auto alone = std::make_shared<std::vector<FixedStepIntegrator<Sys>>>();
  out.push_back(per_step(
      group, one_by_one, long(sample),
      [=] {
        if (alone->empty())
          for (std::size_t i = 0; i < sample; ++i)
            alone->emplace_back(system, initial[i], system.groupoid.unit(initial[i].object),
                                std::make_unique<NewtonStep<Sys>>());
        bool good = true;
        for (auto& integrator : *alone)
          for (long k = 0; k < at_once; ++k) good = integrator.advance().converged() && good;
        return good;
      },
      /*reference=*/true));
}

std::vector<State<SO3>> body_starts() {
  std::vector<State<SO3>> out(100000);
  for (auto& s : out) s.momentum << normal(), normal(), normal();
  return out;
}

}  // namespace

std::vector<Subject> ensemble_subjects() {
  std::vector<Subject> out;
  RigidBody body;
  add(out, bodies, body, body_starts());
  body.rotation = RotationMap::cayley;
  const auto starts = body_starts();
  add(out, cayley_bodies, body, starts);
  const auto kernels = std::make_shared<std::vector<kernels::So3Cayley<1>>>();
  for (std::size_t i = 0; i < sample; ++i)
    kernels->emplace_back(body.h, body.inertia, starts[i].momentum, Eigen::Matrix3d::Identity());
  out.push_back(per_step(cayley_bodies, by_hand, long(sample), [kernels] {
    for (auto& kernel : *kernels)
      for (long k = 0; k < at_once; ++k) kernel.step();
    return true;
  }));

  PlateBall ball;
  ball.spin = 0.4;
  std::vector<State<PlateBall::GroupoidType>> ball_starts(10000);
  for (auto& s : ball_starts) {
    std::get<0>(s.object) << normal(), normal();
    s.momentum << normal(), normal(), normal(), normal(), normal();
  }
  add(out, balls, ball, ball_starts);

  std::vector<State<Pair<1>>> pendulum_starts(100000);
  for (auto& s : pendulum_starts) {
    s.object(0) = normal();
    s.momentum(0) = normal();
  }
  add(out, pendulums, Pendulum{}, pendulum_starts);
  return out;
}

std::vector<Goal> ensemble_goals() {
  return {{bodies, one_by_one, in_batches, 5, /*at_least=*/true},
          {cayley_bodies, one_by_one, in_batches, 5, /*at_least=*/true},
          {balls, one_by_one, in_batches, 3, /*at_least=*/true},
          {pendulums, one_by_one, in_batches, 3, /*at_least=*/true},
          {cayley_bodies, in_batches, on_two_threads, 1.8, /*at_least=*/true}};
}

}  // namespace bench
