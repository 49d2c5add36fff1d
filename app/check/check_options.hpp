#pragma once
/// Options of `lagroid check`.

#include "../command/command.hpp"

namespace lagroid::app {

struct CheckCommandOptions : SceneOptions {
  int samples = 100;
  long seed = 20261120;
};

}  // namespace lagroid::app
