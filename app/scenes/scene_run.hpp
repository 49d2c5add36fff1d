#pragma once
/// Running scenes of bodies.

#include "../task.hpp"

#include <lagroid/run/run_result.hpp>
#include <lagroid/systems/multibody/scene.hpp>

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::app {

class Section;

/// Reads a scene of [[body]], [[joint]] and [[effect]] and runs it, over `most_steps` at most.
RunResult run_bodies(const Section& scene, const RunContext& context,
                     long most_steps = std::numeric_limits<long>::max());

/// The motion of a scene alone, and the methods by which it could be marched.
struct BodiesTrial {
  std::string name;
  std::unique_ptr<Trial> trial;
  std::vector<Method> methods;
};
BodiesTrial begin_bodies(const Section& scene);

/// A scene of bodies whose step is to be asked its laws.
struct BodiesToCheck {
  std::string name;
  std::function<multibody::Scene()> make;
  double step = 0;
  bool symplectic = true;
  bool reversible = true;
};
BodiesToCheck bodies_to_check(const Section& scene);

}  // namespace lagroid::app
