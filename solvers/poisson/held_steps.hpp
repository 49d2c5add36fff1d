#pragma once
/// Extrapolated steps on the levels of a motion (extrapolated_steps.hpp) by inner steps that are given, and their
/// derivative: between two nodes the sizes and the rows that a tolerance asked for are held, while the point and the
/// system differ,
///
///     y = x + sum_j w_j (R_j(x) - x),    x' = the point of the levels along their gradients from y,
///
/// with the levels C(x_0) of the point x_0 that all of them begin from. How inner steps change with the start is not
/// smooth, and what it does to the end is of the size of the run's own error.
///
///     const HeldPoissonSteps<LotkaVolterra> held(LotkaVolterra{}, {2, 0.5}, {{0.1, 6}, {0.15, 7}});
///     const auto slope = held.slope();  // d of held.end(), by the start
///
/// Rows are made over numbers with derivatives; the way back to the levels has a derivative of its own
/// (levels.hpp). `slope` has after the columns by x those by members of the very system that the steps have
/// (`system()`); its formulas read them by `varied`. Not numbers where there are no inner steps, or a level is not
/// reached. Throws std::invalid_argument for more rows than a table has.
///
/// A motion that is smaller than its tolerance, as at an equilibrium, has asked for no inner steps: its derivative is
/// as coarse as nodes are apart. (Internal differentiation: Bock 1981.)

#include <lagroid/solvers/extrapolation/extrapolated_step.hpp>
#include <lagroid/solvers/poisson/levels.hpp>

#include <limits>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// R^N as a homogeneous space of itself.
template <class Scalar, int N> struct FlatSpace {
  using S = Scalar;
  using Point = Vector<S, N>;
  using Algebra = Point;

  void act(const Algebra& u, Point& z) const {
    for (int i = 0; i < N; ++i) z(i) += u(i);
  }
  /// By 2 h u; where a row begins, by half of that.
  void leap(const S& h, const Algebra& u, Point& z) const {
    for (int i = 0; i < N; ++i) z(i) += u(i) * (h * 2.0);
  }
  void leap(const S& h, const S& halved, const Algebra& u, Point& z) const {
    for (int i = 0; i < N; ++i) z(i) += u(i) * (h * (2.0 - halved));
  }
  void generator(const Algebra& u, const Point&, Point& v) const { v = u; }
  void bracket(const Algebra&, const Algebra&, Algebra& w) const { w = zero_algebra(); }
  void project(Point&) const {}
  Point zero_point() const { return Point::Constant(S(0.0)); }
  Algebra zero_algebra() const { return zero_point(); }
};

/// pi dH, over the numbers of rows.
template <class Sys> struct PoissonField {
  const Sys* system;
  template <class Z> void operator()(const auto&, const Z& z, Z& u) const { u = system->velocity(z); }
};

}  // namespace detail

template <class Sys> class HeldPoissonSteps {
 public:
  static constexpr int n = Sys::dimension;
  using X = Vector<double, n>;
  using OnLevels = Levels<Sys, true>;
  struct Inner {
    double size;
    int rows;  ///< of the table that was extrapolated
  };

  HeldPoissonSteps(const Sys& system, const X& start, std::vector<Inner> inner)
      : system_(system), start_(start), inner_(std::move(inner)) {}

  const Sys& system() const { return system_; }
  X end() const {
    return follow([](const Inner&, const X&, const X&, const X&) {});
  }
  Eigen::MatrixXd slope(typename OnLevels::Members members = {}) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Identity(n, n + Eigen::Index(members.size()));
    const Eigen::MatrixXd of_levels = OnLevels::slope_of_values(system_, start_, members);
    const X last = follow([&](const Inner& inner, const X& x, const X& y, const X& z) {
      const auto rows = [&](const auto& at) { return by_rows(inner, at); };
      const Eigen::MatrixXd of_y = detail::chained(varied_jacobian<n>(rows, x, members), out);
      out = OnLevels::slope_of_way(system_, y, z, of_y, of_levels, members);
    });
    if (!last.allFinite()) out.setConstant(std::numeric_limits<double>::quiet_NaN());
    return out;
  }

 private:
  /// Over one scalar alone, for the sake of compile times.
  Vector<VariedNumber, n> by_rows(const Inner& inner, Vector<VariedNumber, n> z) const {
    detail::PoissonField<Sys> field{&system_};
    extrapolated_step(detail::FlatSpace<VariedNumber, n>{}, field, 0, inner.size, inner.rows, z);
    return z;
  }
  /// Calls visit(inner, x, y, z): from x its rows lead to y, and from there the levels to z.
  template <class Visit> X follow(const Visit& visit) const {
    const X nowhere = X::Constant(std::numeric_limits<double>::quiet_NaN());
    const OnLevels levels(system_, start_);
    X x = start_;
    for (const Inner& inner : inner_) {
      const auto reached = by_rows(inner, detail::varied_along(x, -n));
      X y;
      for (int i = 0; i < n; ++i) y(i) = reached(i).value;
      X z = y;
      if (!y.allFinite() || !levels.project(system_, z)) return nowhere;
      visit(inner, x, y, z);
      x = z;
    }
    return inner_.empty() ? nowhere : x;
  }

  Sys system_;
  X start_;
  std::vector<Inner> inner_;
};

}  // namespace lagroid
