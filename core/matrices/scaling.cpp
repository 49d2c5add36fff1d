#include <lagroid/core/matrices/scaling.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <utility>

namespace lagroid::detail {

namespace {

/// Up to these sizes loops are of a fixed size, for steps are solved with them (a factorisation takes a second to
/// compile); up to `small` no memory is allocated.
constexpr int fixed_scales = 8;
constexpr int fixed_factors = 4;
constexpr int small = 16;

/// Vectors and matrices of a number of entries: std::integral_constant, or an int that is at most Most.
template <class Count, int Most> struct Sized {
  static constexpr int size = Eigen::Dynamic;
  static constexpr int most = Most;
};
template <int N, int Most> struct Sized<std::integral_constant<int, N>, Most> {
  static constexpr int size = N;
  static constexpr int most = N;
};
template <class Count, int Most>
using VectorOf = Eigen::Matrix<double, Sized<Count, Most>::size, 1, Eigen::ColMajor, Sized<Count, Most>::most, 1>;
template <class Count, int Most>
using MatrixOf = Eigen::Matrix<double, Sized<Count, Most>::size, Sized<Count, Most>::size, Eigen::ColMajor,
                               Sized<Count, Most>::most, Sized<Count, Most>::most>;

/// In the ratio: 2^round(log2 x).
double nearest_power_of_two(double x) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);  // from a half to one
  return std::ldexp(1.0, fraction < 0.5 * std::numbers::sqrt2 ? exponent - 1 : exponent);
}

template <int Most, class Count>
void equilibrate_of(Count row_count, Count column_count, const double* a, double* row_scale, double* column_scale) {
  const int rows = row_count, columns = column_count;
  const auto inverse_root = [](double x) { return x > 0 && std::isfinite(x) ? 1 / std::sqrt(x) : 1.0; };
  std::fill_n(row_scale, rows, 1.0);
  std::fill_n(column_scale, columns, 1.0);
  VectorOf<Count, Most> in_row(rows), in_column(columns);
  for (int sweep = 0; sweep < 8; ++sweep) {
    in_row.setZero();
    in_column.setZero();
    for (int j = 0; j < columns; ++j)
      for (int i = 0; i < rows; ++i) {
        const double size = std::abs(row_scale[i] * a[i + j * rows] * column_scale[j]);
        in_row(i) = std::max(in_row(i), size);
        in_column(j) = std::max(in_column(j), size);
      }
    for (int i = 0; i < rows; ++i) row_scale[i] *= inverse_root(in_row(i));
    for (int j = 0; j < columns; ++j) column_scale[j] *= inverse_root(in_column(j));
  }
  std::transform(row_scale, row_scale + rows, row_scale, nearest_power_of_two);
  std::transform(column_scale, column_scale + columns, column_scale, nearest_power_of_two);
}

template <int Most, class Count> void solve_of(Count count, const double* a, const double* b, double* x) {
  const int size = count;
  VectorOf<Count, Most> row(size), column(size), side(size);
  equilibrate_of<Most>(count, count, a, row.data(), column.data());
  MatrixOf<Count, Most> scaled(size, size);
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) scaled(i, j) = row(i) * a[i + j * size] * column(j);
  for (int i = 0; i < size; ++i) side(i) = row(i) * b[i];
  const VectorOf<Count, Most> solution = Eigen::FullPivLU<MatrixOf<Count, Most>>(scaled).solve(side);
  for (int j = 0; j < size; ++j) x[j] = column(j) * solution(j);
}

/// Calls use(N) with N a constant, where the count is a small one; false where it is not.
template <int Largest, class Use> bool with_constant(int count, const Use& use) {
  return [&]<int... I>(std::integer_sequence<int, I...>) {
    return ((count == I + 1 && (use(std::integral_constant<int, I + 1>()), true)) || ...);
  }
  (std::make_integer_sequence<int, Largest>());
}

}  // namespace

void equilibrate(const double* a, int rows, int columns, double* row_scale, double* column_scale) {
  const auto of_constant = [&](auto size) { equilibrate_of<small>(size, size, a, row_scale, column_scale); };
  if (rows == columns && with_constant<fixed_scales>(rows, of_constant)) return;
  const auto of_size =
      std::max(rows, columns) <= small ? equilibrate_of<small, int> : equilibrate_of<Eigen::Dynamic, int>;
  of_size(rows, columns, a, row_scale, column_scale);
}

void solve_equilibrated(int size, const double* a, const double* b, double* x) {
  if (with_constant<fixed_factors>(size, [&](auto count) { solve_of<small>(count, a, b, x); })) return;
  const auto of_size = size <= small ? solve_of<small, int> : solve_of<Eigen::Dynamic, int>;
  of_size(size, a, b, x);
}

}  // namespace lagroid::detail
