#pragma once
/// The numbers of an optimal control problem, stage by stage: rows of equal length one after another, and displacements
/// of a trajectory.
///
///     StageRows costates(sizes.stages, sizes.equality);
///     costates[0][1] = 2;  // of the first stage, the second
///     const double most = largest_entry(costates);
///
/// Requires stages within range. Nothing throws.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lagroid {

/// A row of gamma that is sign (u_control - its bound); sign zero: the phase has it not.
struct ControlBound {
  int control;
  double sign;
};

/// Stages with one duration, one after another.
struct TranscriptionPhase {
  long end = 0;  ///< the stage after its last
  bool duration_is_free = false;
  std::vector<bool> control_is_fixed;  ///< of each control; empty: none is
  std::vector<ControlBound> bounds;    ///< the last rows of gamma, as many in every phase
};

/// How many numbers there are of each kind.
struct TranscriptionSizes {
  int node = 0;           ///< n, the dimension of the groupoid: a node's displacement
  int control = 0;        ///< c
  int equality = 0;       ///< of phi, with the most conditions on nodes that a stage has
  int node_equality = 0;  ///< how many of these are conditions on nodes
  int inequality = 0;     ///< of gamma, with the bounds of the controls
  long stages = 0;        ///< N
  std::vector<TranscriptionPhase> phases;
  std::vector<int> conditions;  ///< of each stage, on nodes, after its phi

  /// How many rows of gamma are no bounds of controls.
  int general_inequality() const { return inequality - int(phases.front().bounds.size()); }
  /// The bound of a control that a row of a stage's gamma is; null where it is another inequality.
  const ControlBound* bound_of(long stage, int row) const {
    const int i = row - general_inequality();
    return i < 0 ? nullptr : &phases[std::size_t(phase_of(stage))].bounds[std::size_t(i)];
  }
  int variables() const { return 2 * node + control + 1; }
  int equalities_of(long stage) const { return equality - node_equality + conditions[std::size_t(stage)]; }
  int phase_of(long stage) const {
    std::size_t p = 0;
    while (stage >= phases[p].end) ++p;
    return int(p);
  }
  bool control_is_fixed(long stage, int i) const {
    const std::vector<bool>& fixed = phases[std::size_t(phase_of(stage))].control_is_fixed;
    return !fixed.empty() && fixed[std::size_t(i)];
  }

  // Where the variables of a stage begin.
  static constexpr int at_source = 0;
  int at_target() const { return node; }
  int at_control() const { return 2 * node; }
  int at_duration() const { return 2 * node + control; }
};

/// Rows of equal length, one for each stage.
class StageRows {
 public:
  StageRows() = default;
  StageRows(long stages, int length) : length_(length), numbers_(std::size_t(stages) * std::size_t(length)) {}
  double* operator[](long stage) { return numbers_.data() + stage * length_; }
  const double* operator[](long stage) const { return numbers_.data() + stage * length_; }
  int length() const { return int(length_); }
  std::vector<double>& numbers() { return numbers_; }
  const std::vector<double>& numbers() const { return numbers_; }

 private:
  long length_ = 0;
  std::vector<double> numbers_;
};

/// A displacement of the trajectory: of node k = 0 ... N, of the control of stage k = 0 ... N-1, of the logarithm of
/// each phase's duration, which so stays positive.
struct TrajectoryDisplacement {
  TrajectoryDisplacement() = default;
  explicit TrajectoryDisplacement(const TranscriptionSizes& sizes)
      : nodes(sizes.stages + 1, sizes.node), controls(sizes.stages, sizes.control), durations(sizes.phases.size()) {}
  StageRows nodes;
  StageRows controls;
  std::vector<double> durations;
};

inline void set_all(StageRows& rows, double x) { std::fill(rows.numbers().begin(), rows.numbers().end(), x); }
/// a += factor * b.
inline void add(StageRows& a, double factor, const StageRows& b) {
  for (std::size_t i = 0; i < a.numbers().size(); ++i) a.numbers()[i] += factor * b.numbers()[i];
}
inline double dot(const StageRows& a, const StageRows& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.numbers().size(); ++i) sum += a.numbers()[i] * b.numbers()[i];
  return sum;
}
/// The larger of `most` and |x|; infinite where x is no number.
inline double larger_magnitude(double most, double x) { return std::isnan(x) ? HUGE_VAL : std::max(most, std::abs(x)); }
/// The largest magnitude; infinite where an entry is no number.
inline double largest_entry(const StageRows& rows) {
  double most = 0;
  for (const double x : rows.numbers()) most = larger_magnitude(most, x);
  return most;
}

inline void set_all(TrajectoryDisplacement& x, double to) {
  set_all(x.nodes, to);
  set_all(x.controls, to);
  std::fill(x.durations.begin(), x.durations.end(), to);
}
inline void add(TrajectoryDisplacement& a, double factor, const TrajectoryDisplacement& b) {
  add(a.nodes, factor, b.nodes);
  add(a.controls, factor, b.controls);
  for (std::size_t p = 0; p < a.durations.size(); ++p) a.durations[p] += factor * b.durations[p];
}
inline double dot(const TrajectoryDisplacement& a, const TrajectoryDisplacement& b) {
  double sum = dot(a.nodes, b.nodes) + dot(a.controls, b.controls);
  for (std::size_t p = 0; p < a.durations.size(); ++p) sum += a.durations[p] * b.durations[p];
  return sum;
}
inline double largest_entry(const TrajectoryDisplacement& x) {
  double most = std::max(largest_entry(x.nodes), largest_entry(x.controls));
  for (const double t : x.durations) most = larger_magnitude(most, t);
  return most;
}
inline void negate(TrajectoryDisplacement& x) {
  for (double& each : x.nodes.numbers()) each = -each;
  for (double& each : x.controls.numbers()) each = -each;
  for (double& each : x.durations) each = -each;
}

}  // namespace lagroid
