#pragma once
/// Exact derivatives of a run through events whose times depend on its start and its parameters: where g(t, x) = 0,
///
///     dt* = -(g_x dx + g_theta dtheta) / (g_x X_s + g_t),    dx* = X dx + X_s dt*,
///
/// X the derivative of the partial step that ends there and X_s that by its duration; after a kick k(t, x) the rest of
/// the step, which is shorter by dt*, goes on from (q*, mu* + k). A parameter that becomes another number p(t, x) there
/// depends on the start from then on, dp = p_x dx* + p_theta dtheta + p_t dt*, and no more on what it was. These are
/// the saltation matrices of the discrete motion itself: nothing is differenced, and symplectic steps stay so between
/// events.
///
///     SmoothEvent<Bob> floor{"floor", [](const auto& node) { return node.object(1); }};
///     floor.direction = Event::Direction::falling;
///     floor.then = Event::Then::stop;
///     const EventSensitivities fall = event_sensitivities(bob, start, {floor}, {.steps = 100});
///     const double time_by_height = fall.happened[0].by_start(1);
///
/// Requires what `sensitivities` does, and a Lagrangian that takes its step as an argument; events at zero. Returns a
/// status: `singular` where an event grazes zero, or two happen at once, for there the derivative does not exist; that
/// of a step that fails; `left_domain` where a function is no finite number, or what is set is refused by the system.
/// An event that only records and touches zero has not happened, which is noted.
///
/// Errors: std::invalid_argument for a name that is no parameter or an event without a function; WithoutDerivative for
/// a parameter that varies, as it is asked for or set by what does, or a force's step size, that the system reads as a
/// plain number: the first step that it is in is compared with differences. Source: implicit function theorem at the
/// partial step; Hiskens and Pai, IEEE Trans. Circuits Syst. I 47, 2000, 204 (flows).

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/run/events/event_derivatives.hpp>
#include <lagroid/run/events/function_watch.hpp>
#include <lagroid/run/motion/parameter_values.hpp>
#include <lagroid/solvers/sensitivity/growth/growth.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/solvers/sensitivity/times/timed_node.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

/// What a function of an event sees: a node, or a point within a step, and the time there.
template <class Sys> using EventNode = ObservedTimedNode<Sys>;
/// What is observed of a node.
template <class Sys> using ObserveEventNode = ObserveTimedNode<Sys>;

/// An event with derivatives: where its function passes zero.
template <DiscreteSystem Sys> struct SmoothEvent {
  std::string name;
  std::function<VariedNumber(const EventNode<Sys>&)> function;
  Event::Direction direction = Event::Direction::both;
  Event::Then then = Event::Then::record;
  long count = 1;                   ///< the run stops when it has happened so often
  ObserveEventNode<Sys> kick = {};  ///< added to the momentum there
  double tolerance = 1e-8;          ///< nearer to zero, relative to the largest value so far, its function touches it
  /// A parameter that is a number, which becomes another one there.
  struct Setting {
    std::string name;
    std::function<VariedNumber(const EventNode<Sys>&)> number;
  };
  std::vector<Setting> set = {};

  bool changes_motion() const { return kick || !set.empty(); }
  /// Whether the motion depends on when it happens.
  bool decides() const { return changes_motion() || then == Event::Then::stop; }
};

namespace detail {

/// A system whose step size and start are varied as its parameters are.
template <DiscreteSystem Sys> struct VaryingStep : Sys {
  explicit VaryingStep(const Sys& system) : Sys(system) {}
  /// It hides the functions that take the step: what looks for them has to look there.
  Sys& plain() { return *this; }
  const Sys& plain() const { return *this; }

  template <class A> auto lagrangian(const A& g) const {
    using S = std::remove_cvref_t<decltype(plain().lagrangian(g))>;
    return S(over_step<S>([&](const auto&... times) { return plain().lagrangian(g, times...); }));
  }
  template <class A> auto constraint(const A& g) const requires(Sys::arrow_constraints > 0) {
    using S = std::remove_cvref_t<decltype(plain().constraint(g)(0))>;
    return Vector<S, Sys::arrow_constraints>(
        over_step<S>([&](const auto&... times) { return plain().constraint(g, times...); }));
  }
  template <class A> auto forces(const A& g) const requires Forced<Sys> {
    using S = std::remove_cvref_t<decltype(plain().forces(g).source(0))>;
    if constexpr (
        requires { plain().forces(g, this->h); } || requires { plain().forces(g, this->h, this->h); }) {
      return over_step<S>([&](const auto&... times) { return plain().forces(g, times...); });
    } else {
      return plain().forces(g);  // which may read the step: it is compared
    }
  }

 private:
  /// f(h), or f(t, h) of a system that depends on time.
  template <class S, class F> auto over_step(const F& f) const {
    const S step = constant<S>(varied<S>(this->h));
    if constexpr (TimeDependent<Sys>) {
      return f(constant<S>(varied<S>(this->time)), step);
    } else {
      return f(step);
    }
  }
};

template <DiscreteSystem Sys> class EventPropagation {
 public:
  using G = typename Sys::GroupoidType;
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;

  EventPropagation(const Sys& system, std::unique_ptr<Integrator<Sys>> integrator,
                   const std::vector<SmoothEvent<Sys>>& events, const std::vector<std::string>& parameters,
                   ObserveEventNode<Sys> observe, long observed_node)
      : system_(system),
        integrator_(std::move(integrator)),
        events_(events),
        observe_(std::move(observe)),
        observed_node_(observed_node),
        places_(places_of_parameters(system_.plain(), parameters)),
        asked_(2 * n + int(places_.members.size())) {
    for (const SmoothEvent<Sys>& event : events) {
      if (!event.function) throw std::invalid_argument("event \"" + event.name + "\": it has no function");
      for (const auto& each : event.set) add_place(event, each.name);
      watches_.emplace_back(Event{.name = event.name, .direction = event.direction, .tolerance = event.tolerance});
      happened_.push_back(0);
      touched_.push_back(0);
    }
    count_ = 2 * n + int(places_.members.size());
    directions_ = Eigen::MatrixXd::Identity(count_, asked_);
    time_by_ = Eigen::RowVectorXd::Zero(asked_);
    members_ = places_.members;
    members_.push_back(&system_.h);
    if constexpr (TimeDependent<Sys>) members_.push_back(&system_.time);
    is_compared_.assign(places_.members.size() + 1, 0);
  }
  EventPropagation(const EventPropagation&) = delete;  // derivatives know members by their places
  EventPropagation& operator=(const EventPropagation&) = delete;

  EventSensitivities run(long steps) {
    out_.parameters.assign(places_.names.begin(), places_.names.begin() + (asked_ - 2 * n));
    base_ = integrator_->point();
    for (std::size_t i = 0; i < events_.size(); ++i) watches_[i].next(value_at(i, base_), base_.time);
    if (observed_node_ == 0) observe_end();
    for (long k = 0; k < steps && !is_over_; ++k) advance(k + 1);
    if (out_.converged()) finish();
    for (std::size_t i = 0; i < events_.size(); ++i)
      for (const std::string& note : watches_[i].notes(touched_[i]))
        out_.notes.push_back("event \"" + events_[i].name + "\": " + note);
    return std::move(out_);
  }

 private:
  using Point = TrajectoryPoint<Sys>;
  struct Found {
    std::size_t event;
    double share;
    Passing passing;
  };

  /// What is set varies, whether it is asked for or not.
  void add_place(const SmoothEvent<Sys>& event, const std::string& name) {
    if (place_of(name) < places_.names.size()) return;
    const ParameterPlaces found = places_of_parameters(system_.plain(), {name});
    if (found.names.front() != name)
      throw std::invalid_argument("event \"" + event.name + "\": it sets " + name + ", which is no single number");
    places_.names.push_back(name);
    places_.members.push_back(found.members.front());
  }
  std::size_t place_of(const std::string& name) const {
    return std::size_t(std::find(places_.names.begin(), places_.names.end(), name) - places_.names.begin());
  }

  void fail(SolveStatus status, std::string why) {
    is_over_ = true;
    out_.status = status;
    out_.message = std::move(why);
  }

  /// f at a point, with its derivatives by (v, mu, theta, t): a row for each number.
  template <class F> NodeValues observe(const Point& point, const F& f) const {
    return values_at(system_.plain(), places_, point, 1,
                     [&](int first, const auto& object, const auto& momentum, const auto& configuration) {
                       const VariedNumber time = varied_along(Vector<double, 1>(point.time), count_ - first)(0);
                       return f(EventNode<Sys>{system_.plain(), time, object, momentum, configuration});
                     });
  }
  NodeValues value_of(std::size_t i, const Point& point) const {
    return observe(point, [&](const EventNode<Sys>& node) -> VariedVector {
      return VariedVector::Constant(1, events_[i].function(node));
    });
  }
  double value_at(std::size_t i, const Point& point) const { return value_of(i, point).values(0); }

  Point cut(double share) {
    Point point;
    const StepReport report = integrator_->cut(share, point);
    if (!report.converged()) throw report;
    return point;
  }

  /// The step to a point from the base, linearised: of directions at the base, and of the duration.
  struct Linearised {
    Eigen::MatrixXd end;          ///< by the directions, the duration of the step as it is
    Eigen::VectorXd by_duration;  ///< of (v, mu)
  };
  Linearised linearise(const Point& to) {
    const double duration = to.time - base_.time;
    set_time_step(system_.plain(), duration);
    set_time(system_.plain(), base_.time);
    LinearStep step(n + m, 2 * n, int(members_.size()));
    linearise_step(system_, Step<VaryingStep<Sys>>{to.step.arrow, to.step.multipliers}, members_, step);
    compare_members(to.step, step);
    if (!step.factor()) throw StepReport{SolveStatus::singular};
    const int extra = int(members_.size() - places_.members.size());
    Eigen::MatrixXd from = Eigen::MatrixXd::Zero(count_ + extra, asked_ + 1);
    from.topLeftCorner(count_, asked_) = directions_;
    // Of a base that is an event the start depends on the directions, too.
    if (extra > 1) from.row(count_ + 1).head(asked_) = time_by_;
    from(count_, asked_) = 1;
    const Eigen::MatrixXd all = step.forward(from);
    return {all.topLeftCorner(count_, asked_), all.col(asked_).head(2 * n)};
  }
  /// Once for each parameter that varies, and for the size of the step, which a force may read as a plain number.
  void compare_members(const Step<Sys>& solved, const LinearStep& step) {
    for (std::size_t j = 0; j < is_compared_.size(); ++j) {
      const bool is_size = j == places_.members.size();
      if (is_compared_[j] != 0 || (!is_size && directions_.row(2 * n + Eigen::Index(j)).isZero(0))) continue;
      is_compared_[j] = 1;
      compare_with_differences(system_.plain(), const_cast<double&>(*members_[j]),  // of the system, no constant
                               is_size ? "h" : places_.names[j], solved, step, 2 * n + Eigen::Index(j));
    }
  }
  void advance(long number) try {
    integrator_->keep_node();
    changes_ = 0;
    const double begun = integrator_->point().time;
    const StepReport report = integrator_->advance();
    if (!report.converged()) throw report;
    const Point node = integrator_->point();
    std::vector<std::size_t> suspects;
    for (std::size_t i = 0; i < events_.size(); ++i) {
      const double value = value_at(i, node);
      if (watches_[i].next(value, node.time)) suspects.push_back(i);
      if (number != 1 || !watches_[i].starts_there() || !is_in_direction(events_[i].direction, -value, value)) continue;
      const Eigen::RowVectorXd by = value_of(i, base_).derivatives.row(0);
      out_.begun.push_back({i, by.head(2 * n), by.segment(2 * n, asked_ - 2 * n)});
      if (events_[i].decides())
        return fail(SolveStatus::singular, "the function of event \"" + events_[i].name +
                                               "\" is zero at the start, and what follows has no derivative there");
    }
    while (!suspects.empty() && !is_over_) {
      if (changes_ == most_changes_in_step)
        return fail(SolveStatus::not_converged, "events follow their own changes without end");
      look_into_rest(std::exchange(suspects, {}), suspects);
    }
    if (is_over_) return;
    out_.steps = number;
    // A rest that is shorter is made with the next step.
    if (changes_ > 0 && node.time - base_.time < event_limits::shortest * (node.time - begun)) {
      if (number == observed_node_)
        fail(SolveStatus::singular,
             "node " + std::to_string(number) + " is the time of a change, where it has no derivative");
      is_changed_at_node_ = true;
      return;
    }
    is_changed_at_node_ = false;
    // The rest of a step after a change ends where the step does: what its start is late it is shorter.
    Linearised step = linearise(changes_ > 0 ? cut(1) : node);
    step.end.topRows(2 * n) -= step.by_duration * time_by_;
    move_base(step, integrator_->point(), Eigen::RowVectorXd::Zero(asked_));
    if (number == observed_node_) observe_end();
  } catch (const StepReport& report) {
    const std::string kicked =
        ", after " + std::to_string(changes_) + " changes in it: an event that follows its own kick wants a direction";
    fail(report.status,
         "step " + std::to_string(number) + ", or a part of it, did not converge" + (changes_ > 0 ? kicked : ""));
  } catch (const NoNumber&) {
    fail(SolveStatus::left_domain, "step " + std::to_string(number) + ": the function of an event is no finite number");
  }

  void look_into_rest(const std::vector<std::size_t>& suspects, std::vector<std::size_t>& next) {
    std::vector<Found> found;
    for (const std::size_t i : suspects)
      for (const FoundInStep& each : watches_[i].find([&](double share) { return value_at(i, cut(share)); }))
        if (each.passing == Passing::touching && !events_[i].decides()) {
          ++touched_[i];
        } else {
          found.push_back({i, each.share, each.passing});
        }
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.share < b.share; });
    for (std::size_t k = 0; k < found.size() && !is_over_; ++k) {
      if (k + 1 < found.size() && found[k + 1].share - found[k].share <= event_limits::together)
        return fail(SolveStatus::singular, named(found[k]) + " and " + named(found[k + 1]) +
                                               " happen together, where what follows has no derivative");
      happen(found[k], next);
      if (!next.empty()) return;
    }
  }
  std::string named(const Found& found) const { return "event \"" + events_[found.event].name + "\""; }

  void happen(const Found& found, std::vector<std::size_t>& next) {
    const SmoothEvent<Sys>& event = events_[found.event];
    const Point inside = cut(found.share);
    const Linearised step = linearise(inside);
    const NodeValues g = value_of(found.event, inside);
    // x* at a fixed duration; t* = t_base + duration.
    const Eigen::RowVectorXd by = g.derivatives.leftCols(count_) * step.end + g.derivatives(0, count_) * time_by_;
    const Eigen::VectorXd by_state = g.derivatives.row(0).head(2 * n).transpose();
    const double by_time = g.derivatives(0, count_);
    const double rate = by_state.dot(step.by_duration) + by_time;
    const double terms = by_state.cwiseAbs().dot(step.by_duration.cwiseAbs()) + std::abs(by_time);
    if (found.passing == Passing::touching || std::abs(rate) <= event_limits::grazing * terms)
      return fail(SolveStatus::singular, named(found) + " only grazes zero, where its time has no derivative: t = " +
                                             std::to_string(inside.time));
    if (!g.derivatives.allFinite())
      return fail(SolveStatus::singular,
                  "the function of " + named(found) + " has no derivative at t = " + std::to_string(inside.time));
    const Eigen::RowVectorXd duration_by = -by / rate;
    Linearised at = step;
    at.end.topRows(2 * n) += step.by_duration * duration_by;
    const Eigen::RowVectorXd time_by = time_by_ + duration_by;
    out_.happened.push_back({found.event, inside.time, time_by.head(2 * n), time_by.tail(asked_ - 2 * n), {}, {}, {}});
    auto& last = out_.happened.back();
    set_observed(inside, at.end, time_by, last.observed, last.observed_by_start, last.observed_by_parameters);
    ++happened_[found.event];
    const bool stops = event.then == Event::Then::stop && happened_[found.event] >= event.count;
    if (event.changes_motion()) {
      change(found, inside, at, time_by);
      if (is_over_) return;
      const Point node = integrator_->point();
      for (std::size_t i = 0; i < events_.size(); ++i) {
        const auto passing = i == found.event ? std::optional(found.passing) : std::nullopt;
        if (watches_[i].next_from(value_at(i, base_), passing, value_at(i, node), node.time)) next.push_back(i);
      }
    } else if (stops) {
      move_base(at, inside, time_by);
    }
    if (stops) is_over_ = out_.is_stopped = true;
  }

  /// Kicks, and sets parameters, both by what is there before.
  void change(const Found& found, const Point& inside, const Linearised& at, const Eigen::RowVectorXd& time_by) {
    const SmoothEvent<Sys>& event = events_[found.event];
    Linearised changed = at;
    Point from = inside;
    // f there, by the directions; where it has no derivative the run ends.
    const auto along = [&](const auto& f, const std::string& what) -> NodeValues {
      const NodeValues there = observe(inside, f);
      if (!there.derivatives.allFinite())
        fail(SolveStatus::singular,
             what + " of " + named(found) + " has no derivative at t = " + std::to_string(inside.time));
      return {there.values, there.derivatives.leftCols(count_) * at.end + there.derivatives.col(count_) * time_by};
    };
    std::vector<ParameterValue> to;
    for (const auto& each : event.set) {
      const NodeValues number = along(
          [&](const EventNode<Sys>& node) -> VariedVector { return VariedVector::Constant(1, each.number(node)); },
          "what is set (" + each.name + ")");
      changed.end.row(2 * n + Eigen::Index(place_of(each.name))) = number.derivatives.row(0);
      to.push_back({each.name, number.values(0)});
    }
    double share = found.share;
    if (event.kick) {
      const NodeValues k = along(event.kick, "the kick");
      if (k.values.size() != n)
        throw std::invalid_argument(named(found) + ": its kick has " + std::to_string(k.values.size()) +
                                    " numbers, the momentum has " + std::to_string(n));
      if (!k.values.allFinite())
        return fail(SolveStatus::left_domain,
                    "the kick of " + named(found) + " is no finite number at t = " + std::to_string(inside.time));
      const AlgebroidVector<G> by = k.values;
      changed.end.middleRows(n, n) += k.derivatives;
      from.state.momentum += by;
      if (!is_over_) require(integrator_->kick(std::exchange(share, 0), by));
    }
    if (!is_over_ && !to.empty()) {
      if (const std::string why = set_parameters(system_.plain(), to); !why.empty())
        return fail(SolveStatus::left_domain, named(found) + ": at t = " + std::to_string(inside.time) + " " + why);
      require(integrator_->change(share, [&to](Sys& system) { set_parameters(system, to); }));
    }
    if (is_over_) return;
    move_base(changed, from, time_by);
    ++changes_;
  }
  static void require(const StepReport& report) {
    if (!report.converged()) throw report;
  }

  void move_base(const Linearised& step, const Point& to, const Eigen::RowVectorXd& time_by) {
    directions_ = step.end;
    const Eigen::MatrixXd by_start = directions_.topLeftCorner(2 * n, 2 * n);
    growth_.after_a_step(by_start);
    if (growth_.wants_matrix()) growth_.see(by_start);
    base_ = to;
    time_by_ = time_by;
  }

  /// What is observed at a point, by directions there and the derivative of its time.
  void set_observed(const Point& point, const Eigen::MatrixXd& directions, const Eigen::RowVectorXd& time_by,
                    Eigen::VectorXd& values, Eigen::MatrixXd& by_start, Eigen::MatrixXd& by_parameters) const {
    if (!observe_) return;
    const NodeValues here = observe(point, observe_);
    const Eigen::MatrixXd by = here.derivatives.leftCols(count_) * directions + here.derivatives.col(count_) * time_by;
    values = here.values;
    by_start = by.leftCols(2 * n);
    by_parameters = by.rightCols(asked_ - 2 * n);
  }
  void observe_end() {
    set_observed(base_, directions_, time_by_, out_.observed, out_.observed_by_start, out_.observed_by_parameters);
  }

  void finish() {
    out_.growth = growth_.largest();
    if (is_changed_at_node_ && !out_.is_stopped)
      return fail(SolveStatus::singular, "the end is the time of a change, where it has no derivative");
    if (observed_node_ < 0) observe_end();
    const NodeValues momentum = observe(base_, [](const EventNode<Sys>& node) { return VariedVector(node.momentum); });
    Eigen::MatrixXd end = directions_.topRows(2 * n);
    end.bottomRows(n) = momentum.derivatives.leftCols(count_) * directions_;
    out_.time = base_.time;
    out_.by_start = end.leftCols(2 * n);
    out_.by_parameters = end.rightCols(asked_ - 2 * n);
  }

  VaryingStep<Sys> system_;
  std::unique_ptr<Integrator<Sys>> integrator_;
  const std::vector<SmoothEvent<Sys>>& events_;
  ObserveEventNode<Sys> observe_;
  long observed_node_;                  ///< -1: the end
  ParameterPlaces places_;              ///< those that are asked for, and then others that events set
  std::vector<const double*> members_;  ///< and the step's size, and its start
  int asked_;                           ///< of (v, mu, theta) at the start
  int count_ = 0;                       ///< of (v, mu, theta) on the way, all that vary
  Eigen::MatrixXd directions_;          ///< at the base: these by those
  Growth growth_{Eigen::MatrixXd::Identity(2 * n, 2 * n)};
  Eigen::RowVectorXd time_by_;  ///< of the base's time
  Point base_;                  ///< from which the rest of the step is made
  std::vector<FunctionWatch> watches_;
  std::vector<long> happened_;
  std::vector<long> touched_;  ///< by events that only record
  EventSensitivities out_;
  int changes_ = 0;                  ///< in this step
  bool is_changed_at_node_ = false;  ///< and its rest is to be made with the next step
  bool is_over_ = false;
  std::vector<char> is_compared_;  ///< which members are as differences of a step say
};

}  // namespace detail

/// By equal steps of order two, from the start until the last step or the event that stops the run. `observe`, if any,
/// is looked at where events happen and at the end, or at the node that options.observed asks for. The integrator is at
/// its start and makes steps of one arrow each, also in part, that solve the equations of the system: reduced ones do,
/// too, where nothing is changed on the way.
template <DiscreteSystem Sys>
requires StepDependent<Sys> || TimeDependent<Sys> EventSensitivities event_sensitivities(
    const Sys& system, std::unique_ptr<Integrator<Sys>> integrator, const std::vector<SmoothEvent<Sys>>& events,
    const SensitivityOptions<Sys>& options = {}, ObserveEventNode<Sys> observe = {}) {
  if (options.observed.kind == Observed::Kind::integral)
    throw std::invalid_argument("events leave no equal steps over which to integrate: observe a node, or the end");
  detail::EventPropagation<Sys> motion(system, std::move(integrator), events, options.parameters, std::move(observe),
                                       options.observed.node);
  return motion.run(options.steps);
}
template <DiscreteSystem Sys>
requires StepDependent<Sys> || TimeDependent<Sys> EventSensitivities event_sensitivities(
    const Sys& system, const State<typename Sys::GroupoidType>& start, const std::vector<SmoothEvent<Sys>>& events,
    const SensitivityOptions<Sys>& options = {}, ObserveEventNode<Sys> observe = {}) {
  return event_sensitivities<Sys>(system, detail::newton_integrator(system, start, options), events, options,
                                  std::move(observe));
}

}  // namespace lagroid
