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

/// The values of `system` for scenes that hold the formulas of one.
inline constexpr std::string_view lagrangian = "lagrangian";
inline constexpr std::string_view hamiltonian = "hamiltonian";

/// The values of `system` for scenes on (T*S^2)^k.
inline constexpr std::string_view pendulum_chain = "pendulum_chain";
inline constexpr std::string_view learned_hamiltonian = "learned_hamiltonian";
inline constexpr std::array on_spheres{pendulum_chain, learned_hamiltonian};

/// The values of `system` for Poisson systems.
inline constexpr std::string_view lotka_volterra = "lotka_volterra";
inline constexpr std::string_view three_species = "three_species";
inline constexpr std::string_view volterra_ring = "volterra_ring";
inline constexpr std::string_view euler_top = "euler_top";
inline constexpr std::string_view kirchhoff = "kirchhoff";
inline constexpr std::string_view heavy_top_bracket = "heavy_top_bracket";
inline constexpr std::string_view body_in_space = "body_in_space";
inline constexpr std::string_view spin_chain = "spin_chain";
inline constexpr std::string_view toda = "toda";
inline constexpr std::string_view toda_ring = "toda_ring";
inline constexpr std::string_view maxwell_bloch = "maxwell_bloch";
inline constexpr std::string_view sklyanin = "sklyanin";
inline constexpr std::string_view magnetic_particle = "magnetic_particle";
inline constexpr std::array of_brackets{lotka_volterra,    three_species, volterra_ring,    euler_top, kirchhoff,
                                        heavy_top_bracket, body_in_space, spin_chain,       toda,      toda_ring,
                                        maxwell_bloch,     sklyanin,      magnetic_particle};

}  // namespace lagroid::app::keys
