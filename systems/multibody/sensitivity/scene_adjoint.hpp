#pragma once
/// Gradients back over a step of a scene of places under holonomic joints and forces that have potentials, at the cost
/// of a step or so: its matrix is never made.
///
///     SceneAdjoint adjoint(numbers, write);
///     if (!adjoint.take_back(motion, before, after, gradients))
///       gradients = step.backward(gradients);  // by the step's matrix, scene_derivatives.hpp
///
/// With W = h M^{-1}, what a node gives, g = h f / 2 + D^T lambda at the source and g' = h f' / 2 at the target, and
/// S = D' W D^T, the gradients (y, p) by place and momentum of the target, and t by the numbers, become
///
///     r = y + (dg'/dq)^T p,   S^T m = D (p + W r),   r <- r - D'^T m,   s = p + W r,
///     y <- r + (dg/dq)^T s,   t <- t + (dg'/dt)^T p + (dg/dt)^T s - (dM/dt d / h)^T W r - (dC'/dt)^T m,   p <- s,
///
/// d being the displacements. The derivative of a gradient by places is symmetric, so that (dg/dq)^T s is what g
/// changes along s: one direction in place of one for each coordinate of a few bodies. Numbers are varied by colours,
/// two of them beside that direction. One more direction varies everything by known amounts a, and tells at every step
/// whether all that holds,
///
///     <p, dg a> = <a, (dg)^T p>,   and   dC a = D' a + dC/dt a   row by row:
///
/// of a force without potential, or of a number that begins to act, it does not. Entries of numbers are asked again
/// then; if that is of no help, this adjoint has no more answers.
///
/// A detail of LinearisedScene. Requires a motion that `is_of` its kind, by steps of its own size. Throws what the
/// function throws that writes the scene.

#include <lagroid/solvers/linear_algebra/elimination.hpp>
#include <lagroid/systems/multibody/multibody.hpp>
#include <lagroid/systems/multibody/sensitivity/scene_derivatives.hpp>
#include <lagroid/systems/multibody/sensitivity/varied_node.hpp>

#include <Eigen/Core>

#include <cmath>
#include <deque>
#include <vector>

namespace lagroid::multibody {

class SceneAdjoint {
 public:
  SceneAdjoint(std::vector<double> numbers, WriteScene write);

  /// Whether nothing in it turns in space, is dragged, switched, composed or controlled, and all rows are holonomic and
  /// none depends on others.
  static bool is_of(const Multibody& motion);

  /// Over the step between two nodes. Where it has no answer, or functions are so many that the step's matrix is
  /// cheaper, gradients stay as they are and false is returned.
  bool take_back(const Multibody& motion, const SceneState& before, const SceneState& after,
                 Eigen::MatrixXd& gradients);

 private:
  using Column = Eigen::Ref<Eigen::VectorXd>;
  struct Step {
    const Multibody& motion;
    const SceneState &before, &after;
  };
  /// A number acts on a coordinate of what nodes give, or on a row, in this direction.
  struct Entry {
    int number;
    int at;
    int direction;
  };
  struct Evaluation {
    VariedNode node;
    std::vector<Entry> of_impulses, of_rows;
  };
  /// By how much a number changes the inertia of a coordinate.
  struct InertiaEntry {
    int number;
    int at;
    double change;
  };
  /// A sum that should vanish.
  struct Balance {
    double sum = 0, size = 0;
    void add(double term) {
      sum += term;
      size += std::abs(term);
    }
    void take(double term) { add(-term); }
    /// a.b
    void add(const Vec& a, const Vec& b) {
      sum += a.dot(b);
      size += a.cwiseAbs().dot(b.cwiseAbs());
    }
    void take(const Vec& a, const Vec& b) {
      sum -= a.dot(b);
      size += a.cwiseAbs().dot(b.cwiseAbs());
    }
    bool holds() const;
  };

  void begin(const Multibody& motion);
  /// Whether numbers act in this step where they were not known to.
  bool see(const Step& step);
  /// The evaluations of the entries so far.
  void arrange(double h);
  bool factorise(const Step& step);
  bool take_all_back(const Step& step, const Eigen::MatrixXd& gradients);
  bool take_back(const Step& step, Column gradient);
  /// (dg/dq)^T s of what a node gives in an evaluation, and (dg/dt)^T s, which is added; the balance is between both
  /// and what everything changes along s.
  void give_back(const Evaluation& each, const std::vector<VariedVec>& given, const std::vector<Vec>& s,
                 std::vector<Vec>& back, Column by_numbers, Balance* balance) const;
  /// Goes to a node, and takes back what effects give there, into `pushed_`.
  void push_back(const SceneState& node, const std::vector<Vec>& s, Balance* balance);
  /// Takes back what effects and joints give at the node where it went.
  void react_back(const std::vector<double>& multipliers, const std::vector<Vec>& s, std::vector<Vec>& back,
                  Column by_numbers, Balance& balance);
  /// Takes (dC'/dt)^T m; whether rows change as their gradients say.
  bool take_rows(const Step& step, Column by_numbers);

  std::vector<double> numbers_;
  WriteScene write_;
  bool has_answers_ = true;
  std::vector<Vec> place_amounts_;  ///< of the direction that varies everything
  std::vector<double> amounts_;
  std::vector<std::vector<int>> columns_;  ///< of each number, coordinates of what nodes give and, after them, rows
  std::vector<InertiaEntry> inertia_;
  std::deque<Evaluation> evaluations_;
  std::vector<Elimination> matrices_;  ///< S of the islands
  std::vector<Vec> mobility_;          ///< W
  std::vector<Vec> responses_;         ///< W D^T, entry by entry
  std::vector<Vec> momentum_, left_, moved_, along_, velocity_, back_;
  std::vector<double> multipliers_;
  std::vector<Balance> rows_;
  Eigen::MatrixXd taken_;
  /// Where it went last. Steps are taken back one before the other: where the one begins the next one ends.
  struct Pushed {
    double time = 0;
    std::vector<Vec> at, along, back;
    Eigen::VectorXd by_numbers;
    bool stands(const SceneState& node, const std::vector<Vec>& s) const {
      return time == node.at.time && at == node.at.x && along == s;
    }
  };
  Pushed pushed_;
};

}  // namespace lagroid::multibody
