// In the place of extreme_eigenvalues.cpp in a build without Spectra.
#include <lagroid/solvers/missing_library.hpp>
#include <lagroid/systems/optimisation/extreme_eigenvalues.hpp>

namespace lagroid::optimisation {

Eigen::VectorXd extreme_eigenvalues(const SymmetricOperator&, SpectrumEnd, Eigen::Index, Eigen::Index, double) {
  throw MissingLibrary("the spectrum of a matrix that is not small", "Spectra", "libspectra-dev");
}

}  // namespace lagroid::optimisation
