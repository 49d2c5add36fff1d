#pragma once
/// Other differentials for the iterations of lie_newton.hpp: finite differences, truncated series of dexp and of its
/// inverse, and exact ones by dual numbers.
///
///     dexp_v = sum_k (-1)^k ad_v^k / (k + 1)!
///
/// They serve where no derivative is written (AutomaticField, FiniteDifferences), and to see what cheaper ones cost in
/// convergence ([N] section 5).
///
///     const GroupoidFibre<SO3> fibre(SO3::exp(Vector<double, 3>(0.4, -0.2, 0.9)));
///     const AutomaticField field(fibre, [](const auto& y) { return y.diagonal().eval(); });
///     const auto found = lie_newton(FiniteDifferences(ImplicitStep{fibre, field, 0.5}), Vector<double, 3>::Zero());
///
/// Requirements stand with each class. [N] section 3.2

#include <lagroid/core/scalars/dual.hpp>
#include <lagroid/solvers/newton/lie_newton.hpp>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace lagroid {

/// E with quotients of f along the basis for its differentials: along the fibre by (3.18), in coordinates by the
/// quotient of (3.19), of which (3.15) is the case f = v - h g. Columns where the displaced y has no coordinates are
/// not finite, and the iteration then `singular`.
template <FibreEquation E> class FiniteDifferences : public E {
 public:
  using Point = typename E::Fibre::Point;
  using Vector = typename E::Fibre::Vector;
  using Matrix = typename E::Fibre::Matrix;
  using Scalar = typename Vector::Scalar;

  explicit FiniteDifferences(E equation) : E(std::move(equation)) {}

  Matrix differential(const Point& y, const Vector& v) const {
    return quotients(y, v, [&](const Vector& u) {
      const Point moved = this->fibre().moved(y, u);
      return std::pair{moved, this->fibre().coordinates(moved)};
    });
  }
  Matrix chart_differential(const Point& y, const Vector& v) const {
    return quotients(y, v, [&](const Vector& u) {
      const Vector w = v + u;
      return std::pair{this->fibre().at(w), std::optional<Vector>(w)};
    });
  }

 private:
  template <class Move> Matrix quotients(const Point& y, const Vector& v, const Move& move) const {
    const Scalar t = std::sqrt(std::numeric_limits<Scalar>::epsilon());
    const Vector f = this->residual(y, v);
    Matrix out(f.size(), f.size());
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      const auto [point, coordinates] = move(t * Vector::Unit(f.size(), i));
      if (coordinates) {
        out.col(i) = (this->residual(point, *coordinates) - f) / t;
      } else {
        out.col(i).setConstant(std::numeric_limits<Scalar>::quiet_NaN());
      }
    }
    return out;
  }
};

/// F with dtau_v^{-1} from quotients of the logarithm (3.12).
template <SourceFibre F> class QuotientFibre : public F {
 public:
  using Vector = typename F::Vector;
  using Matrix = typename F::Matrix;

  explicit QuotientFibre(F fibre) : F(std::move(fibre)) {}
  QuotientFibre around(const typename F::Point& y) const { return QuotientFibre(F::around(y)); }

  Matrix dtau_inverse(const Vector& v) const { return FiniteDifferences(Logarithm{*this}).differential(F::at(v), v); }

 private:
  /// f = v, the logarithm itself.
  struct Logarithm {
    using Fibre = F;
    const F& base;
    const F& fibre() const { return base; }
    Vector residual(const typename F::Point&, const Vector& v) const { return v; }
    Matrix differential(const typename F::Point&, const Vector& v) const { return base.dtau_inverse(v); }
    Matrix chart_differential(const typename F::Point&, const Vector& v) const {
      return Matrix::Identity(v.size(), v.size());
    }
    double norm(const Vector& v) const { return base.norm(v); }
  };
};

/// F with the series of dexp_v (2.10) and of its inverse (3.9) cut off after the power `order` of ad_v: order 0 is
/// (3.10) and (3.16), order 1 (3.11) and (3.17). Requires F::ad, and that tau is exp, or that order < 2 and
/// tau(v)^{-1} = tau(-v).
template <SourceFibre F>
requires requires(const F& fibre, const typename F::Vector& v) {
  { fibre.ad(v) } -> std::convertible_to<typename F::Matrix>;
}
class TruncatedFibre : public F {
 public:
  using Vector = typename F::Vector;
  using Matrix = typename F::Matrix;

  TruncatedFibre(F fibre, int order) : F(std::move(fibre)), order_(order) {}
  TruncatedFibre around(const typename F::Point& y) const { return TruncatedFibre(F::around(y), order_); }

  Matrix dtau(const Vector& v) const { return series(v, false); }
  Matrix dtau_inverse(const Vector& v) const { return series(v, true); }

 private:
  Matrix series(const Vector& v, bool inverse) const {
    // dexp has the coefficients (-1)^k / (k + 1)!; those of the inverse follow from the product of the two series.
    std::vector<double> dexp{1};
    std::vector<double> reciprocal{1};
    for (int k = 1; k <= order_; ++k) {
      dexp.push_back(-dexp.back() / (k + 1));
      double sum = 0;
      for (int j = 0; j < k; ++j) sum -= reciprocal[std::size_t(j)] * dexp[std::size_t(k - j)];
      reciprocal.push_back(sum);
    }
    const Matrix ad = F::ad(v);
    Matrix power = Matrix::Identity(v.size(), v.size());
    Matrix out = power;
    for (int k = 1; k <= order_; ++k) {
      power = (ad * power).eval();
      out += (inverse ? reciprocal : dexp)[std::size_t(k)] * power;
    }
    return out;
  }

  int order_;
};

/// E with its own differentials, and the truncated dtau_v for version1_by_chart: (3.13) with (3.16) or (3.17).
template <FibreEquation E> class TruncatedTransport : public E {
 public:
  using Fibre = TruncatedFibre<typename E::Fibre>;

  TruncatedTransport(E equation, int order) : E(std::move(equation)), fibre_(E::fibre(), order) {}
  const Fibre& fibre() const { return fibre_; }

 private:
  Fibre fibre_;
};

/// A field for ImplicitStep with an exact dg by dual numbers: `function` maps points, over any scalar, to vectors.
/// Requires F::displaced.
template <SourceFibre F, class Function>
requires requires(const F& fibre, const typename F::Point& y, const typename F::Vector& u) { fibre.displaced(y, u); }
class AutomaticField {
 public:
  using Point = typename F::Point;
  using Vector = typename F::Vector;
  using Matrix = typename F::Matrix;

  AutomaticField(F fibre, Function function) : fibre_(std::move(fibre)), function_(std::move(function)) {}
  Vector g(const Point& y) const { return function_(y); }
  Matrix dg(const Point& y) const {
    const Eigen::Index n = fibre_.dimension();
    Matrix out(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto moved = function_(fibre_.displaced(y, Vector::Unit(n, i)));
      for (Eigen::Index k = 0; k < n; ++k) out(k, i) = moved(k).derivative;
    }
    return out;
  }

 private:
  F fibre_;
  Function function_;
};

}  // namespace lagroid
