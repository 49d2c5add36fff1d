#include "event_gradient.hpp"

#include "checks/differences.hpp"
#include "checks/run_growth.hpp"

#include <lagroid/run/events/event_watch.hpp>
#include <lagroid/run/files/output_folder.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace lagroid::app {

namespace {

std::vector<std::string> names_in(const std::vector<GradientName>& observed) {
  std::vector<std::string> names{"t"};
  for (const GradientName& each : observed) names.push_back(each.name);
  return names;
}
VariedExpression smooth(const std::string& text, const std::string& event, const std::vector<std::string>& names) try {
  return {text, names};
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(fmt::format("event \"{}\": \"{}\": {}; derivatives are of {}", event, text, error.what(),
                                          fmt::join(names, ", ")));
}

/// A row with its name: final.q, event.floor.1.t.
struct Row : EventRow {
  std::string name = {};
};
Row row_at(EventRow place, std::string name) { return {place, std::move(name)}; }

/// A number that a word ends with, or goes on after with a dot; the rest of the word, behind it.
std::optional<std::pair<long, std::string>> number_first(const std::string& word) {
  long number = 0;
  const auto read = std::from_chars(word.data(), word.data() + word.size(), number);
  const std::size_t end = std::size_t(read.ptr - word.data());
  if (read.ec != std::errc() || (end < word.size() && word[end] != '.')) return std::nullopt;
  return std::pair(number, word.substr(std::min(word.size(), end + 1)));
}

class Rows {
 public:
  Rows(const GradientSubject& subject, const GradientColumns& columns, const EventSensitivities& run)
      : subject_(subject), columns_(columns), run_(run) {}

  std::vector<Row> of(const std::string& word) const {
    if (word == "final" || word.starts_with("final."))
      return columns({}, "final", word.substr(std::min<std::size_t>(6, word.size())), word);
    if (word.starts_with("node.")) {
      const auto number = number_first(word.substr(5));
      if (!number || number->first < 0 || number->first > subject_.steps)
        throw GradientRefused(fmt::format("{}: a node is a number from 0 to {}", word, subject_.steps));
      return columns({.node = number->first}, fmt::format("node.{}", number->first), number->second, word);
    }
    if (word == "events") return times();
    if (const auto event = event_of(word)) {
      const auto& [i, number, column] = *event;
      require_happened(i, number, word);
      return columns({.event = int(i), .which = number - 1}, fmt::format("event.{}.{}", subject_.events[i], number),
                     column, word);
    }
    throw GradientRefused(
        fmt::format("{}: ask for final.NAME, node.K.NAME, events or event.NAME.K.COLUMN; the events are {}", word,
                    fmt::join(subject_.events, ", ")));
  }

 private:
  /// Of event.NAME.K.COLUMN: the event of the longest name that fits, K and the column.
  std::optional<std::tuple<std::size_t, long, std::string>> event_of(const std::string& word) const {
    std::optional<std::tuple<std::size_t, long, std::string>> out;
    std::size_t longest = 0;
    for (std::size_t i = 0; i < subject_.events.size(); ++i) {
      const std::string start = "event." + subject_.events[i] + ".";
      if (!word.starts_with(start) || start.size() <= longest) continue;
      const auto number = number_first(word.substr(start.size()));
      if (!number) continue;
      longest = start.size();
      out.emplace(i, number->first, number->second);
    }
    return out;
  }
  /// All columns, those of a group, or one.
  std::vector<Row> columns(EventRow place, const std::string& where, const std::string& name,
                           const std::string& word) const {
    std::vector<Row> out;
    const auto add = [&](int column, const std::string& called) {
      place.column = column;
      out.push_back(row_at(place, where + "." + called));
    };
    if (place.node < 0 && (name == "t" || name.empty())) add(-1, "t");
    if (name != "t")
      for (const int column : chosen_rows(subject_, word, name))
        add(column, subject_.observed[std::size_t(column)].name);
    if (out.empty()) throw GradientRefused(fmt::format("{}: the times of nodes depend on nothing", word));
    return out;
  }
  std::vector<Row> times() const {
    std::vector<Row> out;
    std::vector<long> counts(subject_.events.size(), 0);
    for (const auto& each : run_.happened) {
      const long which = counts[each.event]++;
      require_counted(each.event, "events");
      out.push_back(row_at({.event = int(each.event), .which = which},
                           fmt::format("event.{}.{}.t", subject_.events[each.event], which + 1)));
    }
    if (out.empty()) throw GradientRefused("events: none has happened");
    return out;
  }
  void require_happened(std::size_t event, long number, const std::string& word) const {
    const auto happened = std::count_if(run_.happened.begin(), run_.happened.end(),
                                        [&](const auto& each) { return each.event == event; });
    if (number < 1 || number > happened)
      throw GradientRefused(fmt::format("{}: \"{}\" has happened {} times, which are counted from 1", word,
                                        subject_.events[event], happened));
    require_counted(event, word);
  }
  void require_counted(std::size_t event, const std::string& word) const {
    const bool is_moved = std::any_of(run_.begun.begin(), run_.begun.end(), [&](const EventSensitivities::Begun& each) {
      return each.event == event && depends_on(columns_, each);
    });
    if (is_moved)
      throw GradientRefused(
          fmt::format("{}: the function of event \"{}\" is zero at the start, and beside it once more "
                      "or not: which time is which has no derivative; ask for final",
                      word, subject_.events[event]));
  }

  /// Whether what is zero at the start changes with some column there.
  static bool depends_on(const GradientColumns& columns, const EventSensitivities::Begun& begun) {
    constexpr double rounding = 1e-12;
    const double most = std::max(largest(begun.by_start), largest(begun.by_parameters));
    const bool by_start = std::any_of(columns.start.begin(), columns.start.end(),
                                      [&](int i) { return std::abs(begun.by_start(i)) > rounding * most; });
    return by_start || largest(begun.by_parameters) > rounding * most;
  }
  static double largest(const Eigen::RowVectorXd& row) { return row.size() == 0 ? 0 : row.cwiseAbs().maxCoeff(); }

  const GradientSubject& subject_;
  const GradientColumns& columns_;
  const EventSensitivities& run_;
};

/// Of a run: the value of a row with its derivatives by starts and by parameters. None where there is no such row.
struct Read {
  double value;
  Eigen::RowVectorXd by_start;
  Eigen::RowVectorXd by_parameters;
};
std::optional<Read> read(const EventSensitivities& run, const EventRow& row) {
  const auto of_column = [&](const auto& place) {
    return Read{place.observed(row.column), place.observed_by_start.row(row.column),
                place.observed_by_parameters.row(row.column)};
  };
  if (row.event < 0) {
    if (row.node > run.steps) return std::nullopt;
    if (row.column >= 0) return of_column(run);
    if (run.is_stopped) return Read{run.time, run.happened.back().by_start, run.happened.back().by_parameters};
    return Read{run.time, Eigen::RowVectorXd::Zero(run.by_start.cols()),
                Eigen::RowVectorXd::Zero(run.by_parameters.cols())};
  }
  long left = row.which;
  for (const auto& each : run.happened)
    if (each.event == std::size_t(row.event) && left-- == 0) {
      if (row.column >= 0) return of_column(each);
      return Read{each.time, each.by_start, each.by_parameters};
    }
  return std::nullopt;
}

/// What happened of that on which the rows of a table depend, in its order: what decides, and what they are of.
std::vector<std::size_t> which_happened(const GradientSubject& subject, const GradientTable& table,
                                        const EventSensitivities& run) {
  const auto is_asked = [&](std::size_t event) {
    return std::any_of(table.event_rows.begin(), table.event_rows.end(),
                       [&](const EventRow& row) { return row.event == int(event); });
  };
  std::vector<std::size_t> out;
  for (const auto& each : run.happened)
    if (subject.events_decide[each.event] != 0 || is_asked(each.event)) out.push_back(each.event);
  return out;
}

/// How fast each column takes some event to the nearest node, over how far it is from there: where it passes it the
/// partial step is one from another node, and the derivative has a kink there of the order of the method.
Eigen::ArrayXd rates_of_passing_nodes(const EventSensitivities& run, const GradientColumns& columns,
                                      LinearisedMotion& at_start) {
  constexpr double nearest = 1e-7;  // of a step
  const auto from_start = Eigen::Index(columns.start.size());
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(from_start + Eigen::Index(columns.parameters.size()));
  const double begun = at_start.time();
  at_start.pass();
  const double step = at_start.time() - begun;
  for (const auto& each : run.happened) {
    const double nodes = (each.time - begun) / step;
    const double away = step * std::max(nearest, std::abs(nodes - std::round(nodes)));
    for (Eigen::Index j = 0; j < from_start; ++j)
      out(j) = std::max(out(j), std::abs(each.by_start(columns.start[std::size_t(j)])) / away);
    for (Eigen::Index j = from_start; j < out.size(); ++j)
      out(j) = std::max(out(j), std::abs(each.by_parameters(j - from_start)) / away);
  }
  return out;
}

/// The run as far as a node is asked for: one for each node, and one for the rest.
class Runs {
 public:
  Runs(const GradientSubject& subject, std::vector<std::string> parameters, std::vector<Nudge> nudges, ThroughEvents by)
      : subject_(subject), parameters_(std::move(parameters)), nudges_(std::move(nudges)), by_(by) {}
  const EventSensitivities& to(long node) {
    const auto found = runs_.find(node);
    if (found != runs_.end()) return found->second;
    return runs_.emplace(node, subject_.through_events(parameters_, nudges_, node, by_)).first->second;
  }

 private:
  const GradientSubject& subject_;
  std::vector<std::string> parameters_;
  std::vector<Nudge> nudges_;
  ThroughEvents by_;
  std::map<long, EventSensitivities> runs_;
};

/// Refuses numbers along which an event at the start would happen there or not, of the start and of parameters, in the
/// order of why_none(parameters). Returns the places of those of the start.
std::vector<int> refuse_at_start(
    const std::function<std::vector<std::string>(const std::vector<std::string>& parameters)>& why_none,
    GradientSubject& subject) {
  std::vector<std::string> parameters, names;
  for (const GradientName& each : subject.parameters) parameters.push_back(each.name);
  for (const GradientName& each : subject.start) names.push_back("initial." + each.name);
  for (const std::string& each : parameters) names.push_back("parameters." + each);
  const std::vector<std::string> why = why_none(parameters);
  std::vector<int> of_start;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (why[i].empty()) continue;
    subject.refused.emplace_back(names[i], why[i]);
    if (i < subject.start.size()) of_start.push_back(int(i));
  }
  return of_start;
}

}  // namespace

EventExpressions::EventExpressions(const Event& event, const std::vector<GradientName>& observed, int momenta)
    : when(smooth(event.when, event.name, names_in(observed))) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format("event \"{}\": {}; leave it out", event.name, why));
  };
  if (event.at != Event::At::zero) refuse("derivatives are of events at zero, not of minima and maxima");
  if (event.call) refuse("what it calls has no derivative");
  if (!event.kick.empty() && int(event.kick.size()) != momenta)
    refuse(fmt::format("its kick has {} numbers, the momentum has {}", event.kick.size(), momenta));
  for (const std::string& text : event.kick) kick.push_back(smooth(text, event.name, names_in(observed)));
  for (const auto& [name, text] : event.set) set.emplace_back(name, smooth(text, event.name, names_in(observed)));
}

ObservedEvent observed_event(const Event& event, const std::shared_ptr<EventExpressions>& texts, bool sets) {
  if (!event.set.empty() && !sets)
    throw std::invalid_argument(
        fmt::format("event \"{}\": what it sets has derivatives in runs of systems by equal variational steps alone; "
                    "leave it out",
                    event.name));
  ObservedEvent out{.name = event.name,
                    .when = event.when,
                    .function = [texts](const VariedVector& seen) { return texts->when(seen); },
                    .direction = event.direction,
                    .then = event.then,
                    .count = event.count};
  out.tolerance = std::max(event.tolerance, out.tolerance);
  for (std::size_t k = 0; k < texts->set.size(); ++k)
    out.set.push_back(
        {texts->set[k].first, [texts, k](const VariedVector& seen) { return texts->set[k].second(seen); }});
  return out;
}

std::vector<ObservedEvent> observed_events(const std::vector<Event>& events, const std::vector<GradientName>& observed,
                                           int momenta, bool sets) {
  std::vector<ObservedEvent> out;
  for (const Event& event : events) {
    const auto texts = std::make_shared<EventExpressions>(event, observed, momenta);
    ObservedEvent& smooth = out.emplace_back(observed_event(event, texts, sets));
    if (event.kick.empty()) continue;
    smooth.kick = [texts](const VariedVector& seen) {
      VariedVector by(Eigen::Index(texts->kick.size()));
      for (std::size_t k = 0; k < texts->kick.size(); ++k) by(Eigen::Index(k)) = texts->kick[k](seen);
      return by;
    };
  }
  return out;
}

std::vector<std::string> numbers_set(const std::vector<ObservedEvent>& events) {
  std::vector<std::string> out;
  for (const ObservedEvent& event : events)
    for (const ObservedEvent::Setting& each : event.set) out.push_back(each.name);
  return out;
}

void go_through_events(const BeginCuttable& begin, const std::vector<ObservedEvent>& events, GradientSubject& subject) {
  for (const ObservedEvent& event : events) {
    subject.events.push_back(event.name);
    subject.events_decide.push_back(event.decides());
  }
  // Numbers that are set are parameters of such motions, whether they are asked for or not.
  const bool sets = !numbers_set(events).empty();
  subject.begins_through_events = !sets && std::none_of(events.begin(), events.end(), [](const ObservedEvent& each) {
    return each.then == Event::Then::stop;
  });
  if (!sets) {
    subject.begin = [begin, events](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
      return std::make_unique<MotionThroughEvents>(begin(parameters, nudges), events);
    };
    subject.begin_along = [](LinearisedMotion& begun_motion, const Eigen::MatrixXd& directions) {
      dynamic_cast<MotionThroughEvents&>(begun_motion).begin_along(directions);
    };
  }
  const auto all_directions = [begun_by = subject.begun_by, starts = Eigen::Index(subject.start.size())](
                                  const MotionThroughEvents& of, const std::vector<std::string>& parameters,
                                  const std::vector<Nudge>& nudges) {
    const auto of_numbers = Eigen::Index(parameters.size());
    Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(of.states() + of.parameters(), starts + of_numbers);
    directions.block(of.states(), starts, of_numbers, of_numbers).setIdentity();
    const Eigen::MatrixXd begun =
        begun_by ? begun_by(parameters, nudges) : Eigen::MatrixXd::Identity(starts, directions.cols());
    directions.topRows(begun.rows()) = begun;
    return directions;
  };
  const std::vector<int> refused_start = refuse_at_start(
      [&](const std::vector<std::string>& parameters) {
        MotionThroughEvents first(begin(parameters, {}), events);
        return first.why_none_along(all_directions(first, parameters, {}));
      },
      subject);
  subject.through_events = [begin, events, all_directions, refused_start, steps = subject.steps](
                               const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges, long node,
                               ThroughEvents by) {
    MotionThroughEvents through(begin(parameters, nudges), events);
    Eigen::MatrixXd directions = all_directions(through, parameters, nudges);
    for (const int each : refused_start) directions.col(each).setZero();
    const Eigen::Index asked = by == ThroughEvents::start_too    ? directions.cols()
                               : by == ThroughEvents::parameters ? Eigen::Index(parameters.size())
                                                                 : 0;
    return through.run(steps, directions.rightCols(asked), node, int(parameters.size()));
  };
}

void require_events(const std::vector<Event>& events, Motion& motion) try {
  const EventWatch watch(events, motion);
} catch (const RunError& error) {
  throw std::invalid_argument(error.what());
}

std::optional<ValuesBeside> values_through_events(const GradientSubject& subject, const GradientTable& table,
                                                  const std::vector<Nudge>& nudges) {
  Runs runs(subject, {}, nudges, ThroughEvents::values_alone);
  const EventSensitivities& whole = runs.to(-1);
  const std::vector<std::size_t> happened = which_happened(subject, table, whole);
  // Where one run is stopped and the other is not, or by another event, `final` is another place.
  const bool same_end =
      whole.is_stopped == table.is_stopped && (!table.is_stopped || happened.back() == table.happened.back());
  if (!whole.converged() || !same_end) return std::nullopt;
  Eigen::VectorXd out(Eigen::Index(table.rows.size()));
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const EventSensitivities& run = runs.to(table.event_rows[i].node);
    const auto value = run.converged() ? read(run, table.event_rows[i]) : std::nullopt;
    if (!value) return std::nullopt;
    out(Eigen::Index(i)) = value->value;
  }
  // Which passage is the K-th is told where all before it are the same.
  const bool is_of_events =
      std::any_of(table.event_rows.begin(), table.event_rows.end(), [](const EventRow& row) { return row.event >= 0; });
  const bool same_events = happened == table.happened;
  if (is_of_events && !same_events) return std::nullopt;
  return ValuesBeside{out, same_events};
}

GradientTable differentiate_through_events(const GradientSubject& subject, const std::vector<std::string>& of,
                                           const std::vector<std::string>& by, bool check) {
  GradientTable out = table_of(subject, by, check);
  const GradientColumns columns = columns_of(subject, by);
  Runs runs(subject, names_of(subject, columns), {},
            columns.start.empty() ? ThroughEvents::parameters : ThroughEvents::start_too);
  const EventSensitivities& whole = runs.to(-1);
  out.steps_solved = whole.steps;
  out.states_kept = 1;
  out.notes.insert(out.notes.end(), whole.notes.begin(), whole.notes.end());
  if (!whole.converged()) {
    out.failure = whole.message;
    return out;
  }
  out.is_stopped = whole.is_stopped;
  if (whole.is_stopped) {
    out.steps = whole.steps + 1;  // the last one in part
    out.notes.push_back(fmt::format("an event stops the run at t = {:.6g}", whole.time));
  }
  std::vector<Row> rows;
  for (const std::string& word : of)
    for (Row& row : Rows(subject, columns, whole).of(word))
      if (std::none_of(rows.begin(), rows.end(), [&](const Row& each) { return each.name == row.name; }))
        rows.push_back(std::move(row));
  const auto width = Eigen::Index(out.columns.size());
  out.values.resize(Eigen::Index(rows.size()));
  out.derivatives.resize(Eigen::Index(rows.size()), width);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const EventSensitivities& run = runs.to(rows[i].node);
    if (!run.converged()) {
      out.failure = run.message;
      return out;
    }
    const auto found = read(run, rows[i]);
    if (!found)
      throw GradientRefused(fmt::format("{}: the run is stopped at t = {:.6g}, before this node; ask for final",
                                        rows[i].name, whole.time));
    out.event_rows.push_back(rows[i]);
    const auto at = Eigen::Index(i);
    out.rows.push_back(rows[i].name);
    out.values(at) = found->value;
    for (std::size_t j = 0; j < columns.start.size(); ++j)
      out.derivatives(at, Eigen::Index(j)) = found->by_start(columns.start[j]);
    for (std::size_t j = 0; j < columns.parameters.size(); ++j)
      out.derivatives(at, Eigen::Index(columns.start.size() + j)) = found->by_parameters(Eigen::Index(j));
  }
  out.happened = which_happened(subject, out, whole);
  SizesOfUnits sizes;
  see(subject, subject.begin({}, {})->observe().values, sizes);
  see(subject, whole.observed, sizes);
  for (const auto& each : whole.happened) see(subject, each.observed, sizes);
  const RunGrowth growth(subject, sizes);
  const bool by_start = whole.observed_by_start.cols() == Eigen::Index(subject.start.size());
  const Eigen::MatrixXd observed_by_start =
      by_start ? whole.observed_by_start
               : subject.through_events({}, {}, -1, ThroughEvents::start_too).observed_by_start;
  set_growth(out, growth.factor(observed_by_start * growth.along()));
  if (check)
    compare_with_differences(subject, columns, out,
                             [&](const std::vector<Nudge>& nudges) -> std::optional<Eigen::VectorXd> {
                               const auto found = values_through_events(subject, out, nudges);
                               return found && found->same_events ? std::optional(found->values) : std::nullopt;
                             },
                             {.where_none = "end early or have other events",
                              .sizes = sizes,
                              .growth = out.growth,
                              .tolerance = subject.tolerance,
                              .rates = rates_of_passing_nodes(whole, columns, *subject.begin({}, {}))});
  return out;
}

}  // namespace lagroid::app
