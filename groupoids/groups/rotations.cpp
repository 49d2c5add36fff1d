#include <lagroid/groupoids/groups/rotations.hpp>

#include <lagroid/core/matrices/real_schur.hpp>

#include <Eigen/LU>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

namespace lagroid {

namespace {

/// The number of the entry (r, c), r < c, of a skew-symmetric n x n matrix.
Eigen::Index entry(Eigen::Index n, Eigen::Index r, Eigen::Index c) { return r * n - r * (r + 1) / 2 + c - r - 1; }

template <class S> S sinc(S x) { return std::abs(x) < S(1e-5) ? 1 - x * x / 6 : std::sin(x) / x; }

template <class S> std::complex<S> dexp_factor(S d) { return std::polar(S(1), -d) * sinc(d); }
template <class S> std::complex<S> dexp_inverse_factor(S d) { return std::polar(S(1), d) / sinc(d); }

/// The rows x and y, as real and imaginary parts, times a factor.
template <class Row, class S> void multiply_complex(Row&& x, Row&& y, const std::complex<S>& factor) {
  const Eigen::RowVectorX<S> real = factor.real() * x - factor.imag() * y;
  y = factor.imag() * x + factor.real() * y;
  x = real;
}

}  // namespace

template <class S> Eigen::MatrixX<S> skew(const Eigen::VectorX<S>& x, Eigen::Index n) {
  Eigen::MatrixX<S> a = Eigen::MatrixX<S>::Zero(n, n);
  Eigen::Index i = 0;
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index c = r + 1; c < n; ++c) {
      a(r, c) = x(i++);
      a(c, r) = -a(r, c);
    }
  return a;
}

template <class S> Eigen::VectorX<S> skew_entries(const Eigen::MatrixX<S>& a) {
  Eigen::VectorX<S> x(a.rows() * (a.rows() - 1) / 2);
  Eigen::Index i = 0;
  for (Eigen::Index r = 0; r < a.rows(); ++r)
    for (Eigen::Index c = r + 1; c < a.rows(); ++c) x(i++) = (a(r, c) - a(c, r)) / 2;
  return x;
}

template <class S> SkewSpectrum<S>::SkewSpectrum(const Matrix& x) : basis_(x.rows(), x.cols()), angles_(x.rows() / 2) {
  if (x.size() == 0) return;
  if (!x.allFinite()) {  // which the Schur form would pass over
    basis_.setConstant(std::numeric_limits<S>::quiet_NaN());
    angles_.setConstant(std::numeric_limits<S>::quiet_NaN());
    return;
  }
  const auto [t, u] = real_schur<S>(x);
  const Eigen::Index n = x.rows();
  Eigen::Index planes = 0;
  std::vector<Eigen::Index> fixed;  // directions that X sends to zero, up to round-off
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i + 1 < n && t(i + 1, i) != 0) {
      angles_(planes) = (t(i + 1, i) - t(i, i + 1)) / 2;
      basis_.template middleCols<2>(2 * planes++) = u.template middleCols<2>(i);
      ++i;
    } else {
      fixed.push_back(i);
    }
  }
  angles_.tail(angles_.size() - planes).setZero();
  for (std::size_t k = 0; k < fixed.size(); ++k) basis_.col(2 * planes + Eigen::Index(k)) = u.col(fixed[k]);
}

template <class S> Eigen::MatrixX<S> SkewSpectrum<S>::exp() const {
  // I + Q (exp(w J) - I) Q^T, without cancellation where w is small.
  Matrix turned = Matrix::Zero(basis_.rows(), basis_.cols());
  for (Eigen::Index k = 0; k < angles_.size(); ++k) {
    const S half = std::sin(angles_(k) / 2);
    const S cosine = -2 * half * half;
    const S sine = std::sin(angles_(k));
    turned.col(2 * k) = cosine * basis_.col(2 * k) + sine * basis_.col(2 * k + 1);
    turned.col(2 * k + 1) = cosine * basis_.col(2 * k + 1) - sine * basis_.col(2 * k);
  }
  Matrix out = turned * basis_.transpose();
  out.diagonal().array() += 1;
  return out;
}

template <class S> Eigen::MatrixX<S> SkewSpectrum<S>::with_angles(const Eigen::VectorX<S>& angles) const {
  Matrix turned = Matrix::Zero(basis_.rows(), basis_.cols());
  for (Eigen::Index k = 0; k < angles.size(); ++k) {
    turned.col(2 * k) = angles(k) * basis_.col(2 * k + 1);
    turned.col(2 * k + 1) = -angles(k) * basis_.col(2 * k);
  }
  const Matrix out = turned * basis_.transpose();
  return (out - out.transpose()) / 2;
}

/// Each column of `inner` has the entries of Q^T Y Q for some Y. A 2 x 2 block between two planes is
/// (p + q J) + (r + s J) diag(1, -1).
template <class S> template <class F> void SkewSpectrum<S>::multiply(Matrix& inner, const F& factor) const {
  const Eigen::Index n = basis_.rows();
  const Eigen::Index planes = angles_.size();
  for (Eigen::Index a = 0; a < planes; ++a) {
    for (Eigen::Index b = a + 1; b < planes; ++b) {
      auto y00 = inner.row(entry(n, 2 * a, 2 * b));
      auto y01 = inner.row(entry(n, 2 * a, 2 * b + 1));
      auto y10 = inner.row(entry(n, 2 * a + 1, 2 * b));
      auto y11 = inner.row(entry(n, 2 * a + 1, 2 * b + 1));
      Eigen::RowVectorX<S> p = (y00 + y11) / 2;
      Eigen::RowVectorX<S> q = (y10 - y01) / 2;
      Eigen::RowVectorX<S> r = (y00 - y11) / 2;
      Eigen::RowVectorX<S> s = (y10 + y01) / 2;
      multiply_complex(p, q, factor((angles_(a) - angles_(b)) / 2));
      multiply_complex(r, s, factor((angles_(a) + angles_(b)) / 2));
      y00 = p + r;
      y11 = p - r;
      y10 = q + s;
      y01 = s - q;
    }
    if (n % 2 != 0)
      multiply_complex(inner.row(entry(n, 2 * a, n - 1)), inner.row(entry(n, 2 * a + 1, n - 1)),
                       factor(angles_(a) / 2));
  }
}

template <class S>
template <class F>
Eigen::MatrixX<S> SkewSpectrum<S>::multiplied(const Matrix& y, const F& factor) const {
  Matrix inner = skew_entries<S>(basis_.transpose() * y * basis_);
  multiply(inner, factor);
  return basis_ * skew<S>(inner.col(0), basis_.rows()) * basis_.transpose();
}

template <class S> template <class F> Eigen::MatrixX<S> SkewSpectrum<S>::matrix_of(const F& factor) const {
  // The matrix of Y -> Q^T Y Q, which is orthogonal.
  const Eigen::Index n = basis_.rows();
  const Eigen::Index q = n * (n - 1) / 2;
  Matrix turn(q, q);
  Eigen::Index column = 0;
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index c = r + 1; c < n; ++c, ++column) {
      Eigen::Index row = 0;
      for (Eigen::Index a = 0; a < n; ++a)
        for (Eigen::Index b = a + 1; b < n; ++b, ++row)
          turn(row, column) = basis_(r, a) * basis_(c, b) - basis_(c, a) * basis_(r, b);
    }
  Matrix inner = turn;
  multiply(inner, factor);
  return turn.transpose() * inner;
}

template <class S> Eigen::MatrixX<S> SkewSpectrum<S>::dexp(const Matrix& y) const {
  return multiplied(y, dexp_factor<S>);
}
template <class S> Eigen::MatrixX<S> SkewSpectrum<S>::dexp_inverse(const Matrix& y) const {
  return multiplied(y, dexp_inverse_factor<S>);
}
template <class S> Eigen::MatrixX<S> SkewSpectrum<S>::dexp_matrix() const { return matrix_of(dexp_factor<S>); }
template <class S> Eigen::MatrixX<S> SkewSpectrum<S>::dexp_inverse_matrix() const {
  return matrix_of(dexp_inverse_factor<S>);
}

template <class S> std::optional<Eigen::MatrixX<S>> principal_log(const Eigen::MatrixX<S>& q) {
  using Matrix = Eigen::MatrixX<S>;
  // Where no plane is turned by more than a right angle: tanh(X / 2), to all digits also near the identity.
  const Matrix one = Matrix::Identity(q.rows(), q.cols());
  const Matrix c = (q + one).partialPivLu().solve(q - one);
  if ((c + c.transpose()).norm() < S(1e-6)) {  // else Q + I is singular to round-off
    const SkewSpectrum<S> tangents((c - c.transpose()) / 2);
    if (tangents.radius() <= 1) return tangents.apply([](S t) { return 2 * std::atan(t); });
  }
  if (!q.allFinite()) return std::nullopt;
  const auto [t, u] = real_schur<S>(q);
  const Eigen::Index n = q.rows();
  Matrix inner = Matrix::Zero(n, n);
  const auto turn = [&](Eigen::Index i, Eigen::Index j, S angle) {
    inner(j, i) = angle;
    inner(i, j) = -angle;
  };
  std::vector<Eigen::Index> reversed;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i + 1 < n && t(i + 1, i) != 0) {
      turn(i, i + 1, std::atan2(t(i + 1, i) - t(i, i + 1), t(i, i) + t(i + 1, i + 1)));
      ++i;
    } else if (t(i, i) < 0) {
      reversed.push_back(i);
    }
  }
  if (reversed.size() % 2 != 0) return std::nullopt;
  for (std::size_t k = 0; k < reversed.size(); k += 2) turn(reversed[k], reversed[k + 1], std::numbers::pi_v<S>);
  const Matrix x = u * inner * u.transpose();
  return (x - x.transpose()) / 2;
}

template Eigen::MatrixX<double> skew(const Eigen::VectorX<double>&, Eigen::Index);
template Eigen::MatrixX<long double> skew(const Eigen::VectorX<long double>&, Eigen::Index);
template Eigen::VectorX<double> skew_entries(const Eigen::MatrixX<double>&);
template Eigen::VectorX<long double> skew_entries(const Eigen::MatrixX<long double>&);
template class SkewSpectrum<double>;
template class SkewSpectrum<long double>;
template std::optional<Eigen::MatrixX<double>> principal_log(const Eigen::MatrixX<double>&);
template std::optional<Eigen::MatrixX<long double>> principal_log(const Eigen::MatrixX<long double>&);

}  // namespace lagroid
