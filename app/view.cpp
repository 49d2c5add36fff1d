#include "view.hpp"

#include "reading/data_set.hpp"
#include "viewer/assets.hpp"

#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/nesting.hpp>
#include <lagroid/run/files/output.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/report.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>
#include <utility>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr std::array<const char*, 1> kept_pages{"view.html"};

fs::path file_of_run(const std::string& run, const char* name) {
  const fs::path folder(run);
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw RunError(fmt::format("{}: no such folder; lagroid run SCENE --out {} makes one", run, run));
  if (!fs::is_regular_file(folder / name, error))
    throw RunError(fmt::format("{}: holds no {}; lagroid run SCENE --out {} writes it", run, name, run));
  return folder / name;
}

/// Refuses texts that no scene may hold: a summary whose names have them is by someone else.
void require_plain(const OrderedJson& json, const fs::path& file) {
  if (json.is_string() && visible(json.get_ref<const std::string&>()) != json.get_ref<const std::string&>())
    throw RunError(fmt::format("{}: has control characters in \"{}\"; run the scene again", file.string(),
                               json.get_ref<const std::string&>()));
  if (json.is_structured())
    for (const OrderedJson& inner : json) require_plain(inner, file);
}

/// What `use` makes of the summary of a run.
template <class Use> auto from_summary(const std::string& run, const Use& use) {
  const fs::path file = file_of_run(run, "summary.json");
  const auto summary = read_json(contents(file).value_or(""));
  if (!summary) throw RunError(fmt::format("{}: is no JSON any more; run the scene again", file.string()));
  require_plain(*summary, file);
  try {
    return use(*summary);
  } catch (const OrderedJson::exception& error) {
    throw RunError(fmt::format("{}: is no summary of a run, or that of another lagroid ({}); run the scene again",
                               file.string(), error.what()));
  }
}

/// Which rows of so many are shown: evenly spaced ones, and the last.
std::vector<std::size_t> chosen_rows(std::size_t rows, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t stride = std::max<std::size_t>(1, (rows + most - 1) / most);
  for (std::size_t row = 0; row < rows; row += stride) chosen.push_back(row);
  if (rows > 0 && chosen.back() != rows - 1) chosen.push_back(rows - 1);
  return chosen;
}

struct Columns {
  OrderedJson time = OrderedJson::array();
  OrderedJson by_label = OrderedJson::object();
  std::size_t recorded = 0;
};

Columns read_columns(const fs::path& file, long most_rows) {
  Columns columns;
  std::vector<std::size_t> rows;
  try {
    read_series(file, [&](const std::vector<double>& time, const RecordedSeries& series) {
      if (columns.recorded == 0) {
        columns.recorded = time.size();
        rows = chosen_rows(time.size(), std::size_t(most_rows));
        for (const std::size_t row : rows) columns.time.push_back(time[row]);
      }
      for (std::size_t c = 0; c < series.columns.size(); ++c) {
        OrderedJson column = OrderedJson::array();
        for (const std::size_t row : rows)
          column.push_back(row < series.first ? OrderedJson() : OrderedJson(series.at(row, c)));
        columns.by_label[series.columns[c]] = std::move(column);
      }
    });
  } catch (const DataError& error) {
    throw RunError(fmt::format("{}; run the scene again", error.what()));
  }
  return columns;
}

std::string filled(std::string_view page, const std::vector<std::pair<std::string_view, std::string_view>>& places) {
  std::string out;
  for (std::size_t from = 0;;) {
    std::size_t next = std::string_view::npos;
    std::pair<std::string_view, std::string_view> place;
    for (const auto& candidate : places)
      if (const std::size_t at = page.find(candidate.first, from); at < next) {
        next = at;
        place = candidate;
      }
    out += page.substr(from, next - from);
    if (next == std::string_view::npos) return out;
    out += place.second;
    from = next + place.first.size();
  }
}

/// Whether it is of what `lagroid control` found.
bool is_of_control(const OrderedJson& summary) {
  return summary.is_object() && summary.contains("problem") && summary.contains("groupoid");
}

/// What was run, how it ended and what is said of it.
OrderedJson told_of_run(const OrderedJson& summary) {
  OrderedJson run;
  for (const char* key : {"system", "status", "steps", "notes"}) run[key] = summary.at(key);
  run["ledger"] = summary.at("ledger").at("entries");
  return run;
}
OrderedJson told_of_control(const OrderedJson& summary) {
  OrderedJson run{{"system", summary.at("problem")},
                  {"status", summary.at("status")},
                  {"steps", summary.at("stages")},
                  {"notes", OrderedJson::array()},
                  {"ledger", OrderedJson::array()}};
  const auto note = [&](const std::string& text) { run["notes"].push_back(text); };
  note(fmt::format("cost {:.10g}, duration {:.10g}", summary.at("cost").get<double>(),
                   summary.at("duration").get<double>()));
  double begin = 0;
  for (const OrderedJson& phase : summary.value("phases", OrderedJson::array())) {
    const double end = begin + phase.at("duration").get<double>();
    note(fmt::format("phase \"{}\" from {:.6g} to {:.6g}", phase.at("name").get<std::string>(), begin, end));
    begin = end;
  }
  for (const OrderedJson& each : summary.at("active"))
    note(fmt::format("bands: {} acts", each.at("name").get<std::string>()));
  for (const OrderedJson& each : summary.at("violated")) note("violated: " + each.get<std::string>());
  for (const OrderedJson& each : summary.at("repeated")) note("repeated: " + each.get<std::string>());
  return run;
}

/// What the page shows.
OrderedJson data_of_page(const OrderedJson& summary, const ViewOptions& options) {
  OrderedJson run = is_of_control(summary) ? told_of_control(summary) : told_of_run(summary);
  run["message"] = summary.value("message", "");
  run["shapes"] = summary.at("picture").at("shapes");
  run["panels"] = summary.at("picture").at("panels");
  const char* const data = is_of_control(summary) ? "control.h5" : "trajectory.h5";
  Columns columns = read_columns(file_of_run(options.run, data), options.most_rows);
  if (columns.recorded == 0)
    throw RunError(fmt::format("{}: nothing was computed ({}); there is nothing to show", options.run,
                               summary.value("message", summary.at("status").get<std::string>())));
  if (columns.time.size() < columns.recorded)
    run["notes"].push_back(
        fmt::format("{} of {} recorded rows are on this page", columns.time.size(), columns.recorded));
  if (summary.contains("events")) {
    OrderedJson& events = run["events"] = summary.at("events");
    OrderedJson& rows = events.at("rows");
    const auto shown = chosen_rows(rows.size(), std::size_t(options.most_rows));
    if (shown.size() < rows.size()) {
      run["notes"].push_back(fmt::format("{} of {} events are on this page", shown.size(), rows.size()));
      OrderedJson some = OrderedJson::array();
      for (const std::size_t row : shown) some.push_back(std::move(rows[row]));
      rows = std::move(some);
    }
  }
  run["time"] = std::move(columns.time);
  run["columns"] = std::move(columns.by_label);
  return run;
}

bool holds_control(const fs::path& folder) {
  const auto summary = read_json(contents(folder / "summary.json").value_or(""));
  return summary && is_of_control(*summary);
}

}  // namespace

void refuse_found_control(const fs::path& folder) {
  if (holds_control(folder))
    throw RunError(fmt::format(
        "{}: holds what lagroid control found, and no run; its picture is {}, and its numbers are in trajectory.csv",
        folder.string(), (folder / "plot.svg").string()));
}

fs::path write_view(const ViewOptions& options) {
  std::error_code ignored;
  std::optional<OutputFolder> held;
  if (holds_control(options.run)) {
    held.emplace(options.run, OutputKind::optimum, std::nullopt, kept_pages);
  } else if (fs::is_directory(options.run, ignored)) {
    held.emplace(folder_of_run(options.run));
  }
  file_of_run(options.run, "summary.json");
  const std::string data =
      from_summary(options.run, [&](const OrderedJson& summary) { return in_script(data_of_page(summary, options)); });
  const std::string page =
      filled(viewer::page(), {{"@STYLE@", viewer::style()}, {"@RUN@", data}, {"@PROGRAM@", viewer::program()}});
  return write_whole(options.run, kept_pages,
                     [&](const fs::path& staging) {
                       write_text(page, staging / "view.html");
                       return std::vector<std::string>{"view.html"};
                     })
      .front();
}

std::vector<fs::path> draw_plots(const PlotOptions& options) {
  std::error_code ignored;
  std::optional<OutputFolder> held;
  if (fs::is_directory(options.run, ignored)) {
    refuse_found_control(options.run);
    held.emplace(folder_of_run(options.run));
  }
  const fs::path file = file_of_run(options.run, "plot.gp");
  const fs::path excerpt = file_of_run(options.run, "trajectory.csv").parent_path() / "plot.csv";
  const auto its_own = [&](const OrderedJson& summary) {
    return plot_script(panels_of(summary), events_of(summary), !fs::exists(excerpt));
  };
  if (!options.own_script && contents(file) != from_summary(options.run, its_own))
    throw RunError(
        fmt::format("{}: is not the script that summary.json gives: someone changed it, or another lagroid wrote it. "
                    "A script can do all that you can: --own-script runs it, where you trust it",
                    file.string()));
  const InterruptGuard guard;
  const Drawing drawing{"plot.gp", {"plot.svg", "plot.png"}};
  if (const std::string reason = draw(options.run, drawing, false); !reason.empty()) {
    const std::string line = fmt::format("{}: {}", options.run, reason);
    if (options.own_script || InterruptGuard::interrupted()) throw RunError(line);
    throw OutputError(line);  // a script of ours is no mistake
  }
  std::vector<fs::path> written;
  for (const std::string& picture : drawing.pictures) written.push_back(fs::path(options.run) / picture);
  return written;
}

}  // namespace lagroid::app
