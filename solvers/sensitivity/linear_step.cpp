#include <lagroid/core/matrices/scaling.hpp>
#include <lagroid/solvers/sensitivity/linear_step.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

namespace lagroid {

namespace {

/// So few equations are solved by loops that need no memory.
constexpr Eigen::Index most_equations = 16;

/// 1 / 2^k, 2^k <= x < 2^(k + 1); one of what is zero, next to it or not finite.
double inverse_power(double x) {
  constexpr std::uint64_t bits_of_fraction = 52, largest = 0x7ff;
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(x) >> bits_of_fraction;
  if (exponent == 0 || exponent >= largest - 1) return 1;
  return std::bit_cast<double>((largest - 1 - exponent) << bits_of_fraction);
}

/// Zero, or no number where an x is no finite one.
double none_of(const Eigen::MatrixXd& matrix) {
  double sum = 0;
  const double* const x = matrix.data();
  for (Eigen::Index i = 0; i < matrix.size(); ++i) sum += 0 * x[i];
  return sum;
}

/// Rows of numbers, of one unknown along all directions each, as long as so many of these: loops have no rest.
using Four = Eigen::Array<double, 4, 1>;
Eigen::Index in_fours(Eigen::Index count) { return (count + 3) / 4 * 4; }
class Rows {
 public:
  Rows(double* begin, Eigen::Index width) : begin_(begin), width_(width) {}
  double* operator[](Eigen::Index i) const { return begin_ + i * width_; }
  void scale(Eigen::Index i, double a) const {
    for (Eigen::Index s = 0; s < width_; s += 4) four(i, s) *= a;
  }
  /// Row i becomes `scale` times the sum of a(j) times row j of `of`; by `add` that sum, from `from` on, is added to
  /// it.
  template <class A, class Count>
  void put(Eigen::Index i, double scale, Count count, const A& a, const Rows& of) const {
    for (Eigen::Index s = 0; s < width_; s += 4) {
      Four sum = Four::Zero();
      for (Eigen::Index j = 0; j < count; ++j) sum += a(j) * of.four(j, s);
      four(i, s) = scale * sum;
    }
  }
  template <class A, class Count>
  void add(Eigen::Index i, Eigen::Index from, Count to, const A& a, const Rows& of) const {
    if (from >= to) return;
    for (Eigen::Index s = 0; s < width_; s += 4) {
      Four sum = four(i, s);
      for (Eigen::Index j = from; j < to; ++j) sum += a(j) * of.four(j, s);
      four(i, s) = sum;
    }
  }

 private:
  Eigen::Map<Four> four(Eigen::Index i, Eigen::Index s) const { return Eigen::Map<Four>((*this)[i] + s); }
  double* begin_;
  Eigen::Index width_;
};

/// The first rows of a matrix of columns, in rows, and back.
void to_rows(const Eigen::MatrixXd& from, Eigen::Index count, const Rows& to) {
  std::fill_n(to[0], to[count] - to[0], 0.0);
  for (Eigen::Index j = 0; j < from.cols(); ++j)
    for (Eigen::Index i = 0; i < count; ++i) to[i][j] = from(i, j);
}
void from_rows(const Rows& from, Eigen::Index count, Eigen::MatrixXd& to) {
  for (Eigen::Index j = 0; j < to.cols(); ++j)
    for (Eigen::Index i = 0; i < count; ++i) to(i, j) = from[i][j];
}

/// use(N), with the number of equations as a constant where it is a common one.
template <class Use> auto with_equations(Eigen::Index equations, const Use& use) {
  switch (equations) {
    case 1:
      return use(std::integral_constant<Eigen::Index, 1>());
    case 2:
      return use(std::integral_constant<Eigen::Index, 2>());
    case 3:
      return use(std::integral_constant<Eigen::Index, 3>());
    case 4:
      return use(std::integral_constant<Eigen::Index, 4>());
    default:
      return use(equations);
  }
}

bool is_regular(const Eigen::PartialPivLU<Eigen::MatrixXd>& factors) {
  // Of a pivot that is zero the estimate of the condition knows nothing.
  return factors.matrixLU().diagonal().cwiseAbs().minCoeff() > 0 &&
         factors.rcond() > std::numeric_limits<double>::epsilon();
}

}  // namespace

LinearStep::LinearStep(int equations, int states, int parameters)
    : equations_by_unknowns(Eigen::MatrixXd::Zero(equations, equations)),
      equations_by_start(Eigen::MatrixXd::Zero(equations, states + parameters)),
      end_by_unknowns(Eigen::MatrixXd::Zero(states, equations)),
      end_by_start(Eigen::MatrixXd::Zero(states, states + parameters)),
      row_scale_(equations),
      column_scale_(equations),
      order_(std::size_t(equations)) {
  if (is_small()) small_ = equations_by_unknowns;
}

bool LinearStep::is_small() const { return equations_by_unknowns.rows() <= most_equations; }

bool LinearStep::factor() {
  if (none_of(equations_by_unknowns) + none_of(equations_by_start) + none_of(end_by_unknowns) + none_of(end_by_start) !=
      0)
    return false;
  if (equations_by_unknowns.size() == 0) return true;
  if (is_small())
    return with_equations(equations_by_unknowns.rows(), [this](auto equations) { return factor_small(equations); });
  const auto scaling = Scaling<Eigen::Dynamic>::equilibrate(equations_by_unknowns);
  row_scale_ = scaling.row;
  column_scale_ = scaling.column;
  large_.compute(scaling.apply(equations_by_unknowns));
  return is_regular(large_);
}

/// E_z, equilibrated by powers of two, becomes L and U, with the inverses of the pivots in the diagonal.
template <class Count> bool LinearStep::factor_small(Count equations) {
  column_scale_.setZero();
  for (Eigen::Index i = 0; i < equations; ++i) {
    order_[std::size_t(i)] = i;
    double largest = 0;
    for (Eigen::Index j = 0; j < equations; ++j) largest = std::max(largest, std::abs(equations_by_unknowns(i, j)));
    row_scale_(i) = inverse_power(largest);
    for (Eigen::Index j = 0; j < equations; ++j) {
      small_(i, j) = row_scale_(i) * equations_by_unknowns(i, j);
      column_scale_(j) = std::max(column_scale_(j), std::abs(small_(i, j)));
    }
  }
  for (Eigen::Index j = 0; j < equations; ++j) {
    column_scale_(j) = inverse_power(column_scale_(j));
    for (Eigen::Index i = 0; i < equations; ++i) small_(i, j) *= column_scale_(j);
  }
  double most = 0;
  std::array<double, most_equations> pivots;
  for (Eigen::Index k = 0; k < equations; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < equations; ++i)
      if (std::abs(small_(i, k)) > std::abs(small_(pivot, k))) pivot = i;
    if (pivot != k) {
      for (Eigen::Index j = 0; j < equations; ++j) std::swap(small_(k, j), small_(pivot, j));
      std::swap(order_[std::size_t(k)], order_[std::size_t(pivot)]);
    }
    const double size = pivots[std::size_t(k)] = std::abs(small_(k, k));
    if (!(size > 0)) return false;
    most = std::max(most, size);
    small_(k, k) = 1 / small_(k, k);
    for (Eigen::Index i = k + 1; i < equations; ++i) {
      const double factor = small_(i, k) *= small_(k, k);
      for (Eigen::Index j = k + 1; j < equations; ++j) small_(i, j) -= factor * small_(k, j);
    }
  }
  // The product of the pivots over the largest bounds the inverse; where it is small, the condition is asked for.
  constexpr double surely_regular = 1e-6;
  double product = 1;
  for (Eigen::Index k = 0; k < equations; ++k) product *= pivots[std::size_t(k)] / most;
  if (product > surely_regular) return true;
  const auto scaling = Scaling<Eigen::Dynamic>::equilibrate(equations_by_unknowns);
  return is_regular(Eigen::PartialPivLU<Eigen::MatrixXd>(scaling.apply(equations_by_unknowns)));
}

double* LinearStep::memory(Eigen::Index size) const {
  if (memory_.size() < std::size_t(size)) memory_.resize(std::size_t(size));
  return memory_.data();
}

void LinearStep::go_forward(Eigen::MatrixXd& directions) const {
  eigen_assert(directions.rows() == end_by_start.cols());
  if (!is_small()) {
    directions = forward_large(directions);
    return;
  }
  const Eigen::Index states = end_by_start.rows(), all = end_by_start.cols(), width = in_fours(directions.cols());
  with_equations(equations_by_unknowns.rows(), [&](auto equations) {
    double* const begin = memory((all + equations + states) * width);
    const Rows x(begin, width), z(x[all], width), end(z[equations], width);
    to_rows(directions, all, x);
    const auto eliminated = [this](Eigen::Index k) { return [this, k](Eigen::Index i) { return -small_(k, i); }; };
    for (Eigen::Index k = 0; k < equations; ++k) {
      const Eigen::Index row = order_[std::size_t(k)];
      z.put(
          k, row_scale_(row), all, [&](Eigen::Index j) { return equations_by_start(row, j); }, x);
      z.add(k, 0, k, eliminated(k), z);
    }
    for (Eigen::Index k = equations - 1; k >= 0; --k) {
      z.add(k, k + 1, equations, eliminated(k), z);
      z.scale(k, small_(k, k));
    }
    for (Eigen::Index k = 0; k < equations; ++k) z.scale(k, -column_scale_(k));
    for (Eigen::Index i = 0; i < states; ++i) {
      end.put(
          i, 1, all, [&](Eigen::Index j) { return end_by_start(i, j); }, x);
      end.add(
          i, 0, equations, [&](Eigen::Index k) { return end_by_unknowns(i, k); }, z);
    }
    from_rows(end, states, directions);
  });
}

void LinearStep::go_back(Eigen::MatrixXd& gradients) const {
  eigen_assert(gradients.rows() == end_by_start.cols());
  if (!is_small()) {
    gradients = backward_large(gradients);
    return;
  }
  const Eigen::Index states = end_by_start.rows(), all = end_by_start.cols(), width = in_fours(gradients.cols());
  with_equations(equations_by_unknowns.rows(), [&](auto equations) {
    double* const begin = memory((all + equations + all) * width);
    const Rows end(begin, width), z(end[all], width), out(z[equations], width);
    to_rows(gradients, all, end);
    const auto eliminated = [this](Eigen::Index k) { return [this, k](Eigen::Index i) { return -small_(i, k); }; };
    for (Eigen::Index k = 0; k < equations; ++k) {
      z.put(
          k, -column_scale_(k), states, [&](Eigen::Index i) { return end_by_unknowns(i, k); }, end);
      z.add(k, 0, k, eliminated(k), z);
      z.scale(k, small_(k, k));
    }
    for (Eigen::Index k = equations - 1; k >= 0; --k) z.add(k, k + 1, equations, eliminated(k), z);
    for (Eigen::Index k = 0; k < equations; ++k) z.scale(k, row_scale_(order_[std::size_t(k)]));
    for (Eigen::Index j = 0; j < all; ++j) {
      out.put(
          j, 1, states, [&](Eigen::Index i) { return end_by_start(i, j); }, end);
      if (j >= states)
        out.add(
            j, j, j + 1, [](Eigen::Index) { return 1.0; }, end);
      out.add(
          j, 0, equations, [&](Eigen::Index k) { return equations_by_start(order_[std::size_t(k)], j); }, z);
    }
    from_rows(out, all, gradients);
  });
}

Eigen::MatrixXd LinearStep::forward(const Eigen::MatrixXd& directions) const {
  Eigen::MatrixXd out = directions;
  go_forward(out);
  return out;
}
Eigen::MatrixXd LinearStep::backward(const Eigen::MatrixXd& gradients) const {
  Eigen::MatrixXd out = gradients;
  go_back(out);
  return out;
}

Eigen::MatrixXd LinearStep::forward_large(const Eigen::MatrixXd& directions) const {
  const Eigen::Index states = end_by_start.rows();
  Eigen::MatrixXd out = directions;
  const Eigen::MatrixXd right = row_scale_.asDiagonal() * (equations_by_start * directions);
  const Eigen::MatrixXd unknowns = column_scale_.asDiagonal() * large_.solve(right);
  out.topRows(states) = end_by_start * directions;
  out.topRows(states) -= end_by_unknowns * unknowns;
  return out;
}

Eigen::MatrixXd LinearStep::backward_large(const Eigen::MatrixXd& gradients) const {
  const Eigen::Index states = end_by_start.rows();
  Eigen::MatrixXd out = gradients;
  out.topRows(states).setZero();
  out += end_by_start.transpose() * gradients.topRows(states);
  const Eigen::MatrixXd right = column_scale_.asDiagonal() * (end_by_unknowns.transpose() * gradients.topRows(states));
  const Eigen::MatrixXd solved = large_.transpose().solve(right);
  out -= equations_by_start.transpose() * (row_scale_.asDiagonal() * solved);
  return out;
}

}  // namespace lagroid
