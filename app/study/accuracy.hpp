#pragma once
/// `[accuracy] target`: the method and the step are found by trying.

#include "../reading/scene_reader.hpp"

#include <string>
#include <vector>

namespace lagroid::app {

/// What a pilot study chose.
struct AccuracyChoice {
  Section scene;                   ///< to be run: the same with the method and the step
  std::vector<std::string> notes;  ///< what was chosen, what it costs, what ten times better would cost
};

/// [accuracy] target, the error of the state at the end relative to its size along the motion; methods, patterns as
/// `lagroid study` takes them; pilot, the seconds that the choice may take. [time] holds duration, or step and steps,
/// and nothing that chooses a method.
///
/// Every method with equal steps runs with halved steps until the difference of two runs says that the error of the
/// first is below the target: e(h) = |y_h - y_{h/2}| 2^p / (2^p - 1). The cheapest that gets there is taken, its step
/// by e ~ h^p between. Where none does within the time, they try a tenth of the duration, and so on; the error is taken
/// to grow as it did over the second half of that, and tried over the whole where there is time.
///
/// Throws SceneError where the scene is no initial value, and where no method reaches the target.
AccuracyChoice choose_by_accuracy(const Section& scene);

/// Throws SceneError where [accuracy] is not what `choose_by_accuracy` takes.
void check_accuracy(const Section& scene);

}  // namespace lagroid::app
