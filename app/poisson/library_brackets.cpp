#include "../reading/kinds.hpp"
#include "poisson_entry_of.hpp"
#include "poisson_family.hpp"

#include <lagroid/systems/poisson/fields.hpp>
#include <lagroid/systems/poisson/lattices.hpp>
#include <lagroid/systems/poisson/lotka_volterra.hpp>
#include <lagroid/systems/poisson/rotations.hpp>
#include <lagroid/systems/poisson/spins.hpp>
#include <lagroid/systems/poisson/tops.hpp>

namespace lagroid::app {

const PoissonFamily& library_brackets() {
  static const PoissonFamily family(
      {poisson_entry<LotkaVolterra>(std::string(keys::lotka_volterra), "predator and prey", "{x, y} = x y", {}),
       poisson_entry<ThreeSpecies>(std::string(keys::three_species), "three species that feed on each other",
                                   "{x_i, x_j} = c_ij x_i x_j on R^3", {"a b ln x1 - b ln x2 + ln x3"}),
       poisson_entry<VolterraRing<5>>(std::string(keys::volterra_ring),
                                      "five species on a ring, each feeding on the next", "{x_i, x_i+1} = x_i x_i+1",
                                      {"sum of ln x_i"}),
       poisson_entry<EulerTop>(std::string(keys::euler_top), "free rigid body by its momentum in the body", "so(3)*",
                               {"|M|^2 / 2"}),
       poisson_entry<Kirchhoff>(std::string(keys::kirchhoff),
                                "rigid body in a fluid; on a sphere or in hyperbolic space",
                                "se(3)*, so(4)* or so(3, 1)*", {"|p|^2 + kappa |M|^2", "M.p"}),
       poisson_entry<HeavyTopBracket>(std::string(keys::heavy_top_bracket),
                                      "heavy top by its momentum and the vertical in the body", "se(3)*",
                                      {"|g|^2", "M.g"}),
       poisson_entry<BodyInSpace>(std::string(keys::body_in_space),
                                  "rigid body with its attitude, free or under gravity",
                                  "so(3) acting on three vectors; T*SO(3) where they are orthonormal",
                                  {"(R R^T)_11", "(R R^T)_22", "(R R^T)_33", "(R R^T)_12", "(R R^T)_23", "(R R^T)_31"}),
       poisson_entry<SpinChain<3>>(std::string(keys::spin_chain), "three spins in a row, each turned by its neighbours",
                                   "so(3)*^3", {"|S1|^2 / 2", "|S2|^2 / 2", "|S3|^2 / 2"}),
       poisson_entry<OpenToda<4>>(std::string(keys::toda), "Toda lattice of four particles in Flaschka's variables",
                                  "{a_i, b_i} = -a_i, {a_i, b_i+1} = a_i", {"total momentum"}),
       poisson_entry<PeriodicToda<3>>(std::string(keys::toda_ring), "Toda lattice of three particles on a ring",
                                      "{a_i, b_i} = -a_i, {a_i, b_i+1} = a_i",
                                      {"total momentum", "product of all a_i"}),
       poisson_entry<MaxwellBloch>(std::string(keys::maxwell_bloch), "a laser: the real Maxwell-Bloch equations",
                                   "{x, y} = -z, {x, z} = y", {"(y^2 + z^2) / 2"}),
       poisson_entry<Sklyanin>(std::string(keys::sklyanin), "spins by Sklyanin's quadratic bracket",
                               "{f, g} = det(df, dg, dC1, dC2) on R^4", {"first quadric", "second quadric"}),
       poisson_entry<MagneticParticle>(std::string(keys::magnetic_particle),
                                       "charge in a magnetic field that varies, in a trap",
                                       "{x_i, v_j} = delta_ij, {v_i, v_j} = eps_ijk B_k(x)", {})});
  return family;
}

const SceneFamily& poisson_family() { return library_brackets(); }

}  // namespace lagroid::app
