#pragma once
/// Scenes of bodies as motions.

#include "../keys/key.hpp"
#include "../scenes/motion_scene.hpp"

#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <functional>
#include <string>

namespace lagroid::app {

/// A scene of bodies whose step is to be asked its laws.
struct BodiesToCheck {
  std::string name;
  std::function<multibody::Scene()> make;
  double step = 0;
  bool symplectic = true;
  bool reversible = true;
};

/// A scene of [[body]], [[joint]] and [[effect]] that has been read.
struct BodiesScene : MotionScene {
  BodiesToCheck to_check;
  multibody::Options options;
};
/// The method that [time] names: equal steps of a variational method, or controlled ones.
const IntegrationMethod& read_bodies_method(const Section& time);
Table scene_of_bodies_table();
BodiesScene read_bodies(const Section& scene, const RunContext& context);
/// The motion of a scene at its start. Throws SceneError for starts that are none.
multibody::Multibody begin_bodies(const Section& scene, double step, const multibody::Options& options);

}  // namespace lagroid::app
