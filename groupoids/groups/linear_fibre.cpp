#include <lagroid/core/matrices/matrix_functions.hpp>
#include <lagroid/groupoids/groups/linear_fibre.hpp>

#include <Eigen/LU>

#include <cmath>

namespace lagroid {

Eigen::MatrixXd LinearFibre::hat(const Vector& v) const {
  Matrix x = Matrix::Zero(size(), size());
  x.reshaped().head(dimension()) = v;
  if (determinant_ == Determinant::kept) x(size() - 1, size() - 1) = -x.trace();
  return x;
}

std::optional<Eigen::VectorXd> LinearFibre::coordinates(const Point& y) const {
  const Matrix g = z_.partialPivLu().solve(y);
  if (!g.allFinite()) return std::nullopt;
  for (const auto& eigenvalue : matrix_eigenvalues(g))
    if (eigenvalue.imag() == 0 && eigenvalue.real() <= 0) return std::nullopt;
  const Matrix x = matrix_logarithm(g);
  if (!x.allFinite()) return std::nullopt;
  if (determinant_ == Determinant::kept && std::abs(x.trace()) > 1e-8 * (1 + x.norm())) return std::nullopt;
  return vee(x);
}

Eigen::MatrixXd LinearFibre::moved(const Point& y, const Vector& u) const { return y * matrix_exponential(hat(u)); }

Eigen::MatrixXd LinearFibre::dtau(const Vector& v) const {
  // exp of [X E; 0 X] has exp'_X(E) in its corner (Najfeld and Havel 1995, [N]'s reference 17).
  const Eigen::Index n = size();
  const Matrix x = hat(v);
  const Matrix back = matrix_exponential(-x);
  Matrix block = Matrix::Zero(2 * n, 2 * n);
  block.topLeftCorner(n, n) = x;
  block.bottomRightCorner(n, n) = x;
  return matrix_of([&](const Matrix& e) -> Matrix {
    block.topRightCorner(n, n) = e;
    return back * matrix_exponential(block).topRightCorner(n, n);
  });
}

Eigen::MatrixXd LinearFibre::ad(const Vector& v) const {
  const Matrix x = hat(v);
  return matrix_of([&](const Matrix& e) -> Matrix { return x * e - e * x; });
}

}  // namespace lagroid
