#pragma once
/// Derivatives of the steps of chains of spherical pendula, by their states and by masses, lengths and gravity.
///
///     const SphereIntegratorOptions options{.method = "rattle", .step = 0.01};
///     const auto derivatives = make_chain_derivatives(chain, options, SphereForm::momenta, {"masses.0", "lengths"});
///
/// States are in the form of the options, observed are momenta or velocities as `shown` says: the bobs (3 k numbers),
/// the directions (3 k), these (3 k), the energy and the momentum about the vertical. A parameter is one number, or by
/// the name of a list all of its numbers, which vary as one.
///
/// Extrapolation goes by velocities. Throws std::invalid_argument for a name that is no parameter and for a method that
/// there is not.

#include <lagroid/systems/pendulums/pendulum_chain.hpp>
#include <lagroid/systems/spheres/sphere_derivatives.hpp>

#include <memory>
#include <string>
#include <vector>

namespace lagroid {

std::unique_ptr<SphereDerivatives> make_chain_derivatives(const PendulumChain<Eigen::Dynamic>& chain,
                                                          const SphereIntegratorOptions& options, SphereForm shown,
                                                          const std::vector<std::string>& parameters);

}  // namespace lagroid
