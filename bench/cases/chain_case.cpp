#include "chain_case.hpp"

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>

#include <cmath>
#include <utility>

namespace bench {

using namespace lagroid::multibody;

std::vector<Vec> wound_chain(int links) {
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

std::shared_ptr<Multibody> hanging_chain(int links, double h, const Options& options) {
  Scene scene;
  hang(scene, scene.ground(Vec::Zero()), wound_chain(links));
  return std::make_shared<Multibody>(std::move(scene), h, options);
}

kernels::SphericalChain chain_kernel(int links, double h) {
  std::vector<kernels::Triple> places;
  for (const Vec& x : wound_chain(links)) places.emplace_back(x);
  return {h, 1.0 / links, 1.0 / links, gravity, std::move(places)};
}

}  // namespace bench
