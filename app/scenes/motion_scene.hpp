#pragma once
/// Initial-value scenes that have been read: a motion at its start, how far it goes, and the methods that apply.

#include <lagroid/run/motion/drive.hpp>
#include <lagroid/run/motion/motion.hpp>
#include <lagroid/run/study/method.hpp>

#include <memory>
#include <vector>

namespace lagroid::app {

/// A motion, how far it is to go, and the methods by which it could be integrated.
struct MotionScene {
  std::unique_ptr<Motion> motion;
  RunExtent extent;
  std::vector<Method> methods;
};

}  // namespace lagroid::app
