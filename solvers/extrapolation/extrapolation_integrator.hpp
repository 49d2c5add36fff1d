#pragma once
/// Extrapolation on a homogeneous space: Gragg's explicit midpoint rule carried by the group,
///
///     z_1 = exp(h F(z_0)) z_0,    z_{i+1} = exp(2 h F(z_i)) z_{i-1},
///
/// with h = H/2, H/4, ..., H/2k, extrapolated to h = 0. Order and step follow a tolerance.
///
/// For few steps and many digits nothing explicit costs less, and no coefficients are needed for any order. It keeps
/// nothing but M: energies drift.
///
///     const auto spin = [](double, const auto&, auto& out) { out.setConstant(1); };  // an element of the algebra
///     ExtrapolationIntegrator integrator(Spheres<1>{}, spin, Spheres<1>::Point(0, 0, 1), {.tolerance = 1e-12});
///     const StepReport report = integrator.advance_to(2);
///
/// **Why the error is even in h.** z_0, z_2, ... and z_1, z_3, ... are the two halves of a Strang splitting of (u, v)'
/// = (F(v)_M(u), F(u)_M(v)) from u = v, whose flows with the other half frozen are exponentials: symmetric, thus with
/// an expansion in h^2 (Stetter; Hairer, Norsett, Wanner, Solving ODEs I, theorem II.9.2, on M in place of R^n). Points
/// are extrapolated in the coordinates of M, and the result, off M by no more than its error, is projected to it.
///
/// **Side by side.** Rows do not depend on each other. Where M and F are over Batch<W> (core/scalars/batch.hpp) as many
/// go on side by side; each lane holds what it would alone.
///
/// **Other moves** than exponentials serve where each is its half done twice and undone by -h: a space may have
/// `leap(h, u, z)` in place of exp(2 h u), and `leap(h, halved, u, z)`, which in lanes where `halved` is 1 does half of
/// it (SpheresAndVectors).
///
/// Requires a field(t, z, u) that writes an element of the algebra, over the scalar of M, and a start on M, of doubles.
/// Throws std::invalid_argument as ControlledSteps. Status as there: `not_finite`, `no_step`, `not_converged`.

#include <lagroid/core/hamiltonian/homogeneous_space.hpp>
#include <lagroid/solvers/extrapolation/extrapolation_table.hpp>
#include <lagroid/solvers/extrapolation/row_register.hpp>
#include <lagroid/solvers/lie_group/controlled_steps.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <limits>
#include <string>
#include <utility>

namespace lagroid {

/// A step of the order and size that the tolerance asks for, for ControlledSteps.
template <HomogeneousSpace M> class ExtrapolationStep {
 public:
  using S = typename M::Point::Scalar;
  using Point = Eigen::Matrix<double, M::Point::RowsAtCompileTime, M::Point::ColsAtCompileTime>;
  using Algebra = typename M::Algebra;
  using Table = ExtrapolationTable;
  using Memory = ExtrapolationOrder::Memory;

  explicit ExtrapolationStep(M space, double tolerance = 1e-10,
                             double longest = std::numeric_limits<double>::infinity())
      : space_(std::move(space)),
        order_(tolerance, lanes, 2, longest),
        earlier_(space_.zero_point()),
        later_(earlier_),
        slope_(space_.zero_algebra()),
        ends_(earlier_.size(), int(Table::most_rows)),
        sums_(earlier_.size(), 3) {}

  Point zero_point() const { return Point::Zero(earlier_.rows(), earlier_.cols()); }
  /// Of the highest order there is.
  MethodTraits traits() const {
    const auto& of = extrapolation_method;
    return {std::string(of.name), of.order, false, false, true, of.stages};
  }

  template <class F> StepAttempt attempt(F& field, double t, double h, const Point& z, Point& next) {
    const Table& table = order_.table();
    const int evaluations = table.rows * (table.rows + 1);
    advance(field, t, h, table, z);
    if (!extrapolate(table, z, next)) return {false, false, 0.2 * h, evaluations};
    const auto largest = [](const auto& x) { return x.cwiseAbs().maxCoeff(); };
    const auto verdict = order_.judge(h, largest(sums_.col(1)), largest(sums_.col(2)), largest(next));
    if (verdict.accepted) project(next);
    if (!next.allFinite()) return {false, false, 0.2 * h, evaluations};  // nothing of M is near
    return {verdict.accepted, true, verdict.next, evaluations};
  }

  /// One step of size h by k rows, whatever its error.
  template <class F> void step(F& field, double t, double h, int rows, const Point& z, Point& next) {
    const Table table = Table::of(rows, lanes, 2);
    advance(field, t, h, table, z);
    extrapolate(table, z, next);
    project(next);
  }

  void serialize(NumberArchive& archive) { order_.serialize(archive); }
  void keep(Memory& at) const { at = order_.memory(); }
  void go_back_to(const Memory& at) { order_.go_back_to(at); }

 private:
  using L = detail::RowRegister<S>;
  static constexpr int lanes = L::width;

  /// The rows of the table, whose ends are then columns of ends_. Each step of a lane is (a, b) <- (b, exp(2 h F(b))
  /// a), the first from a = b = z by half of that.
  template <class F> void advance(F& field, double t, double h, const Table& table, const Point& z) {
    if constexpr (Point::SizeAtCompileTime != Eigen::Dynamic && Point::SizeAtCompileTime <= 4) {
      typename M::Point earlier, later;  // which stay in registers
      Algebra slope;
      advance_from(field, t, h, table, z, earlier, later, slope);
    } else {
      advance_from(field, t, h, table, z, earlier_, later_, slope_);
    }
  }
  template <class F>
  void advance_from(F& field, double t, double h, const Table& table, const Point& z, typename M::Point& earlier,
                    typename M::Point& later, Algebra& slope) {
    for (Eigen::Index i = 0; i < z.size(); ++i) later.data()[i] = earlier.data()[i] = S(z.data()[i]);
    for (const Table::Slot& slot : table.slots) {
      field(L::load(slot.time) * h + t, later, slope);
      move(L::load(slot.step) * h, slot, slope, earlier);
      earlier.swap(later);
      for (const Table::End& end : slot.ends)
        for (Eigen::Index i = 0; i < z.size(); ++i) ends_(i, end.row - 1) = L::get(later.data()[i], end.lane);
      if (slot.others.empty()) continue;
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        const S start(z.data()[i]);
        later.data()[i] = L::choose(slot.others, start, later.data()[i]);
        earlier.data()[i] = L::choose(slot.others, start, earlier.data()[i]);
      }
    }
  }
  /// By 2 h, at the beginning of a row by h.
  void move(const S& h, const Table::Slot& slot, Algebra& slope, typename M::Point& z) {
    if constexpr (requires { space_.leap(h, slope, z); }) {
      if (slot.begins)
        space_.leap(h, L::load(slot.first), slope, z);
      else
        space_.leap(h, slope, z);
    } else {
      slope *= h * (2.0 - L::load(slot.first));
      space_.act(slope, z);
    }
  }

  /// next <- T_k, of increments, so that their rounding is theirs, and not that of z. False where it is not finite.
  bool extrapolate(const Table& table, const Point& z, Point& next) {
    sums_.setZero();
    for (int j = 0; j < table.rows; ++j) {
      const double a = table.weights(j, 0);
      const double b = table.weights(j, 1);
      const double c = table.weights(j, 2);
      const double* end = &ends_(0, j);
      double* value = &sums_(0, 0);
      double* error = &sums_(0, 1);
      double* below = &sums_(0, 2);
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        const double change = end[i] - z.data()[i];
        value[i] += a * change;
        error[i] += b * change;
        below[i] += c * change;
      }
    }
    next.reshaped() = z.reshaped() + sums_.col(0);
    return sums_.allFinite();
  }

  void project(Point& z) {
    for (Eigen::Index i = 0; i < z.size(); ++i) later_.data()[i] = S(z.data()[i]);
    space_.project(later_);
    for (Eigen::Index i = 0; i < z.size(); ++i) z.data()[i] = L::get(later_.data()[i], 0);
  }

  M space_;
  ExtrapolationOrder order_;
  typename M::Point earlier_, later_;
  Algebra slope_;
  Eigen::Matrix<double, Point::SizeAtCompileTime, Table::most_rows> ends_;
  Eigen::Matrix<double, Point::SizeAtCompileTime, 3> sums_;  ///< of them, by the weights
};

/// Steps by extrapolation under a tolerance.
template <HomogeneousSpace M, class F> class ExtrapolationIntegrator : public ControlledSteps<ExtrapolationStep<M>, F> {
 public:
  using Point = typename ExtrapolationStep<M>::Point;

  /// Throws std::invalid_argument for control that is not positive, or a start of another size than the points of M.
  ExtrapolationIntegrator(M space, F field, Point start, const LieGroupControl& control, double time = 0)
      : ControlledSteps<ExtrapolationStep<M>, F>(
            ExtrapolationStep<M>(std::move(space), control.tolerance, control.largest_step), std::move(field),
            std::move(start), control, time) {}
};

}  // namespace lagroid
