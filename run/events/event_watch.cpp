#include <lagroid/run/events/event_watch.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/ledger/ledger.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

namespace lagroid {

namespace {

/// A partial step did not converge.
struct NoPartialStep {
  double share;
};

/// Times of one step that differ by less, relative to it, cannot be told apart.
constexpr double apart = 1e-11;

std::string named(const Event& event) { return fmt::format("event \"{}\"", event.name); }

Passing direction_of(double from, double to) { return from < to ? Passing::rising : Passing::falling; }

void require(const Event& event, std::set<std::string>& names) {
  if (event.name.empty() || event.name.find_first_of("\n\r") != std::string::npos)
    throw RunError("an event has a name of one line");
  if (!names.insert(event.name).second) throw RunError(fmt::format("{}: two have this name", named(event)));
  if (event.count < 1) throw RunError(fmt::format("{}: it counts to {}, to no event", named(event), event.count));
  if (!(event.tolerance >= 0 && event.tolerance < 1))
    throw RunError(fmt::format("{}: its tolerance is a share from 0 to 1", named(event)));
}

void require_plot(const Event& event, const std::vector<std::string>& columns) {
  if (event.plot.empty()) return;
  for (const std::string& column : event.plot)
    if (column != "t" && std::find(columns.begin(), columns.end(), column) == columns.end())
      throw RunError(fmt::format("{}: it cannot be drawn over \"{}\"; there are t, {}", named(event), column,
                                 fmt::join(columns, ", ")));
  if (event.plot.size() != 2) throw RunError(fmt::format("{}: it is drawn in two columns, x and y", named(event)));
}

}  // namespace

std::string_view to_string(Passing passing) {
  switch (passing) {
    case Passing::rising:
      return "rising";
    case Passing::falling:
      return "falling";
    case Passing::touching:
      return "touching";
    case Passing::minimum:
      return "minimum";
    case Passing::maximum:
      return "maximum";
  }
  return "";
}

std::optional<EventSpan> span_of(const EventTable& events, std::size_t event) {
  std::optional<EventSpan> span;
  for (const Happening& row : events.rows) {
    if (row.event != event || row.passing == Passing::touching) continue;
    if (!span) span = EventSpan{row.time, row.time};
    span->last = row.time;
  }
  const long count = events.watched[event].count;
  if (span && count > 1) span->mean_interval = (span->last - span->first) / double(count - 1);
  return span;
}

EventWatch::EventWatch(const std::vector<Event>& events, Motion& motion)
    : motion_(motion), time_(motion.time()), arrived_(time_) {
  if (const std::string why = motion.why_not_cut(); !why.empty())
    throw RunError(fmt::format("{}: nothing inside of steps can be found: {}", named(events.front()), why));
  const Observables& node = motion.look();
  table_.columns = columns_within(node);
  std::set<std::string> names;
  for (const Event& event : events) {
    require(event, names);
    try {
      watches_.push_back({event, EventFunction(event, node)});
    } catch (const std::invalid_argument& error) {
      throw RunError(fmt::format("{}: {}", named(event), error.what()));
    }
    watches_.back().goes_on_to(node);
    table_.watched.push_back({event.name, event.when, event.plot});
    require_plot(event, table_.columns);
  }
}

bool EventWatch::Watch::goes_on_to(const Observables& node) {
  const bool is_first = std::isnan(before) && !std::isnan(now) && undefined == 0;
  change = now - before;
  before = now;
  slope_before = slope;
  slope = unknown;
  now = function(node);
  if (!std::isfinite(now)) {
    if (undefined++ == 0) undefined_at = node.time();
    now = unknown;
    return false;
  }
  largest = std::max(largest, std::abs(now));
  if (std::isnan(before)) return false;
  if (event.at != Event::At::zero) return may_turn();
  constexpr double round_off = 1e-12;
  if (is_first && std::abs(before) <= round_off * std::abs(now - before)) {
    starts_at_zero = true;
    before = now;
    return false;
  }
  return passes_zero() || may_touch();
}

/// Over a step a function bends by an eighth of its second difference.
bool EventWatch::Watch::may_touch() const {
  const double bend = now - before - change;
  return (before < 0) == (now < 0) && (bend < 0) == (now < 0) &&
         std::min(std::abs(before), std::abs(now)) <= 0.5 * std::abs(bend);
}

/// By the slopes at both nodes of the parabola through the last three.
bool EventWatch::Watch::may_turn() const {
  if (std::isnan(change)) return true;
  const double step = now - before;
  const double bend = step - change;
  const double first = step - 0.5 * bend;
  const double last = step + 0.5 * bend;
  return (first < 0) != (last < 0) || std::min(std::abs(first), std::abs(last)) <= std::abs(bend);
}

double EventWatch::value_at(std::size_t i, double share) {
  const Observables* inside = motion_.look_within(share);
  if (inside == nullptr) throw NoPartialStep{share};
  return watches_[i].function(*inside);
}

std::optional<double> EventWatch::turn_of(std::size_t i, const StepFunction& g, bool is_minimum) {
  Watch& watch = watches_[i];
  const double before = std::isnan(watch.slope_before) ? slope_within(g, 0) : watch.slope_before;
  watch.slope = slope_within(g, 1);
  const double sign = is_minimum ? 1 : -1;
  if (!(sign * before < 0 && sign * watch.slope >= 0)) return std::nullopt;
  return root_within([&](double share) { return slope_within(g, share); }, 0, 1, before, watch.slope);
}

void EventWatch::look_for_zeros(std::size_t i, std::vector<Found>& found) {
  const Watch& watch = watches_[i];
  const StepFunction g = [&](double share) { return value_at(i, share); };
  const auto add = [&](double a, double b, double at_a, double at_b) {
    if (watch.counts(at_a, at_b)) found.push_back({i, root_within(g, a, b, at_a, at_b), direction_of(at_a, at_b)});
  };
  if ((watch.before < 0) != (watch.now < 0)) {
    add(0, 1, watch.before, watch.now);
    return;
  }
  const double sign = watch.now < 0 ? -1 : 1;
  const std::optional<double> found_turn = turn_of(i, g, sign > 0);
  if (!found_turn) return;
  const double turn = *found_turn;
  const double nearest = g(turn);
  if (std::abs(nearest) <= watch.event.tolerance * watch.largest) {
    found.push_back({i, turn, Passing::touching});
  } else if (sign * nearest < 0) {
    add(0, turn, watch.before, nearest);
    add(turn, 1, nearest, watch.now);
  }
}

void EventWatch::look_for_extremum(std::size_t i, std::vector<Found>& found) {
  const bool is_minimum = watches_[i].event.at == Event::At::minimum;
  const StepFunction g = [&](double share) { return value_at(i, share); };
  if (const std::optional<double> turn = turn_of(i, g, is_minimum))
    found.push_back({i, *turn, is_minimum ? Passing::minimum : Passing::maximum});
}

EventWatch::Goes EventWatch::look_into_step() {
  looked_within_ = true;
  const double step_size = arrived_ - time_;
  std::vector<Found> found;
  std::size_t looking_for = 0;
  try {
    for (const std::size_t i : suspects_) {
      looking_for = i;
      watches_[i].event.at == Event::At::zero ? look_for_zeros(i, found) : look_for_extremum(i, found);
    }
    // In the order of time and, where that does not tell, in that in which they were written.
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.share < b.share; });
    for (auto first = found.begin(); first != found.end();) {
      const auto last =
          std::find_if(first, found.end(), [&](const Found& f) { return f.share > first->share + apart; });
      std::stable_sort(first, last, [](const Found& a, const Found& b) { return a.event < b.event; });
      first = last;
    }
    for (const Found& each : found) {
      looking_for = each.event;
      if (!happens(each, step_size)) return Goes::ended;
    }
  } catch (const NoPartialStep& none) {
    reason_ = fmt::format(
        "{}: could not be located between t = {:.6g} and {:.6g}: a step of {:.3g} of that one does "
        "not converge; use a smaller time.step",
        named(watches_[looking_for].event), time_, arrived_, none.share);
    return Goes::failed;
  }
  return Goes::on;
}

bool EventWatch::happens(const Found& found, double step_size) {
  const Event& event = watches_[found.event].event;
  const Observables* inside = motion_.look_within(found.share);
  if (inside == nullptr) throw NoPartialStep{found.share};
  Happening happening{found.event, step_, inside->time(), found.passing, false, values_within(*inside)};
  happening.together =
      !table_.rows.empty() && std::abs(happening.time - table_.rows.back().time) <= apart * std::abs(step_size);
  table_.rows.push_back(std::move(happening));
  const Happening& row = table_.rows.back();
  WatchedEvent& watched = table_.watched[found.event];
  const bool counted = found.passing != Passing::touching;
  ++(counted ? watched.count : watched.touches);
  const bool goes_on = !event.call || event.call(row, *inside);
  if (goes_on && !(counted && event.then == Event::Then::stop && watched.count >= event.count)) return true;
  end_ = inside;
  reason_ = fmt::format("ended by {} at t = {:.15g}, in step {}", named(event), row.time, row.step);
  if (watched.count > 1) reason_ += fmt::format(": it happened for the {}. time", watched.count);
  return false;
}

void EventWatch::report(RunResult& result) const {
  result.events = table_;
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    const Watch& watch = watches_[i];
    const WatchedEvent& watched = table_.watched[i];
    result.ledger.entries.push_back(counted_entry(named(watch.event), watched.count, result.steps));
    if (watch.starts_at_zero)
      result.notes.push_back(
          fmt::format("{}: its function is zero at the start, which is not counted", named(watch.event)));
    if (watched.touches > 0)
      result.notes.push_back(fmt::format("{}: its function came to zero {} times without passing it; not counted",
                                         named(watch.event), watched.touches));
    if (watch.undefined > 0)
      result.notes.push_back(
          fmt::format("{}: its function was no finite number at {} of {} nodes, the first at t = "
                      "{:.6g}; nothing was found next to them",
                      named(watch.event), watch.undefined, result.steps + 1, watch.undefined_at));
  }
}

std::vector<double> EventWatch::flat_rows() const {
  std::vector<double> out;
  for (const Happening& row : table_.rows) {
    out.insert(out.end(),
               {double(row.event), double(row.step), row.time, double(int(row.passing)), double(row.together)});
    out.insert(out.end(), row.values.begin(), row.values.end());
  }
  return out;
}

void EventWatch::restore(const std::vector<double>& rows) {
  constexpr std::size_t own = 5;
  const std::size_t width = own + table_.columns.size();
  if (rows.size() % width != 0) throw std::out_of_range("events of another computation");
  table_.rows.clear();
  for (WatchedEvent& each : table_.watched) each.count = each.touches = 0;
  for (auto at = rows.begin(); at != rows.end(); at += std::ptrdiff_t(width)) {
    Happening row{std::size_t(at[0]),  long(at[1]), at[2],
                  Passing(int(at[3])), at[4] != 0,  std::vector<double>(at + own, at + std::ptrdiff_t(width))};
    WatchedEvent& watched = table_.watched.at(row.event);
    ++(row.passing == Passing::touching ? watched.touches : watched.count);
    table_.rows.push_back(std::move(row));
  }
}

IntegrationEnd integrate_nodes(WatchedMotion& watched, EventWatch& events, long count,
                               const std::function<bool(const StepReport&)>& goes_on) {
  Motion& motion = watched.motion();
  for (long k = 0; k < count; ++k) {
    events.keep();
    const StepReport report = motion.advance();
    if (!report.converged()) return {IntegrationEnd::Why::failed, report};
    if (!std::isfinite(motion.time())) return {IntegrationEnd::Why::not_finite, report};
    const Observables& node = motion.look();
    const EventWatch::Goes goes = events.pass(node);
    if (goes == EventWatch::Goes::ended) {
      watched.end_at(events.end());
      return {IntegrationEnd::Why::event, report};
    }
    if (events.looked_within()) motion.look();
    if (!watched.observe(node)) return {IntegrationEnd::Why::not_finite, report};
    if (goes == EventWatch::Goes::failed) return {IntegrationEnd::Why::event, {SolveStatus::not_converged}};
    if (!goes_on(report)) return {IntegrationEnd::Why::stopped, report};
  }
  return {};
}

}  // namespace lagroid
