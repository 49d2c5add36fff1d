#include <lagroid/run/events/event_watch.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/ledger/ledger.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

namespace lagroid {

namespace {

/// A partial step did not converge.
struct NoPartialStep {
  double share;
};

/// An event cannot change the motion as it is to.
struct NoChange {
  std::string why;
};

/// The end of those that happen at the time of the first, as far as shares of the step tell.
template <class Iterator> Iterator together_with(Iterator first, Iterator end) {
  return std::find_if(first, end, [first](const auto& each) { return each.share > first->share + indistinguishable; });
}

/// Of every quantity that is known inside of steps its value and the size of its terms; of the others zeros.
std::vector<QuantityWithin> quantities_within(const Observables& node) {
  std::vector<QuantityWithin> all;
  for (std::size_t i = 0; i < node.quantities().size(); ++i) {
    const Watched& quantity = node.quantities()[i];
    all.push_back({std::vector<double>(quantity.components.size())});
    QuantityWithin& each = all.back();
    if (!quantity.on_arrows && !quantity.adds_up) each.size = node.measure(i, each.value.data());
  }
  return all;
}

std::string named(const Event& event) { return fmt::format("event \"{}\"", event.name); }

void require(const Event& event, std::set<std::string>& names) {
  // In tables and in pictures, where these mean something else.
  if (event.name.empty() || event.name.find_first_of("\n\r,\"\\") != std::string::npos)
    throw RunError("an event has a name of one line, without commas, quotes and backslashes");
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

/// Where among the numbers of all momenta those that it kicks begin.
std::size_t require_kick(const Event& event, const Changeable& changeable) {
  if (event.kick.empty()) {
    if (!event.body.empty()) throw RunError(fmt::format("{}: it names a body, which nothing kicks", named(event)));
    return 0;
  }
  if (changeable.momenta.empty())
    throw RunError(fmt::format(
        "{}: nothing can be added to the momentum inside of the steps of this run: leave out kick", named(event)));
  std::size_t first = 0;
  std::vector<std::string> names;
  for (const Changeable::Momentum& each : changeable.momenta) {
    if (each.name == event.body) {
      if (event.kick.size() != each.numbers)
        throw RunError(fmt::format("{}: its kick has {} numbers, the momentum{} has {}", named(event),
                                   event.kick.size(), each.name.empty() ? "" : " of \"" + each.name + "\"",
                                   each.numbers));
      return first;
    }
    first += each.numbers;
    names.push_back(each.name);
  }
  if (names == std::vector<std::string>{""})
    throw RunError(fmt::format("{}: a body is that of a scene of bodies; here the momentum is one", named(event)));
  throw RunError(fmt::format("{}: it kicks a body, and \"{}\" is none; there are {}", named(event), event.body,
                             fmt::join(names, ", ")));
}

std::vector<EventFunction> set_of(const Event& event, const Observables& node) {
  std::vector<EventFunction> out;
  for (const auto& [name, number] : event.set) out.emplace_back(Event{.name = event.name, .when = number}, node);
  return out;
}

void require_set(const Event& event, const Motion& motion, const Changeable& changeable) {
  if (event.set.empty()) return;
  const std::vector<std::string>& names = changeable.parameters;
  if (names.empty())
    throw RunError(fmt::format("{}: no parameter can be changed on the way: {}", named(event), motion.traits().name));
  for (const auto& [name, number] : event.set)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw RunError(fmt::format("{}: it sets \"{}\", which is no parameter that is a number; there are {}",
                                 named(event), name, fmt::join(names, ", ")));
}

void require_switches(const Event& event, const Motion& motion, const Changeable& changeable) {
  std::set<std::string> names;
  for (const Switched& each : changeable.switches) names.insert(each.name);
  for (const auto* list : {&event.switch_on, &event.switch_off})
    for (const std::string& name : *list)
      if (!names.contains(name))
        throw RunError(fmt::format("{}: it switches \"{}\"; {}", named(event), name,
                                   names.empty()
                                       ? "nothing here has a name by which it is switched: " + motion.traits().name
                                       : fmt::format("there are {}", fmt::join(names, ", "))));
  for (const std::string& name : event.switch_on)
    if (std::find(event.switch_off.begin(), event.switch_off.end(), name) != event.switch_off.end())
      throw RunError(fmt::format("{}: it switches \"{}\" on and off", named(event), name));
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
  const Happening* first = nullptr;
  const Happening* last = nullptr;
  for (const Happening& row : events.rows) {
    if (row.event != event || row.passing == Passing::touching) continue;
    if (first == nullptr) first = &row;
    last = &row;
  }
  if (first == nullptr) return std::nullopt;
  EventSpan span{first->time, last->time};
  if (const long intervals = events.watched[event].count - 1; intervals > 0) {
    span.mean_interval = (span.last - span.first) / double(intervals);
    span.error = (first->time_error + last->time_error) / double(intervals);
  }
  return span;
}

EventWatch::EventWatch(const std::vector<Event>& events, Motion& motion)
    : motion_(motion), time_(motion.time()), arrived_(time_), begun_(time_) {
  if (const std::string why = motion.why_not_cut(); !why.empty())
    throw RunError(fmt::format("{}: nothing inside of steps can be found: {}", named(events.front()), why));
  const Observables& node = motion.look();
  const Changeable changeable = motion.changeable();
  table_.columns = columns_within(node);
  std::set<std::string> names;
  for (const Event& event : events) {
    require(event, names);
    try {
      watches_.push_back(
          {event, EventFunction(event, node), kick_of(event, node), set_of(event, node), FunctionWatch(event)});
    } catch (const std::invalid_argument& error) {
      throw RunError(fmt::format("{}: {}", named(event), error.what()));
    }
    watches_.back().kicked_at = require_kick(event, changeable);
    require_set(event, motion, changeable);
    require_switches(event, motion, changeable);
    watches_.back().function.next(watches_.back().value(node), time_);
    table_.watched.push_back({event.name, event.when, event.plot});
    require_plot(event, table_.columns);
  }
}

const Observables& EventWatch::within(double share) {
  const Observables* inside = motion_.look_within(share);
  if (inside == nullptr) throw NoPartialStep{share};
  return *inside;
}

std::vector<EventWatch::Found> EventWatch::find_in_step() {
  std::vector<Found> found;
  for (const std::size_t i : suspects_) {
    looking_for_ = i;
    Watch& watch = watches_[i];
    for (const FoundInStep& each : watch.function.find([&](double share) { return watch.value(within(share)); }))
      found.push_back({i, each.share, each.passing});
  }
  suspects_.clear();
  // In the order of time and, where that does not tell, in that in which they were written.
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.share < b.share; });
  for (auto first = found.begin(); first != found.end();) {
    const auto last = together_with(first, found.end());
    std::stable_sort(first, last, [](const Found& a, const Found& b) { return a.event < b.event; });
    first = last;
  }
  return found;
}

EventWatch::Goes EventWatch::look_into_step() {
  looked_within_ = true;
  try {
    for (int kicks = 0; !suspects_.empty(); ++kicks) {
      if (kicks == most_changes_in_step) {
        reason_ = fmt::format("{}: follows its own kicks without end, {} times between t = {:.6g} and {:.6g}",
                              named(watches_[looking_for_].event), kicks, time_, arrived_);
        return Goes::failed;
      }
      std::vector<Found> found = find_in_step();
      if (look_into_rest(found) == Goes::ended) return Goes::ended;
    }
  } catch (const NoPartialStep& none) {
    reason_ = fmt::format(
        "{}: could not be located between t = {:.6g} and {:.6g}: a step of {:.3g} of that one does "
        "not converge; use a smaller time.step",
        named(watches_[looking_for_].event), time_, arrived_, none.share);
    return Goes::failed;
  } catch (const NoChange& none) {
    reason_ = fmt::format("{}: {}", named(watches_[looking_for_].event), none.why);
    return Goes::failed;
  }
  return Goes::on;
}

EventWatch::Goes EventWatch::look_into_rest(std::vector<Found>& found) {
  for (auto first = found.cbegin(); first != found.cend();) {
    const auto last = together_with(first, found.cend());
    // All that happens at that time has happened, and has changed the motion, before the run ends.
    const Found* ending = nullptr;
    for (auto each = first; each != last; ++each) {
      looking_for_ = each->event;
      if (!happens(*each) && ending == nullptr) ending = &*each;
    }
    const bool is_changed = change(Group(&*first, std::size_t(last - first)));
    if (ending != nullptr) {
      end_ = &within(is_changed ? 0 : ending->share);
      return Goes::ended;
    }
    if (is_changed) break;
    first = last;
  }
  return Goes::on;
}

bool EventWatch::change(Group together) {
  const double share = std::max_element(together.begin(), together.end(), [](const Found& a, const Found& b) {
                         return a.share < b.share;
                       })->share;
  MotionChange change;
  std::vector<QuantityWithin> before;
  std::vector<Watch*> changing;
  for (const Found& found : together) {
    Watch& watch = watches_[found.event];
    if (!watch.event.changes_motion() || found.passing == Passing::touching) continue;
    looking_for_ = found.event;
    const Observables& inside = within(share);
    add_change(watch, inside, change);
    before = quantities_within(inside);
    changing.push_back(&watch);
  }
  if (change.empty()) return false;
  if (const std::string why = motion_.refused(share, change); !why.empty())
    throw NoChange{fmt::format("between t = {:.6g} and {:.6g}: {}", time_, arrived_, why)};
  if (const StepReport report = motion_.change_within(share, change); !report.converged())
    throw NoChange{fmt::format(
        "after its change, between t = {:.6g} and {:.6g}, the rest of the step does not converge ({}); use a smaller "
        "one or a smaller time.step",
        time_, arrived_, to_string(report.status))};
  for (Watch* each : changing) ++each->changes;
  const Observables& changed = within(0);
  measure_change(before, changed);
  begun_ = changed.time();
  std::vector<double> there;
  for (Watch& watch : watches_) there.push_back(watch.value(changed));
  const Observables& node = motion_.look();
  arrived_ = node.time();  // a rest of a transformed time lasts as long as it does
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    const auto fired = std::find_if(together.begin(), together.end(), [&](const Found& f) { return f.event == i; });
    const auto passing = fired == together.end() ? std::nullopt : std::optional(fired->passing);
    if (watches_[i].function.next_from(there[i], passing, watches_[i].value(node), arrived_)) suspects_.push_back(i);
  }
  return true;
}

void EventWatch::add_change(Watch& watch, const Observables& inside, MotionChange& change) const {
  const Event& event = watch.event;
  const auto value_of = [&](EventFunction& function, const std::string& text, const char* what) {
    const double number = function(inside);
    if (!std::isfinite(number))
      throw NoChange{
          fmt::format("{} is no finite number at t = {:.6g}: \"{}\" is {}", what, inside.time(), text, number)};
    return number;
  };
  if (!watch.kick.empty()) change.kick.resize(motion_.changeable().numbers());
  for (std::size_t k = 0; k < watch.kick.size(); ++k)
    change.kick[watch.kicked_at + k] += value_of(watch.kick[k], event.kick[k], "its kick");
  for (std::size_t k = 0; k < watch.set.size(); ++k)
    change.parameters.push_back({event.set[k].first, value_of(watch.set[k], event.set[k].second, "what it sets")});
  for (const std::string& name : event.switch_on) change.switches.push_back({name, true});
  for (const std::string& name : event.switch_off) change.switches.push_back({name, false});
}

void EventWatch::measure_change(const std::vector<QuantityWithin>& before, const Observables& changed) {
  const std::vector<QuantityWithin> after = quantities_within(changed);
  if (shifts_.empty())
    for (const QuantityWithin& each : after) shifts_.push_back({std::vector<double>(each.value.size())});
  for (std::size_t i = 0; i < after.size(); ++i) {
    for (std::size_t k = 0; k < after[i].value.size(); ++k) {
      if (!std::isfinite(after[i].value[k]))
        throw NoChange{fmt::format("after its change at t = {:.6g} {} is no finite number any more; use a smaller one",
                                   changed.time(), changed.quantities()[i].name)};
      shifts_[i].value[k] += after[i].value[k] - before[i].value[k];
    }
    shifts_[i].size = std::max({shifts_[i].size, before[i].size, after[i].size});
  }
}

void EventWatch::settle(Judge& judge) {
  for (std::size_t i = 0; i < shifts_.size(); ++i) judge.shift(i, shifts_[i].value.data(), shifts_[i].size);
  shifts_.clear();
}

bool EventWatch::happens(const Found& found) {
  Watch& watch = watches_[found.event];
  const Event& event = watch.event;
  const double uncertainty = watch.function.uncertainty({found.share, found.passing}, [&](double share) {
    const Observables* inside = motion_.look_within(share);
    return inside == nullptr ? std::numeric_limits<double>::quiet_NaN() : watch.value(*inside);
  });
  const Observables& inside = within(found.share);
  Happening happening{found.event,   step_, inside.time(),        uncertainty * std::abs(arrived_ - begun_),
                      found.passing, false, values_within(inside)};
  happening.together = !table_.rows.empty() && std::abs(happening.time - table_.rows.back().time) <=
                                                   indistinguishable * std::abs(arrived_ - time_);
  table_.rows.push_back(std::move(happening));
  const Happening& row = table_.rows.back();
  WatchedEvent& watched = table_.watched[found.event];
  const bool counted = found.passing != Passing::touching;
  ++(counted ? watched.count : watched.touches);
  const bool goes_on = !event.call || event.call(row, inside);
  if (goes_on && !(counted && event.then == Event::Then::stop && watched.count >= event.count)) return true;
  if (!reason_.empty()) return false;  // the first of those that end it together
  reason_ = fmt::format("ended by {} at t = {:.15g}, in step {}", named(event), row.time, row.step);
  if (watched.count > 1) reason_ += fmt::format(": it happened for the {}. time", watched.count);
  return false;
}

void EventWatch::report(RunResult& result) const {
  result.events = table_;
  const bool is_changed = std::any_of(watches_.begin(), watches_.end(), [](const Watch& w) { return w.changes > 0; });
  // What is summed up over steps, or belongs to their arrows, does not know of the two that a change makes of one.
  if (is_changed)
    for (const Watched& quantity : motion_.look().quantities())
      for (LedgerEntry& entry : result.ledger.entries)
        if ((quantity.adds_up || quantity.on_arrows) && entry.name == quantity.name && entry.promise != "none") {
          entry.verdict = "unjudged";
          entry.reason = quantity.adds_up ? "it is summed up over whole steps, and changes came between"
                                          : "it belongs to whole steps, and changes came between";
        }
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    const Watch& watch = watches_[i];
    const WatchedEvent& watched = table_.watched[i];
    result.ledger.entries.push_back(counted_entry(named(watch.event), watched.count, result.steps));
    const auto note = [&](const std::string& text) { result.notes.push_back(named(watch.event) + ": " + text); };
    for (const std::string& told : watch.function.notes()) note(told);
    if (watch.changes > 0)
      note(fmt::format("{} the motion {} times; the ledger's first values are moved by it",
                       watch.event.set.empty() && watch.event.switch_on.empty() && watch.event.switch_off.empty()
                           ? "kicked"
                           : "changed",
                       watch.changes));
    if (watched.touches > 0) note(words_of_touches(watched.touches));
  }
}

std::vector<double> EventWatch::flat_rows() const {
  std::vector<double> out;
  for (const Happening& row : table_.rows) {
    out.insert(out.end(), {double(row.event), double(row.step), row.time, row.time_error, double(int(row.passing)),
                           double(row.together)});
    out.insert(out.end(), row.values.begin(), row.values.end());
  }
  return out;
}

void EventWatch::restore(const std::vector<double>& rows) {
  constexpr std::size_t own = 6;
  const std::size_t width = own + table_.columns.size();
  if (rows.size() % width != 0) throw std::out_of_range("events of another computation");
  table_.rows.clear();
  for (WatchedEvent& each : table_.watched) each.count = each.touches = 0;
  for (auto at = rows.begin(); at != rows.end(); at += std::ptrdiff_t(width)) {
    Happening row{std::size_t(at[0]),
                  long(at[1]),
                  at[2],
                  at[3],
                  Passing(int(at[4])),
                  at[5] != 0,
                  std::vector<double>(at + own, at + std::ptrdiff_t(width))};
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
      if (watched.judge() != nullptr) events.settle(*watched.judge());
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
