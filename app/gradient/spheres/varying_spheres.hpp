#pragma once
/// Systems on spheres whose numbers vary, for derivatives of their runs.
///
///     const auto system = varying_spheres(*read.system, scene);
///     const auto heavier = system->changed({{.parameter = "gravity", .by = 0.1}});
///
/// Numbers are named as the scene has them: masses where one number stands for all, else masses.0, masses.1, ...; those
/// of a learned model, which its file has, model.0, model.1, ...
/// Errors: std::domain_error for numbers that a system cannot have, std::invalid_argument for an unknown name.

#include "../../spheres/sphere_system.hpp"
#include "../gradient_subject.hpp"

#include <lagroid/systems/spheres/sphere_derivatives.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

class VaryingSpheres {
 public:
  virtual ~VaryingSpheres() = default;
  /// By their names.
  virtual std::vector<std::pair<std::string, double>> numbers() const = 0;
  /// The system whose numbers differ by the nudges of parameters.
  virtual std::unique_ptr<SphereSystem> changed(const std::vector<Nudge>& nudges) const = 0;
  /// Of its steps by these options; observed are momenta or velocities as `shown` says.
  virtual std::unique_ptr<SphereDerivatives> derivatives(const std::vector<Nudge>& nudges,
                                                         const SphereIntegratorOptions& options, SphereForm shown,
                                                         const std::vector<std::string>& parameters) const = 0;
};

/// That of a system of the library.
std::shared_ptr<const VaryingSpheres> varying_spheres(const SphereSystem& system, const Section& scene);

}  // namespace lagroid::app
