#pragma once
/// A way to integrate a scene, as studies select it: its name, its order, and its keys in [time].

#include <string>
#include <vector>

namespace lagroid {

/// A way to integrate a scene: what stands in its [time], as "key=value".
struct Method {
  std::string name;
  int order = 2;
  int stages = 1;  ///< steps of order two that it is made of, so that first steps of methods cost about the same
  bool equal_steps = true;
  std::vector<std::string> settings;
  bool to_compare = false;  ///< there to be compared with, and not chosen for anyone
};

}  // namespace lagroid
