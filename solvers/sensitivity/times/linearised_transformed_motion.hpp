#pragma once
/// Motions by explicit steps that are equal in another time s (transformed.hpp), linearised. A step is evaluated over
/// numbers with derivatives,
///
///     (v, mu, t, E, s) -> (v', mu', t + dt, E, s),
///
/// s being its length in the other time. E and s are made of the start, before the first step, and stay:
///
///     E = T(mu_0) + U(q_0),    s = -h U(q_0).
///
///     LinearisedTransformedMotion<Kepler> motion(kepler, start, unit, {"strength"}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);  // columns (v, mu, t, E, s, theta)
///
/// A start varies by (v, mu) alone. The matrix of a step is symplectic on the phase space extended by t and -E.
///
/// Requires an AttractiveSystem whose flows and energies are templates on the scalar. Errors: std::invalid_argument for
/// a name that is no parameter and for a composition of two flows; WithoutDerivative for a parameter that is read as a
/// plain number. Where the motion leaves the attraction, that is its status.

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/solvers/integrators/transformed.hpp>
#include <lagroid/solvers/sensitivity/explicit/charts_of_nodes.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/solvers/sensitivity/times/timed_node.hpp>
#include <lagroid/solvers/sensitivity/varied_point.hpp>

#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// Whether runs in transformed time have derivatives.
template <class Sys>
concept VariedAttraction = AttractiveSystem<Sys> &&
    requires(const Sys& system, const ObjectOf<typename Sys::GroupoidType, VariedNumber>& object,
             const AlgebroidVector<typename Sys::GroupoidType, VariedNumber>& momentum) {
  { system.kinetic_energy(momentum) } -> std::same_as<VariedNumber>;
  { system.potential_energy(object) } -> std::same_as<VariedNumber>;
};

template <VariedAttraction Sys> class LinearisedTransformedMotion final : public LinearisedMotion {
 public:
  using G = typename Sys::GroupoidType;
  using Chart = GroupoidChart<Sys>;
  static constexpr int n = Sys::dimension;
  static constexpr int time_place = 2 * n;  ///< of t in a state
  static constexpr int energy_place = 2 * n + 1;
  static constexpr int length_place = 2 * n + 2;
  static constexpr int size = 2 * n + 3;

  LinearisedTransformedMotion(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration,
                              const std::vector<std::string>& parameters, ObserveTimedNode<Sys> observe,
                              const Composition& composition = compositions::single)
      : system_(system),
        composition_(composition),
        integrator_(system, start, configuration, composition),
        places_(places_of_parameters(system_, parameters)),
        observe_(std::move(observe)),
        beginning_(0, size, this->parameters()),
        stage_(0, size, this->parameters()) {
    begin();
  }
  LinearisedTransformedMotion(const LinearisedTransformedMotion&) = delete;  // derivatives know members by their places
  LinearisedTransformedMotion& operator=(const LinearisedTransformedMotion&) = delete;

  int states() const override { return size; }
  int parameters() const override { return int(places_.members.size()); }
  const std::vector<std::string>& parameter_names() const { return places_.names; }
  const TrajectoryPoint<Sys>& point() const { return integrator_.point(); }
  double time() const override { return point().time; }
  bool has_equal_steps() const override { return false; }
  StepReport advance() override {
    before_ = point();
    return integrator_.advance();
  }

  bool linearise() override {
    const Step step{*this, before_, point(), integrator_.length()};
    differentiate(step, stage_.end_by_start);
    if (!std::exchange(compared_, true)) compare(step, stage_);
    return stage_.factor();
  }
  /// Before the first step E and s are made.
  int stages() const override { return point().index == 1 ? 2 : 1; }
  const LinearStep& stage(int k) const override { return k + 1 < stages() ? beginning_ : stage_; }

  NodeValues observe() const override { return detail::observe_timed(system_, places_, point(), size, observe_); }
  std::optional<NodeValues> observe_later(double time) override {
    const auto length = length_of(time - point().time);
    if (!length) return std::nullopt;
    const TrajectoryPoint<Sys> to = part(*length);
    Eigen::MatrixXd all(size, size + parameters());
    differentiate(Step{*this, point(), to, *length}, all);
    // It ends at this time, whenever it began; its length in s is what gives.
    LinearStep step(1, size, parameters());
    const auto split = [](auto&& from, auto&& by_unknown, auto&& by_start) {
      by_unknown = from.col(length_place);
      by_start = from;
      by_start.col(length_place).setZero();
    };
    split(all, step.end_by_unknowns, step.end_by_start);
    split(all.row(time_place), step.equations_by_unknowns, step.equations_by_start);
    step.end_by_unknowns(length_place, 0) = 0;
    step.end_by_start(length_place, length_place) = 1;
    if (!step.factor()) return std::nullopt;
    NodeValues seen = detail::before_step(detail::observe_timed(system_, places_, to, size, observe_), step);
    if (point().index == 0) seen = detail::before_step(seen, beginning_);
    return seen;
  }

  void serialize(NumberArchive& archive) override { integrator_.serialize(archive); }

 private:
  /// Over any scalar, in displacements of the states at its two nodes.
  struct Step {
    const LinearisedTransformedMotion& of;
    const TrajectoryPoint<Sys>& from;
    const TrajectoryPoint<Sys>& to;
    double length;

    template <class S> Vector<S, size> operator()(const Vector<S, size>& x) const {
      const NodeOver<G, S> node = Chart(of.system_, from).displaced(Vector<S, 2 * n>(x.template head<2 * n>()));
      SplitMotion<Sys, S> motion(of.system_, node.object, node.momentum);
      bool inside = true;
      const S taken =
          detail::transformed_step(of.system_, of.composition_, S(x(energy_place) + of.integrator_.energy()),
                                   S(x(length_place) + length), motion, inside);
      const NodeOver<G, S> end{motion.object(), motion.momentum(),
                               of.system_.groupoid.compose(node.configuration, motion.arrow())};
      Vector<S, size> out = x;
      out.template head<2 * n>() = Chart(of.system_, to).displacement(end);
      out(time_place) += taken - (to.time - from.time);
      return out;
    }
  };
  /// (v, mu, t, E, s) of the start, of which E and s follow from the others.
  struct Beginning {
    const LinearisedTransformedMotion& of;
    const TrajectoryPoint<Sys>& start;

    template <class S> Vector<S, size> operator()(const Vector<S, size>& x) const {
      const NodeOver<G, S> node = Chart(of.system_, start).displaced(Vector<S, 2 * n>(x.template head<2 * n>()));
      const S potential = of.system_.potential_energy(node.object);
      Vector<S, size> out = x;
      out(energy_place) = of.system_.kinetic_energy(node.momentum) + potential;
      out(length_place) = potential * -of.system_.h;
      return out;
    }
  };

  /// By states and parameters.
  template <class Map> void differentiate(const Map& map, Eigen::MatrixXd& out) const {
    const Vector<double, size> zero = Vector<double, size>::Zero();
    detail::for_directions(size + parameters(), [&](int first) {
      const VariedMembers varying(places_.members, size - first);
      detail::put_tangents(map(detail::varied_along(zero, -first)), first, out);
    });
  }
  template <class Map> void compare(const Map& map, const LinearStep& step) {
    detail::compare_with_differences(
        places_, step.end_by_start.rightCols(parameters()), detail::size_of(system_, before_),
        [&] { return Eigen::VectorXd(map(Vector<double, size>(Vector<double, size>::Zero()))); });
  }
  void begin() {
    const Beginning map{*this, point()};
    differentiate(map, beginning_.end_by_start);
    beginning_.factor();
    compare(map, beginning_);
  }

  /// Where a part of a step of this length leads.
  TrajectoryPoint<Sys> part(double length) const {
    SplitMotion<Sys, double> motion(system_, point().state.object, point().state.momentum);
    bool inside = true;
    TrajectoryPoint<Sys> out = point();
    out.step_size = detail::transformed_step(system_, composition_, integrator_.energy(), length, motion, inside);
    out.time += inside ? out.step_size : std::numeric_limits<double>::quiet_NaN();
    out.state = {motion.object(), motion.momentum()};
    out.configuration = system_.groupoid.compose(out.configuration, motion.arrow());
    return out;
  }
  /// Of the part of a step that takes this time, by Newton's method; none where there is none.
  std::optional<double> length_of(double duration) const {
    constexpr int at_most = 30;
    double length = -duration * system_.potential_energy(point().state.object);
    for (int k = 0; k < at_most; ++k) {
      SplitMotion<Sys, VariedNumber> motion(
          system_, system_.groupoid.template cast_object<VariedNumber>(point().state.object),
          AlgebroidVector<G, VariedNumber>(point().state.momentum.template cast<VariedNumber>()));
      bool inside = true;
      const VariedNumber taken = detail::transformed_step(system_, composition_, VariedNumber(integrator_.energy()),
                                                          VariedNumber::variable(length, 0), motion, inside);
      const double change = (duration - taken.value) / taken.tangent(0);
      if (!inside || !std::isfinite(change)) return std::nullopt;
      length += change;
      if (std::abs(change) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(length)) return length;
    }
    return std::nullopt;
  }

  Sys system_;
  Composition composition_;
  TransformedIntegrator<Sys> integrator_;
  ParameterPlaces places_;  ///< of system_
  ObserveTimedNode<Sys> observe_;
  LinearStep beginning_;
  LinearStep stage_;
  TrajectoryPoint<Sys> before_ = integrator_.point();
  bool compared_ = false;
};

}  // namespace lagroid
