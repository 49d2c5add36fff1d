#pragma once
/// The fields and starting points of [N] section 5, g : O(N) -> so(N), to reproduce its figures with. Compiled for S =
/// double and long double.

#include <lagroid/groupoids/groups/rotations.hpp>

#include <cstdint>

namespace lagroid {

/// g : O(N) -> so(N), as ImplicitStep wants it.
///
///     first    u = diag(diag(y, 1), 1), the entries beside the diagonal alone       g(y) = u - u^T
///     second   u = sin(y) (2 y - 5 y^2), sin entry by entry
enum class NewtonExample { first, second };

template <class S = double> class ExampleField {
 public:
  explicit ExampleField(NewtonExample example) : example_(example) {}
  Eigen::VectorX<S> g(const Eigen::MatrixX<S>& y) const;
  /// The matrix of dg_y(u) = d/dt g(y exp(t u)).
  Eigen::MatrixX<S> dg(const Eigen::MatrixX<S>& y) const;

 private:
  NewtonExample example_;
};

/// A random element of O(N): the orthogonal factor, with a positive diagonal of the other, of a matrix of numbers
/// uniform in [0, 1) (splitmix64 from seed * 1000003 + N, row by row).
template <class S = double> Eigen::MatrixX<S> random_orthogonal(Eigen::Index n, std::uint64_t seed);

}  // namespace lagroid
