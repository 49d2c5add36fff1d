#pragma once
/// The values of Casimirs, and of the energy, that a motion on a Poisson manifold began with, and the nearest point
/// that has them.
///
///     Levels<EulerTop, false> spheres(EulerTop{}, Vector<double, 3>(0.8, 0.6, 1.1));
///     Vector<double, 3> x(0.8, 0.6, 1.2);
///     const bool there = spheres.project(EulerTop{}, x);  // on the sphere of the first point
///
/// Along the gradients at the point, by Newton's method; Casimirs come first. A value whose gradient is zero or depends
/// on those before it, as the energy's at a relative equilibrium, is left as it is. Returns false where a point is
/// outside of the system's domain, or the values are not reached from it. Nothing is allocated but where it is said,
/// nothing throws.
///
/// The derivative of that point is the one of its equations, by the implicit function theorem: from y along the
/// gradients G(y) there,
///
///     z = y + sum_c l_c dC_c(y),    C(z) = L,
///
/// where `project` ends but for the third power of how far y was off, as all but the first of Newton's corrections are
/// small; none of them is differentiated. With u = y + sum_c l_c dC_c(y), the l_c being held,
///
///     dz = du + G(y)^T dl,    G(z) G(y)^T dl = dL - G(z) du.
///
/// `slope_along` is that of u, `detail::AlongGradients` has the l_c and the rest, `slope_of_way` is all of it. Where
/// gradients are kept at y, as in a ProjectedStep (steps.hpp), it is exact.
///
/// Source: Hairer, Lubich, Wanner, *Geometric Numerical Integration*, 2006, IV.4.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/poisson/gauss_collocation.hpp>
#include <lagroid/core/poisson/poisson_system.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace lagroid {

namespace detail {

/// A B.
inline Eigen::MatrixXd multiplied(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd out(a.rows(), b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      double sum = 0;
      for (Eigen::Index k = 0; k < b.rows(); ++k) sum += a(i, k) * b(k, j);
      out(i, j) = sum;
    }
  return out;
}
/// Of f(x, members), from its own derivative, by x and members, and that of x.
inline Eigen::MatrixXd chained(const Eigen::MatrixXd& of_f, const Eigen::MatrixXd& of_x) {
  Eigen::MatrixXd out = multiplied(of_f, of_x);
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    for (Eigen::Index j = of_x.rows(); j < out.cols(); ++j) out(i, j) += of_f(i, j);
  return out;
}

/// The way from y along the gradients to levels, and its derivative. Derivatives have a column for each number of the
/// point that a run begins from, and then for members of its system; gradients that `Levels` passes over move nothing.
/// Sizes are known at run time and products written entry by entry, for the sake of compile times (docs/decisions/72).
class AlongGradients {
 public:
  /// `moved` is z - y. One of which so much of its length is left beside those before it, or less, is passed over.
  AlongGradients(const Eigen::MatrixXd& gradients, const Eigen::VectorXd& moved, double dependent)
      : units_(gradients.cols(), gradients.rows()), scale_(Eigen::VectorXd::Zero(gradients.rows())) {
    units_.setZero();
    Eigen::MatrixXd directions = units_;
    for (Eigen::Index c = 0; c < units_.cols(); ++c) take(gradients, c, dependent, directions);
    Eigen::MatrixXd by(units_.cols(), 1);
    for (Eigen::Index c = 0; c < by.rows(); ++c) by(c, 0) = product(units_, c, moved, 0);
    by = solved(gradients, std::move(by));
    multipliers_ = by.col(0);
    for (Eigen::Index c = 0; c < by.rows(); ++c) multipliers_(c) *= scale_(c);
  }

  /// The l_c.
  const Eigen::VectorXd& multipliers() const { return multipliers_; }
  /// Of z, from those of u, of C by z and members, and of the levels.
  Eigen::MatrixXd slope(const Eigen::MatrixXd& of_u, const Eigen::MatrixXd& of_values,
                        const Eigen::MatrixXd& of_levels) const {
    Eigen::MatrixXd missing = chained(of_values, of_u);
    for (Eigen::Index c = 0; c < missing.rows(); ++c)
      for (Eigen::Index j = 0; j < missing.cols(); ++j) missing(c, j) = scale_(c) * (of_levels(c, j) - missing(c, j));
    Eigen::MatrixXd out = multiplied(units_, solved(of_values, std::move(missing)));
    out += of_u;
    return out;
  }

 private:
  /// a_i . b_j, columns.
  static double product(const Eigen::MatrixXd& a, Eigen::Index i, const Eigen::MatrixXd& b, Eigen::Index j) {
    double sum = 0;
    for (Eigen::Index k = 0; k < a.rows(); ++k) sum += a(k, i) * b(k, j);
    return sum;
  }
  /// Gradient c of length one, and its direction beside those before it, unless it is passed over.
  void take(const Eigen::MatrixXd& gradients, Eigen::Index c, double dependent, Eigen::MatrixXd& directions) {
    const auto scaled = [](Eigen::MatrixXd& columns, Eigen::Index of) {
      const double length = std::sqrt(product(columns, of, columns, of));
      for (Eigen::Index i = 0; i < columns.rows(); ++i) columns(i, of) *= length > 0 ? 1 / length : 0;
      return length;
    };
    for (Eigen::Index i = 0; i < units_.rows(); ++i) units_(i, c) = gradients(c, i);
    const double length = scaled(units_, c);
    for (Eigen::Index i = 0; i < units_.rows(); ++i) directions(i, c) = units_(i, c);
    for (Eigen::Index k = 0; k < c; ++k) {
      const double both = product(directions, k, units_, c);
      for (Eigen::Index i = 0; i < units_.rows(); ++i) directions(i, c) -= both * directions(i, k);
    }
    const bool tells = scaled(directions, c) > dependent;
    if (tells) scale_(c) = 1 / length;
    for (Eigen::Index i = 0; !tells && i < units_.rows(); ++i) units_(i, c) = directions(i, c) = 0;
  }
  /// X of A X = B, A = scale G units, and 1 where gradients are passed over.
  Eigen::MatrixXd solved(const Eigen::MatrixXd& of_values, const Eigen::MatrixXd& right) const {
    Eigen::MatrixXd a = multiplied(of_values, units_);
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      for (Eigen::Index j = 0; j < a.cols(); ++j) a(i, j) *= scale_(i);
      if (scale_(i) == 0) a(i, i) = 1;
    }
    return solve_regular(a, right);
  }

  Eigen::MatrixXd units_;  ///< gradients of length one, a column each; 0 where they are passed over
  Eigen::VectorXd scale_;  ///< one over their lengths, or 0
  Eigen::VectorXd multipliers_;
};

}  // namespace detail

template <class Sys, bool WithEnergy> class Levels {
 public:
  static constexpr int n = Sys::dimension;
  static constexpr int casimirs = casimir_count<Sys>();
  static constexpr int count = casimirs + int(WithEnergy);
  using X = Vector<double, n>;
  using Members = std::span<const double* const>;  ///< of the very system that is given
  /// Of a gradient's length: where no more is left beside those before it, it says nothing.
  static constexpr double dependent = 1e-4;

  Levels(const Sys& system, const X& start) : values_(measured<double>(system, start)) {}

  bool project(const Sys& system, X& x) const {
    constexpr int most_passes = 4;
    constexpr double near = 1e-9;  // whose square is rounding: what is left after a pass
    if (!system.contains(x)) return false;
    if constexpr (count > 0) {
      for (int pass = 0; pass < most_passes; ++pass) {
        Vector<Jet<double, n>, n> at;
        for (int i = 0; i < n; ++i) at(i) = Jet<double, n>::variable(x(i), i);
        const auto here = measured<Jet<double, n>>(system, at);
        Vector<double, count> gap;
        Vector<double, count> relative;  // to the terms that the values are sums of
        Matrix<double, count, n> slope;
        for (int c = 0; c < count; ++c) {
          const auto at_c = std::size_t(c);
          gap(c) = values_[at_c] - here[at_c].value;
          slope.row(c) = here[at_c].gradient().transpose();
          double terms = std::abs(values_[at_c]);
          for (int i = 0; i < n; ++i) terms += std::abs(x(i) * slope(c, i));
          relative(c) = std::abs(gap(c)) / (terms > 0 ? terms : 1);
        }
        if (relative.maxCoeff() <= std::numeric_limits<double>::epsilon()) return true;
        if (move(slope, gap, relative, x) <= near) return true;
      }
      return false;
    }
    return true;
  }
  void serialize(NumberArchive& archive) { archive(values_); }

  /// Derivatives of the values by x and by members, a row each. Allocates.
  static Matrix<double, count, Eigen::Dynamic> slope_of_values(const Sys& system, const X& x, Members members = {}) {
    const auto values = [&]<class S>(const Vector<S, n>& at) {
      const auto all = measured<S>(system, at);
      Vector<S, count> out;
      for (int c = 0; c < count; ++c) out(c) = all[std::size_t(c)];
      return out;
    };
    return varied_jacobian<count>(values, x, members);
  }
  /// Those of x + sum_c l_c dC_c(x), l the multipliers. Allocates.
  static Matrix<double, n, Eigen::Dynamic> slope_along(const Sys& system, const X& x,
                                                       const Vector<double, count>& multipliers, Members members) {
    const auto moved = [&](const Vector<VariedNumber, n>& at) {
      Vector<VariedNumber, n> out = at;
      if constexpr (WithEnergy) add(system.gradient(at), multipliers(casimirs), out);
      if constexpr (casimirs > 0) {
        const auto sum = [&](const Vector<Dual<VariedNumber>, n>& y) {
          const auto values = system.casimirs(y);
          Dual<VariedNumber> all = values(0) * multipliers(0);
          for (int c = 1; c < casimirs; ++c) all += values(c) * multipliers(c);
          return all;
        };
        add(gradient_of(sum, at), 1, out);
      }
      return out;
    };
    return varied_jacobian<n>(moved, x, members);
  }
  /// That of the point z of levels that is reached along the gradients at y, from those of y and of the levels, by the
  /// same columns. Gradients are passed over as by AlongGradients. Allocates.
  static Eigen::MatrixXd slope_of_way(const Sys& system, const X& y, const X& z, const Eigen::MatrixXd& of_y,
                                      const Eigen::MatrixXd& of_levels, Members members,
                                      double passed_over = dependent) {
    const detail::AlongGradients way(slope_of_values(system, y), z - y, passed_over);
    const Eigen::MatrixXd of_u = detail::chained(slope_along(system, y, way.multipliers(), members), of_y);
    return way.slope(of_u, slope_of_values(system, z, members), of_levels);
  }

 private:
  static void add(const Vector<VariedNumber, n>& a, double times, Vector<VariedNumber, n>& out) {
    for (int i = 0; i < n; ++i) out(i) += a(i) * times;
  }
  /// Energy last.
  template <class S> static std::array<S, std::size_t(count)> measured(const Sys& system, const Vector<S, n>& x) {
    std::array<S, std::size_t(count)> all;
    if constexpr (casimirs > 0) {
      const auto values = system.casimirs(x);
      for (int c = 0; c < casimirs; ++c) all[std::size_t(c)] = values(c);
    }
    if constexpr (WithEnergy) all[std::size_t(casimirs)] = system.hamiltonian(x);
    return all;
  }
  /// Along the gradients, made orthonormal one after another; one that depends on those before it says nothing more.
  /// Returns how far those that say something were off.
  static double move(const Matrix<double, count, n>& slope, const Vector<double, count>& gap,
                     const Vector<double, count>& relative, X& x) {
    double farthest = 0;
    Matrix<double, count, n> directions;
    Vector<double, count> along;
    int found = 0;
    for (int c = 0; c < count; ++c) {
      const double length = slope.row(c).norm();
      if (!(length > 0)) continue;
      X direction = slope.row(c).transpose() / length;
      double by = gap(c) / length;
      for (int k = 0; k < found; ++k) {
        const double both = directions.row(k).dot(slope.row(c)) / length;
        direction -= both * directions.row(k).transpose();
        by -= both * along(k);
      }
      const double rest = direction.norm();
      if (!(rest > dependent)) continue;
      directions.row(found) = direction.transpose() / rest;
      along(found) = by / rest;
      detail::raise(farthest, relative(c));
      ++found;
    }
    for (int k = 0; k < found; ++k) x += along(k) * directions.row(k).transpose();
    return farthest;
  }

  std::array<double, std::size_t(count)> values_;
};

}  // namespace lagroid
