#pragma once
/// Scenes of bodies as motions.

#include <lagroid/run/study/method.hpp>

#include <lagroid/run/drive.hpp>
#include <lagroid/run/motion.hpp>
#include <lagroid/systems/multibody/scene.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::app {

class Section;

/// A scene of bodies whose step is to be asked its laws.
struct BodiesToCheck {
  std::string name;
  std::function<multibody::Scene()> make;
  double step = 0;
  bool symplectic = true;
  bool reversible = true;
};

/// A scene of [[body]], [[joint]] and [[effect]] that has been read.
struct BodiesScene {
  std::unique_ptr<Motion> motion;
  Pace pace;
  std::vector<Method> methods;  ///< by which it could be marched
  BodiesToCheck to_check;
};
BodiesScene read_bodies(const Section& scene, const RunContext& context);

}  // namespace lagroid::app
