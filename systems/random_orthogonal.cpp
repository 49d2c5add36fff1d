#include <lagroid/systems/newton_examples.hpp>

#include <Eigen/QR>

namespace lagroid {

template <class S> Eigen::MatrixX<S> random_orthogonal(Eigen::Index n, std::uint64_t seed) {
  std::uint64_t state = seed * 1000003U + std::uint64_t(n);
  const auto uniform = [&state] {
    std::uint64_t z = (state += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    z ^= z >> 31;
    return S(z >> 11) * S(0x1p-53);
  };
  Eigen::MatrixX<S> a(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) a(i, j) = uniform();
  const Eigen::HouseholderQR<Eigen::MatrixX<S>> qr(a);
  Eigen::MatrixX<S> q = qr.householderQ();
  for (Eigen::Index j = 0; j < n; ++j)
    if (qr.matrixQR()(j, j) < 0) q.col(j) *= -1;
  return q;
}

template Eigen::MatrixX<double> random_orthogonal(Eigen::Index, std::uint64_t);
template Eigen::MatrixX<long double> random_orthogonal(Eigen::Index, std::uint64_t);

}  // namespace lagroid
