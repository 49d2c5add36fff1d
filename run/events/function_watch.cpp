#include <lagroid/run/events/function_watch.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace lagroid {

namespace {

/// Of the change over a step: what cannot be told from zero at its end.
constexpr double rounding_of_values = 1e-12;
constexpr double tiny = std::numeric_limits<double>::min();

}  // namespace

std::string words_of_touches(long touches) {
  return fmt::format("its function came to zero {} times without passing it; not counted", touches);
}

void FunctionWatch::see(double value, double time) {
  time_ = time;
  now_ = value;
  if (std::isfinite(now_)) {
    largest_ = std::max(largest_, std::abs(now_));
    return;
  }
  undefined_.add(time);
  now_ = unknown;
}

bool FunctionWatch::next(double value, double time) {
  ++nodes_;
  const bool was_at_zero = is_at_zero_;
  change_ = is_whole_ ? now_ - before_ : unknown;
  is_whole_ = true;
  is_at_zero_ = false;
  before_ = now_;
  slope_before_ = slope_;
  slope_ = unknown;
  see(value, time);
  if (std::isnan(now_) || std::isnan(before_)) return false;
  if (at_ != Event::At::zero) return may_turn();
  const double step = now_ - before_;
  if (is_first_step() && std::abs(before_) <= rounding_of_values * std::abs(step)) starts_there_ = true;
  if (was_at_zero || (is_first_step() && starts_there_)) {
    if (now_ == 0) {
      is_at_zero_ = true;
      return false;
    }
    before_ = std::copysign(tiny, now_);
  }
  is_at_zero_ = step != 0 && std::abs(now_) <= rounding_of_values * std::abs(step);
  return is_at_zero_ || passes_zero() || may_touch();
}

bool FunctionWatch::next_from(double changed, std::optional<Passing> passing, double value, double time) {
  is_whole_ = is_at_zero_ = false;
  change_ = slope_ = slope_before_ = unknown;
  before_ = changed;
  // What has just happened does not happen again there: its function has passed zero, or turned.
  constexpr double at_zero = 1e-9;
  const bool turned = passing == Passing::minimum || passing == Passing::maximum;
  const bool passed = passing && !turned && std::abs(before_) <= at_zero * largest_;
  if (turned)
    slope_before_ = passing == Passing::minimum ? tiny : -tiny;
  else if (passed)
    before_ = passing == Passing::touching ? std::copysign(tiny, value) : passing == Passing::falling ? -tiny : tiny;
  see(value, time);
  if (passed && std::abs(now_) <= rounding_of_values * largest_) {
    is_at_zero_ = true;  // it passed at the node: the step from there does not begin on the other side
    return false;
  }
  // Nothing is known of how it bends: it is looked at.
  return !std::isnan(now_) && !std::isnan(before_);
}

/// Over a step a smooth function bends by an eighth of its second difference, one with a kink by half of it.
bool FunctionWatch::may_touch() const {
  if (std::isnan(change_)) return true;
  const double bend = now_ - before_ - change_;
  return (before_ < 0) == (now_ < 0) && (bend < 0) == (now_ < 0) &&
         std::min(std::abs(before_), std::abs(now_)) <= 0.75 * std::abs(bend);
}

/// By the slopes at both nodes of the parabola through the last three.
bool FunctionWatch::may_turn() const {
  if (std::isnan(change_)) return true;
  const double step = now_ - before_;
  const double bend = step - change_;
  const double first = step - 0.5 * bend;
  const double last = step + 0.5 * bend;
  return (first < 0) != (last < 0) || std::min(std::abs(first), std::abs(last)) <= std::abs(bend);
}

std::vector<FoundInStep> FunctionWatch::find(const StepFunction& g) {
  std::vector<FoundInStep> found;
  try {
    if (at_ == Event::At::zero) {
      find_zeros(g, found);
    } else {
      const bool is_minimum = at_ == Event::At::minimum;
      if (const auto turn = turn_of(g, is_minimum))
        found.push_back({*turn, is_minimum ? Passing::minimum : Passing::maximum});
    }
  } catch (const NoNumber&) {
    undefined_.add(time_);
  }
  return found;
}

void FunctionWatch::find_zeros(const StepFunction& g, std::vector<FoundInStep>& found) {
  const auto add = [&](double a, double b, double at_a, double at_b) {
    if (!counts(at_a, at_b)) return;
    const RootInStep root = root_within(g, a, b, at_a, at_b);
    if (root.is_jump)
      jumps_.add(time_);
    else
      found.push_back({root.share, passing_of(at_a, at_b)});
  };
  // Near zero for good, a sign is one of round-off.
  constexpr double small = 1e-9;
  if ((is_at_zero_ || passes_zero()) && std::max(std::abs(before_), std::abs(now_)) <= small * largest_ &&
      is_rounding_within(g)) {
    flat_.add(time_);
    return;
  }
  if (is_at_zero_) {
    // It passes, unless it arrives there without a slope.
    const double slope = slope_within(g, 1);
    constexpr double level = 1e-6;
    if ((before_ < 0) == (slope > 0) && std::abs(slope) > level * std::abs(before_)) {
      if (counts(before_, -before_)) found.push_back({1, passing_of(before_, -before_)});
    } else if (std::abs(slope) <= level * std::abs(before_)) {
      found.push_back({1, Passing::touching});
    }
    return;
  }
  if (passes_zero()) {
    add(0, 1, before_, now_);
    return;
  }
  const double sign = now_ < 0 ? -1 : 1;
  const std::optional<double> turn = turn_of(g, sign > 0);
  if (!turn) return;
  const double nearest = g(*turn);
  if (std::abs(nearest) <= tolerance_ * largest_) {
    found.push_back({*turn, Passing::touching});
  } else if (sign * nearest < 0) {
    add(0, *turn, before_, nearest);
    add(*turn, 1, nearest, now_);
  }
}

std::optional<double> FunctionWatch::turn_of(const StepFunction& g, bool is_minimum) {
  const double before = std::isnan(slope_before_) ? slope_within(g, 0) : slope_before_;
  slope_ = slope_within(g, 1);
  const double sign = is_minimum ? 1 : -1;
  // At an extremum the slope is round-off, of either sign.
  constexpr double level = 1e-7, rounding = 1e-11;
  if (is_first_step() && std::abs(before) <= level * std::abs(slope_ - before) + rounding * largest_) {
    if (at_ != Event::At::zero && sign * slope_ > rounding * largest_) starts_there_ = true;
    return std::nullopt;
  }
  if (!(sign * before < 0 && sign * slope_ >= 0)) return std::nullopt;
  const double turn = turn_within(g, before, slope_);
  constexpr double shallow = 1e-9, some_units = 1e-14;
  const double at = g(turn);
  const double depth = std::max(std::abs(g(0) - at), std::abs(g(1) - at));
  if (depth <= some_units * largest_ || (depth <= shallow * largest_ && is_rounding_within(g))) {
    flat_.add(time_);
    return std::nullopt;
  }
  return turn;
}

double FunctionWatch::uncertainty(const FoundInStep& found, const StepFunction& g) const {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  try {
    if (found.passing == Passing::rising || found.passing == Passing::falling)
      return std::fmin(1, rounding * largest_ / std::abs(slope_within(g, found.share)));
    constexpr double around = 1.0 / 64;
    const double low = std::max(0.0, found.share - around), high = std::min(1.0, found.share + around);
    const double curvature = (slope_within(g, high) - slope_within(g, low)) / (high - low);
    return std::fmin(1, rounding * slope_rounding * largest_ / std::abs(curvature));
  } catch (const NoNumber&) {
    return 1;
  }
}

std::vector<std::string> FunctionWatch::notes(long touches) const {
  std::vector<std::string> out;
  if (starts_there_)
    out.push_back(fmt::format("its function is {} at the start, which is not counted", at_ == Event::At::zero ? "zero"
                                                                                       : at_ == Event::At::minimum
                                                                                           ? "smallest"
                                                                                           : "largest"));
  if (jumps_.times > 0)
    out.push_back(
        fmt::format("its function changes sign by a jump or a pole, not through zero, {} times, first in the "
                    "step to t = {:.6g}; not counted",
                    jumps_.times, jumps_.first));
  if (flat_.times > 0)
    out.push_back(
        fmt::format("its function is constant to round-off in {} steps where it seems to turn or to pass, "
                    "first in that to t = {:.6g}; not counted",
                    flat_.times, flat_.first));
  if (undefined_.times > 0)
    out.push_back(
        fmt::format("its function was no finite number at {} of {} nodes, the first at t = {:.6g}; nothing "
                    "was found next to them",
                    undefined_.times, nodes_, undefined_.first));
  if (touches > 0) out.push_back(words_of_touches(touches));
  return out;
}

}  // namespace lagroid
