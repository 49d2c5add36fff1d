#pragma once
/// Orders of constrained Hamiltonian maps of types I, II and III, measured.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lagroid::app {

/// A method's errors after a fixed time by that many steps.
struct MapErrors {
  int steps = 0;
  double q = 0;
  double p = 0;        ///< of the momentum as the map has it
  double tangent = 0;  ///< of its tangent part
};

struct MapMethod {
  std::string problem;
  std::string name;
  std::vector<MapErrors> errors;
  std::string status = "converged";
};

/// The spherical pendulum in R^3 with |q| = 1, and a planar pendulum without constraint, each from `coarsest` steps on,
/// doubled `refinements` - 1 times; against the solution by Taylor's method of order 19. `report(done, all)` is called
/// after each method.
std::vector<MapMethod> run_map_study(int coarsest, int refinements, const std::function<void(long, long)>& report);

/// The exponent between the last two numbers of steps of which the finer leaves an error above round-off; not a number
/// where there are none.
double map_order(const MapMethod& method, const std::function<double(const MapErrors&)>& error);

extern const std::vector<const char*> map_report_files;

/// report.md, errors.csv and the figure. `note` says why there is no picture, where there is none.
std::vector<std::filesystem::path> write_map_report(const std::vector<MapMethod>& methods, const std::string& command,
                                                    const std::filesystem::path& folder, std::string& note);

}  // namespace lagroid::app
