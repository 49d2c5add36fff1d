// Scenes of bodies: a chain against a kernel by hand, pendulums together and alone.
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include "comparison.hpp"
#include "kernels/spherical_chain.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace bench {

using lagroid::multibody::Body;
using lagroid::multibody::ConstantForce;
using lagroid::multibody::Multibody;
using lagroid::multibody::Rod;
using lagroid::multibody::Scene;
using lagroid::multibody::Site;
using lagroid::multibody::Vec;

namespace {

constexpr double gravity = 9.81;
constexpr const char* chain_20 = "chain of 20 links, a step";
constexpr const char* chain_growth = "chains, a step of one link";
constexpr const char* pendulums = "1000 pendulums, a step of one";

/// Places of a chain of length and mass 1, slanting and wound a little.
std::vector<Vec> wound(int links) {
  std::vector<Vec> out;
  Vec x = Vec::Zero();
  for (int i = 0; i < links; ++i) {
    const double turn = 0.6 * i / links;
    x += Vec(std::sin(1.2) * std::cos(turn), std::sin(1.2) * std::sin(turn), -std::cos(1.2)) / links;
    out.push_back(x);
  }
  return out;
}

void hang(Scene& scene, Site from, const std::vector<Vec>& places) {
  const auto links = double(places.size());
  Site last = from;
  for (const Vec& x : places) {
    const Body body = scene.point_mass(1 / links, x, Vec::Zero());
    scene.add(Rod{{last, body.centre}, 1 / links});
    scene.add(ConstantForce{{body.centre}, {0, 0, -gravity / links}});
    last = body.centre;
  }
}

std::shared_ptr<Multibody> chain(int links, double h) {
  Scene scene;
  hang(scene, scene.ground(Vec::Zero()), wound(links));
  return std::make_shared<Multibody>(std::move(scene), h);
}

/// Steps of links: so many that `links` of them are one step of the scene.
Subject scene_steps(std::string group, std::string name, std::vector<std::shared_ptr<Multibody>> scenes, long links,
                    bool reference = false) {
  return {std::move(group), std::move(name),
          [scenes = std::move(scenes), links](benchmark::State& state) {
            bool good = true;
            timed(state, [&](long steps) {
              for (long k = 0; k < steps && good; k += links * long(scenes.size()))
                for (const auto& scene : scenes) good = good && scene->advance().converged();
            });
            if (!good) state.SkipWithError("a step failed");
          },
          reference};
}

void add_chains(std::vector<Subject>& out) {
  constexpr int links = 20;
  constexpr double h = 1e-3;
  std::vector<kernels::Triple> places;
  for (const Vec& x : wound(links)) places.emplace_back(x);
  auto kernel = std::make_shared<kernels::SphericalChain>(h, 1.0 / links, 1.0 / links, gravity, places);
  out.push_back({chain_20, "by hand",
                 [kernel](benchmark::State& state) {
                   bool good = true;
                   timed(state, [&](long steps) {
                     for (long k = 0; k < steps && good; ++k) good = kernel->step();
                   });
                   if (!good) state.SkipWithError("a step failed");
                 },
                 true});
  out.push_back(scene_steps(chain_20, "scene", {chain(links, h)}, 1));
  for (const int n : {20, 100, 1000})
    out.push_back(scene_steps(chain_growth, fmt::format("{} links", n), {chain(n, 2e-2 / n)}, n, n == 20));
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
  out.push_back(scene_steps(pendulums, "a scene each", std::move(single), 1, true));
  out.push_back(scene_steps(pendulums, "one scene", {std::make_shared<Multibody>(std::move(together), 0.01)}, count));
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
          {chain_growth, "1000 links", "20 links", 1.5},
          {pendulums, "one scene", "a scene each", 1.1}};
}

}  // namespace bench
