#pragma once
/// The scene that effects are added to: what it holds costs the same whether or not they exist.

#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace effects {

using namespace lagroid::multibody;

/// Two bodies that turn, hinged by a ball joint, and two points on a rod.
struct Base {
  Scene scene;
  Body left, right, near, far;

  Base() {
    const Quaternion upright(1, 0, 0, 0);
    left = scene.rigid_body(1, {0.1, 0.2, 0.25}, {0, 0, 0}, upright, {0, 0.1, 0}, {0, 0, 0});
    right = scene.rigid_body(2, {0.3, 0.2, 0.25}, {1, 0, 0}, upright, {0, 0.1, 0}, {0, 0, 0});
    near = scene.point_mass(0.5, {0.5, 1, 0}, {0.1, 0, 0});
    far = scene.point_mass(0.5, {0.5, 2, 0}, {-0.1, 0, 0});
    scene.add(Coincidence{{scene.point_of(left, {0.5, 0, 0}), scene.point_of(right, {-0.5, 0, 0})}});
    scene.add(Rod{{near.centre, far.centre}, 1});
  }
};

/// Integrates the scene, and prints what memory it takes.
inline int integrate(Scene scene, long steps) {
  Multibody motion(std::move(scene), 0.001);
  std::printf("memory %zu\n", motion.memory());
  for (long k = 0; k < steps; ++k)
    if (!motion.advance().converged()) return 1;
  return 0;
}

}  // namespace effects
