#include "measured.hpp"

#include "../../reading/csv_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace lagroid::app {

namespace {

/// The times of a subject's nodes; no step where it varies.
struct Nodes {
  double start;
  double step;
  long count;  ///< of the scene's own run
};
Nodes nodes_of(const GradientSubject& subject) {
  if (subject.through_events && !subject.begins_through_events)
    throw GradientRefused("a fit takes runs without events that end them or set numbers; leave those out");
  const auto motion = subject.begin({}, {});
  const double start = motion->time();
  if (!motion->has_equal_steps()) return {start, 0, 0};
  if (!motion->advance().converged()) throw GradientRefused("the first step of the scene's own run does not converge");
  return {start, motion->time() - start, subject.steps};
}

/// Where steps vary, times are those of no node.
long node_at(double time, const Nodes& nodes, const std::string& file, long line) {
  const auto refuse = [&](const std::string& why) {
    throw DataError(fmt::format("{}: row {}: t = {:.10g} is {}", file, line, time, why));
  };
  const double steps = nodes.step == 0 ? time - nodes.start : (time - nodes.start) / nodes.step;
  if (!(steps >= -1e-6)) refuse(fmt::format("before the start of the run, {:g}", nodes.start));
  if (nodes.step == 0) return -1;
  // Runs of a fit go as far as the data do; one far longer than the scene's, many times over, is hardly meant.
  if (steps > std::max(1e6, 10 * double(nodes.count)))
    refuse(
        fmt::format("{:.10g} steps after the start, and the scene's run has {}; give it as many by time.steps, if that "
                    "is meant",
                    std::ceil(steps), nodes.count));
  const double nearest = std::round(steps);
  if (std::abs(steps - nearest) > 1e-6)
    refuse(fmt::format("no node of the run, which has them at {:g} + k {:g}; choose a time.step that divides the times",
                       nodes.start, nodes.step));
  return long(nearest);
}

/// Rows are numbered from one, as lines would be.
CsvTable table_of_series(const std::string& file) {
  CsvTable out;
  out.names = {"t"};
  read_series(file, [&](const std::vector<double>& time, const RecordedSeries& series) {
    for (std::size_t k = out.rows.size(); k < time.size(); ++k) {
      out.rows.push_back({time[k]});
      out.lines.push_back(long(k) + 1);
    }
    for (const std::string& name : series.columns) {
      if (out.column(name) != CsvTable::npos)
        throw DataError(fmt::format("{}: there are two columns {}; leave one", file, name));
      out.names.push_back(name);
    }
    for (std::size_t k = 0; k < time.size(); ++k)
      for (std::size_t c = 0; c < series.columns.size(); ++c) out.rows[k].push_back(series.at(k, c));
  });
  return out;
}

constexpr double largest = 1e100;  // of sigma: more has no sum of squares

/// One who reads the columns of several files.
class Reader {
 public:
  Reader(const GradientSubject& subject, const FitOptions& options, Fit& fit)
      : subject_(subject), options_(options), fit_(fit), nodes_(nodes_of(subject)) {
    for (const auto& [name, sigma] : options.sigma) number_of(name);
    for (const std::string& name : options.columns) column_of(name);
  }

  MeasuredRun read(const std::string& file) {
    const CsvTable table =
        is_hdf5(file) ? table_of_series(file) : read_csv_table(file, "t and columns of the run", Gaps::allowed);
    const std::size_t time = table.column("t");
    if (time == CsvTable::npos) throw DataError(fmt::format("{}: no column t, the time, in the header", file));
    MeasuredRun out;
    long gaps = 0;
    for (std::size_t c = 0; c < table.names.size(); ++c) {
      const std::string& name = table.names[c];
      if (c == time) continue;
      const auto column = wanted(name);
      if (!column) continue;
      const auto given = options_.sigma.find(name);
      const double sigma = given == options_.sigma.end() ? 1 : given->second;
      const long before = gaps;
      for (std::size_t k = 0; k < table.rows.size(); ++k) {
        const double at = table.rows[k][time], value = table.rows[k][c];
        if (!std::isfinite(at)) throw DataError(fmt::format("{}: row {}: it has no time", file, table.lines[k]));
        if (std::isnan(value)) {
          ++gaps;
          continue;
        }
        if (std::isinf(value))
          throw DataError(fmt::format("{}: row {}: {} is infinite; leave the field empty", file, table.lines[k], name));
        if (!(std::abs(value) < largest * sigma))
          throw DataError(
              fmt::format("{}: row {}: {} = {:g} is beyond {:g} sigma, whose squares are no numbers; leave "
                          "the field empty, or measure in another unit",
                          file, table.lines[k], name, value, largest));
        out.push_back({node_at(at, nodes_, file, table.lines[k]), at, number_of(name), *column, value, sigma});
      }
      if (gaps > before)
        fit_.notes.push_back(fmt::format("{}: of {} {} of {} fields are empty or NaN, and are left out", file, name,
                                         gaps - before, table.rows.size()));
    }
    if (table.rows.empty()) throw DataError(fmt::format("{}: it has a header and no rows", file));
    if (out.empty() && gaps > 0) throw DataError(fmt::format("{}: all fields that count are empty or NaN", file));
    if (out.empty())
      throw DataError(fmt::format("{}: nothing in it is a column of the run{}; there are {}", file,
                                  options_.columns.empty() ? "" : " that --of names", fmt::join(names(), ", ")));
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
    return out;
  }

 private:
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const GradientName& each : subject_.observed) out.push_back(each.name);
    return out;
  }
  auto observed_as(const std::string& name) const {
    return std::find_if(subject_.observed.begin(), subject_.observed.end(),
                        [&](const GradientName& each) { return each.name == name; });
  }
  int number_of(const std::string& name) const {
    const auto found = observed_as(name);
    if (found != subject_.observed.end()) return int(found - subject_.observed.begin());
    throw GradientRefused(fmt::format("{}: no such column of the run; there are {}", name, fmt::join(names(), ", ")));
  }
  std::size_t column_of(const std::string& name) {
    number_of(name);
    for (std::size_t i = 0; i < fit_.columns.size(); ++i)
      if (fit_.columns[i].name == name) return i;
    fit_.columns.push_back({name});
    return fit_.columns.size() - 1;
  }
  /// The column to be fitted of that name, if there is one.
  std::optional<std::size_t> wanted(const std::string& name) {
    const auto known = observed_as(name);
    const bool is_known = known != subject_.observed.end();
    const bool is_named = std::find(options_.columns.begin(), options_.columns.end(), name) != options_.columns.end();
    // What is computed of the state says nothing that the state does not.
    const bool is_chosen = is_named || (options_.columns.empty() && is_known && !known->only_by_name);
    if (is_known && is_chosen) return column_of(name);
    std::vector<std::string>& unused = is_known ? fit_.left_out : fit_.ignored;
    if (std::find(unused.begin(), unused.end(), name) == unused.end()) unused.push_back(name);
    return std::nullopt;
  }

  const GradientSubject& subject_;
  const FitOptions& options_;
  Fit& fit_;
  Nodes nodes_;
};

}  // namespace

std::vector<MeasuredRun> read_measured(const GradientSubject& subject, const std::vector<std::string>& files,
                                       const FitOptions& options, Fit& fit) {
  std::vector<MeasuredRun> out;
  Reader reader(subject, options, fit);
  for (const std::string& file : files) out.push_back(reader.read(file));
  for (const Fit::Column& column : fit.columns) {
    const auto is_of_it = [&](const MeasuredNumber& each) { return &fit.columns[each.column] == &column; };
    if (std::none_of(out.begin(), out.end(),
                     [&](const MeasuredRun& run) { return std::any_of(run.begin(), run.end(), is_of_it); }))
      throw DataError(fmt::format("{}: nothing is measured of it", column.name));
  }
  for (const auto& given : options.sigma) {
    const std::string& name = given.first;
    if (std::none_of(fit.columns.begin(), fit.columns.end(),
                     [&](const Fit::Column& each) { return each.name == name; }))
      fit.notes.push_back(fmt::format("--sigma {}: no column of that name is used", name));
  }
  return out;
}

}  // namespace lagroid::app
