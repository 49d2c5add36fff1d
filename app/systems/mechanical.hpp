#pragma once
/// What the scenes of point masses on R^n have in common.

#include "../registry.hpp"

#include <lagroid/systems/mechanical.hpp>

namespace lagroid::app {

/// [parameters] quadrature, shared by all systems with a potential on R^n.
inline Quadrature read_quadrature(const Section& parameters, const std::string& fallback) {
  return parameters.choice_or("quadrature", fallback, {"midpoint", "trapezoid"}) == "midpoint" ? Quadrature::midpoint
                                                                                               : Quadrature::trapezoid;
}

/// [initial] position and momentum as vectors of R^n.
template <int N>
State<Pair<N>> read_vector_state(const Section& initial, std::string_view position, std::string_view momentum) {
  State<Pair<N>> s;
  s.object = Eigen::Map<const Vector<double, N>>(initial.numbers("position", N, position).data());
  s.momentum = Eigen::Map<const Vector<double, N>>(initial.numbers("momentum", N, momentum).data());
  return s;
}

/// Positions, momenta and two panels; the caller fills in labels.
template <class Sys, int N>
Presentation<Sys> vector_presentation(std::string name, std::vector<std::string> position, std::string position_unit,
                                      std::vector<std::string> momentum, std::string momentum_unit) {
  Presentation<Sys> p;
  p.name = std::move(name);
  p.position = std::move(position);
  p.position_unit = std::move(position_unit);
  p.momentum = std::move(momentum);
  p.momentum_unit = std::move(momentum_unit);
  p.position_of = [](const TrajectoryPoint<Sys>& point) {
    const auto& q = point.state.object;
    return std::vector<double>(q.data(), q.data() + N);
  };
  p.conventions = {{"state", "object q and momentum p at the nodes"}};
  return p;
}

/// Reads what is left of the scene, refuses unknown keys, and runs.
template <class Sys, int N>
RunResult run_mechanical(const Section& scene, const RunContext& context, Sys system, const Presentation<Sys>& p,
                         const State<Pair<N>>& initial) {
  const TimeGrid grid = read_time(scene);
  system.h = grid.step;
  const StepperChoice choice = read_stepper(scene.section_or_empty("solver"));
  const long every = read_every(scene, context);
  scene.finish();
  return simulate(system, p, initial, PairArrow<double, N>{initial.object, initial.object}, grid.steps, choice, every,
                  context);
}

}  // namespace lagroid::app
