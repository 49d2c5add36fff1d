// A Hamiltonian of one's own on (T*S^2)^2: two compass needles that feel each other. See docs/lie_group_integrators.md.

#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/systems/spheres/sphere_hamiltonian.hpp>

#include <cmath>
#include <iostream>

namespace {

using namespace lagroid;

// Rods of inertia 1 with magnetic moments along q_1, q_2, a unit apart along x.
struct Needles {
  template <class S> S energy(const Eigen::Matrix<S, 6, 2>& z) const {
    const Vector<S, 3> q1 = z.col(0).template head<3>();
    const Vector<S, 3> q2 = z.col(1).template head<3>();
    const S kinetic = 0.5 * (z.col(0).template tail<3>().squaredNorm() + z.col(1).template tail<3>().squaredNorm());
    return kinetic + q1.dot(q2) - 3.0 * q1(0) * q2(0);
  }
};

}  // namespace

int main() {
  const CotangentSpheres<2> space;
  const HamiltonianField<Needles, 2> field{Needles{}};
  CotangentSpheres<2>::Point start;
  start.col(0) << 0.6, 0.8, 0, 0.4, -0.3, 1;
  start.col(1) << 0, 0, 1, 0.5, 0.2, 0;
  const double energy = Needles{}.energy(start);

  LieGroupIntegrator integrator(space, field, lie_group_methods::commutator_free_4, start, 0.01);
  for (int n = 0; n < 2000; ++n)
    if (!integrator.advance().converged()) return 1;
  ControlledLieGroupIntegrator controlled(space, field, lie_group_methods::munthe_kaas_54, start, {.tolerance = 1e-12});
  if (!controlled.advance_to(20).converged()) return 1;

  const double apart = (integrator.point() - controlled.point()).norm();
  const double drift = std::abs(Needles{}.energy(integrator.point()) - energy);
  std::cout << "after t = 20 the methods are " << apart << " apart; the energy moved by " << drift << ", |q_1| - 1 is "
            << integrator.point().col(0).head<3>().norm() - 1 << "\n";
  return apart < 1e-5 && drift < 1e-6 ? 0 : 1;
}
