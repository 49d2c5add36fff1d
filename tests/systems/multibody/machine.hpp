#pragma once
/// A scene of bodies that many tests move, and how they move it.

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <gtest/gtest.h>

namespace lagroid::multibody_tests {

using namespace multibody;
using multibody::Vec;

inline const Quaternion upright{1, 0, 0, 0};

inline void advance(Multibody& scene, long steps) {
  for (long k = 0; k < steps; ++k) {
    const StepReport report = scene.advance();
    ASSERT_TRUE(report.converged()) << to_string(report.status) << " at step " << k << ", roundoff_ratio "
                                    << report.roundoff_ratio;
  }
}

inline double energy(const Multibody& scene) {
  return scene.kinetic_energy(scene.momenta()) + scene.potential_energy();
}

/// A box that hangs by a ball joint from a sliding, turning carriage; a spring and a bob on a rod.
struct Machine {
  Body carriage, box, bob;
  Scene scene;

  explicit Machine(double damping = 0) {
    const Vec inertia(0.3, 0.4, 0.5);
    carriage = scene.rigid_body(2, inertia, {0, 0, 0}, upright, {0.1, 0, 0}, {0, 0, 0});
    box = scene.rigid_body(1, {0.1, 0.05, 0.12}, {0.5, 0.2, -0.7}, Quaternion(1, 0.2, -0.1, 0.3).normalized(),
                           {0.1, 0, 0}, {0, 0, 0});
    bob = scene.point_mass(0.4, {0.5, 0.2, -1.5}, {0.1, 0.3, 0});
    const Site under = scene.point_of(carriage, {0.5, 0.2, -0.3});
    const auto attitude = SO3::from_quaternion(Quaternion(1, 0.2, -0.1, 0.3).normalized());
    scene.add(Coincidence{{under, scene.point_of(box, attitude.transpose() * Vec(0, 0, 0.4))}});
    scene.add(Rod{{box.centre, bob.centre}, 0.8});
    // The carriage slides along the first axis and turns about it.
    const Site rail = scene.ground(Vec::Zero());
    scene.add(InPlane{{rail, carriage.centre}, {Attitude{}}, {0, 1, 0}});
    scene.add(InPlane{{rail, carriage.centre}, {Attitude{}}, {0, 0, 1}});
    scene.add(FixedAngle{{}, {Attitude{}, carriage.attitude}, {0, 1, 0}, {1, 0, 0}});
    scene.add(FixedAngle{{}, {Attitude{}, carriage.attitude}, {0, 0, 1}, {1, 0, 0}});
    for (const auto& [body, mass] : {std::pair{carriage, 2.0}, {box, 1.0}, {bob, 0.4}})
      scene.add(ConstantForce{{body.centre}, {0, 0, -9.81 * mass}});
    scene.add(Spring{{scene.ground({1, 0, 0}), scene.point_of(box, {0.1, 0.1, 0})}, 5, 0.4});
    if (damping > 0) scene.damp(box, damping, damping);
  }
};

}  // namespace lagroid::multibody_tests
