#include <lagroid/groupoids/rotations.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <complex>
#include <vector>

namespace lagroid {

namespace {

constexpr double pi = 3.14159265358979323846;

/// (Q + I)^{-1} (Q - I) = tanh(X / 2): the logarithm where no eigenvalue of Q is near -1, to all digits also near the
/// identity; not finite where Q + I is singular.
Eigen::MatrixXd log_by_cayley(const Eigen::MatrixXd& q) {
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(q.rows(), q.cols());
  const Eigen::MatrixXd c = (q + one).partialPivLu().solve(q - one);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> hermitian(0.5 * (c - c.transpose()) *
                                                                  std::complex<double>(0, -1));
  const Eigen::VectorXcd turned =
      hermitian.eigenvalues().unaryExpr([](double t) { return std::complex<double>(0, 2 * std::atan(t)); });
  return (hermitian.eigenvectors() * turned.asDiagonal() * hermitian.eigenvectors().adjoint()).real();
}

}  // namespace

Eigen::MatrixXd skew(const Eigen::VectorXd& x, Eigen::Index n) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  Eigen::Index i = 0;
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index c = r + 1; c < n; ++c) {
      a(r, c) = x(i++);
      a(c, r) = -a(r, c);
    }
  return a;
}

Eigen::VectorXd skew_entries(const Eigen::MatrixXd& a) {
  Eigen::VectorXd x(a.rows() * (a.rows() - 1) / 2);
  Eigen::Index i = 0;
  for (Eigen::Index r = 0; r < a.rows(); ++r)
    for (Eigen::Index c = r + 1; c < a.rows(); ++c) x(i++) = 0.5 * (a(r, c) - a(c, r));
  return x;
}

SkewSpectrum::SkewSpectrum(const Eigen::MatrixXd& x) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> hermitian(x * std::complex<double>(0, -1));
  frequencies_ = hermitian.eigenvalues();
  basis_ = hermitian.eigenvectors();
}

Eigen::MatrixXd SkewSpectrum::exp() const {
  // I + U (exp(i w) - 1) U^*, without cancellation where w is small.
  const Eigen::VectorXcd turned =
      frequencies_.unaryExpr([](double w) { return 2 * std::sin(0.5 * w) * std::polar(1.0, 0.5 * (w + pi)); });
  Eigen::MatrixXd out = (basis_ * turned.asDiagonal() * basis_.adjoint()).real();
  out.diagonal().array() += 1;
  return out;
}

Eigen::MatrixXd SkewSpectrum::multiplied(const Eigen::MatrixXd& y, const Eigen::MatrixXcd& factors) const {
  const Eigen::MatrixXcd inner = basis_.adjoint() * y * basis_;
  return (basis_ * inner.cwiseProduct(factors) * basis_.adjoint()).real();
}

namespace {

/// f of half the differences of frequencies.
template <class F> Eigen::MatrixXcd of_differences(const Eigen::VectorXd& w, const F& f) {
  Eigen::MatrixXcd out(w.size(), w.size());
  for (Eigen::Index j = 0; j < w.size(); ++j)
    for (Eigen::Index k = 0; k < w.size(); ++k) out(j, k) = f(0.5 * (w(j) - w(k)));
  return out;
}

double sinc(double x) { return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x; }

/// Entry (j, i) of a generator of a plane's rotation, and its mirror image.
void set_turn(Eigen::MatrixXd& x, Eigen::Index i, Eigen::Index j, double angle) {
  x(j, i) = angle;
  x(i, j) = -angle;
}

}  // namespace

Eigen::MatrixXd SkewSpectrum::dexp(const Eigen::MatrixXd& y) const {
  return multiplied(y, of_differences(frequencies_, [](double d) { return std::polar(1.0, -d) * sinc(d); }));
}

Eigen::MatrixXd SkewSpectrum::dexp_inverse(const Eigen::MatrixXd& y) const {
  return multiplied(y, of_differences(frequencies_, [](double d) { return std::polar(1.0, d) / sinc(d); }));
}

std::optional<Eigen::MatrixXd> principal_log(const Eigen::MatrixXd& q) {
  // No plane is turned by more than a right angle.
  if ((q + q.transpose()).selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() > 0) return log_by_cayley(q);
  const Eigen::RealSchur<Eigen::MatrixXd> schur(q);
  const Eigen::MatrixXd& t = schur.matrixT();
  const Eigen::Index n = q.rows();
  Eigen::MatrixXd inner = Eigen::MatrixXd::Zero(n, n);
  std::vector<Eigen::Index> reversed;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i + 1 < n && t(i + 1, i) != 0) {
      set_turn(inner, i, i + 1, std::atan2(t(i + 1, i) - t(i, i + 1), t(i, i) + t(i + 1, i + 1)));
      ++i;
    } else if (t(i, i) < 0) {
      reversed.push_back(i);
    }
  }
  if (reversed.size() % 2 != 0) return std::nullopt;
  for (std::size_t k = 0; k < reversed.size(); k += 2) set_turn(inner, reversed[k], reversed[k + 1], pi);
  const Eigen::MatrixXd x = schur.matrixU() * inner * schur.matrixU().transpose();
  return 0.5 * (x - x.transpose());
}

}  // namespace lagroid
