#pragma once
/// A motion whose steps can be made in part and which can be changed in between, linearised by the durations of the
/// parts too: what derivatives go through events of (run/events/derivatives/motion_through_events.hpp), whatever its
/// system.
///
///     motion.keep();                           // at a node
///     if (motion.advance().converged() && motion.go(0.3 * h).converged()) {  // where something happens
///       const Derivatives part = motion.part();
///       motion.kick(by);
///       motion.keep();                         // what follows begins here
///       motion.go(0.7 * h);
///       motion.end_step();                     // usual steps again
///     }
///
/// Directions of a part are states, parameters, the time t at which it begins, and its duration s; a part leaves the
/// last three as they are.
///
/// Parameters that events set are among the parameters of the motion, and change along it as its state does.
///
/// Requires that `part` follows a `go` that converged. Errors: WithoutDerivative, one line, for a change that has none;
/// std::domain_error for one that is not possible where the motion is, std::invalid_argument for what has no such name.

#include <lagroid/solvers/sensitivity/linearised_motion.hpp>
#include <lagroid/solvers/sensitivity/times/derivative_chain.hpp>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// What is switched on, true, or off, by its name.
using Switching = std::vector<std::pair<std::string, bool>>;

/// A parameter that becomes another number, which may depend on the start and on other parameters, or on nothing.
struct SetNumber {
  std::string name;
  double value = 0;
  bool varies = false;
};

class CuttableMotion : public LinearisedMotion {
 public:
  /// Parts begin here.
  virtual void keep() = 0;
  /// From where they begin, by a part of a step; of no duration, back to there.
  virtual StepReport go(double duration) = 0;
  /// The derivative of that part; none where it is not finite or singular.
  virtual Derivatives part() = 0;
  /// Here is the end of the step that `advance` made last.
  virtual void end_step() = 0;
  /// Back to the end that this step had.
  virtual void leave_step() = 0;

  /// What is observed here, with its derivatives by states, parameters and the time.
  virtual NodeValues observe_in_part() const = 0;

  /// How many numbers momenta have; as many are before them among the states.
  virtual int momenta() const { return states() / 2; }
  /// Adds to them.
  virtual void kick(const Eigen::VectorXd& by) = 0;
  /// The place of a number that can be set, among the parameters.
  virtual int place_of(const std::string& number) const {
    throw std::invalid_argument("this motion has no number that can be set: " + number);
  }
  /// From here on these are what is said of them.
  virtual void set(const std::vector<SetNumber>& numbers) { place_of(numbers.front().name); }
  /// What a switch is to derivatives: of what it does to the momentum, and, by states, parameters and the time, of what
  /// was held until then and of what is held from then on. There are derivatives where the one makes the other vanish.
  struct Switched {
    Derivatives momentum = {};
    Eigen::MatrixXd held = {}, holds = {};
  };
  /// Switches; returns all that where it is asked for.
  virtual Switched switch_to(const Switching& /*what*/, bool /*linearised*/) {
    throw std::invalid_argument("nothing of this motion can be switched");
  }
};

}  // namespace lagroid
