#pragma once
/// The Transcription of a ControlSystem: its arrows and controls behind the interface that solvers know.
///
///     TranscriptionOf<DubinsCar> transcription(task, straight_trajectory(task, 100));
///     InteriorPoint solver(transcription);
///     solver.solve();
///     const ControlTrajectory<DubinsCar>& found = transcription.trajectory();
///
/// A stage's derivatives, exact second ones included, are automatic, in one pass: along the arrow's frame where the
/// groupoid has one, else along both ends. A system that evaluates its cost and constraint in one writes
/// `cost_and_constraint(g, u, h, cost, constraint)` beside them. Nothing throws.

#include <lagroid/core/derivatives/arrow_frame.hpp>
#include <lagroid/core/derivatives/displaced_arrow.hpp>
#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/solvers/control/control_system.hpp>
#include <lagroid/solvers/control/displaced_jet.hpp>
#include <lagroid/solvers/control/end_inequalities.hpp>
#include <lagroid/solvers/control/transcription.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace lagroid {

template <class Sys> class TranscriptionOf final : public Transcription {
 public:
  using G = typename Sys::GroupoidType;
  using A = ArrowOf<G>;

  /// The trajectory's stages are those of the task's phases, one phase after another.
  TranscriptionOf(const ControlTask<Sys>& task, ControlTrajectory<Sys> start)
      : task_(task),
        phases_(phases_of(task, long(start.arrows.size()))),
        free_start_(task.free_start.begin(), task.free_start.end()),
        free_end_(task.free_end.begin(), task.free_end.end()) {
    for (bool free : free_start_) start_is_free_ = start_is_free_ || free;
    for (bool free : free_end_) end_is_fixed_ = end_is_fixed_ && !free;
    bounds_ = control_bounds_of(phases_);
    duration_bounds_ = duration_bounds_of(phases_);
    sizes_.node = n;
    sizes_.control = Sys::controls;
    sizes_.inequality = before_bounds() + int(bounds_.size());
    sizes_.stages = long(start.arrows.size());
    for (std::size_t p = 0; p < phases_.size(); ++p) {
      TranscriptionPhase& phase = sizes_.phases.emplace_back();
      phase.end = (p == 0 ? 0 : sizes_.phases[p - 1].end) + start.phases[p].stages;
      phase.duration_is_free = phases_[p].duration_is_free;
      for (const PhaseControlBound<Sys>& each : bounds_)
        phase.bounds.push_back({each.control, each.holds(phases_[p]) ? each.sign : 0});
      for (int i = 0; i < Sys::controls; ++i) {
        if (phases_[p].lower(i) < phases_[p].upper(i)) continue;
        phase.control_is_fixed.resize(Sys::controls);
        phase.control_is_fixed[std::size_t(i)] = true;
        for (long k = phase.end - start.phases[p].stages; k < phase.end; ++k)
          start.controls[std::size_t(k)](i) = phases_[p].lower(i);
      }
    }
    place_conditions(start);
    stand_at(std::move(start), task.boundary);
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
    locate_conditions();
    tried_ = now_;
    has_tried_ = false;
  }
  /// Another trajectory of as many stages, and what the task's ends lead to.
  void stand_at(ControlTrajectory<Sys> path, const A& boundary) {
    now_ = {std::move(path), boundary, std::vector<A>(conditions_.size(), boundary)};
    const G& groupoid = task_.system.groupoid;
    if (now_.path.start) now_.boundary = groupoid.compose(groupoid.inverse(*now_.path.start), boundary);
    if (start_is_free_ && !now_.path.start) now_.path.start = groupoid.unit(groupoid.source(boundary));
    locate_conditions();
    tried_ = now_;
    has_tried_ = false;
  }

  /// How many rows of gamma there are before those of the controls' bounds.
  int before_bounds() const { return Sys::inequalities + int(duration_bounds_.size()); }

  const TranscriptionSizes& sizes() const override { return sizes_; }
  const std::vector<bool>& free_start() const override { return free_start_; }
  const std::vector<bool>& free_end() const override { return free_end_; }

  void values(StageValues& out) const override {
    const Standing& latest = has_tried_ ? tried_ : now_;
    const ControlTrajectory<Sys>& path = latest.path;
    long k = 0;
    for (std::size_t p = 0; p < phases_.size(); ++p)
      for (; k < sizes_.phases[p].end; ++k) {
        const auto at = std::size_t(k);
        const ControlPhase<Sys>& phase = phases_[p];
        const bool inequalities_hold = inequalities_of(phase);
        const auto f = functions<double>(phase.system, path.arrows[at], path.controls[at], path.phases[p].step);
        out.cost[k][0] = f.cost;
        for (int i = 0; i < Sys::equalities; ++i) out.equality[k][i] = f.equality(i);
        for (int i = 0; i < Sys::inequalities; ++i)
          out.inequality[k][i] = inequalities_hold ? f.inequality(i) : not_there;
        for (std::size_t i = 0; i < duration_bounds_.size(); ++i)
          out.inequality[k][Sys::inequalities + int(i)] =
              duration_bounds_[i].holds(phase) && begins(k, p)
                  ? duration_bounds_[i].value(phase, double(path.phases[p].stages) * path.phases[p].step)
                  : not_there;
        for (std::size_t i = 0; i < bounds_.size(); ++i)
          out.inequality[k][before_bounds() + int(i)] =
              bounds_[i].holds(phase) ? bounds_[i].sign * (path.controls[at](bounds_[i].control) - bounds_[i].of(phase))
                                      : not_there;
      }
    for (std::size_t i = 0; i < conditions_.size(); ++i)
      conditions_[i].put_values(task_.system.groupoid, latest.nodes[i], out);
  }

  void derivatives(const StageRows& lambda, const StageRows& z, StageDerivatives& out) const override {
    static constexpr std::array<double, std::size_t(Sys::inequalities) + 1> none{};
    long k = 0;
    for (std::size_t p = 0; p < phases_.size(); ++p)
      for (; k < sizes_.phases[p].end; ++k) {
        const ControlPhase<Sys>& phase = phases_[p];
        const bool inequalities_hold = inequalities_of(phase);
        const double* weights = inequalities_hold ? z[k] : none.data();
        const double h = now_.path.phases[p].step;
        if constexpr (knows_derivatives) {
          const auto at = std::size_t(k);
          phase.system.stage_derivatives(now_.path.arrows[at], now_.path.controls[at], h, lambda[k],
                                         StagePlaces{out.gradient[k], out.equality[k], out.hessian[k]});
          if constexpr (Sys::inequalities > 0)
            if (inequalities_hold) by_jets<Part::inequalities>(phase.system, k, h, lambda[k], weights, out);
        } else {
          by_jets<Part::all>(phase.system, k, h, lambda[k], weights, out);
        }
        double* rows = out.inequality[k];
        if (!inequalities_hold) std::fill(rows, rows + Sys::inequalities * d, 0.0);
        std::fill(rows + Sys::inequalities * d, rows + before_bounds() * d, 0.0);
        for (std::size_t i = 0; i < duration_bounds_.size(); ++i)
          if (duration_bounds_[i].holds(phase) && begins(k, p))
            rows[(Sys::inequalities + int(i) + 1) * d - 1] = duration_bounds_[i].sign;
      }
    for (std::size_t i = 0; i < conditions_.size(); ++i)
      conditions_[i].put_derivatives(task_.system.groupoid, now_.nodes[i], lambda, out);
  }

  void sizes_of_displaced(TrajectoryDisplacement& out) const override {
    sizes_along(task_.system.groupoid, now_.path, out);
  }
  void try_displacement(const TrajectoryDisplacement& by, double fraction) override {
    has_tried_ = true;
    const G& groupoid = task_.system.groupoid;
    const auto node = [&](long k) {
      AlgebroidVector<G> v;
      for (int i = 0; i < n; ++i) v(i) = fraction * by.nodes[k][i];
      return v;
    };
    const A first = groupoid.tau(groupoid.source(now_.boundary), node(0));
    A back = groupoid.inverse(first);
    A product = groupoid.unit(groupoid.target(first));
    if (start_is_free_) tried_.path.start = groupoid.project(groupoid.compose(*now_.path.start, first));
    std::size_t condition = 0;
    for (; condition < conditions_.size() && conditions_[condition].node() == 0; ++condition)
      tried_.nodes[condition] = start_is_free_ ? *tried_.path.start : product;
    for (long k = 0; k < sizes_.stages; ++k) {
      const auto at = std::size_t(k);
      // A fixed end is where it was: what rounding adds up along the path is the last arrow's.
      if (k + 1 == sizes_.stages && end_is_fixed_) {
        tried_.boundary = groupoid.compose(groupoid.inverse(first), now_.boundary);
        tried_.path.arrows[at] = groupoid.project(groupoid.compose(groupoid.inverse(product), tried_.boundary));
        product = tried_.boundary;
      } else {
        displace_next(groupoid, now_.path.arrows[at], node(k + 1), back, tried_.path.arrows[at], product);
      }
      for (; condition < conditions_.size() && conditions_[condition].node() == k + 1; ++condition)
        tried_.nodes[condition] =
            start_is_free_ ? groupoid.project(groupoid.compose(*tried_.path.start, product)) : product;
      for (int i = 0; i < Sys::controls; ++i)
        tried_.path.controls[at](i) = now_.path.controls[at](i) + fraction * by.controls[k][i];
    }
    if (!end_is_fixed_) tried_.boundary = product;
    for (std::size_t p = 0; p < phases_.size(); ++p)
      tried_.path.phases[p].step = now_.path.phases[p].step * std::exp(fraction * by.durations[p]);
  }
  void accept() override {
    std::swap(now_, tried_);
    has_tried_ = false;
  }

 private:
  static constexpr int n = Sys::dimension;
  static constexpr int d = 2 * n + Sys::controls + 1;
  static constexpr bool framed = HasArrowFrame<G>;

  /// What an inequality is that a phase has not: it holds.
  static constexpr double not_there = -1;

  bool begins(long stage, std::size_t phase) const { return stage == (phase == 0 ? 0 : sizes_.phases[phase - 1].end); }
  struct Standing {
    ControlTrajectory<Sys> path;
    A boundary;
    std::vector<A> nodes;  // of each condition, from where the task begins
  };
  /// Of a stage's functions. Second-order jets are large: no copies are made on the way.
  template <class S> struct Arguments {
    ArrowOf<G, S> g;
    Vector<S, Sys::controls> u;
    S h;
  };
  template <class S> using Functions = StageFunctions<Sys, S>;

  static bool inequalities_of(const ControlPhase<Sys>& phase) {
    if constexpr (requires { phase.system.has_inequalities(); })
      if (!phase.system.has_inequalities()) return false;
    return phase.inequalities_hold;
  }

  template <class S>
  static Functions<S> functions(const Sys& system, const ArrowOf<G, S>& g, const Vector<S, Sys::controls>& u,
                                const S& h) {
    Functions<S> out;
    if constexpr (requires { system.cost_and_constraint(g, u, h, out.cost, out.equality); }) {
      system.cost_and_constraint(g, u, h, out.cost, out.equality);
    } else {
      out.cost = system.cost(g, u, h);
      out.equality = system.constraint(g, u, h);
    }
    if constexpr (Sys::inequalities > 0) out.inequality = system.inequality(g, u, h);
    return out;
  }

  void place_conditions(const ControlTrajectory<Sys>& path) {
    const auto place = [&](const std::shared_ptr<const NodeCondition<G>>& psi, long node) {
      if (!psi) return;
      const long stage = std::max(node - 1, 0L);
      int& count = sizes_.conditions[std::size_t(stage)];
      conditions_.emplace_back(psi, node, Sys::equalities + count);
      count += psi->size();
    };
    sizes_.conditions.assign(std::size_t(sizes_.stages), 0);
    place(task_.start_condition, 0);
    std::shared_ptr<const NodeCondition<G>> of_nodes;
    if constexpr (Sys::node_equalities > 0) {
      of_nodes = node_condition<G, Sys::node_equalities>(
          [system = task_.system](const auto& node) { return system.node_constraint(system.groupoid.target(node)); });
    }
    for (std::size_t p = 0; p < phases_.size(); ++p) {
      if (of_nodes)
        for (long k = p == 0 ? 1 : sizes_.phases[p - 1].end + 1; k < sizes_.phases[p].end; ++k) place(of_nodes, k);
      if (of_nodes && (p + 1 < phases_.size() || restricts_end(*of_nodes, path))) place(of_nodes, sizes_.phases[p].end);
      place(phases_[p].end_condition, sizes_.phases[p].end);
    }
    place(task_.end_condition, sizes_.stages);
    if constexpr (Sys::end_equalities > 0) {
      const auto psi = [system = phases_.back().system](const auto& node) {
        return system.end_constraint(system.groupoid.target(node));
      };
      place(node_condition<G, Sys::end_equalities>(psi), sizes_.stages);
    }
    if (task_.end_cost) conditions_.emplace_back(task_.end_cost, sizes_.stages, PlacedCondition<G>::cost);
    sizes_.node_equality = *std::max_element(sizes_.conditions.begin(), sizes_.conditions.end());
    sizes_.equality = Sys::equalities + sizes_.node_equality;
  }
  /// Whether a condition depends on what is free of the last node.
  bool restricts_end(const NodeCondition<G>& psi, const ControlTrajectory<Sys>& path) const {
    const int size = psi.size();
    const std::vector<double> none(std::size_t(size), 0.0);
    std::vector<double> rows(std::size_t(size * n));
    std::vector<double> hessian(std::size_t(n * n));
    psi.derivatives(task_.system.groupoid, path.arrows.back(), none.data(), rows.data(), hessian.data());
    for (int i = 0; i < size * n; ++i)
      if (free_end_[std::size_t(i % n)] && rows[std::size_t(i)] != 0) return true;
    return false;
  }
  /// Where the trajectory stands: the nodes that conditions are on.
  void locate_conditions() {
    if (conditions_.empty()) return;
    const G& groupoid = task_.system.groupoid;
    A product = now_.path.start ? *now_.path.start : groupoid.unit(groupoid.source(now_.path.arrows.front()));
    long k = 0;
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      for (; k < conditions_[i].node(); ++k)
        product = groupoid.project(groupoid.compose(product, now_.path.arrows[std::size_t(k)]));
      now_.nodes[i] = product;
    }
  }
  /// Systems that know <lambda, phi> without each of phi: second derivatives are its alone.
  static constexpr bool weighs =
      requires(const Sys& system, const A& g, const Vector<double, Sys::controls>& u, double h, const double* lambda) {
    system.weighted_constraint(g, u, h, lambda);
  };

  /// Systems whose derivatives need no jets along all directions of a stage.
  static constexpr bool knows_derivatives =
      requires(const Sys& system, const A& g, const Vector<double, Sys::controls>& u, double h, const double* lambda,
               const StagePlaces& out) {
    system.stage_derivatives(g, u, h, lambda, out);
  };
  /// What jets give: all of a stage, or what its inequalities add.
  enum class Part { all, inequalities };
  template <Part Which>
  void by_jets(const Sys& system, long stage, double h, const double* lambda, const double* z,
               StageDerivatives& out) const {
    if constexpr (Which == Part::inequalities && InequalitiesOfEnd<Sys>) {
      const auto at = std::size_t(stage);
      inequalities_of_end(system, now_.path.arrows[at], now_.path.controls[at], h, z, out.inequality[stage],
                          out.hessian[stage]);
    } else if constexpr (framed) {
      along_frame<Which>(system, stage, h, lambda, z, out);
    } else {
      along_ends<Which>(system, stage, h, lambda, z, out);
    }
  }
  template <Part Which> static void place_second(double& out, double x) { out = Which == Part::all ? x : out + x; }

  template <class J, class Place>
  void place_rows(const Functions<J>& f, long stage, const Place& place, StageDerivatives& out) const {
    place(f.cost, out.gradient[stage]);
    for (int i = 0; i < Sys::equalities; ++i) place(f.equality(i), out.equality[stage] + i * d);
    for (int i = 0; i < Sys::inequalities; ++i) place(f.inequality(i), out.inequality[stage] + i * d);
  }
  /// The stage's Lagrangian. at<T>() are arrow, controls and duration over jets T of N variables; place(jet, row)
  /// writes the first derivatives of each function.
  template <int N, Part Which, class At, class Place>
  SecondJet<double, N> lagrangian_of(const Sys& system, const At& at, long stage, const double* lambda, const double* z,
                                     const Place& place, StageDerivatives& out) const {
    using J = SecondJet<double, N>;
    const auto& [g, u, h] = at.template operator()<J>();
    if constexpr (Which == Part::inequalities) {
      const Vector<J, Sys::inequalities> gamma = system.inequality(g, u, h);
      J sum(0.0);
      for (int i = 0; i < Sys::inequalities; ++i) {
        place(gamma(i), out.inequality[stage] + i * d);
        sum += gamma(i) * z[i];
      }
      return sum;
    } else if constexpr (weighs) {
      using First = Jet<double, N>;
      const auto& [g1, u1, h1] = at.template operator()<First>();
      place_rows(functions<First>(system, g1, u1, h1), stage, place, out);
      J lagrangian = system.cost(g, u, h) + system.weighted_constraint(g, u, h, lambda);
      if constexpr (Sys::inequalities > 0) {
        const Vector<J, Sys::inequalities> gamma = system.inequality(g, u, h);
        for (int i = 0; i < Sys::inequalities; ++i) lagrangian += gamma(i) * z[i];
      }
      return lagrangian;
    } else {
      const Functions<J> f = functions<J>(system, g, u, h);
      place_rows(f, stage, place, out);
      J lagrangian = f.cost;
      for (int i = 0; i < Sys::equalities; ++i) lagrangian += f.equality(i) * lambda[i];
      for (int i = 0; i < Sys::inequalities; ++i) lagrangian += f.inequality(i) * z[i];
      return lagrangian;
    }
  }

  /// In one pass along the arrow's frame, pushed to its ends (second_derivatives.hpp).
  template <Part Which>
  void along_frame(const Sys& system, long stage, double h, const double* lambda, const double* z,
                   StageDerivatives& out) const requires framed {
    constexpr int f = arrow_dimension_of<G>();
    constexpr int others = Sys::controls + 1;
    constexpr int all = f + others;
    const G& groupoid = task_.system.groupoid;
    const auto at = std::size_t(stage);
    const A& g = now_.path.arrows[at];
    const auto arguments = [&]<class J>() {
      Vector<J, Sys::controls> u;
      for (int i = 0; i < Sys::controls; ++i) u(i) = J::variable(now_.path.controls[at](i), f + i);
      return Arguments<J>{groupoid.template frame_jet<J>(g), u, J::variable(0, all - 1).chain(h, h, h)};  // h exp(x)
    };

    // From a row over the frame, controls and duration to one over both ends, controls and duration.
    const auto push = [&](const auto& of, double* row) {
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
    const SecondJet<double, all> lagrangian = lagrangian_of<all, Which>(system, arguments, stage, lambda, z, push, out);

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
        for (int j = 0; j < (First == Second ? i + 1 : n); ++j) {
          const int row = (First == End::source ? 0 : n) + i;
          const int column = (Second == End::source ? 0 : n) + j;
          place_second<Which>(square[row * d + column], transposed(j, i));
          if (row != column) place_second<Which>(square[column * d + row], transposed(j, i));
        }
    };
    place.template operator()<End::source, End::source>(hessian);
    place.template operator()<End::target, End::target>(hessian);
    place.template operator()<End::source, End::target>(hessian + 0.5 * groupoid.frame_bracket(gradient));
    const Matrix<double, n, others> source = groupoid.template frame_to_end<End::source>(g, beside);
    const Matrix<double, n, others> target = groupoid.template frame_to_end<End::target>(g, beside);
    for (int j = 0; j < others; ++j) {
      for (int i = 0; i < n; ++i) {
        place_second<Which>(square[i * d + 2 * n + j], source(i, j));
        place_second<Which>(square[(2 * n + j) * d + i], source(i, j));
        place_second<Which>(square[(n + i) * d + 2 * n + j], target(i, j));
        place_second<Which>(square[(2 * n + j) * d + n + i], target(i, j));
      }
      for (int i = 0; i < others; ++i) place_second<Which>(square[(2 * n + i) * d + 2 * n + j], whole(f + i, f + j));
    }
  }

  /// Along both ends, by the operations of the groupoid alone.
  template <Part Which>
  void along_ends(const Sys& system, long stage, double h, const double* lambda, const double* z,
                  StageDerivatives& out) const {
    const G& groupoid = task_.system.groupoid;
    const auto at = std::size_t(stage);
    const auto arguments = [&]<class J>() {
      Vector<J, Sys::controls> u;
      for (int i = 0; i < Sys::controls; ++i) u(i) = J::variable(now_.path.controls[at](i), 2 * n + i);
      return Arguments<J>{displaced_jet<J>(groupoid, now_.path.arrows[at], 0, n), u,
                          J::variable(0, d - 1).chain(h, h, h)};  // h exp(x)
    };
    const auto place = [](const auto& of, double* row) { Eigen::Map<Vector<double, d>>{row} = of.gradient(); };
    const SecondJet<double, d> lagrangian = lagrangian_of<d, Which>(system, arguments, stage, lambda, z, place, out);
    const Matrix<double, d, d> whole = lagrangian.hessian();
    for (int i = 0; i < d * d; ++i) place_second<Which>(out.hessian[stage][i], whole.data()[i]);
  }

  ControlTask<Sys> task_;
  std::vector<ControlPhase<Sys>> phases_;
  std::vector<bool> free_start_, free_end_;
  bool start_is_free_ = false;
  bool end_is_fixed_ = true;
  std::vector<PhaseDurationBound<Sys>> duration_bounds_;
  std::vector<PhaseControlBound<Sys>> bounds_;
  std::vector<PlacedCondition<G>> conditions_;
  TranscriptionSizes sizes_;
  Standing now_, tried_;
  bool has_tried_ = false;  // since it stands there
};

}  // namespace lagroid
