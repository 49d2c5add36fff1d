#include <lagroid/run/events/derivatives/motion_through_events.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

namespace lagroid {

namespace {

/// Numbers with names, as plain ones.
struct Unnamed {
  NumberArchive& archive;
  template <class T> void operator()(const char*, T& field) const {
    if constexpr (requires { field.serialize(*this); }) {
      field.serialize(*this);
    } else {
      archive(field);
    }
  }
};

}  // namespace

MotionThroughEvents::MotionThroughEvents(std::unique_ptr<CuttableMotion> motion, std::vector<ObservedEvent> events)
    : motion_(std::move(motion)),
      events_(std::move(events)),
      happened_(events_.size(), 0),
      touched_(events_.size(), 0),
      begins_(events_.size(), 0) {
  for (const ObservedEvent& event : events_) {
    if (!event.function) throw std::invalid_argument(fmt::format("event \"{}\": it has no function", event.name));
    watches_.emplace_back(Event{.name = event.name, .direction = event.direction, .tolerance = event.tolerance});
  }
  const std::vector<double> now = values();
  for (std::size_t i = 0; i < events_.size(); ++i) watches_[i].next(now[i], time());
}

VariedVector MotionThroughEvents::numbers_seen(const Eigen::VectorXd& seen) const {
  VariedVector all(seen.size() + 1);
  all(0) = time();
  for (Eigen::Index i = 0; i < seen.size(); ++i) all(i + 1) = seen(i);
  return all;
}

double MotionThroughEvents::value_of(std::size_t event, const Eigen::VectorXd& seen) const {
  return events_[event].function(numbers_seen(seen)).value;
}

std::vector<double> MotionThroughEvents::values() const {
  const Eigen::VectorXd seen = motion_->seen();
  std::vector<double> out;
  for (std::size_t i = 0; i < events_.size(); ++i) out.push_back(value_of(i, seen));
  return out;
}

std::string MotionThroughEvents::named(const Piece& piece) const {
  return fmt::format("event \"{}\"", events_[piece.events.front()].name);
}

StepReport MotionThroughEvents::advance() try {
  if (is_over_) throw std::invalid_argument("the run is ended by an event: no step follows it");
  pieces_.clear();
  reason_.clear();
  chain_.reset();
  begun_ = motion_->save();
  begun_at_ = time();
  motion_->keep();
  const StepReport report = motion_->advance();
  if (!report.converged()) return report;
  size_ = rest_ = time() - begun_at_;
  ++steps_;
  std::vector<std::size_t> suspects;
  const std::vector<double> now = values();
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (watches_[i].next(now[i], time())) suspects.push_back(i);
    if (steps_ == 1) begins_[i] = watches_[i].starts_there() && is_in_direction(events_[i].direction, -now[i], now[i]);
    if (steps_ == 1 && begins_[i] != 0 && events_[i].decides() && !stays_at_start(i)) conflict_ = why_none_at_start(i);
  }
  for (int changes = 0; !suspects.empty() && !is_over_; ++changes) {
    if (changes == most_changes_in_step) {
      reason_ = "events follow their own changes without end: they want a direction";
      return {SolveStatus::not_converged};
    }
    const double end = begun_at_ + size_;
    const std::size_t before = pieces_.size();
    const std::vector<Found> found = find(suspects, rest_);
    motion_->leave_step();
    suspects.clear();
    take(found, rest_);
    if (pieces_.size() == before || !(pieces_.back().changes || pieces_.back().ends)) break;
    // From there on it is another motion.
    const Piece& last = pieces_.back();
    if (const StepReport part = motion_->go(last.duration); !part.converged()) return part;
    if (last.changes) change(last, nullptr);
    if (last.ends) {
      is_over_ = true;
      break;
    }
    motion_->keep();
    const std::vector<double> there = values();
    // What rounding of times leaves is no rest.
    constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
    rest_ = end - time();
    if (!(rest_ > rounding * std::max(std::abs(end), size_))) rest_ = 0;
    if (const StepReport part = motion_->go(rest_); !part.converged()) return part;
    motion_->end_step();
    const std::vector<double> after = values();
    for (std::size_t i = 0; i < events_.size(); ++i) {
      std::optional<Passing> passing;
      for (const Found& each : found)
        if (each.event == i && std::find(last.events.begin(), last.events.end(), i) != last.events.end())
          passing = passing ? passing : each.passing;
      if (watches_[i].next_from(there[i], passing, after[i], time())) suspects.push_back(i);
    }
  }
  return report;
} catch (const StepReport& failed) {
  return failed;
} catch (const NoNumber&) {
  reason_ = "the function of an event is no finite number";
  return {SolveStatus::left_domain};
} catch (const std::domain_error& error) {
  reason_ = error.what();
  return {SolveStatus::left_domain};
}

std::string MotionThroughEvents::why_none_at_start(std::size_t event) const {
  return fmt::format("the function of event \"{}\" is zero at the start, and what follows has no derivative there",
                     events_[event].name);
}

std::vector<MotionThroughEvents::Found> MotionThroughEvents::find(const std::vector<std::size_t>& suspects,
                                                                  double length) {
  std::vector<Found> out;
  for (const std::size_t i : suspects)
    for (const FoundInStep& each : watches_[i].find([&](double share) {
           if (const StepReport part = motion_->go(share * length); !part.converged()) throw part;
           return value_of(i, motion_->seen());
         }))
      out.push_back({i, each.share, each.passing});
  std::stable_sort(out.begin(), out.end(), [](const Found& a, const Found& b) { return a.share < b.share; });
  return out;
}

std::string MotionThroughEvents::conflict_of(const std::vector<Found>& found, std::size_t first,
                                             std::size_t last) const {
  const auto differ = [&](std::size_t a, std::size_t b) {
    const ObservedEvent &one = events_[found[a].event], &other = events_[found[b].event];
    return (one.decides() || other.decides()) && (one.when != other.when || one.when.empty());
  };
  for (std::size_t k = first; k < found.size() && found[k].share - found[first].share <= event_limits::together; ++k)
    for (std::size_t j = first; j < std::min(k, last); ++j)
      if (differ(j, k))
        return fmt::format("event \"{}\" and event \"{}\" happen together, where what follows has no derivative",
                           events_[found[j].event].name, events_[found[k].event].name);
  return "";
}

void MotionThroughEvents::take(const std::vector<Found>& found, double length) {
  for (std::size_t first = 0; first < found.size();) {
    std::size_t last = first;
    Piece piece{};
    while (last < found.size() && found[last].share <= found[first].share + indistinguishable) {
      const Found& each = found[last++];
      const ObservedEvent& event = events_[each.event];
      piece.duration = each.share * length;
      if (each.passing == Passing::touching) {  // which changes nothing
        if (event.decides()) {
          pieces_.push_back({.duration = piece.duration, .events = {each.event}, .touches = true});
        } else {
          ++touched_[each.event];
        }
        continue;
      }
      piece.events.push_back(each.event);
      piece.changes = piece.changes || event.changes_motion();
      ++happened_[each.event];
      piece.ends = piece.ends || (event.then == Event::Then::stop && happened_[each.event] >= event.count);
    }
    piece.conflict = conflict_of(found, first, last);
    first = last;
    if (piece.events.empty()) continue;
    pieces_.push_back(std::move(piece));
    if (pieces_.back().changes || pieces_.back().ends) return;
  }
}

void MotionThroughEvents::change(const Piece& piece, Derivatives* step) {
  const VariedVector seen = numbers_seen(motion_->seen());
  const Eigen::VectorXd kick = kick_of(piece, seen);
  std::vector<SetNumber> numbers = numbers_of(piece, seen);
  if (step != nullptr && (kick.size() > 0 || !numbers.empty())) {
    const Eigen::MatrixXd by = changed_by(piece);
    for (SetNumber& each : numbers) each.varies = !by.row(number_row(each.name) - motion_->momenta()).isZero(0);
    step->push_back(std::make_shared<ReplacedRows>(motion_->momenta(), by));
  }
  if (kick.size() > 0) motion_->kick(kick);
  if (!numbers.empty()) motion_->set(numbers);
  const Switching what = switching_of(piece);
  if (what.empty()) return;
  if (step != nullptr) {
    follow_switch(piece, what, *step);
  } else {
    motion_->switch_to(what, /*linearised=*/false);
  }
}

/// None where nothing is kicked.
Eigen::VectorXd MotionThroughEvents::kick_of(const Piece& piece, const VariedVector& seen) const {
  Eigen::VectorXd out;
  for (const std::size_t i : piece.events) {
    if (!events_[i].kick) continue;
    const VariedVector by = events_[i].kick(seen);
    if (by.size() != motion_->momenta())
      throw std::invalid_argument(fmt::format("event \"{}\": its kick has {} numbers, the momentum has {}",
                                              events_[i].name, by.size(), motion_->momenta()));
    if (out.size() == 0) out = Eigen::VectorXd::Zero(by.size());
    for (Eigen::Index k = 0; k < out.size(); ++k) out(k) += by(k).value;
    if (!out.allFinite())
      throw std::domain_error(fmt::format("the kick of event \"{}\" is no finite number", events_[i].name));
  }
  return out;
}

std::vector<SetNumber> MotionThroughEvents::numbers_of(const Piece& piece, const VariedVector& seen) const {
  std::vector<SetNumber> out;
  for (const std::size_t i : piece.events)
    for (const ObservedEvent::Setting& each : events_[i].set) out.push_back({each.name, each.number(seen).value});
  return out;
}

Switching MotionThroughEvents::switching_of(const Piece& piece) const {
  Switching out;
  for (const std::size_t i : piece.events)
    out.insert(out.end(), events_[i].switches.begin(), events_[i].switches.end());
  return out;
}

void MotionThroughEvents::serialize(NumberArchive& archive) {
  motion_->serialize(archive);
  const Unnamed unnamed{archive};
  for (FunctionWatch& watch : watches_) watch.serialize(unnamed);
  archive(happened_, steps_, is_over_);
}

}  // namespace lagroid
