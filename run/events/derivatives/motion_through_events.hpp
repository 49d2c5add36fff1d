#pragma once
/// A motion that goes through events, linearised: kicks and switches where a function of the time and of what is
/// observed passes zero are part of its steps,
///
///     ds = -(g_x dx + g_theta dtheta + g_t dt) / (g_x X_s + g_t),    dx* = X dx + X_s ds,    dt* = dt + ds,
///
/// x* and t* where g(t*, x*) = 0, after a part of a step of the duration s, which began at t. The rest of the step is
/// shorter by dt*, so that nodes stay at their times: propagate_forward and propagate_backward take it as any other
/// motion. It is that of event_sensitivities.hpp for motions of any system that can be cut (CuttableMotion).
///
///     ObservedEvent floor{.name = "floor", .when = "ball.z", .function = height};
///     floor.kick = [](const VariedVector& seen) { return VariedVector(seen.segment<3>(4) * VariedNumber(-2.0)); };
///     MotionThroughEvents motion(std::move(scene), {floor});
///     const Propagated end = propagate_backward(motion, 100);
///
/// Requires a motion at its start, that observes what the functions are of. Events that happen at once have one `when`,
/// as those by which two bodies strike each other have. Status of a step: that of a part that does not converge;
/// `not_converged` where kicks follow each other without end; `left_domain` where a function is no finite number, or
/// what is switched on does not hold. Errors: EventWithoutDerivative, one line, where an event that changes the motion
/// grazes zero, happens together with another one or at a node, is one at the start, or switches on what would not hold
/// there from another start;
/// std::invalid_argument for an event without a function, for a kick of another size, and for a step after the event
/// that ends the run, of which `run` alone knows the end. Source: as of event_sensitivities.hpp.

#include <lagroid/run/events/derivatives/event_derivatives.hpp>
#include <lagroid/run/events/event.hpp>
#include <lagroid/run/events/function_watch.hpp>
#include <lagroid/solvers/sensitivity/times/cuttable_motion.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>
#include <lagroid/solvers/sensitivity/varied_point.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lagroid {

/// An event of which the run has no derivative.
class EventWithoutDerivative : public WithoutDerivative {
  using WithoutDerivative::WithoutDerivative;
};

/// An event at zero of a function of the time and, after it, of what is observed.
struct ObservedEvent {
  std::string name;
  std::string when = {};  ///< its function in words: events of the same are one
  std::function<VariedNumber(const VariedVector& seen)> function = {};
  Event::Direction direction = Event::Direction::both;
  Event::Then then = Event::Then::record;
  long count = 1;                                                   ///< it ends the run when it has happened so often
  double tolerance = 1e-8;                                          ///< nearer to zero, relative, it touches it
  std::function<VariedVector(const VariedVector& seen)> kick = {};  ///< added to the momentum
  Switching switches = {};
  /// A parameter that is a number, which becomes another one there.
  struct Setting {
    std::string name;
    std::function<VariedNumber(const VariedVector& seen)> number;
  };
  std::vector<Setting> set = {};

  bool changes_motion() const { return kick || !switches.empty() || !set.empty(); }
  bool decides() const { return changes_motion() || then == Event::Then::stop; }
};

class MotionThroughEvents final : public LinearisedMotion {
 public:
  MotionThroughEvents(std::unique_ptr<CuttableMotion> motion, std::vector<ObservedEvent> events);

  int states() const override { return motion_->states(); }
  int parameters() const override { return motion_->parameters(); }
  double time() const override { return motion_->time(); }
  StepReport advance() override;
  bool linearise() override;
  int stages() const override { return chain_ ? 1 : motion_->stages(); }
  const StepDerivative& stage(int k) const override { return chain_ ? *chain_ : motion_->stage(k); }
  /// Why a step is none, where an event is why.
  const std::string& reason() const { return reason_; }
  NodeValues observe() const override { return motion_->observe(); }
  Eigen::VectorXd seen() const override { return motion_->seen(); }
  void serialize(NumberArchive& archive) override;

  /// All of a run: along so many directions, columns of (v, mu, theta), what is observed where events happen, and at a
  /// node or, for -1, at the end, which an event may be. The last of the directions, `asked` of them or as many as
  /// there are parameters, are of these, the others of the start, along which it begins; where there are none, values
  /// alone are found. An event that has no derivative ends it with the status `singular`.
  EventSensitivities run(long steps, const Eigen::MatrixXd& directions, long node = -1, int asked = -1);
  /// Before the first step, along which directions of (v, mu, theta) it is asked for: an event whose function is zero
  /// at the start has a derivative where it stays zero along all of them. Without it none has.
  void begin_along(const Eigen::MatrixXd& directions);
  /// Of each of such directions, why the run has no derivative along it for an event that is zero at the start; empty
  /// where it has none of these. It takes the first step.
  std::vector<std::string> why_none_along(const Eigen::MatrixXd& directions);

 private:
  /// A part of a step, to where something happened.
  struct Piece {
    double duration;
    std::vector<std::size_t> events;
    bool touches = false;
    bool changes = false;
    bool ends = false;
    std::string conflict = {};  ///< with what happens at the same time
  };
  struct Found {
    std::size_t event;
    double share;
    Passing passing;
  };
  /// What a place on the way is to derivatives: what leads there from where the step began.
  using AtPiece = std::function<void(const Piece& piece, const Derivatives& to)>;

  double value_of(std::size_t event, const Eigen::VectorXd& seen) const;
  /// The time and what is seen, as plain numbers: what functions of events take.
  VariedVector numbers_seen(const Eigen::VectorXd& seen) const;
  /// Of all watched functions where the motion is.
  std::vector<double> values() const;
  std::vector<Found> find(const std::vector<std::size_t>& suspects, double length);
  /// Takes what was found into pieces, until one changes the motion or ends the run; the others are found anew.
  void take(const std::vector<Found>& found, double length);
  std::string conflict_of(const std::vector<Found>& found, std::size_t first, std::size_t last) const;
  std::string named(const Piece& piece) const;
  bool grazes(const Piece& piece) const;
  /// Kicks, sets and switches, all by what is there before; adds the derivatives of that to a step, if there is one.
  void change(const Piece& piece, Derivatives* step);
  Eigen::VectorXd kick_of(const Piece& piece, const VariedVector& seen) const;
  std::vector<SetNumber> numbers_of(const Piece& piece, const VariedVector& seen) const;
  Switching switching_of(const Piece& piece) const;

  /// Makes the last step again and joins its derivatives: of the pieces that change it, or of all, of which it tells.
  /// False where a part is singular. An event that ends the run is where the motion is left.
  bool follow(Derivatives& step, const AtPiece* tell);
  /// Adds the part to a piece, of a duration by which its function stays zero.
  bool lead_to(const Piece& piece, Derivatives& to);
  /// Adds the part to the step's end, after a piece whose time depends on something, or does not.
  bool follow_rest(const std::string& after, bool moves, Derivatives& step);
  /// What becomes of momenta and parameters, by (states, theta, t, s).
  Eigen::MatrixXd changed_by(const Piece& piece) const;
  /// Switches as it does. What holds from then on has to, whatever the start and the numbers.
  void follow_switch(const Piece& piece, const Switching& what, Derivatives& step);
  /// f(t, seen) by (states, theta, t), where the motion is.
  NodeValues along(const NodeValues& seen, const std::function<VariedVector(const VariedVector&)>& f) const;
  NodeValues function_by(std::size_t event, const NodeValues& seen) const;
  /// How functions change along directions at the start, zero where that is rounding: a row for each event.
  Eigen::MatrixXd changes_at_start(const Eigen::MatrixXd& directions) const;
  bool stays_at_start(std::size_t event) const;
  std::string why_none_at_start(std::size_t event) const;

  // Rows of the directions of a part.
  Eigen::Index number_row(const std::string& parameter) const { return states() + motion_->place_of(parameter); }
  Eigen::Index time_row() const { return states() + parameters(); }
  Eigen::Index duration_row() const { return time_row() + 1; }

  std::unique_ptr<CuttableMotion> motion_;
  std::vector<ObservedEvent> events_;
  std::vector<FunctionWatch> watches_;
  std::vector<long> happened_;
  std::vector<long> touched_;  ///< by events that only record
  std::vector<char> begins_;   ///< which are zero at the start, and would happen there
  Eigen::MatrixXd at_start_;   ///< how functions change there, along the directions that are asked for
  long steps_ = 0;
  bool is_over_ = false;  ///< an event has ended the run
  // Of the last step.
  std::vector<double> begun_;  ///< where it began
  double begun_at_ = 0, size_ = 0;
  std::vector<Piece> pieces_;
  double rest_ = 0;       ///< after the last of them that changed it
  std::string conflict_;  ///< why there is no derivative at the start
  std::string reason_;
  bool moves_ = false;           ///< whether the time of the last piece depends on anything
  Eigen::RowVectorXd function_;  ///< of the last piece, by (states, theta, t)
  std::shared_ptr<const DerivativeChain> chain_;
};

}  // namespace lagroid
