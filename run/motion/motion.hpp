#pragma once
/// What can be run: one interface for systems on groupoids, scenes of bodies and systems on spheres.
///
/// Loop, recorder, ledger, studies and Python are written once, against it.
///
///     while (motion.index() < 1000) {
///       if (const StepReport report = motion.advance(); !report.converged()) break;
///       std::cout << motion.time() << '\n';
///     }
///
/// A motion of one's own derives from Motion. A step that does not converge must leave everything as it was.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/run/motion/observables.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lagroid {

/// Some numbers at a node that are compared as one vector.
struct NamedVector {
  std::string name;
  std::vector<double> values;
  double size = 0;  ///< of the terms that they are made of, to which an error is relative; 0: their own
};

/// A parameter of a system by its name (mass, inertia.0), and the number that it becomes.
struct ParameterValue {
  std::string name;
  double value = 0;
  bool operator==(const ParameterValue&) const = default;
};

/// What is named in a scene, a joint or an effect, and whether it acts.
struct Switched {
  std::string name;
  bool on = true;
  bool operator==(const Switched&) const = default;
};

/// What can be changed inside of a step.
struct Changeable {
  /// A part of the momentum, as that of a body, and how many numbers it has; the only part of a system has no name.
  struct Momentum {
    std::string name;
    std::size_t numbers;
  };
  std::vector<Momentum> momenta{};  ///< to which something can be added
  std::vector<std::string> parameters{};
  std::vector<Switched> switches{};  ///< as they are now

  std::size_t numbers() const {
    std::size_t sum = 0;
    for (const Momentum& each : momenta) sum += each.numbers;
    return sum;
  }
};

/// A change of a motion: what is added to its momenta, in their order, or nothing; then parameters and switches.
struct MotionChange {
  std::vector<double> kick{};
  std::vector<ParameterValue> parameters{};
  std::vector<Switched> switches{};
  bool empty() const { return kick.empty() && parameters.empty() && switches.empty(); }
};

/// A motion: it advances from node to node, and what is to be seen at a node can be looked at. The loop, the recorder
/// and the ledger (drive.hpp, recorder.hpp, judge.hpp), studies and Python use nothing else of what they run.
class Motion {
 public:
  virtual ~Motion() = default;

  /// Of the system or the scene.
  virtual std::string name() const = 0;
  virtual MethodTraits traits() const = 0;

  /// One step. Where it does not converge everything is as it was.
  virtual StepReport advance() = 0;
  /// Why a step did not converge, and what to do. `step` is its number, from 1 on.
  virtual std::string failure(const StepReport& report, long step) const = 0;
  /// Evaluations of the method (MethodTraits::stages) that a step took, or iterations of its solver.
  virtual long evaluations(const StepReport& report) const { return std::max(report.iterations, 1); }

  /// Of the node that was reached.
  virtual long index() const = 0;
  virtual double time() const = 0;  ///< s
  /// Of the last step; before the first, of that (s).
  virtual double step_size() const = 0;
  /// What is to be seen there, computed once; the same object at every node.
  virtual const Observables& look() = 0;
  /// Configuration and momentum there, in coordinates.
  virtual std::vector<NamedVector> state() const = 0;
  /// The largest residual there of all equations that states obey: constraints, and the groupoid's own. None where
  /// there are none.
  virtual std::optional<double> defect() const = 0;
  /// False where looking costs so much that only the nodes that are recorded are looked at.
  virtual bool is_judged_at_every_node() const { return true; }

  /// Adds what describes the whole run: panels, shapes, conventions, notes, what the ledger counts.
  virtual void describe(RunResult& result) const = 0;
  /// Why steps cannot be made in part, as what happens inside of one is looked for (run/events/); empty where they can.
  virtual std::string why_not_cut() const { return "steps of this motion cannot be made in part"; }
  /// Keeps this node, from which the next step can be made in part.
  virtual void keep_node() {}
  /// What is to be seen where a share of the last step, 0 to 1, leads to from the node that was kept before it, by the
  /// same method. Null where that does not converge. The motion stays where it is, but has to be looked at anew before
  /// anything else is asked of it.
  virtual const Observables* look_within(double /*share*/) { return nullptr; }
  /// What can be changed inside of a step; nothing where there is nothing.
  virtual Changeable changeable() const { return {}; }
  /// Why it cannot be changed so where a share of the last step leads to; empty where it can.
  virtual std::string refused(double /*share*/, const MotionChange& /*change*/) { return ""; }
  /// Changes it where a share of the last step leads to, and makes the rest of the step from there; shares are from now
  /// on those of that rest. The motion stays at its node, in another state. Requires that the change is not refused.
  virtual StepReport change_within(double /*share*/, const MotionChange& /*change*/) { return {}; }
  /// Visits all that the next step goes on from: a motion begun alike, to which it is restored, goes on with the same
  /// bits.
  virtual void serialize(NumberArchive& archive) = 0;
};

}  // namespace lagroid
