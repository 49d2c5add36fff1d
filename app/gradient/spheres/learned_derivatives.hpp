#pragma once
/// Derivatives of the steps of a learned Hamiltonian, by its states and by parameters of its model.
///
/// Observed are points on unit rods, as they are shown, directions, momenta, the learned energy and the momentum about
/// the vertical. Requires steps by a Lie group method or extrapolation. Nothing throws.

#include "../../spheres/learned/model_file.hpp"

#include <lagroid/systems/spheres/sphere_derivatives.hpp>

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace lagroid::app {

std::unique_ptr<SphereDerivatives> learned_derivatives(const LearnedHamiltonian& learned,
                                                       const SphereIntegratorOptions& options,
                                                       std::vector<Eigen::Index> places);

}  // namespace lagroid::app
