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
/// outside of the system's domain, or the values are not reached from it. Nothing is allocated, nothing throws.
///
/// Source: Hairer, Lubich, Wanner, *Geometric Numerical Integration*, 2006, IV.4.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/poisson/gauss_collocation.hpp>
#include <lagroid/core/poisson/poisson_system.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace lagroid {

template <class Sys, bool WithEnergy> class Levels {
 public:
  static constexpr int n = Sys::dimension;
  static constexpr int casimirs = casimir_count<Sys>();
  static constexpr int count = casimirs + int(WithEnergy);
  using X = Vector<double, n>;

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

 private:
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
    constexpr double dependent = 1e-4;
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
