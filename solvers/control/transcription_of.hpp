#pragma once
/// The Transcription of a ControlSystem: its arrows and controls behind the interface that solvers know.
///
///     TranscriptionOf<DubinsCar> transcription(task, straight_trajectory(task, 100));
///     InteriorPoint solver(transcription);
///     solver.solve();
///     const ControlTrajectory<DubinsCar>& found = transcription.trajectory();
///
/// A stage's derivatives, exact second ones included, are automatic, in one pass: along the arrow's frame where the
/// groupoid has one, else along both ends. Nothing throws.

#include <lagroid/core/derivatives/arrow_frame.hpp>
#include <lagroid/core/derivatives/displaced_arrow.hpp>
#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/solvers/control/control_system.hpp>
#include <lagroid/solvers/control/transcription.hpp>

#include <cmath>
#include <utility>

namespace lagroid {

template <class Sys> class TranscriptionOf final : public Transcription {
 public:
  using G = typename Sys::GroupoidType;
  using A = ArrowOf<G>;

  TranscriptionOf(const ControlTask<Sys>& task, ControlTrajectory<Sys> start)
      : task_(task),
        now_{std::move(start), task.boundary},
        tried_(now_),
        free_start_(task.free_start.begin(), task.free_start.end()),
        free_end_(task.free_end.begin(), task.free_end.end()) {
    for (int i = 0; i < Sys::controls; ++i) {
      if (std::isfinite(task.upper(i))) bounds_.push_back({i, 1, task.upper(i)});
      if (std::isfinite(task.lower(i))) bounds_.push_back({i, -1, task.lower(i)});
    }
    sizes_.node = n;
    sizes_.control = Sys::controls;
    sizes_.equality = Sys::equalities + Sys::end_equalities;
    sizes_.end_equality = Sys::end_equalities;
    sizes_.inequality = Sys::inequalities + int(bounds_.size());
    sizes_.stages = long(now_.path.arrows.size());
    for (bool free : task.free_end) end_is_fixed_ = end_is_fixed_ && !free;
  }

  const ControlTrajectory<Sys>& trajectory() const { return now_.path; }
  const A& boundary() const { return now_.boundary; }  ///< the product of its arrows

  /// Stage k + 1 becomes stage k, and the last one rests where it ends, with the control that it had. `boundary` leads
  /// from where the motion is now to the end: the first arrow takes up the difference.
  void move_on(const A& boundary) {
    const G& groupoid = task_.system.groupoid;
    ControlTrajectory<Sys>& path = now_.path;
    std::move(path.arrows.begin() + 1, path.arrows.end(), path.arrows.begin());
    std::move(path.controls.begin() + 1, path.controls.end(), path.controls.begin());
    path.arrows.back() = groupoid.unit(groupoid.target(boundary));
    A rest = path.arrows.back();
    for (std::size_t k = path.arrows.size() - 1; k-- > 1;) rest = groupoid.compose(path.arrows[k], rest);
    path.arrows.front() = groupoid.project(groupoid.compose(boundary, groupoid.inverse(rest)));
    now_.boundary = boundary;
    tried_ = now_;
  }
  /// Another trajectory of as many stages, and what its arrows lead to.
  void stand_at(ControlTrajectory<Sys> path, const A& boundary) {
    now_ = {std::move(path), boundary};
    tried_ = now_;
  }

  const TranscriptionSizes& sizes() const override { return sizes_; }
  const std::vector<bool>& free_start() const override { return free_start_; }
  const std::vector<bool>& free_end() const override { return free_end_; }
  bool duration_is_free() const override { return task_.duration_is_free; }

  void values(StageValues& out) const override {
    const ControlTrajectory<Sys>& path = tried_.path;
    for (long k = 0; k < sizes_.stages; ++k) {
      const auto at = std::size_t(k);
      const Functions<double> f = functions<double>(path.arrows[at], path.controls[at], path.step, k);
      out.cost[k][0] = f.cost;
      for (int i = 0; i < sizes_.equality; ++i) out.equality[k][i] = f.equality(i);
      for (int i = 0; i < Sys::inequalities; ++i) out.inequality[k][i] = f.inequality(i);
      for (std::size_t i = 0; i < bounds_.size(); ++i)
        out.inequality[k][Sys::inequalities + int(i)] =
            bounds_[i].sign * (path.controls[at](bounds_[i].control) - bounds_[i].value);
    }
  }

  void derivatives(const StageRows& lambda, const StageRows& z, StageDerivatives& out) const override {
    for (long k = 0; k < sizes_.stages; ++k) {
      if constexpr (framed) {
        along_frame(k, lambda[k], z[k], out);
      } else {
        along_ends(k, lambda[k], z[k], out);
      }
      double* bounds = out.inequality[k] + Sys::inequalities * d;
      std::fill(bounds, bounds + int(bounds_.size()) * d, 0.0);
      for (std::size_t i = 0; i < bounds_.size(); ++i)
        bounds[int(i) * d + 2 * n + bounds_[i].control] = bounds_[i].sign;
    }
  }

  void try_displacement(const TrajectoryDisplacement& by, double fraction) override {
    const G& groupoid = task_.system.groupoid;
    const auto node = [&](long k) {
      AlgebroidVector<G> v;
      for (int i = 0; i < n; ++i) v(i) = fraction * by.nodes[k][i];
      return v;
    };
    const A first = groupoid.tau(groupoid.source(now_.boundary), node(0));
    A back = groupoid.inverse(first);
    A product = groupoid.unit(groupoid.target(first));
    for (long k = 0; k < sizes_.stages; ++k) {
      const auto at = std::size_t(k);
      // A fixed end is where it was: what rounding adds up along the path is the last arrow's.
      if (k + 1 == sizes_.stages && end_is_fixed_) {
        tried_.boundary = groupoid.compose(groupoid.inverse(first), now_.boundary);
        tried_.path.arrows[at] = groupoid.project(groupoid.compose(groupoid.inverse(product), tried_.boundary));
      } else {
        displace_next(groupoid, now_.path.arrows[at], node(k + 1), back, tried_.path.arrows[at], product);
      }
      for (int i = 0; i < Sys::controls; ++i)
        tried_.path.controls[at](i) = now_.path.controls[at](i) + fraction * by.controls[k][i];
    }
    if (!end_is_fixed_) tried_.boundary = product;
    tried_.path.step = now_.path.step * std::exp(fraction * by.duration);
  }
  void accept() override { now_ = tried_; }

 private:
  static constexpr int n = Sys::dimension;
  static constexpr int d = 2 * n + Sys::controls + 1;
  static constexpr int all_equalities = Sys::equalities + Sys::end_equalities;
  static constexpr bool framed = HasArrowFrame<G>;

  /// u_control <= value (sign 1) or >= value (sign -1).
  struct Bound {
    int control;
    double sign;
    double value;
  };
  struct Standing {
    ControlTrajectory<Sys> path;
    A boundary;
  };
  template <class S> struct Functions {
    S cost;
    Vector<S, all_equalities> equality;
    Vector<S, Sys::inequalities> inequality;
  };

  template <class S>
  Functions<S> functions(const ArrowOf<G, S>& g, const Vector<S, Sys::controls>& u, const S& h, long stage) const {
    Functions<S> out;
    const Sys& system = task_.system;
    out.cost = system.cost(g, u, h);
    out.equality.template head<Sys::equalities>() = system.constraint(g, u, h);
    if constexpr (Sys::end_equalities > 0) {
      if (stage + 1 == sizes_.stages) {
        out.equality.template tail<Sys::end_equalities>() = system.end_constraint(system.groupoid.target(g));
      } else {
        out.equality.template tail<Sys::end_equalities>().fill(S(0));
      }
    }
    if constexpr (Sys::inequalities > 0) out.inequality = system.inequality(g, u, h);
    return out;
  }

  /// The stage's Lagrangian; place(jet, row) writes the first derivatives of each of its functions.
  template <class J, class Place>
  J lagrangian_of(const Functions<J>& f, long stage, const double* lambda, const double* z, const Place& place,
                  StageDerivatives& out) const {
    place(f.cost, out.gradient[stage]);
    J lagrangian = f.cost;
    for (int i = 0; i < all_equalities; ++i) {
      place(f.equality(i), out.equality[stage] + i * d);
      lagrangian += f.equality(i) * lambda[i];
    }
    for (int i = 0; i < Sys::inequalities; ++i) {
      place(f.inequality(i), out.inequality[stage] + i * d);
      lagrangian += f.inequality(i) * z[i];
    }
    return lagrangian;
  }

  /// In one pass along the arrow's frame, pushed to its ends (second_derivatives.hpp).
  void along_frame(long stage, const double* lambda, const double* z, StageDerivatives& out) const requires framed {
    constexpr int f = arrow_dimension_of<G>();
    constexpr int others = Sys::controls + 1;
    constexpr int all = f + others;
    using J = SecondJet<double, all>;
    const G& groupoid = task_.system.groupoid;
    const auto at = std::size_t(stage);
    const A& g = now_.path.arrows[at];
    Vector<J, Sys::controls> u;
    for (int i = 0; i < Sys::controls; ++i) u(i) = J::variable(now_.path.controls[at](i), f + i);
    const double h = now_.path.step;
    const J step = J::variable(0, all - 1).chain(h, h, h);  // h exp(x)
    const Functions<J> at_jet = functions<J>(groupoid.template frame_jet<J>(g), u, step, stage);

    // From a row over the frame, controls and duration to one over both ends, controls and duration.
    const auto push = [&](const J& of, double* row) {
      const Vector<double, all> gradient = of.gradient();
      const Vector<double, f> frame = gradient.template head<f>();
      const Vector<double, n> source = groupoid.template frame_to_end<End::source>(g, frame);
      const Vector<double, n> target = groupoid.template frame_to_end<End::target>(g, frame);
      for (int i = 0; i < n; ++i) {
        row[i] = source(i);
        row[n + i] = target(i);
      }
      for (int i = 0; i < others; ++i) row[2 * n + i] = gradient(f + i);
    };
    const J lagrangian = lagrangian_of(at_jet, stage, lambda, z, push, out);

    const Matrix<double, all, all> whole = lagrangian.hessian();
    const Matrix<double, f, f> hessian = whole.template topLeftCorner<f, f>();
    const Matrix<double, f, others> beside = whole.template topRightCorner<f, others>();
    const Vector<double, f> gradient = lagrangian.gradient().template head<f>();
    double* square = out.hessian[stage];
    const auto place = [&]<End First, End Second>(const Matrix<double, f, f>& form) {
      const Matrix<double, n, f> rows = groupoid.template frame_to_end<First>(g, form);
      Matrix<double, f, n> columns;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < f; ++j) columns(j, i) = rows(i, j);
      const Matrix<double, n, n> transposed = groupoid.template frame_to_end<Second>(g, columns);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const int row = (First == End::source ? 0 : n) + i;
          const int column = (Second == End::source ? 0 : n) + j;
          square[row * d + column] = square[column * d + row] = transposed(j, i);
        }
    };
    place.template operator()<End::source, End::source>(hessian);
    place.template operator()<End::target, End::target>(hessian);
    place.template operator()<End::source, End::target>(hessian + 0.5 * groupoid.frame_bracket(gradient));
    const Matrix<double, n, others> source = groupoid.template frame_to_end<End::source>(g, beside);
    const Matrix<double, n, others> target = groupoid.template frame_to_end<End::target>(g, beside);
    for (int j = 0; j < others; ++j) {
      for (int i = 0; i < n; ++i) {
        square[i * d + 2 * n + j] = square[(2 * n + j) * d + i] = source(i, j);
        square[(n + i) * d + 2 * n + j] = square[(2 * n + j) * d + n + i] = target(i, j);
      }
      for (int i = 0; i < others; ++i) square[(2 * n + i) * d + 2 * n + j] = whole(f + i, f + j);
    }
  }

  /// Along both ends, by the operations of the groupoid alone.
  void along_ends(long stage, const double* lambda, const double* z, StageDerivatives& out) const {
    using J = SecondJet<double, d>;
    const G& groupoid = task_.system.groupoid;
    const auto at = std::size_t(stage);
    Vector<J, n> a;
    Vector<J, n> b;
    Vector<J, Sys::controls> u;
    for (int i = 0; i < n; ++i) {
      a(i) = J::variable(0, i);
      b(i) = J::variable(0, n + i);
    }
    for (int i = 0; i < Sys::controls; ++i) u(i) = J::variable(now_.path.controls[at](i), 2 * n + i);
    const double h = now_.path.step;
    const J step = J::variable(0, d - 1).chain(h, h, h);  // h exp(x)
    const ArrowOf<G, J> g = groupoid.translate(a, groupoid.template cast<J>(now_.path.arrows[at]), b);
    const Functions<J> f = functions<J>(g, u, step, stage);
    const auto place = [](const J& of, double* row) { Eigen::Map<Vector<double, d>>{row} = of.gradient(); };
    const J lagrangian = lagrangian_of(f, stage, lambda, z, place, out);
    Eigen::Map<Matrix<double, d, d>>{out.hessian[stage]} = lagrangian.hessian();
  }

  ControlTask<Sys> task_;
  Standing now_;
  Standing tried_;
  std::vector<bool> free_start_;
  std::vector<bool> free_end_;
  bool end_is_fixed_ = true;
  std::vector<Bound> bounds_;
  TranscriptionSizes sizes_;
};

}  // namespace lagroid
