#pragma once
/// Hard cases: what is promised at the edge of what is supported, and what the obvious way gives there.

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace lagroid::hard {

/// A regime, the defect that is promised there at most, and a naive way, which must miss the promise by a wide margin.
/// Where the promise is a typed refusal the defect is zero or one, and the bound zero.
struct HardCase {
  std::string name;     ///< of the test, unique within its topic
  std::string regime;   ///< where in the space of states, parameters and steps
  std::string promise;  ///< what `ours` measures
  std::string naive;    ///< what `broken` does instead
  double bound = 0;
  std::function<double()> ours;
  std::function<double()> broken;
  bool nightly = false;
};

/// By how many times its bound a naive way must exceed it; one that is not finite does.
inline constexpr double margin = 10;

inline bool kept(const HardCase& hard, double defect) { return defect <= hard.bound; }
inline bool missed(const HardCase& hard, double defect) {
  return !std::isfinite(defect) || defect > margin * hard.bound;
}

struct Topic {
  std::string name;   ///< of the test suite, after "Hard_"
  std::string title;  ///< of its table
  std::vector<HardCase> (*cases)();
};

std::vector<HardCase> rotations();
std::vector<HardCase> spin();
std::vector<HardCase> pendulums();
std::vector<HardCase> bodies();
std::vector<HardCase> joints();
std::vector<HardCase> orbits();
std::vector<HardCase> steps();
std::vector<HardCase> long_runs();
std::vector<HardCase> plate_ball();
std::vector<HardCase> boundary_values();
std::vector<HardCase> bad_input();

inline const double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline const double infinite = std::numeric_limits<double>::infinity();

/// The larger of two defects; a NaN, which std::max may drop, is the largest.
inline double worse(double a, double b) { return std::isnan(a) || b <= a ? a : b; }

}  // namespace lagroid::hard
