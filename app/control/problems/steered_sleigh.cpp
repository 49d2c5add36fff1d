#include <lagroid/systems/control/flows/steered_sleigh.hpp>

#include "../problem_of.hpp"
#include "pictures.hpp"
#include "problems.hpp"

namespace lagroid::app {

const ControlProblem& steered_sleigh_problem() {
  static const ControlProblemOf<SteeredSleigh> problem(
      "steered_sleigh", "a sleigh on a blade, pushed and turned", [](const SteeredSleigh& sleigh) {
        std::vector<Shape> shapes{in_the_plane({"box", {0.6, 0.3, 0.05}}, 0.1),
                                  in_the_plane({"box", {0.3, 0.02, 0.15}}, 0.05)};
        shapes[0].offset[0] = sleigh.ahead;
        shapes[1].trail = true;
        return shapes;
      });
  return problem;
}

}  // namespace lagroid::app
