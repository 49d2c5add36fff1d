#include <lagroid/core/matrices/scaling.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace lagroid::detail {

namespace {

/// Up to this size no memory is allocated.
constexpr int small = 16;
template <int Size>
using MatrixUpTo = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, Size, Size>;
template <int Size> using VectorUpTo = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, Size, 1>;

template <int Size>
void equilibrate_up_to(const double* a, int rows, int columns, double* row_scale, double* column_scale) {
  const auto inverse_root = [](double x) { return x > 0 && std::isfinite(x) ? 1 / std::sqrt(x) : 1.0; };
  std::fill_n(row_scale, rows, 1.0);
  std::fill_n(column_scale, columns, 1.0);
  VectorUpTo<Size> in_row(rows);
  VectorUpTo<Size> in_column(columns);
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
  const auto power_of_two = [](double x) { return std::exp2(std::round(std::log2(x))); };
  std::transform(row_scale, row_scale + rows, row_scale, power_of_two);
  std::transform(column_scale, column_scale + columns, column_scale, power_of_two);
}

template <int Size> void solve_up_to(int size, const double* a, const double* b, double* x) {
  VectorUpTo<Size> row(size);
  VectorUpTo<Size> column(size);
  equilibrate_up_to<Size>(a, size, size, row.data(), column.data());
  MatrixUpTo<Size> scaled(size, size);
  VectorUpTo<Size> side(size);
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) scaled(i, j) = row(i) * a[i + j * size] * column(j);
  for (int i = 0; i < size; ++i) side(i) = row(i) * b[i];
  const VectorUpTo<Size> solution = Eigen::FullPivLU<MatrixUpTo<Size>>(scaled).solve(side);
  for (int j = 0; j < size; ++j) x[j] = column(j) * solution(j);
}

}  // namespace

void equilibrate(const double* a, int rows, int columns, double* row_scale, double* column_scale) {
  const auto of_size = std::max(rows, columns) <= small ? equilibrate_up_to<small> : equilibrate_up_to<Eigen::Dynamic>;
  of_size(a, rows, columns, row_scale, column_scale);
}

void solve_equilibrated(int size, const double* a, const double* b, double* x) {
  const auto of_size = size <= small ? solve_up_to<small> : solve_up_to<Eigen::Dynamic>;
  of_size(size, a, b, x);
}

}  // namespace lagroid::detail
