#pragma once
/// A node, or a point within a step, whose time has derivatives: as those of events and of steps that vary.
///
///     const ObserveTimedNode<Kepler> end_time = [](const auto& node) { return VariedVector::Constant(1, node.time); };
///
/// Requires nothing. Nothing throws.

#include <lagroid/core/system.hpp>
#include <lagroid/solvers/integrators/cut_step.hpp>
#include <lagroid/solvers/sensitivity/linear_step.hpp>
#include <lagroid/solvers/sensitivity/varied_point.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace lagroid {

template <class Sys> struct ObservedTimedNode {
  using G = typename Sys::GroupoidType;
  const Sys& system;
  VariedNumber time;
  ObjectOf<G, VariedNumber> object;
  AlgebroidVector<G, VariedNumber> momentum;  ///< the one that is reported
  ArrowOf<G, VariedNumber> configuration;
};
/// What is observed there.
template <class Sys> using ObserveTimedNode = std::function<VariedVector(const ObservedTimedNode<Sys>&)>;

namespace detail {

/// What is observed at a point, by a state (v, mu, t, ...) of `states` numbers and the parameters.
template <DiscreteSystem Sys>
NodeValues observe_timed(const Sys& system, const ParameterPlaces& places, const TrajectoryPoint<Sys>& point,
                         int states, const ObserveTimedNode<Sys>& f) {
  constexpr int time_place = 2 * Sys::dimension;
  const int parameters = int(places.members.size());
  const int time_direction = time_place + parameters;
  const NodeValues here = values_at(
      system, places, point, 1, [&](int first, const auto& object, const auto& momentum, const auto& configuration) {
        const auto time = varied_along(Vector<double, 1>(point.time), time_direction - first);
        return f({system, time(0), object, momentum, configuration});
      });
  NodeValues out{here.values, Eigen::MatrixXd::Zero(here.values.size(), states + parameters)};
  out.derivatives.leftCols(time_place) = here.derivatives.leftCols(time_place);
  out.derivatives.col(time_place) = here.derivatives.col(time_direction);
  out.derivatives.rightCols(parameters) = here.derivatives.middleCols(time_place, parameters);
  return out;
}

/// What is observed after a step, by the state before it.
inline NodeValues before_step(const NodeValues& after, const LinearStep& step) {
  const Eigen::Index count = after.derivatives.cols();
  return {after.values, after.derivatives * step.forward(Eigen::MatrixXd::Identity(count, count))};
}

/// A step to a given time from a point of a motion, by a solver of its own.
template <DiscreteSystem Sys> class StepInPart {
 public:
  StepInPart(const Sys& system, std::unique_ptr<StepSolver<Sys>> solver) : predictor_(system, std::move(solver)) {}

  std::optional<TrajectoryPoint<Sys>> from(const TrajectoryPoint<Sys>& point, double time) {
    TrajectoryPoint<Sys> to;
    if (!cut_step(predictor_, point, time - point.time, to).converged()) return std::nullopt;
    return to;
  }

 private:
  StepPredictor<Sys> predictor_;
};

}  // namespace detail

}  // namespace lagroid
