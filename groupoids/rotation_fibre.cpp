#include <lagroid/groupoids/rotation_fibre.hpp>

namespace lagroid {

namespace {

/// The matrix of a linear map of skew-symmetric matrices.
template <class Map> Eigen::MatrixXd matrix_of(Eigen::Index n, const Map& map) {
  const Eigen::Index q = n * (n - 1) / 2;
  Eigen::MatrixXd out(q, q);
  for (Eigen::Index i = 0; i < q; ++i) out.col(i) = skew_entries(map(skew(Eigen::VectorXd::Unit(q, i), n)));
  return out;
}

}  // namespace

std::optional<Eigen::VectorXd> RotationFibre::coordinates(const Point& y) const {
  const auto log = principal_log(z_.transpose() * y);
  if (!log) return std::nullopt;
  return skew_entries(*log);
}

Eigen::MatrixXd RotationFibre::dtau(const Vector& v) const {
  const SkewSpectrum spectrum(skew(v, size()));
  return matrix_of(size(), [&](const Eigen::MatrixXd& u) { return spectrum.dexp(u); });
}

Eigen::MatrixXd RotationFibre::dtau_inverse(const Vector& v) const {
  const SkewSpectrum spectrum(skew(v, size()));
  return matrix_of(size(), [&](const Eigen::MatrixXd& u) { return spectrum.dexp_inverse(u); });
}

}  // namespace lagroid
