#include <lagroid/systems/optimisation/extreme_eigenvalues.hpp>

#include <Spectra/SymEigsSolver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lagroid::optimisation {

namespace {

/// (A - shift) / scale as Spectra wants it.
class Scaled {
 public:
  using Scalar = double;
  Scaled(const SymmetricOperator& a, double shift, double scale) : a_(a), shift_(shift), scale_(scale) {}

  Eigen::Index rows() const { return a_.size; }
  Eigen::Index cols() const { return a_.size; }
  void perform_op(const double* in, double* out) const {
    const Eigen::Map<const Eigen::MatrixXd> x(in, a_.size, 1);
    Eigen::Map<Eigen::MatrixXd> y(out, a_.size, 1);
    a_.apply(x, y);
    y = (y - shift_ * x) / scale_;
  }

 private:
  const SymmetricOperator& a_;
  double shift_;
  double scale_;
};

/// A Rayleigh quotient and the residual that goes with it, of a vector that is orthogonal to nothing in particular.
std::pair<double, double> shift_and_scale(const SymmetricOperator& a) {
  Eigen::MatrixXd v(a.size, 1);
  for (Eigen::Index i = 0; i < a.size; ++i)
    v(i) = std::sin(1.3 * double(i + 1)) + 0.5 * std::cos(0.37 * double(i) * double(i));
  v.normalize();
  Eigen::MatrixXd w(a.size, 1);
  a.apply(v, w);
  const double shift = v.col(0).dot(w.col(0));
  return {shift, (w - shift * v).stableNorm()};
}

}  // namespace

Eigen::VectorXd extreme_eigenvalues(const SymmetricOperator& a, SpectrumEnd end, Eigen::Index count, Eigen::Index basis,
                                    double tolerance) {
  constexpr Eigen::Index restarts = 3000;
  const auto [shift, scale] = shift_and_scale(a);
  if (!std::isfinite(scale)) return Eigen::VectorXd::Constant(count, std::numeric_limits<double>::quiet_NaN());
  if (scale <= 1e-14 * std::abs(shift)) return Eigen::VectorXd::Constant(count, shift);
  const auto rule = end == SpectrumEnd::both ? Spectra::SortRule::BothEnds : Spectra::SortRule::SmallestAlge;
  Scaled op(a, shift, scale);
  Spectra::SymEigsSolver<Scaled> solver(op, count, std::min(a.size, basis));
  solver.init();
  if (solver.compute(rule, restarts, tolerance, Spectra::SortRule::LargestAlge) < count)
    throw std::runtime_error("the ends of the spectrum were not found; is the matrix symmetric?");
  return (scale * solver.eigenvalues()).array() + shift;
}

}  // namespace lagroid::optimisation
