#include <lagroid/systems/newton_examples.hpp>

#include <cmath>

namespace lagroid {

namespace {

template <class S> Eigen::MatrixX<S> sine(const Eigen::MatrixX<S>& y) { return y.array().sin(); }

/// What the first g makes of a change of y.
template <class S> Eigen::VectorX<S> beside_the_diagonal(const Eigen::MatrixX<S>& y) {
  Eigen::MatrixX<S> u = Eigen::MatrixX<S>::Zero(y.rows(), y.cols());
  u.diagonal(1) = y.diagonal(1);
  return skew_entries<S>(u - u.transpose());
}

/// The matrix with the columns change(r, c), for y E with E the generator (r, c): y E has y's column r as its column c
/// and minus y's column c as its column r.
template <class S, class Change> Eigen::MatrixX<S> along_generators(Eigen::Index n, const Change& change) {
  Eigen::MatrixX<S> out(n * (n - 1) / 2, n * (n - 1) / 2);
  Eigen::Index i = 0;
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index c = r + 1; c < n; ++c) out.col(i++) = change(r, c);
  return out;
}

template <class S> Eigen::MatrixX<S> dg_of_first(const Eigen::MatrixX<S>& y) {
  const Eigen::Index n = y.rows();
  return along_generators<S>(n, [&](Eigen::Index r, Eigen::Index c) {
    Eigen::MatrixX<S> change = Eigen::MatrixX<S>::Zero(n, n);
    change.col(c) = y.col(r);
    change.col(r) = -y.col(c);
    return beside_the_diagonal(change);
  });
}

template <class S> Eigen::MatrixX<S> dg_of_second(const Eigen::MatrixX<S>& y) {
  using Matrix = Eigen::MatrixX<S>;
  const Matrix s = sine(y);
  const Matrix cosine = y.array().cos();
  const Matrix square = y * y;
  const Matrix polynomial = 2 * y - 5 * square;
  const Matrix sy = s * y;
  const Matrix right = 2 * sy - 5 * (s * square);
  return along_generators<S>(y.rows(), [&](Eigen::Index r, Eigen::Index c) {
    // cos(y) o (y E) (2 y - 5 y^2) + sin(y) (2 y E - 5 (y E y + y y E)), all of rank two.
    Matrix u = cosine.col(c).cwiseProduct(y.col(r)) * polynomial.row(c) -
               cosine.col(r).cwiseProduct(y.col(c)) * polynomial.row(r) -
               5 * (sy.col(r) * y.row(c) - sy.col(c) * y.row(r));
    u.col(c) += right.col(r);
    u.col(r) -= right.col(c);
    return skew_entries<S>(u - u.transpose());
  });
}

}  // namespace

template <class S> Eigen::VectorX<S> ExampleField<S>::g(const Eigen::MatrixX<S>& y) const {
  if (example_ == NewtonExample::first) return beside_the_diagonal(y);
  const Eigen::MatrixX<S> u = sine(y) * (2 * y - 5 * y * y);
  return skew_entries<S>(u - u.transpose());
}

template <class S> Eigen::MatrixX<S> ExampleField<S>::dg(const Eigen::MatrixX<S>& y) const {
  return example_ == NewtonExample::first ? dg_of_first(y) : dg_of_second(y);
}

template class ExampleField<double>;
template class ExampleField<long double>;

}  // namespace lagroid
