// Scenes of bodies: a chain against a kernel by hand, pendulums together and alone.
#include "../cases/chain_case.hpp"
#include "../report/comparison.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

namespace bench {

using lagroid::multibody::Multibody;
using lagroid::multibody::Scene;
using lagroid::multibody::Vec;

namespace {

constexpr const char* chain_20 = "chain of 20 links, a step";
constexpr const char* chain_growth = "1000 links, a step of all";
constexpr const char* pendulums = "1000 pendulums, a step of all";

/// A step of all the scenes.
Subject scene_steps(std::string group, std::string name, std::vector<std::shared_ptr<Multibody>> scenes,
                    bool reference = false) {
  return {std::move(group), std::move(name),
          [scenes = std::move(scenes)](benchmark::State& state) {
            bool good = true;
            timed(state, [&](long steps) {
              for (long k = 0; k < steps; ++k)
                for (const auto& scene : scenes) good = good && scene->advance().converged();
            });
            if (!good) state.SkipWithError("a step failed");
          },
          reference};
}

void add_chains(std::vector<Subject>& out) {
  constexpr int links = 20;
  constexpr double h = 1e-3;
  auto kernel = std::make_shared<kernels::SphericalChain>(chain_kernel(links, h));
  out.push_back({chain_20, "by hand",
                 [kernel](benchmark::State& state) {
                   bool good = true;
                   timed(state, [&](long steps) {
                     for (long k = 0; k < steps && good; ++k) good = kernel->step();
                   });
                   if (!good) state.SkipWithError("a step failed");
                 },
                 true});
  out.push_back(scene_steps(chain_20, "scene", {hanging_chain(links, h)}));
  for (const int n : {20, 100, 1000}) {
    std::vector<std::shared_ptr<Multibody>> chains;
    for (int k = 0; k < 1000 / n; ++k) chains.push_back(hanging_chain(n, 2e-2 / n));
    out.push_back(scene_steps(chain_growth, fmt::format("chains of {}", n), std::move(chains), n == 20));
  }
}

void add_pendulums(std::vector<Subject>& out) {
  constexpr int count = 1000;
  std::vector<std::shared_ptr<Multibody>> single;
  Scene together;
  for (int i = 0; i < count; ++i) {
    const Vec bob = Vec(std::sin(0.3 + 0.002 * i), 0, -std::cos(0.3 + 0.002 * i));
    Scene alone;
    hang(alone, alone.ground(Vec::Zero()), {bob});
    single.push_back(std::make_shared<Multibody>(std::move(alone), 0.01));
    hang(together, together.ground(Vec::Zero()), {bob});
  }
  out.push_back(scene_steps(pendulums, "a scene each", std::move(single), true));
  out.push_back(scene_steps(pendulums, "one scene", {std::make_shared<Multibody>(std::move(together), 0.01)}));
}

}  // namespace

std::vector<Subject> scene_subjects() {
  std::vector<Subject> out;
  add_chains(out);
  add_pendulums(out);
  return out;
}

std::vector<Goal> scene_goals() {
  return {{chain_20, "scene", "by hand", 2.5},
          {chain_growth, "chains of 1000", "chains of 20", 1.5},
          {pendulums, "one scene", "a scene each", 1.1}};
}

}  // namespace bench
