#include <lagroid/systems/newton_examples.hpp>

#include <Eigen/QR>

#include <cmath>

namespace lagroid {

namespace {

Eigen::MatrixXd sine(const Eigen::MatrixXd& y) { return y.array().sin(); }

/// What g makes of a change of y.
Eigen::VectorXd beside_the_diagonal(const Eigen::MatrixXd& y) {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(y.rows(), y.cols());
  u.diagonal(1) = y.diagonal(1);
  return skew_entries(u - u.transpose());
}

}  // namespace

Eigen::VectorXd ExampleField::g(const Eigen::MatrixXd& y) const {
  if (example_ == NewtonExample::first) return beside_the_diagonal(y);
  const Eigen::MatrixXd u = sine(y) * (2 * y - 5 * y * y);
  return skew_entries(u - u.transpose());
}

Eigen::MatrixXd ExampleField::dg(const Eigen::MatrixXd& y) const {
  const Eigen::Index n = y.rows();
  Eigen::MatrixXd out(n * (n - 1) / 2, n * (n - 1) / 2);
  const Eigen::MatrixXd s = sine(y);
  const Eigen::MatrixXd polynomial = 2 * y - 5 * y * y;
  const Eigen::MatrixXd cosine = y.array().cos();
  Eigen::Index i = 0;
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index c = r + 1; c < n; ++c, ++i) {
      // y E with E the generator (r, c): column c is y's column r, column r minus its column c.
      Eigen::MatrixXd change = Eigen::MatrixXd::Zero(n, n);
      change.col(c) = y.col(r);
      change.col(r) = -y.col(c);
      if (example_ == NewtonExample::first) {
        out.col(i) = beside_the_diagonal(change);
      } else {
        const Eigen::MatrixXd u =
            cosine.cwiseProduct(change) * polynomial + s * (2 * change - 5 * (change * y + y * change));
        out.col(i) = skew_entries(u - u.transpose());
      }
    }
  return out;
}

Eigen::MatrixXd random_orthogonal(Eigen::Index n, std::uint64_t seed) {
  std::uint64_t state = seed * 1000003U + std::uint64_t(n);
  const auto uniform = [&state] {
    std::uint64_t z = (state += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    z ^= z >> 31;
    return double(z >> 11) * 0x1p-53;
  };
  Eigen::MatrixXd a(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) a(i, j) = uniform();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  Eigen::MatrixXd q = qr.householderQ();
  for (Eigen::Index j = 0; j < n; ++j)
    if (qr.matrixQR()(j, j) < 0) q.col(j) *= -1;
  return q;
}

}  // namespace lagroid
