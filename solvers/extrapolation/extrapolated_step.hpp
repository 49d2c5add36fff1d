#pragma once
/// One step of extrapolation on a homogeneous space by a given number of rows, over any scalar, derivatives included:
/// what ExtrapolationStep does (extrapolation_integrator.hpp), row after row.
///
///     const Spheres<1> sphere{};
///     auto spin = [](double, const auto&, auto& out) { out.setConstant(1); };  // an element of the algebra
///     Spheres<1>::Point z(0, 0, 1);
///     extrapolated_step(sphere, spin, 0, 0.1, 4, z);  // t, h, rows
///
/// Requires a field(t, z, u) that writes an element of the algebra. Throws std::invalid_argument for more rows than a
/// table has.

#include <lagroid/core/hamiltonian/homogeneous_space.hpp>
#include <lagroid/solvers/extrapolation/extrapolation_table.hpp>

namespace lagroid {

template <HomogeneousSpace M, class F>
void extrapolated_step(const M& space, F& field, double t, double h, int rows, typename M::Point& z) {
  using S = typename M::Point::Scalar;
  const ExtrapolationTable table = ExtrapolationTable::of(rows, 1, 2);
  typename M::Point sum = space.zero_point();
  typename M::Algebra slope = space.zero_algebra();
  for (int row = 1; row <= rows; ++row) {
    const double size = h / (2 * row);
    typename M::Point earlier = z, later = z;
    for (int i = 0; i < 2 * row; ++i) {
      field(t + i * size, later, slope);
      const double half = i == 0 ? 1 : 0;
      if constexpr (requires { space.leap(S(size), S(half), slope, earlier); }) {
        space.leap(S(size), S(half), slope, earlier);
      } else {
        slope *= S((2 - half) * size);
        space.act(slope, earlier);
      }
      earlier.swap(later);
    }
    sum += (later - z) * table.weights(row - 1, 0);
  }
  z += sum;
  space.project(z);
}

}  // namespace lagroid
