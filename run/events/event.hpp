#pragma once
/// What may happen in a run: where a function of time and state passes zero, or is smallest or largest,
///
///     g(t, z(t)) = 0    or    d/dt g(t, z(t)) = 0.
///
/// Close encounters, sections, periods and ends of runs are found so, inside of steps and to the order of the method.
///
///     Event section{"section", "q1"};  // where the first coordinate passes zero,
///     section.direction = Event::Direction::rising;
///     const RunResult result = run(Dido{}, {{0, 0}, {1, 0, 1}}, {.steps = 126, .events = {section}});
///
/// Requires a function of the columns that nodes have, of their quantities and of the time `t`, or one in C++, which
/// depends on the node alone; and a motion whose steps can be made in part (Motion::why_not_cut). Errors are those of
/// EventWatch. RunResult::events has what happened.

#include <lagroid/run/motion/observables.hpp>
#include <lagroid/run/run_result.hpp>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// Something that is watched for in a run.
struct Event {
  enum class At { zero, minimum, maximum };
  enum class Direction { both, rising, falling };  ///< in which its function passes zero
  enum class Then { record, stop };

  std::string name;
  std::string when{};  ///< its function, of columns, quantities and `t`: "x - 0.5", "sqrt(x^2 + y^2) - 1"
  std::function<double(const Observables&)> function{};  ///< the same in C++, in its place
  At at = At::zero;
  Direction direction = Direction::both;  ///< of events at zero
  Then then = Then::record;
  long count = 1;                   ///< the run stops when it has happened so often
  double tolerance = 1e-10;         ///< nearer to zero, relative to the largest value so far, its function touches it
  std::vector<std::string> plot{};  ///< two columns, drawn as the points at which it happened: a section; or none
  /// Added to the momentum there: an expression of the same names for each of its numbers, or none. The rest of the
  /// step is made from the changed state, and the ledger holds the motion to its promises from there.
  std::vector<std::string> kick{};
  std::string body{};  ///< of a scene of bodies, the one whose momentum that is
  /// Parameters of the system that become other numbers there, each with an expression of the same names. The rest of
  /// the step is made with them, as after a kick.
  std::vector<std::pair<std::string, std::string>> set{};
  /// Joints and effects of a scene of bodies, by their names, that act from there on, or do so no more.
  std::vector<std::string> switch_on{};
  std::vector<std::string> switch_off{};
  /// Called where it has happened; the run ends where it returns false.
  std::function<bool(const Happening&, const Observables&)> call{};

  /// Whether the motion is another one where it has happened.
  bool changes_motion() const { return !(kick.empty() && set.empty() && switch_on.empty() && switch_off.empty()); }
};

/// "gravity = 1.62" as what Event::set holds; none where it is of another form.
std::optional<std::pair<std::string, std::string>> event_setting(const std::string& text);

}  // namespace lagroid
