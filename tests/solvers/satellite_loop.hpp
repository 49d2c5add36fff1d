#pragma once
// What control loops of tests do: a satellite is turned by plans made anew, each from where the last one and chance
// lead.

#include <lagroid/solvers/control/control_loop.hpp>
#include <lagroid/systems/control/flows/satellite_turn.hpp>

#include <random>

namespace lagroid::satellite_loop {

using States = FlowStates<SatelliteTurn::GroupoidType>;

/// Torques at their bounds, and a cone in the way.
inline ControlTask<SatelliteTurn> turn() {
  SatelliteTurn satellite;
  satellite.avoided << 0.8369922322356853, 0.09964193240901018, 0.5380664350086549;
  satellite.cone = 0.4363323129985824;
  States::State end;
  end << 2 * Vector<double, 3>(0.2, 1, 0.1).normalized(), 0, 0, 0;
  ControlTask<SatelliteTurn> task{satellite, States::arrow(States::State::Zero(), end, satellite.avoided), 5};
  task.lower.setConstant(-0.6);
  task.upper.setConstant(0.6);
  return task;
}

/// What chance does to a state.
class Chance {
 public:
  explicit Chance(double size) : normal_(0, size) {}
  Vector<double, 6> operator()() {
    Vector<double, 6> off;
    for (double& x : off) x = normal_(generator_);
    return off;
  }

 private:
  std::mt19937 generator_{1};
  std::normal_distribution<double> normal_;
};

}  // namespace lagroid::satellite_loop
