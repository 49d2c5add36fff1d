#pragma once
/// What keeps a bracket from being a Poisson bracket at a point: the largest entry that is not antisymmetric, the
/// largest of the Jacobi identity,
///
///     J^{ijk} = pi^{li} d_l pi^{jk} + pi^{lj} d_l pi^{ki} + pi^{lk} d_l pi^{ij} = 0,
///
/// and the largest d_j C pi^{ij} of a Casimir. A motion by a bracket that is none keeps nothing that is promised.
///
///     const Vector<double, 2> x(1, 2);
///     const BracketDefect worst = worst_bracket_defect(Populations{}, x);
///     if (worst.relative > 1e-12) std::cerr << worst.sentence() << '\n';
///
/// Requires a bivector and Casimirs over jets. Returns values relative to the terms that they are sums of. Nothing
/// throws.

#include <lagroid/core/poisson/poisson_system.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace lagroid {

/// The largest value of a condition at a point: where, of which entries, how large and how large the terms are.
struct BracketDefect {
  std::string condition;     ///< "antisymmetry", "Jacobi identity", "Casimir"
  std::vector<int> entries;  ///< from 1 on
  std::vector<double> point;
  double value = 0;
  double relative = 0;  ///< over 1 and the largest term

  /// Takes the other where it is larger; one that is no number is largest.
  void raise(const BracketDefect& other) {
    if (!(other.relative <= relative)) *this = other;
  }
  /// "Jacobi identity of (1, 2, 3) is -2 at (0.5, 1, 2), not 0"
  std::string sentence() const {
    const auto list = [](std::ostringstream& out, const auto& numbers) {
      out << '(';
      for (std::size_t i = 0; i < numbers.size(); ++i) out << (i > 0 ? ", " : "") << numbers[i];
      out << ')';
    };
    std::ostringstream out;
    out.precision(10);
    out << condition << " of ";
    list(out, entries);
    out << " is " << value << " at ";
    list(out, point);
    out << ", not 0";
    return out.str();
  }
};

namespace detail {

template <int N>
BracketDefect defect_at(const char* condition, std::vector<int> entries, const Vector<double, N>& x, double value,
                        double terms) {
  const double size = std::abs(value) / std::max(1.0, terms);
  return {condition,
          std::move(entries),
          {x.data(), x.data() + N},
          value,
          std::isfinite(size) ? size : std::numeric_limits<double>::infinity()};
}

template <class Sys> auto bivector_jet(const Sys& system, const Vector<double, Sys::dimension>& x) {
  constexpr int n = Sys::dimension;
  Vector<Jet<double, n>, n> at;
  for (int i = 0; i < n; ++i) at(i) = Jet<double, n>::variable(x(i), i);
  return Matrix<Jet<double, n>, n, n>(system.bivector(at));
}

}  // namespace detail

/// pi^{ij} + pi^{ji}.
template <PoissonStructure Sys>
BracketDefect antisymmetry_defect(const Sys& system, const Vector<double, Sys::dimension>& x) {
  constexpr int n = Sys::dimension;
  const Matrix<double, n, n> pi = system.bivector(x);
  BracketDefect worst;
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j)
      worst.raise(detail::defect_at<n>("antisymmetry", {i + 1, j + 1}, x, pi(i, j) + pi(j, i),
                                       std::abs(pi(i, j)) + std::abs(pi(j, i))));
  return worst;
}

/// J^{ijk}.
template <PoissonStructure Sys>
BracketDefect jacobi_defect(const Sys& system, const Vector<double, Sys::dimension>& x) {
  constexpr int n = Sys::dimension;
  const auto pi = detail::bivector_jet(system, x);
  BracketDefect worst;
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      for (int k = j + 1; k < n; ++k) {
        double sum = 0;
        double terms = 0;
        const auto add = [&](int a, int b, int c) {
          for (int l = 0; l < n; ++l) {
            const double term = pi(l, a).value * pi(b, c).gradient(l);
            sum += term;
            terms += std::abs(term);
          }
        };
        add(i, j, k);
        add(j, k, i);
        add(k, i, j);
        worst.raise(detail::defect_at<n>("Jacobi identity", {i + 1, j + 1, k + 1}, x, sum, terms));
      }
  return worst;
}

/// pi dC for each Casimir that the system names; its number and that of the component.
template <PoissonStructure Sys>
BracketDefect casimir_defect(const Sys& system, const Vector<double, Sys::dimension>& x) {
  constexpr int n = Sys::dimension;
  BracketDefect worst;
  if constexpr (casimir_count<Sys>() > 0) {
    Vector<Jet<double, n>, n> at;
    for (int i = 0; i < n; ++i) at(i) = Jet<double, n>::variable(x(i), i);
    const Matrix<double, n, n> pi = system.bivector(x);
    const auto casimirs = system.casimirs(at);
    for (int c = 0; c < casimirs.size(); ++c)
      for (int i = 0; i < n; ++i) {
        double sum = 0;
        double terms = 0;
        for (int j = 0; j < n; ++j) {
          const double term = pi(i, j) * casimirs(c).gradient(j);
          sum += term;
          terms += std::abs(term);
        }
        worst.raise(detail::defect_at<n>("Casimir", {c + 1, i + 1}, x, sum, terms));
      }
  }
  return worst;
}

/// The worst of the three.
template <PoissonStructure Sys>
BracketDefect worst_bracket_defect(const Sys& system, const Vector<double, Sys::dimension>& x) {
  BracketDefect worst = antisymmetry_defect(system, x);
  worst.raise(jacobi_defect(system, x));
  worst.raise(casimir_defect(system, x));
  return worst;
}

}  // namespace lagroid
