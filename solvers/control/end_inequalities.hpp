#pragma once
/// Derivatives of inequalities that depend on where an arrow ends and on the controls, gamma(beta(g), u): along these
/// n + c directions alone, of the 2n + c + 1 of a stage. A second-order jet costs the square of its directions.
///
///     static constexpr bool inequalities_of_end = true;  // a system's: neither of the arrow's source nor of h
///
/// What a system says so of that is not true is found by `laws::transcription_laws`, which compares with differences.
/// Nothing throws.

#include <lagroid/solvers/control/displaced_jet.hpp>

namespace lagroid {

template <class Sys>
concept InequalitiesOfEnd = requires {
  requires Sys::inequalities_of_end;
};

/// Writes the derivatives of each gamma_i along the stage's variables (a, b, du, t) into a row of `rows`, and adds the
/// Hessian of <z, gamma> to `hessian`, both of 2n + c + 1 columns.
template <InequalitiesOfEnd Sys>
void inequalities_of_end(const Sys& system, const ArrowOf<typename Sys::GroupoidType>& g,
                         const Vector<double, Sys::controls>& at, double h, const double* z, double* rows,
                         double* hessian) {
  constexpr int n = Sys::dimension;
  constexpr int few = n + Sys::controls;
  constexpr int all = 2 * n + Sys::controls + 1;
  using J = SecondJet<double, few>;
  Vector<J, Sys::controls> u;
  for (int i = 0; i < Sys::controls; ++i) u(i) = J::variable(at(i), n + i);
  const Vector<J, Sys::inequalities> gamma = system.inequality(displaced_end_jet<J>(system.groupoid, g, 0), u, J(h));
  for (int i = 0; i < Sys::inequalities; ++i) {
    double* row = rows + i * all;
    for (int j = 0; j < all; ++j) row[j] = j < n || j + 1 == all ? 0 : gamma(i).gradient(j - n);
    for (int j = 0; j < few; ++j)
      for (int k = 0; k < few; ++k) hessian[(n + j) * all + n + k] += z[i] * gamma(i).hessian(j, k);
  }
}

}  // namespace lagroid
