#pragma once
/// Eigenvalues at the ends of the spectrum of y = A x by Lanczos' iteration, restarted (Spectra), of A shifted and
/// scaled: what operators.hpp is made of, and all that it needs Spectra for.
///
/// Requires a symmetric A of more rows than `count`. Throws std::runtime_error where they are not found, and
/// MissingLibrary in a build without Spectra. Not finite where A is not.

#include <lagroid/systems/optimisation/operators.hpp>

namespace lagroid::optimisation {

/// Which of them: as many at either end, or the smallest.
enum class SpectrumEnd { both, smallest };

/// `count` eigenvalues, decreasing, by a basis of so many vectors, to a relative tolerance.
Eigen::VectorXd extreme_eigenvalues(const SymmetricOperator& a, SpectrumEnd end, Eigen::Index count, Eigen::Index basis,
                                    double tolerance);

}  // namespace lagroid::optimisation
