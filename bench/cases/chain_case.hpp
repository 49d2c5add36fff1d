#pragma once
/// The chain that all its peers compute: of length and mass 1, slanting and wound a little at first.

#include <lagroid/systems/multibody/multibody.hpp>

#include "../kernels/spherical_chain.hpp"

#include <memory>
#include <vector>

namespace bench {

inline constexpr double gravity = 9.81;  ///< m/s^2

std::vector<lagroid::multibody::Vec> wound_chain(int links);
/// Adds bobs at these places on rods, the first from `from`.
void hang(lagroid::multibody::Scene& scene, lagroid::multibody::Site from,
          const std::vector<lagroid::multibody::Vec>& places);
std::shared_ptr<lagroid::multibody::Multibody> hanging_chain(int links, double h,
                                                             const lagroid::multibody::Options& options = {});
kernels::SphericalChain chain_kernel(int links, double h);

}  // namespace bench
