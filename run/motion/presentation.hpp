#pragma once
/// How reports name the numbers of a system: labels, units, panels and shapes.
///
/// The mathematics is in systems/; what a person reads is declared here, apart from it.
///
///     Presentation<Sys> p = plain_presentation<Sys>(system, "pendulum", quantities);
///     p.momentum = {"p"};
///     p.momentum_unit = "kg m^2/s";

#include <lagroid/core/quantity.hpp>
#include <lagroid/run/run_result.hpp>

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lagroid {

/// A recorded function of trajectory points beyond those every system has.
template <class Sys> struct ExtraColumns {
  Columns series;  ///< without values
  std::function<void(const TrajectoryPoint<Sys>&, double*)> evaluate;
};

/// The words and units of a system.
template <class Sys> struct Presentation {
  std::string name;
  std::vector<std::string> position;  ///< labels; may be empty (a group has one object)
  std::string position_unit;
  bool has_attitude = false;
  bool body_is_transposed = false;  ///< reports show the attitude A^T too
  std::vector<std::string> momentum;
  std::string momentum_unit;
  std::vector<std::string> multipliers;
  std::function<std::vector<double>(const TrajectoryPoint<Sys>&)> position_of;
  std::function<std::array<double, 4>(const TrajectoryPoint<Sys>&)> attitude_of;
  std::vector<ExtraColumns<Sys>> extras;
  std::vector<Panel> panels;
  std::vector<Shape> shapes;
  std::map<std::string, std::string> conventions;
};

/// Adds its words and pictures to a result.
template <class Sys> void present(const Presentation<Sys>& presentation, RunResult& result) {
  result.trajectory.conventions = presentation.conventions;
  result.panels = presentation.panels;
  result.shapes = presentation.shapes;
}

}  // namespace lagroid
