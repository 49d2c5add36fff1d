#pragma once
/// The derivative of a scene's step from few evaluations of its equations, whatever the number of its bodies.
///
///     SceneDerivatives derivatives(sizes, numbers, write);
///     std::optional<SparseStep> step;
///     derivatives.find({motion, scenes}, solved, step);  // scenes: constant, and varied by a few numbers each
///     if (step->factor()) x = step->forward(x);
///
/// A detail of LinearisedScene. Bodies that no joint and no effect brings together are in no equation at once, so that
/// they are varied in one direction: columns are coloured (colouring.hpp). For what a place changes by itself not to be
/// in the equations of its target too, unknowns are the displacements of targets, v + w, of all that is no rotation.
/// Which entries there are is asked of a step nearby in which nothing vanishes by chance. As an effect may begin to act
/// later, one more direction varies everything at once, by known amounts, at every step: where it is not what the
/// entries say, they are asked again.
///
/// Of steps that are made in part or whose sizes vary there are two more columns, after those of the numbers: the time
/// at which the step starts, and its size.
///
/// Requires a function that gives numbers their tangents. Throws what that function throws.

#include <lagroid/solvers/sensitivity/sparse/sparse_step.hpp>
#include <lagroid/systems/multibody/sensitivity/varied_scene.hpp>

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace lagroid::multibody {

/// A scene as a function of its numbers.
using WriteScene = std::function<WrittenScene(const std::vector<VariedNumber>& numbers)>;

/// A motion, and its scene over numbers with derivatives: the first constant, each other varied by the next few
/// numbers.
struct VariedMotion {
  const Multibody& motion;
  std::deque<VariedScene>& scenes;
};

class SceneDerivatives {
 public:
  /// By the time and the size of steps, too, where these are of about the size `step`; zero: not by them.
  SceneDerivatives(SceneSizes sizes, std::vector<double> numbers, WriteScene write, double step = 0);

  /// The derivatives of a step, by unknowns, states, numbers and times; not yet factored.
  void find(const VariedMotion& of, const SolvedStep& solved, std::optional<SparseStep>& out);

  /// How often the equations are evaluated for one step.
  int evaluations() const { return int(passes_.size()); }

 private:
  /// An entry, where an evaluation has it.
  struct Entry {
    int row;
    int direction;
    int value;
    double amount;  ///< of its column, where everything is varied
  };
  struct Pass {
    std::vector<VariedTangent> tangents;  ///< of unknowns, states and times
    std::vector<Entry> of_equations, of_end;
    std::optional<VariedScene> scene;  ///< one that is varied by numbers
  };

  int columns() const { return int(columns_.size()); }
  int rows() const { return sizes_.unknowns() + sizes_.states(); }
  /// The column of the time; past the last where there is none.
  int time_column() const { return rows() + int(numbers_.size()); }
  /// Of unknowns, states and times, from those of the columns.
  template <class TangentOf> std::vector<VariedTangent> tangents(const TangentOf& of) const;
  /// Adds the entries that a step has.
  void see(const VariedMotion& of, const SolvedStep& solved);
  /// The pattern and the evaluations of the entries so far.
  void arrange(const Multibody& motion);
  /// Whether what everything varies comes to is what the entries say.
  bool evaluate(const VariedMotion& of, const SolvedStep& solved, SparseStep& out);
  bool agrees(const VariedScene& last, const SparseStep& found) const;

  SceneSizes sizes_;
  std::vector<double> numbers_;
  WriteScene write_;
  std::vector<double> amounts_;            ///< of all columns, in the direction that varies everything
  std::vector<std::vector<int>> columns_;  ///< their rows
  std::shared_ptr<const StepPattern> pattern_;
  std::deque<Pass> passes_;
  int everything_ = 0;  ///< that direction in the last of them
  std::vector<double> expected_;
};

}  // namespace lagroid::multibody
