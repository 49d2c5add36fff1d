#include <lagroid/groupoids/groups/rotation_fibre.hpp>

#include <stdexcept>
#include <utility>

namespace lagroid {

template <class S> RotationFibre<S>::RotationFibre(Point z) : z_(std::move(z)) {
  const Matrix defect = z_.transpose() * z_ - Matrix::Identity(z_.cols(), z_.cols());
  if (z_.rows() != z_.cols() || !(defect.norm() <= S(1e-6)))
    throw std::invalid_argument("RotationFibre: the centre is not an orthogonal matrix");
}

template <class S> auto RotationFibre<S>::coordinates(const Point& y) const -> std::optional<Vector> {
  const auto log = principal_log<S>(z_.transpose() * y);
  if (!log) return std::nullopt;
  return skew_entries(*log);
}

template <class S> auto RotationFibre<S>::ad(const Vector& v) const -> Matrix {
  const Matrix x = skew(v, size());
  Matrix out(dimension(), dimension());
  for (Eigen::Index i = 0; i < dimension(); ++i) {
    const Matrix e = skew<S>(Vector::Unit(dimension(), i), size());
    out.col(i) = skew_entries<S>(x * e - e * x);
  }
  return out;
}

template class RotationFibre<double>;
template class RotationFibre<long double>;

}  // namespace lagroid
