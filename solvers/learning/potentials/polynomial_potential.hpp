#pragma once
/// Potentials that are polynomials in the coordinates x of q_1, ..., q_k,
///
///     V = sum_a theta_a x^a,    1 <= |a| <= d.
///
/// Linear in theta; gravity is of degree one.
///
///     const learning::PolynomialPotential potential(2, 3);  // bodies, degree
///
/// No bodies, no degree or more than `most` monomials throw std::invalid_argument.

#include <lagroid/solvers/learning/functions/polynomial.hpp>
#include <lagroid/solvers/learning/potentials/potential.hpp>

namespace lagroid::learning {

/// V = sum_a theta_a x^a over all monomials of degree 1, ..., d in the 3k coordinates x of q_1, ..., q_k. On spheres
/// the monomials of degree 2 and above are not independent, |q_i|^2 = 1.
class PolynomialPotential : public Polynomial {
 public:
  /// Throws std::invalid_argument for no bodies, degree 0, or more than `most` monomials.
  PolynomialPotential(int bodies, int degree) : Polynomial(3 * bodies, degree) {}
  /// None: starts differ by their masses.
  Eigen::VectorXd start(unsigned) const { return Eigen::VectorXd::Zero(size()); }
};

}  // namespace lagroid::learning
