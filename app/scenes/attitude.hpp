#pragma once
/// The panel that shows an attitude over time, in reports of scenes.

#include "arrow_format.hpp"

#include <lagroid/run/run_result.hpp>

#include <string>
#include <vector>

namespace lagroid::app {

inline Panel attitude_panel(const std::vector<std::string>& quaternion = attitude_columns,
                            const std::string& title = "attitude") {
  return {title + ", unit quaternion", "t", "w, x, y, z", "t", quaternion};
}

}  // namespace lagroid::app
