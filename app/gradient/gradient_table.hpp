#pragma once
/// The derivatives that `lagroid gradient` was asked for, and how they are printed.
///
///     const GradientTable table = differentiate(subject, {"final.position"}, {"parameters.strength"}, true);
///     print(text_of(table));
///
/// Errors: GradientRefused, one line, for what has no derivative or no such name.

#include "gradient_subject.hpp"

#include <lagroid/solvers/sensitivity/propagate.hpp>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::app {

class GradientRefused : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a row shows of a run through events: the time, or what is observed, of the end, a node or an event.
struct EventRow {
  long node = -1;   ///< -1: the end
  int event = -1;   ///< of the scene, or none
  long which = 0;   ///< the how-manieth time it happened, from zero
  int column = -1;  ///< of what is observed; -1: the time
};

struct GradientTable {
  std::string system;
  long steps = 0;
  std::vector<std::string> rows;     ///< final.x, node.10.px, integral.x
  std::vector<int> observed;         ///< their places in GradientSubject::observed
  std::vector<std::string> columns;  ///< initial.x, parameters.strength
  Eigen::VectorXd values;            ///< of the rows
  Eigen::MatrixXd derivatives;
  double growth = 1;  ///< of errors of the start, whatever columns there are (checks/run_growth.hpp)
  double digits_left = 0;
  long steps_solved = 0;
  long states_kept = 0;
  bool checked = false;
  Eigen::MatrixXd differences;   ///< extrapolated, of the program
  double digits_agreed = 0;      ///< the fewest, to the largest of each row
  bool within_rounding = false;  ///< whether all rows agree to the rounding of differences, which has these digits
  std::vector<std::string> contradicted;  ///< by differences, as `final.q by parameters.length`
  std::vector<std::string> untold;        ///< of which differences tell nothing
  std::string failure;                    ///< of a run that ended early
  std::vector<EventRow> event_rows;       ///< through events: what the rows are
  std::vector<std::size_t> happened;      ///< through events: which, in their order, of those that rows depend on
  bool is_stopped = false;                ///< by the last of what happened
  std::vector<std::string> notes;         ///< on them
  bool of_boundary_value = false;         ///< its row is the cost
};

/// The starts and the parameters that words initial.NAME and parameters.NAME choose, each once.
struct GradientColumns {
  std::vector<int> start;       ///< places in GradientSubject::start
  std::vector<int> parameters;  ///< and in GradientSubject::parameters
  std::vector<int> left_out;    ///< in GradientSubject::refused, which a word chooses among others
};
/// Throws GradientRefused for a word that chooses nothing, or nothing that has a derivative.
GradientColumns columns_of(const GradientSubject& subject, const std::vector<std::string>& words);
/// Which numbers are left out and why, a line for each reason.
std::vector<std::string> notes_on_left_out(const GradientSubject& subject, const GradientColumns& columns);
/// The names of its parameters.
std::vector<std::string> names_of(const GradientSubject& subject, const GradientColumns& columns);
/// Those directions of the state and, below it, the parameters, in which it begins: a column for each of these.
Eigen::MatrixXd directions_of(const GradientSubject& subject, const GradientColumns& columns,
                              const std::vector<Nudge>& nudges, Eigen::Index states);
/// What `name` chooses: all, those of a group, or one.
std::vector<int> chosen_names(const std::vector<GradientName>& all, const std::string& word, const std::string& name);
/// The same of what is observed; throws GradientRefused, with the reason, for what has no derivative.
std::vector<int> chosen_rows(const GradientSubject& subject, const std::string& word, const std::string& name);

/// A table with its columns, still without rows.
GradientTable table_of(const GradientSubject& subject, const std::vector<std::string>& by, bool check);
void set_growth(GradientTable& table, double growth);
/// Of sixteen.
double digits_left_by(double growth);

/// The rows of a table, one after another, of a run from a start that differs.
struct ValuesBeside {
  Eigen::VectorXd values;
  bool same_events = true;  ///< whether what happened is what the table has, in its order
};
/// None where the run ended early or by another event, and of rows of events where other ones happened.
std::optional<ValuesBeside> values_of(const GradientSubject& subject, const GradientTable& table,
                                      const std::vector<Nudge>& nudges);

/// With a budget the way is back, whatever is cheaper; GradientRefused where there is no such way.
GradientTable differentiate(const GradientSubject& subject, const std::vector<std::string>& of,
                            const std::vector<std::string>& by, bool check, StateBudget budget = {});

/// By how much derivatives grew, and the notes: the end of what is printed of them.
std::string words_of_growth(const GradientTable& table);
std::string text_of(const GradientTable& table);
std::string json_of(const GradientTable& table);

}  // namespace lagroid::app
