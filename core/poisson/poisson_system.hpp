#pragma once
/// Poisson systems: numbers x in R^N, a Poisson bivector pi(x) and a Hamiltonian H(x), which move by
///
///     x'^i = pi^{ij}(x) d_j H(x),    {f, g} = d_i f pi^{ij} d_j g.
///
/// Most brackets are not those of an A*G, which are linear on its fibres: populations, lattices, lasers and systems
/// that were reduced have others. Bivector, Hamiltonian and Casimirs are all that is written of one; its local
/// symplectic groupoid and its integrators follow.
///
///     struct Populations : PoissonSystem<Populations, 2> {
///       template <class S> Matrix<S, 2, 2> bivector(const Vector<S, 2>& x) const {
///         const S xy = x(0) * x(1);
///         return skew<S, 2>({{0, 1, xy}});
///       }
///       template <class S> S hamiltonian(const Vector<S, 2>& x) const { return log(x(0) * x(1)) - x(0) - x(1); }
///     };
///
/// Requires an antisymmetric pi that satisfies the Jacobi identity (laws::poisson_laws asks both), smooth where the
/// motion goes. A system may also have
///
///     template <class S> Vector<S, K> casimirs(const Vector<S, N>& x) const  they commute with all functions
///     static std::array<std::string, N> labels()                             what the numbers are called
///     bool contains(const Vector<double, N>& x) const                        where pi and H are smooth
///     std::string refusal(const Vector<double, N>& x) const                  why x is no start, "" where it is one
///     static constexpr int parts = F;                                        H = sum_i H_i(<l_i, x>), F terms:
///     template <class S> S part(int i, const S& s) const                     H_i, in place of `hamiltonian`
///     template <class S> S part_slope(int i, const S& s) const               H_i', where it costs less
///     Vector<double, N> form(int i) const                                    l_i; else the i-th axis
///     static constexpr std::array<std::string_view, K> noise_names           of its noise Hamiltonians:
///     template <class S> S noise(int k, const Vector<S, N>& x) const         H_k, which drive it along their fields
///     static constexpr bool linear_bracket = true;                           pi(x) is linear in x
///     static constexpr bool in_lanes = true;                                 its formulas hold over Batch
///     static constexpr double rotation_sign                                  pi(x) p = s x x p, three by three
///     static constexpr int turned_vectors                                    rotations that turn so many vectors
///     template <class S = double> Matrix<.., N, N> log_coefficients() const  {x_i, x_j} = c_ij x_i x_j
///
/// and parameters as other systems declare them (core/parameter.hpp), which formulas read by `varied` where derivatives
/// by them are wanted (core/scalars/varied.hpp). Returns derivatives that are exact, by jets.
/// Nothing throws.
///
/// Source: Weinstein, The local structure of Poisson manifolds, 1983.

#include <lagroid/core/derivatives/directional.hpp>
#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/core/types.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>

namespace lagroid {

template <class Derived, int N> struct PoissonSystem;

/// A bivector is there, for numbers.
template <class Sys>
concept PoissonStructure = requires(const Sys& system, const Vector<double, Sys::dimension>& x) {
  { system.bivector(x) } -> std::convertible_to<Matrix<double, Sys::dimension, Sys::dimension>>;
};
template <class Sys>
concept HasCasimirs = requires(const Sys& system, const Vector<double, Sys::dimension>& x) {
  system.casimirs(x)(0);
};
/// Its bivector is a linear function of x.
template <class Sys>
concept HasLinearBracket = requires {
  requires Sys::linear_bracket;
};
/// The energy is a sum of functions of linear forms.
template <class Sys>
concept SumOfForms = requires(const Sys& system) {
  { Sys::parts } -> std::convertible_to<int>;
  { system.part(0, 1.0) } -> std::convertible_to<double>;
};
namespace detail {
/// Takes the forms that a system has from its base.
template <class Derived, int N> void inherited(Vector<double, N> (PoissonSystem<Derived, N>::*form)(int) const);
}  // namespace detail
/// Those forms are the coordinates themselves: the system writes no others.
template <class Sys>
concept HasAxesAsForms = requires {
  detail::inherited(&Sys::form);
};
/// Noise may drive it, along the Hamiltonian fields of functions of its own.
template <class Sys>
concept HasNoise = requires(const Sys& system, const Vector<double, Sys::dimension>& x) {
  { Sys::noise_names.size() } -> std::convertible_to<std::size_t>;
  { system.noise(0, x) } -> std::convertible_to<double>;
};
/// How many functions those are.
template <class Sys> constexpr int noise_count() {
  if constexpr (HasNoise<Sys>) {
    return int(Sys::noise_names.size());
  } else {
    return 0;
  }
}

/// c of a bracket {x_i, x_j} = c_ij x_i x_j; over the scalar of parameters in a formula over S, where it depends on
/// these.
template <class S, class Sys> auto log_coefficients_of(const Sys& system) {
  if constexpr (requires { system.template log_coefficients<S>(); }) {
    return system.template log_coefficients<S>();
  } else {
    return system.log_coefficients();
  }
}

/// One entry above the diagonal of an antisymmetric matrix.
template <class S> struct SkewEntry {
  int row;
  int column;
  S value;
};
/// Writes an entry, and the one across the diagonal.
template <class S, int N> void set_skew(Matrix<S, N, N>& matrix, int row, int column, const S& value) {
  matrix(row, column) = value;
  matrix(column, row) = -value;
}
/// The antisymmetric matrix with these entries, and zeros elsewhere.
template <class S, int N> Matrix<S, N, N> skew(std::initializer_list<SkewEntry<S>> entries) {
  Matrix<S, N, N> out;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) out(i, j) = S(0.0);
  for (const SkewEntry<S>& e : entries) set_skew(out, e.row, e.column, e.value);
  return out;
}

/// Base of Poisson systems: what follows from bivector and Hamiltonian.
template <class Derived, int N> struct PoissonSystem {
  static constexpr int dimension = N;

  /// pi(x) p: how the Hamiltonian <p, x> moves x. Both scalars may have derivatives, or one alone.
  template <class S> Vector<S, N> field(const Vector<S, N>& x, const Vector<S, N>& p) const {
    return applied(self().bivector(x), p);
  }
  /// pi(x) dH(x).
  template <class S> Vector<S, N> velocity(const Vector<S, N>& x) const { return field(x, gradient(x)); }

  /// The sum of the parts, for systems that write these.
  template <class S> S hamiltonian(const Vector<S, N>& x) const {
    S sum(0.0);
    for (int i = 0; i < Derived::parts; ++i) {
      const Vector<double, N> l = self().form(i);
      S along(0.0);
      for (int j = 0; j < N; ++j)
        if (l(j) != 0) along += x(j) * l(j);
      sum += self().part(i, along);
    }
    return sum;
  }
  Vector<double, N> form(int i) const { return Vector<double, N>::Unit(i); }

  /// dH(x). A system that has it in closed form supplies its own.
  template <class S> Vector<S, N> gradient(const Vector<S, N>& x) const {
    if constexpr (std::same_as<S, double>) {
      Vector<Jet<double, N>, N> at;
      for (int i = 0; i < N; ++i) at(i) = Jet<double, N>::variable(x(i), i);
      return self().hamiltonian(at).gradient();
    } else {
      return gradient_of([this](const auto& y) { return self().hamiltonian(y); }, x);
    }
  }

  /// Where the system has a smooth bracket and energy: everywhere, unless it says otherwise.
  bool contains(const Vector<double, N>&) const { return true; }
  /// x1, x2, ..., unless the system names its numbers.
  static std::array<std::string, N> labels() {
    std::array<std::string, N> out;
    for (int i = 0; i < N; ++i) out[std::size_t(i)] = "x" + std::to_string(i + 1);
    return out;
  }

  /// a p, entry by entry.
  template <class S> static Vector<S, N> applied(const Matrix<S, N, N>& a, const Vector<S, N>& p) {
    Vector<S, N> out;
    for (int i = 0; i < N; ++i) {
      S sum = a(i, 0) * p(0);
      for (int j = 1; j < N; ++j) sum += a(i, j) * p(j);
      out(i) = sum;
    }
    return out;
  }

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }
};

/// How many Casimirs the system names.
template <class Sys> constexpr int casimir_count() {
  if constexpr (HasCasimirs<Sys>) {
    using X = Vector<double, Sys::dimension>;
    return std::remove_cvref_t<decltype(std::declval<const Sys&>().casimirs(
        std::declval<const X&>()))>::SizeAtCompileTime;
  } else {
    return 0;
  }
}

/// dH and the second derivatives of H, from one evaluation.
template <int N> struct EnergyDerivatives {
  Vector<double, N> gradient;
  Matrix<double, N, N> hessian;
};
template <class Sys>
EnergyDerivatives<Sys::dimension> energy_derivatives(const Sys& system, const Vector<double, Sys::dimension>& x) {
  constexpr int n = Sys::dimension;
  Vector<SecondJet<double, n>, n> at;
  for (int i = 0; i < n; ++i) at(i) = SecondJet<double, n>::variable(x(i), i);
  const SecondJet<double, n> h = system.hamiltonian(at);
  return {h.gradient(), h.hessian()};
}

}  // namespace lagroid
