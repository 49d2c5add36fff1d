#pragma once
/// Polynomials in some numbers x, with their gradients, in any scalar:
///
///     f = sum_a theta_a x^a,    1 <= |a| <= d.
///
/// Linear in theta; no constant, since a constant of a Hamiltonian moves nothing. What potentials on spheres
/// (PolynomialPotential) and Hamiltonians of (q, p) are made of.
///
///     const learning::Polynomial f(2, 4);  // of two numbers, of degree four
///     const int parameters = f.size();     // 14
///
/// No numbers, no degree or more than `most` monomials throw std::invalid_argument.

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lagroid::learning {

/// sum_a theta_a x^a over all monomials of degree 1, ..., d in the numbers x.
class Polynomial {
 public:
  /// Throws std::invalid_argument for no inputs, degree 0, or more than `most` monomials.
  Polynomial(int inputs, int degree);
  static constexpr int most = 2000;

  int inputs() const { return inputs_; }
  int degree() const { return degree_; }
  int size() const { return int(monomials_.size()); }
  int scratch() const { return 2 * size(); }
  /// The powers of x in the a-th monomial.
  std::vector<int> powers(int a) const;
  /// As a formula of numbers with these names, in the words of scenes, every bit kept. Empty where it has more than
  /// `longest` characters.
  std::string formula(const Eigen::VectorXd& theta, std::span<const std::string> names, std::size_t longest) const;
  /// Parameters to begin with: none for seed 0, else small random ones of degree two, by which starts differ.
  Eigen::VectorXd start(unsigned seed) const;

  /// The value, and g <- df/dx. Each monomial is one before it times a number, so that both are a sweep there and one
  /// back.
  template <class X>
  typename X::Scalar gradient(const X& x, const typename X::Scalar* theta, typename X::Scalar* scratch, X& g) const {
    using S = typename X::Scalar;
    const int n = size();
    S* value = scratch;
    S* adjoint = scratch + n;
    S sum(0.0);
    for (int a = 0; a < n; ++a) {
      const auto [parent, variable] = monomials_[std::size_t(a)];
      const S& number = x.data()[variable];
      value[a] = parent < 0 ? number : value[parent] * number;
      adjoint[a] = theta[a];
      sum += theta[a] * value[a];
    }
    for (Eigen::Index i = 0; i < g.size(); ++i) g.data()[i] = S(0.0);
    for (int a = n; a-- > 0;) {
      const auto [parent, variable] = monomials_[std::size_t(a)];
      if (parent < 0) {
        g.data()[variable] += adjoint[a];
      } else {
        adjoint[parent] += adjoint[a] * x.data()[variable];
        g.data()[variable] += adjoint[a] * value[parent];
      }
    }
    return sum;
  }

 private:
  struct Monomial {
    int parent;  ///< -1: it is the number itself
    int variable;
  };
  int inputs_, degree_;
  std::vector<Monomial> monomials_;
};

}  // namespace lagroid::learning
