#pragma once
/// Explicit steps of order 4 to 16 by extrapolation of splitting steps: over a time H the Strang step is made 1, 2,
/// ..., k times, and what it leads to is extrapolated to steps of none, in the coordinates of arrows g from q and of
/// momenta,
///
///     g = project(sum_j w_j g_j),    mu' - mu = sum_j w_j (mu_j - mu),
///
/// with the weights of ExtrapolationTable: Strang's step is symmetric, its error thus even in H/j.
///
/// For a short motion to many digits nothing here costs less, since a row costs half of one of Gragg's. What it keeps
/// is the groupoid and object constraints; neither energy nor momentum nor the symplectic form is kept but to the
/// tolerance, and over long times a splitting is better.
///
/// Rows do not depend on each other: where flows can be followed for a time of each lane (SplitSystem) four of them go
/// on side by side.
///
///     ExtrapolatedSplitting<Kepler> orbit(Kepler{}, {{1, 0}, {0, 1}}, Pair<2>::unit(Vector<double, 2>(1, 0)), 1e-12);
///     const StepReport report = orbit.advance();  // to the next node, after h
///
/// Requires a SplitSystem; its step `h`, of either sign, is the distance of the nodes, between which steps are as long
/// as the tolerance allows: the error of one, in components of place and momentum, each relative to the largest so far.
/// The constructor throws std::invalid_argument for a tolerance that is not positive and for a configuration that does
/// not end at the initial object. Status: `no_step` where the error stays above the tolerance however small the step,
/// `not_finite`, `not_converged` where a node takes more than a million steps; all leave everything as it was. The
/// report counts Strang steps. (Gragg 1965; Deuflhard 1983; Hairer, Norsett, Wanner, Solving ODEs I, II.9 and II.14.)

#include <lagroid/solvers/extrapolation/extrapolation_table.hpp>
#include <lagroid/solvers/extrapolation/onto_object_constraints.hpp>
#include <lagroid/solvers/extrapolation/row_register.hpp>
#include <lagroid/solvers/generating/constrained_momentum.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/solvers/lie_group/controlled_steps.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

/// A step on the way to the next node.
struct InnerStep {
  double size;
  int rows;  ///< of the table that was extrapolated
};

template <SplitSystem Sys> class ExtrapolatedSplitting {
 public:
  using G = typename Sys::GroupoidType;

  /// `configuration` is the arrow whose target is the initial object (see TrajectoryPoint).
  ExtrapolatedSplitting(Sys system, const State<G>& initial, const ArrowOf<G>& configuration, double tolerance)
      : system_(std::move(system)),
        start_(start_time(system_)),
        trajectory_(system_.groupoid, initial, configuration, start_),
        order_(tolerance, Register::width, 1, std::abs(system_.h)),
        next_(std::abs(system_.h)) {
    measure(initial.momentum);
  }

  const TrajectoryPoint<Sys>& point() const { return trajectory_.point(); }
  const Sys& system() const { return system_; }
  MethodTraits traits() const {
    const auto& of = extrapolation_method;
    return {std::string(of.name) + " of Strang steps", of.order, false, false, true, 0};
  }

  /// To the next node.
  StepReport advance() {
    return advance([](const InnerStep&) {});
  }
  /// The same, which tells the inner steps that it makes.
  template <class Visit> StepReport advance(const Visit& visit) {
    const auto kept = std::make_tuple(trajectory_, order_.memory(), next_, place_size_, momentum_size_);
    StepReport report;
    const double node = std::abs(system_.h);
    double gone = 0;
    for (long tried = 1; gone < node; ++tried) {
      const double left = node - gone;
      const double step = detail::step_on_the_way(next_, left);
      const InnerStep inner{std::copysign(step, system_.h), order_.table().rows};
      const StepAttempt attempt = try_step(inner.size);
      report.iterations += attempt.evaluations;
      next_ = std::min(detail::size_after(attempt, step, next_), node);
      if (attempt.accepted) {
        gone = step == left ? node : gone + step;
        visit(inner);
      }
      const bool too_many = tried >= most_inner_steps && gone < node;
      if (!too_many && (attempt.accepted || gone + next_ > gone)) continue;
      report.status = too_many         ? SolveStatus::not_converged
                      : attempt.finite ? SolveStatus::no_step
                                       : SolveStatus::not_finite;
      auto memory = order_.memory();
      std::tie(trajectory_, memory, next_, place_size_, momentum_size_) = kept;
      order_.go_back_to(memory);
      return report;
    }
    report.status = SolveStatus::converged;
    trajectory_.arrive_at(start_ + double(point().index + 1) * system_.h, system_.h);
    return report;
  }
  /// Goes to a point, from which the next node is a share as far as it was.
  void begin_cut(const TrajectoryPoint<Sys>& from, double share) {
    system_.h *= share;
    trajectory_ = CompensatedTrajectory<Sys>(system_.groupoid, from.state, from.configuration);
  }
  /// Goes on from a point of the same index and time, which no step of its own led to.
  void go_on_from(const TrajectoryPoint<Sys>& point) {
    trajectory_.go_on_from(point);
    measure(point.state.momentum);
  }
  /// Visits the system that its steps are of, to change it; the step's size stays.
  template <class F> void for_each_system(const F& f) { f(system_); }
  /// Visits all that the next step goes on from.
  void serialize(NumberArchive& archive) {
    trajectory_.serialize(system_.groupoid, archive);
    archive(order_, next_, place_size_, momentum_size_);
  }

 private:
  static constexpr int n = G::dimension;
  static constexpr int coordinates = G::arrow_coordinate_count();
  using S = std::conditional_t<SplitInLanes<Sys, RowBatch>, RowBatch, double>;
  using Register = detail::RowRegister<S>;
  using Place = Vector<double, coordinates>;
  using Momentum = Vector<double, n>;

  /// The largest component, whose square might overflow.
  template <class X> static double largest(const X& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0; }
  /// The largest so far: of places by the coordinates of their units.
  void measure(const AlgebroidVector<G>& momentum) {
    const G& groupoid = system_.groupoid;
    place_size_ = std::max(place_size_, largest(groupoid.coordinates_of_arrow(groupoid.unit(point().state.object))));
    momentum_size_ = std::max(momentum_size_, largest(momentum));
  }

  /// Of which evaluations are Strang steps.
  StepAttempt try_step(double step) {
    const G& groupoid = system_.groupoid;
    const State<G> from = point().state;
    const ExtrapolationTable& table = order_.table();
    follow_rows(table, step, from);
    const Place begun = groupoid.coordinates_of_arrow(groupoid.unit(from.object));
    std::array<Place, 3> place;
    std::array<Momentum, 3> change;
    for (int w = 0; w < 3; ++w) {
      place[std::size_t(w)].setZero();
      change[std::size_t(w)].setZero();
      for (int j = 0; j < table.rows; ++j) {
        place[std::size_t(w)] += (places_.col(j) - begun) * table.weights(j, w);
        change[std::size_t(w)] += momenta_.col(j) * table.weights(j, w);
      }
    }
    const int strang_steps = table.rows * (table.rows + 1) / 2;
    if (!place[0].allFinite() || !change[0].allFinite()) return {false, false, 0.2 * std::abs(step), strang_steps};
    const double place_size = std::max(place_size_, largest(place[0]));
    const double momentum_size = std::max(momentum_size_, largest(change[0]));
    const auto error = [&](std::size_t w) {
      return std::max(largest(place[w]) / (place_size > 0 ? place_size : 1),
                      largest(change[w]) / (momentum_size > 0 ? momentum_size : 1));
    };
    const auto verdict = order_.judge(std::abs(step), error(1), error(2), 1);
    if (!verdict.accepted) return {false, true, verdict.next, strang_steps};
    StepSolution<Sys> solution;
    solution.step = {groupoid.project(groupoid.template arrow_at<double>(Place(begun + place[0]))),
                     Sys::Multipliers::Zero()};
    solution.momentum_change = change[0];
    solution.remainder = remainders_.leftCols(table.rows) * table.weights.col(0);
    if constexpr (Sys::object_constraints > 0) {
      onto_object_constraints<double>(system_, solution.step.arrow);
      const State<G> off{groupoid.target(solution.step.arrow), from.momentum + solution.momentum_change};
      solution.momentum_change = tangent_momentum(system_, off) - from.momentum;
    }
    trajectory_.join(groupoid, solution);
    measure(point().state.momentum);
    return {true, true, verdict.next, strang_steps};
  }

  /// The rows of the table: where each leads to, in places_ and momenta_. The half of flow 0 at the end of a step joins
  /// that at the beginning of the next one.
  void follow_rows(const ExtrapolationTable& table, double step, const State<G>& from) {
    const G& groupoid = system_.groupoid;
    const auto begun =
        groupoid.template object_at<S>(groupoid.coordinates_of_object(from.object).template cast<S>().eval());
    SplitMotion<Sys, S> rows(system_, begun, from.momentum.template cast<S>().eval());
    const auto of_lanes = [&](const std::vector<double>& x) { return Register::load(x) * step; };
    rows.template follow<0>(of_lanes(table.slots.front().step) * 0.5);
    for (auto slot = table.slots.begin(); slot != table.slots.end(); ++slot) {
      const auto h = of_lanes(slot->step);
      rows.follow_others(h);
      rows.template follow<0>(h * (1.0 - 0.5 * Register::load(slot->last)));
      if (!slot->ends.empty()) {
        const auto place = groupoid.coordinates_of_arrow(rows.arrow());
        for (const auto& [lane, row] : slot->ends) {
          for (int i = 0; i < coordinates; ++i) places_(i, row - 1) = Register::get(place(i), lane);
          for (int i = 0; i < n; ++i) momenta_(i, row - 1) = Register::get(rows.momentum_change()(i), lane);
          for (int i = 0; i < n; ++i) remainders_(i, row - 1) = Register::get(rows.remainder()(i), lane);
        }
      }
      if (slot->others.empty()) continue;
      rows.begin_again(begun, [&](const S& a, const S& b) { return Register::choose(slot->others, a, b); });
      rows.template follow<0>(of_lanes((slot + 1)->step) * Register::load(slot->others) * 0.5);
    }
  }

  Sys system_;
  double start_;
  CompensatedTrajectory<Sys> trajectory_;
  ExtrapolationOrder order_;
  double next_;            ///< the size of the next step
  double place_size_ = 0;  ///< the largest so far
  double momentum_size_ = 0;
  Eigen::Matrix<double, coordinates, ExtrapolationTable::most_rows> places_;
  Eigen::Matrix<double, n, ExtrapolationTable::most_rows> momenta_, remainders_;
};

}  // namespace lagroid
