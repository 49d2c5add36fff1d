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

/// The end of those that happen at the time of the first, as far as shares of the step tell.
template <class Iterator> Iterator together_with(Iterator first, Iterator end) {
  return std::find_if(first, end, [first](const auto& each) { return each.share > first->share + apart; });
}

/// Of every quantity that is known inside of steps its value; of the others zeros.
std::vector<std::vector<double>> quantities_within(const Observables& node) {
  std::vector<std::vector<double>> all;
  for (std::size_t i = 0; i < node.quantities().size(); ++i) {
    const Watched& quantity = node.quantities()[i];
    all.emplace_back(quantity.components.size());
    if (!quantity.on_arrows && !quantity.adds_up) node.measure(i, all.back().data());
  }
  return all;
}

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

std::vector<EventFunction> kick_of(const Event& event, const Observables& node) {
  std::vector<EventFunction> out;
  for (const std::string& number : event.kick) out.emplace_back(Event{.name = event.name, .when = number}, node);
  return out;
}

void require_kick(const Event& event, const Motion& motion) {
  if (event.kick.empty()) return;
  const std::size_t numbers = motion.kicked_numbers();
  if (numbers == 0)
    throw RunError(fmt::format("{}: nothing can be added to the momentum on the way: {}, or no system of a scene",
                               named(event), motion.traits().name));
  if (event.kick.size() != numbers)
    throw RunError(
        fmt::format("{}: its kick has {} numbers, the momentum has {}", named(event), event.kick.size(), numbers));
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
      watches_.push_back({event, EventFunction(event, node), kick_of(event, node)});
    } catch (const std::invalid_argument& error) {
      throw RunError(fmt::format("{}: {}", named(event), error.what()));
    }
    require_kick(event, motion);
    watches_.back().goes_on_to(node);
    table_.watched.push_back({event.name, event.when, event.plot});
    require_plot(event, table_.columns);
  }
}

void EventWatch::Watch::see(const Observables& node) {
  now = function(node);
  if (std::isfinite(now)) {
    largest = std::max(largest, std::abs(now));
    return;
  }
  if (undefined++ == 0) undefined_at = node.time();
  now = unknown;
}

bool EventWatch::Watch::goes_on_to(const Observables& node) {
  const bool is_first = std::isnan(before) && !std::isnan(now) && undefined == 0;
  change = now - before;
  before = now;
  slope_before = slope;
  slope = unknown;
  see(node);
  if (std::isnan(now) || std::isnan(before)) return false;
  if (event.at != Event::At::zero) return may_turn();
  constexpr double round_off = 1e-12;
  if (is_first && std::abs(before) <= round_off * std::abs(now - before)) {
    starts_at_zero = true;
    before = now;
    return false;
  }
  return passes_zero() || may_touch();
}

bool EventWatch::Watch::goes_on_from(double kicked, std::optional<Passing> passing, const Observables& node) {
  constexpr double tiny = std::numeric_limits<double>::min();
  constexpr double round_off = 1e-9;
  change = slope = slope_before = unknown;
  before = kicked;
  // What has just happened does not happen again there: its function has passed zero, or turned.
  if (passing == Passing::minimum || passing == Passing::maximum)
    slope_before = passing == Passing::minimum ? tiny : -tiny;
  else if (passing && std::abs(before) <= round_off * largest)
    before = passing == Passing::falling ? -tiny : tiny;
  see(node);
  if (std::isnan(now) || std::isnan(before)) return false;
  return event.at == Event::At::zero ? passes_zero() : may_turn();
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

void EventWatch::find_in_step(std::vector<Found>& found, std::size_t& looking_for) {
  found.clear();
  for (const std::size_t i : suspects_) {
    looking_for = i;
    watches_[i].event.at == Event::At::zero ? look_for_zeros(i, found) : look_for_extremum(i, found);
  }
  // In the order of time and, where that does not tell, in that in which they were written.
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.share < b.share; });
  for (auto first = found.begin(); first != found.end();) {
    const auto last = together_with(first, found.end());
    std::stable_sort(first, last, [](const Found& a, const Found& b) { return a.event < b.event; });
    first = last;
  }
}

EventWatch::Goes EventWatch::look_into_step() {
  constexpr int most_kicks = 100;
  looked_within_ = true;
  std::vector<Found> found;
  std::size_t looking_for = 0;
  try {
    for (int kicks = 0; !suspects_.empty(); ++kicks) {
      if (kicks == most_kicks) {
        reason_ = fmt::format("{}: follows its own kicks without end, {} times between t = {:.6g} and {:.6g}",
                              named(watches_[looking_for].event), kicks, time_, arrived_);
        return Goes::failed;
      }
      find_in_step(found, looking_for);
      suspects_.clear();
      for (auto first = found.cbegin(); first != found.cend();) {
        const auto last = together_with(first, found.cend());
        for (auto each = first; each != last; ++each) {
          looking_for = each->event;
          if (!happens(*each)) return Goes::ended;
        }
        if (kick({&*first, std::size_t(last - first)})) break;
        first = last;
      }
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

bool EventWatch::kick(std::span<const Found> together) {
  const double share = std::max_element(together.begin(), together.end(), [](const Found& a, const Found& b) {
                         return a.share < b.share;
                       })->share;
  std::vector<double> by;
  std::vector<std::vector<double>> before;
  for (const Found& found : together) {
    Watch& watch = watches_[found.event];
    if (watch.kick.empty() || found.passing == Passing::touching) continue;
    const Observables* inside = motion_.look_within(share);
    if (inside == nullptr) throw NoPartialStep{share};
    by.resize(watch.kick.size());
    for (std::size_t k = 0; k < by.size(); ++k) by[k] += watch.kick[k](*inside);
    before = quantities_within(*inside);
  }
  if (by.empty()) return false;
  if (!motion_.kick_within(share, by).converged()) throw NoPartialStep{share};
  const Observables* kicked = motion_.look_within(0);
  if (kicked == nullptr) throw NoPartialStep{0};
  const std::vector<std::vector<double>> after = quantities_within(*kicked);
  if (kicked_.empty())
    for (const std::vector<double>& each : after) kicked_.emplace_back(each.size());
  for (std::size_t i = 0; i < after.size(); ++i)
    for (std::size_t k = 0; k < after[i].size(); ++k) kicked_[i][k] += after[i][k] - before[i][k];
  std::vector<double> at_kick;
  for (Watch& watch : watches_) at_kick.push_back(watch.function(*kicked));
  const Observables& node = motion_.look();
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    const auto fired = std::find_if(together.begin(), together.end(), [&](const Found& f) { return f.event == i; });
    const auto passing = fired == together.end() ? std::nullopt : std::optional(fired->passing);
    if (watches_[i].goes_on_from(at_kick[i], passing, node)) suspects_.push_back(i);
  }
  return true;
}

void EventWatch::settle(Judge& judge) {
  for (std::size_t i = 0; i < kicked_.size(); ++i) judge.shift(i, kicked_[i].data());
  kicked_.clear();
}

bool EventWatch::happens(const Found& found) {
  const Event& event = watches_[found.event].event;
  const Observables* inside = motion_.look_within(found.share);
  if (inside == nullptr) throw NoPartialStep{found.share};
  Happening happening{found.event, step_, inside->time(), found.passing, false, values_within(*inside)};
  happening.together =
      !table_.rows.empty() && std::abs(happening.time - table_.rows.back().time) <= apart * std::abs(arrived_ - time_);
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
    if (!watch.kick.empty() && watched.count > 0)
      result.notes.push_back(fmt::format("{}: kicked the motion {} times; the ledger's first values are moved by it",
                                         named(watch.event), watched.count));
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
    if (watched.judge() != nullptr) events.settle(*watched.judge());
    if (!watched.observe(node)) return {IntegrationEnd::Why::not_finite, report};
    if (goes == EventWatch::Goes::failed) return {IntegrationEnd::Why::event, {SolveStatus::not_converged}};
    if (!goes_on(report)) return {IntegrationEnd::Why::stopped, report};
  }
  return {};
}

}  // namespace lagroid
