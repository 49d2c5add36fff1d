// In the place of integrate_reference.cpp in a build without Boost.
#include <lagroid/solvers/missing_library.hpp>
#include <lagroid/systems/reference.hpp>

namespace lagroid {

Eigen::VectorXd integrate_reference(const VectorField&, const Eigen::VectorXd&, double) {
  throw MissingLibrary("a solution of the continuous equations", "Boost.odeint", "libboost-dev");
}

}  // namespace lagroid
