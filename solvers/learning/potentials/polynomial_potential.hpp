#pragma once
/// Potentials that are polynomials in the coordinates x of q_1, ..., q_k,
///
///     V = sum_a theta_a x^a,    1 <= |a| <= d.
///
/// Linear in theta; gravity is of degree one. No bodies, no degree or more than `most` monomials throw
/// std::invalid_argument.

#include <lagroid/solvers/learning/potentials/potential.hpp>

#include <vector>

namespace lagroid::learning {

/// V = sum_a theta_a x^a over all monomials of degree 1, ..., d in the 3k coordinates x of q_1, ..., q_k. Linear in
/// theta. On spheres the monomials of degree 2 and above are not independent, |q_i|^2 = 1.
class PolynomialPotential {
 public:
  /// Throws std::invalid_argument for no bodies, degree 0, or more than `most` monomials.
  PolynomialPotential(int bodies, int degree);
  static constexpr int most = 2000;

  int degree() const { return degree_; }
  int size() const { return int(monomials_.size()); }
  int scratch() const { return 2 * size(); }
  /// The powers of x in the a-th monomial.
  std::vector<int> powers(int a) const;

  /// Each monomial is one before it times a coordinate, so that value and gradient are a sweep there and one back.
  template <class S, int K> S gradient(const Positions<S, K>& q, const S* theta, S* scratch, Positions<S, K>& g) const {
    const int n = size();
    S* value = scratch;
    S* adjoint = scratch + n;
    S sum(0.0);
    for (int a = 0; a < n; ++a) {
      const auto [parent, variable] = monomials_[std::size_t(a)];
      const S& x = q.data()[variable];
      value[a] = parent < 0 ? x : value[parent] * x;
      adjoint[a] = theta[a];
      sum += theta[a] * value[a];
    }
    for (Eigen::Index i = 0; i < g.size(); ++i) g.data()[i] = S(0.0);
    for (int a = n; a-- > 0;) {
      const auto [parent, variable] = monomials_[std::size_t(a)];
      if (parent < 0) {
        g.data()[variable] += adjoint[a];
      } else {
        adjoint[parent] += adjoint[a] * q.data()[variable];
        g.data()[variable] += adjoint[a] * value[parent];
      }
    }
    return sum;
  }

 private:
  struct Monomial {
    int parent;  ///< -1: it is the coordinate itself
    int variable;
  };
  int bodies_, degree_;
  std::vector<Monomial> monomials_;
};

}  // namespace lagroid::learning
