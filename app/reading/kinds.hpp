#pragma once
/// The keys by which a scene declares of what kind it is.

#include <array>
#include <string_view>

namespace lagroid::app::keys {

inline constexpr std::string_view system = "system";
inline constexpr std::string_view bodies = "body";
inline constexpr std::string_view optimisation = "problem";
inline constexpr std::string_view control = "control";
inline constexpr std::string_view sweep = "scene";

/// The values of `system` for scenes on (T*S^2)^k.
inline constexpr std::string_view pendulum_chain = "pendulum_chain";
inline constexpr std::string_view learned_hamiltonian = "learned_hamiltonian";
inline constexpr std::array on_spheres{pendulum_chain, learned_hamiltonian};

}  // namespace lagroid::app::keys
