#pragma once
/// Follows the function of an event from node to node, g_k = g(t_k, z_k): tells whether something may have happened in
/// a step, and finds by its values inside of the step where.
///
/// Most steps are passed by two comparisons; partial steps are made only where signs or the parabola through the last
/// three nodes give a reason.
///
///     FunctionWatch watch(Event{.name = "floor", .when = "q"});
///     watch.next(0.3, 0.0);
///     const StepFunction g = [](double share) { return 0.3 - share; };
///     if (watch.next(-0.7, 0.1)) std::cout << watch.find(g).front().share << '\n';  // 0.3
///
/// Requires every node in its order, and of `find` that the step is the last one. A node at which the function is no
/// finite number is passed over, and counted. Where a sign changes by a jump or through a pole, and where an extremum
/// is one of rounding alone, nothing has happened; that is counted too. Nothing throws but what the function throws.

#include <lagroid/run/events/event.hpp>
#include <lagroid/run/events/within_step.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace lagroid {

/// How a function passes zero from one value to another.
inline Passing passing_of(double from, double to) { return from < to ? Passing::rising : Passing::falling; }
/// Whether that is a direction in which it counts.
inline bool is_in_direction(Event::Direction direction, double from, double to) {
  return direction == Event::Direction::both || (direction == Event::Direction::rising) == (from < to);
}

/// Where in a step something happened, as a share of it.
struct FoundInStep {
  double share;
  Passing passing;
};

/// Of a step: times that differ by less cannot be told apart.
inline constexpr double indistinguishable = 1e-11;
/// More changes than these in one step follow each other without end.
inline constexpr int most_changes_in_step = 100;

/// What is said of a function that came to zero so often without passing it.
std::string words_of_touches(long touches);

class FunctionWatch {
 public:
  explicit FunctionWatch(const Event& event)
      : at_(event.at), direction_(event.direction), tolerance_(event.tolerance) {}

  /// Of the next node; whether something may have happened on the way to it.
  bool next(double value, double time);
  /// The motion was changed inside of that step: of the rest from there, which begins with the value `changed` and, if
  /// the function itself is why, with its `passing`, and ends with `value`.
  bool next_from(double changed, std::optional<Passing> passing, double value, double time);
  /// What happened in the step, or in what next_from left of it.
  std::vector<FoundInStep> find(const StepFunction& g);

  /// Of one of these, what rounding of the function leaves open of its share: the rounding over the slope there, of a
  /// turn that of the slope over the curvature. At most 1.
  double uncertainty(const FoundInStep& found, const StepFunction& g) const;

  /// Occasions on which nothing could be found, and the first of them.
  struct Count {
    long times = 0;
    double first = 0;  ///< s
    void add(double time) {
      if (times++ == 0) first = time;
    }
    template <class Archive> void serialize(Archive& archive) {
      archive("times", times);
      archive("first", first);
    }
  };
  const Count& undefined() const { return undefined_; }  ///< no finite number at a node, or on the way to it
  const Count& jumps() const { return jumps_; }          ///< a sign that changed without a zero
  const Count& flat() const { return flat_; }            ///< an extremum of round-off
  bool starts_there() const { return starts_there_; }    ///< the first node is a zero, or an extremum, of the function
  /// Those of them that are to be told, in words; of a function that came to zero so often without passing it, that,
  /// too.
  std::vector<std::string> notes(long touches = 0) const;

  template <class Archive> void serialize(Archive& archive) {
    archive("nodes", nodes_);
    archive("now", now_);
    archive("before", before_);
    archive("change", change_);
    archive("slope", slope_);
    archive("largest", largest_);
    archive("is whole", is_whole_);
    archive("is at zero", is_at_zero_);
    archive("starts there", starts_there_);
    archive("undefined", undefined_);
    archive("jumps", jumps_);
    archive("flat", flat_);
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  void see(double value, double time);
  bool is_first_step() const { return nodes_ == 2 && is_whole_; }
  bool passes_zero() const { return (before_ < 0) != (now_ < 0); }
  bool counts(double from, double to) const { return is_in_direction(direction_, from, to); }
  bool may_touch() const;
  bool may_turn() const;
  void find_zeros(const StepFunction& g, std::vector<FoundInStep>& found);
  /// Where in the step the function is smallest or largest, if it is somewhere.
  std::optional<double> turn_of(const StepFunction& g, bool is_minimum);

  Event::At at_;
  Event::Direction direction_;
  double tolerance_;
  long nodes_ = 0;
  double time_ = 0;
  double now_ = unknown;
  double before_ = unknown;
  double change_ = unknown;        ///< over the step before
  double slope_ = unknown;         ///< at this node, where it was needed
  double slope_before_ = unknown;  ///< at that before: a turn at a node belongs to one of two steps
  double largest_ = 0;
  bool is_whole_ = true;     ///< the last step, unless it was begun anew inside of it
  bool is_at_zero_ = false;  ///< this node, as far as it can be told: what happened there does not happen again
  bool starts_there_ = false;
  Count undefined_, jumps_, flat_;
};

}  // namespace lagroid
