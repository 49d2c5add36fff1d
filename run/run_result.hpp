#pragma once
/// What a run returns, whatever the system: columns of numbers along the trajectory, the ledger, how it ended, and what
/// its pictures show.
///
/// Reports, files and plots are made of it and of nothing else.
///
///     for (const LedgerEntry& entry : result.ledger.entries)
///       if (entry.broken()) std::cerr << entry.name << " drifted by " << entry.drift << '\n';
///
/// A run that ended early has a `status` other than "converged", a `message`, and all that was computed until then.

#include <lagroid/run/motion/shape.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid {

/// One sampled quantity along a trajectory: `width` numbers a row.
struct Columns {
  std::string name;                     ///< dataset name in HDF5
  std::vector<std::string> components;  ///< column labels in CSV
  std::string unit;
  std::string meaning;
  bool on_arrows = false;      ///< one row per arrow, beginning with the first, instead of one per node
  std::vector<double> values;  ///< row after row
  std::size_t width() const { return components.size(); }
};

struct Trajectory {
  std::vector<double> time;  ///< of the nodes, s
  std::vector<Columns> series;
  std::map<std::string, std::string> conventions;  ///< attributes of the file
};

/// A state as users see it.
struct Endpoint {
  double time = 0;  ///< s
  std::vector<double> position;
  std::optional<std::array<double, 4>> attitude;       ///< A, unit quaternion w, x, y, z
  std::optional<std::array<double, 4>> body_attitude;  ///< A^T where the physical body is the transpose
  std::vector<double> momentum;
};

/// Of a boundary value: a path that was found, and what kind of stationary point of the action it is.
struct StationaryPath {
  double cost = 0;
  int starts = 0;  ///< that led to it; none where a way down from a saddle did
  std::vector<double> momentum;
  bool is_minimum = false;
  bool isolated = true;
  bool normal = true;
  long negative_directions = 0;
};

/// One line of the ledger: what was promised, what was found.
struct LedgerEntry {
  std::string name;
  std::string promise;  ///< "round-off", "conserved", "bounded", "none", "counted"
  std::vector<double> initial;
  std::vector<double> final;
  double drift = 0;  ///< largest deviation from the initial value
  /// The same over the size of the initial value: of its terms where that is round-off of theirs, over 1 where it is 0.
  double relative_drift = 0;
  double bound = 0;     ///< on `drift`; zero where none is promised
  std::string verdict;  ///< "kept", "BROKEN", "bounded", "growing", "unjudged", "watched", "counted"
  std::string reason;   ///< of a verdict that drift and bound do not explain; else empty
  bool broken() const { return verdict == "BROKEN"; }
};

struct Ledger {
  std::vector<LedgerEntry> entries;
  double mean_iterations = 0;
  int most_iterations = 0;
};

/// A plot panel: curves by CSV column label.
struct Panel {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::string x;                    ///< column on the x axis
  std::vector<std::string> curves;  ///< columns
  bool equal_axes = false;
  double x_offset = 0;  ///< shown is the column less this
  double y_offset = 0;
};

/// How the function of an event was where it happened.
enum class Passing {
  rising,    ///< it passed zero upwards
  falling,   ///< downwards
  touching,  ///< it came to zero, and went back
  minimum,
  maximum
};
std::string_view to_string(Passing passing);

/// An event that happened.
struct Happening {
  std::size_t event = 0;  ///< which of EventTable::watched
  long step = 0;          ///< in which it did, from 1 on
  double time = 0;        ///< s
  double time_error = 0;  ///< what rounding of the function leaves open of it (FunctionWatch::uncertainty), s
  Passing passing = Passing::rising;
  bool together = false;       ///< at the same time as the one before, as far as times can be told apart
  std::vector<double> values;  ///< of the node's columns, EventTable::columns
};

/// An event that was watched for.
struct WatchedEvent {
  std::string name;
  std::string when;
  std::vector<std::string> plot{};  ///< two columns over each other, a section; or none
  long count = 0;                   ///< how often it happened
  long touches = 0;                 ///< how often its function came to zero without passing it
};

/// What happened in a run, in the order of time.
struct EventTable {
  std::vector<WatchedEvent> watched;
  std::vector<std::string> columns;  ///< of a node: those of the trajectory, without what belongs to arrows
  std::vector<Happening> rows;
};

/// When an event happened, touches left out.
struct EventSpan {
  double first = 0;
  double last = 0;
  double mean_interval = 0;  ///< zero where it happened once
  double error = 0;          ///< of that, by those of the first and the last time
};
/// None where it did not.
std::optional<EventSpan> span_of(const EventTable& events, std::size_t event);

/// The status of a run that Ctrl-C or SIGTERM ended.
inline constexpr const char* interrupted_status = "interrupted";

struct RunResult {
  std::string system;
  std::string method;                ///< of an initial value, and what it declares
  std::string status = "converged";  ///< of the solve: this or a typed failure
  std::string message;               ///< why, at which step, what to do
  std::string output_error;          ///< why the files of the run could not be written
  long steps = 0;                    ///< arrows computed
  long steps_asked = 0;
  double seconds = 0;
  long iterations = 0;
  std::optional<double> cost;
  std::optional<double> residual;  ///< of a solve that failed: the smallest scaled residual found
  Endpoint initial;
  Endpoint final;
  std::vector<double> first_multipliers;
  std::vector<double> last_multipliers;
  int starts = 0;  ///< of a boundary value, all that were made
  std::vector<StationaryPath> stationary_paths;
  std::vector<std::string> notes;
  Ledger ledger;
  Trajectory trajectory;
  EventTable events;
  std::vector<Panel> panels;
  std::vector<Shape> shapes;

  bool converged() const { return status == "converged"; }
  bool interrupted() const { return status == interrupted_status; }
};

}  // namespace lagroid
