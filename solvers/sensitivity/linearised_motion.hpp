#pragma once
/// A motion whose steps are linearised, whatever its system: what propagates derivatives knows nothing else.
///
///     if (motion.advance().converged() && motion.linearise())
///       for (int k = 0; k < motion.stages(); ++k) x = motion.stage(k).forward(x);
///
/// States begin with 2 n numbers: a displacement v of the configuration, g tau(v), and the change of the momentum in
/// the basis of the displaced object; those of steps that vary have more. `LinearisedMotionOf` makes one of a system
/// and its integrator.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/solvers/sensitivity/linear_step.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// Functions of a node, by their values and their derivatives: a row for each, columns of the state and theta.
struct NodeValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd derivatives;
};

/// A node of a motion, kept in a form of the motion's own.
class KeptNode {
 public:
  virtual ~KeptNode() = default;
};

class LinearisedMotion {
 public:
  virtual ~LinearisedMotion() = default;

  /// 2 n, or more; a start varies by the first 2 n alone.
  virtual int states() const = 0;
  /// The numbers with respect to which derivatives are taken, beside the start.
  virtual int parameters() const = 0;
  virtual double time() const = 0;
  /// Whether the times of nodes depend on nothing.
  virtual bool has_equal_steps() const { return true; }

  virtual StepReport advance() = 0;
  /// Linearises the last step, of as many stages as it was composed of; false where a derivative is not finite or the
  /// equations are singular.
  virtual bool linearise() = 0;
  virtual int stages() const = 0;
  virtual const StepDerivative& stage(int k) const = 0;
  /// What is observed, at the present node.
  virtual NodeValues observe() const = 0;
  /// Its values alone.
  virtual Eigen::VectorXd seen() const { return observe().values; }

  /// What is observed later, before the next node, by a part of a step; derivatives are by the state at the present
  /// node. None where that step has no root, or where the motion has no such steps.
  virtual std::optional<NodeValues> observe_later(double /*time*/) { return std::nullopt; }

  /// One step that is not going to be linearised.
  virtual StepReport pass() { return advance(); }
  /// Keeps the present node, in memory that one kept earlier may have left.
  virtual void keep_node(std::unique_ptr<KeptNode>& node) { node = std::make_unique<KeptNumbers>(save()); }
  /// Goes on from a node that this motion kept, with the same bits.
  virtual void return_to(const KeptNode& node) { restore(static_cast<const KeptNumbers&>(node).numbers); }
  /// Whether `take_back` can, so that nodes are worth keeping for it.
  virtual bool takes_back() const { return false; }
  /// The gradients of functions of the node `after`, by the state and theta, become those of the node before it,
  /// without making the step between them again. Where this motion cannot do that, they stay and false is returned.
  virtual bool take_back(const KeptNode& /*before*/, const KeptNode& /*after*/, Eigen::MatrixXd& /*gradients*/) {
    return false;
  }

  /// Visits all that the next step goes on from.
  virtual void serialize(NumberArchive& archive) = 0;
  /// Its numbers, and back to them: the steps from there have the same bits.
  std::vector<double> save() {
    NumberArchive archive;
    serialize(archive);
    return archive.numbers();
  }
  void restore(const std::vector<double>& saved) {
    NumberArchive archive(saved);
    serialize(archive);
  }

 private:
  struct KeptNumbers final : KeptNode {
    explicit KeptNumbers(std::vector<double> all) : numbers(std::move(all)) {}
    std::vector<double> numbers;
  };
};

}  // namespace lagroid
