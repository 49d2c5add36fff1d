#pragma once
/// The subjects of `lagroid gradient` by the systems of a program: each is compiled by itself, and asked in turn
/// whether a scene is its own.
///
///     return gradient_program(argc, argv, {{&systems_family()}, {&kepler_module()}, {}}, {kepler_gradient});

#include "../program.hpp"
#include "../reading/scene_reader.hpp"
#include "gradient_subject.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace lagroid::app {

/// Of a scene of its system; nothing where that is another system. Throws SceneError.
using AskGradient = std::function<std::optional<GradientSubject>(const Section& scene)>;

/// Of a scene of the library's Poisson systems, without events (SceneError).
std::optional<GradientSubject> poisson_gradient(const Section& scene);

/// Of a scene of bodies, by equal steps of order 2, without events (SceneError).
std::optional<GradientSubject> bodies_gradient(const Section& scene);

/// Of a scene on spheres, without events (SceneError).
std::optional<GradientSubject> spheres_gradient(const Section& scene);

/// Of a scene that holds its formulas, without constraints and events (SceneError).
std::optional<GradientSubject> formula_gradient(const Section& scene);

/// Serves a command line of `lagroid gradient`. Returns the exit code.
int gradient_program(int argc, char** argv, ProgramParts parts, const std::vector<AskGradient>& subjects);

}  // namespace lagroid::app
