#pragma once
/// Directions of a system, which reading brings to length one, as the numbers that the scene has of them: with x in the
/// scene and n = x / |x| in the system,
///
///     dn/dx = (1 - n n^T) / |x|,
///
/// so that a derivative by a number is that of what the program computes when the scene is edited there.
///
///     return in_numbers_of_the_scene(subject, given_directions<AttitudeControl>(scene));
///
/// Requires a subject that names the numbers of each direction as the system does: forbidden.0, forbidden.1, ...
/// Nothing throws but what the subject does.

#include "../../reading/scene_reader.hpp"
#include "../gradient_subject.hpp"

#include <lagroid/core/parameter.hpp>

#include <string>
#include <vector>

namespace lagroid::app {

struct GivenDirection {
  std::string name;
  Eigen::VectorXd numbers;  ///< as the scene has them
};

/// Those that a scene gives; others are of length one already, as the system's constructor makes them.
template <class Sys> std::vector<GivenDirection> given_directions(const Section& scene) {
  std::vector<GivenDirection> out;
  const Section parameters = scene.section_or_empty("parameters");
  const Sys usual{};
  for_each_parameter<Sys>([&](const auto& p) {
    if constexpr (requires { p.direction; })
      if constexpr (requires { (usual.*p.member).size(); })
        if (p.direction && parameters.has(p.name)) {
          const std::vector<double> given =
              parameters.numbers(p.name, std::size_t((usual.*p.member).size()), p.meaning);
          out.push_back({std::string(p.name), Eigen::VectorXd::Map(given.data(), Eigen::Index(given.size()))});
        }
  });
  return out;
}

GradientSubject in_numbers_of_the_scene(const GradientSubject& subject, const std::vector<GivenDirection>& directions);

}  // namespace lagroid::app
