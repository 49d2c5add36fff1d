#include "view.hpp"

#include "viewer/assets.hpp"

#include <lagroid/run/files/hdf5_file.hpp>
#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/nesting.hpp>
#include <lagroid/run/files/output.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/report.hpp>
#include <lagroid/run/reports/text.hpp>

#include <H5Cpp.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <stdexcept>
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

std::string text_attribute(const H5::H5Object& object, const char* name) {
  std::string text;
  const H5::Attribute attribute = object.openAttribute(name);
  attribute.read(attribute.getStrType(), text);
  return text;
}

std::vector<double> numbers(const H5::DataSet& set) {
  std::vector<double> values(std::size_t(set.getSpace().getSimpleExtentNpoints()));
  if (!values.empty()) set.read(values.data(), H5::PredType::NATIVE_DOUBLE);
  return values;
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

/// Column labels stand in attributes, joined by ", ".
std::vector<std::string> labels_of(const H5::DataSet& set) {
  std::vector<std::string> labels;
  for (std::size_t part = 0; part == 0 || set.attrExists(components_attribute(part)); ++part) {
    const std::string joined = text_attribute(set, components_attribute(part).c_str());
    for (std::size_t from = 0; from <= joined.size();) {
      const std::size_t to = std::min(joined.find(", ", from), joined.size());
      labels.push_back(joined.substr(from, to - from));
      from = to + 2;
    }
  }
  return labels;
}

Columns read_columns(const fs::path& file, long most_rows) {
  H5::Exception::dontPrint();
  try {
    const H5::H5File in(file.string(), H5F_ACC_RDONLY);
    const std::vector<double> time = numbers(in.openDataSet("time"));
    const auto rows = chosen_rows(time.size(), std::size_t(most_rows));
    Columns columns;
    columns.recorded = time.size();
    for (const std::size_t row : rows) columns.time.push_back(time[row]);
    for (hsize_t i = 0; i < in.getNumObjs(); ++i) {
      const std::string name = in.getObjnameByIdx(i);
      if (name == "time" || in.childObjType(name) == H5O_TYPE_GROUP) continue;
      const H5::DataSet set = in.openDataSet(name);
      const std::vector<double> values = numbers(set);
      const std::vector<std::string> labels = labels_of(set);
      const std::size_t first = text_attribute(set, "rows") == "one per recorded arrow" ? 1 : 0;
      if (values.size() != (time.size() - std::min(first, time.size())) * labels.size())
        throw RunError(
            fmt::format("{}: \"{}\" has another number of rows than time; run the scene again", file.string(), name));
      for (std::size_t c = 0; c < labels.size(); ++c) {
        OrderedJson column = OrderedJson::array();
        for (const std::size_t row : rows)
          column.push_back(row < first ? OrderedJson() : OrderedJson(values[(row - first) * labels.size() + c]));
        columns.by_label[labels[c]] = std::move(column);
      }
    }
    return columns;
  } catch (const std::length_error&) {  // more rows than any memory holds
    throw RunError(fmt::format("{}: is damaged; run the scene again", file.string()));
  } catch (const std::bad_alloc&) {
    throw RunError(
        fmt::format("{}: does not fit into the memory, or is damaged; run the scene again with a larger "
                    "output.every",
                    file.string()));
  } catch (const H5::Exception& error) {
    throw RunError(fmt::format("{}: HDF5: {}; run the scene again", file.string(), error.getDetailMsg()));
  }
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

/// What the page shows.
OrderedJson data_of_page(const OrderedJson& summary, const ViewOptions& options) {
  OrderedJson run;
  for (const char* key : {"system", "status", "steps", "notes"}) run[key] = summary.at(key);
  run["message"] = summary.value("message", "");
  run["ledger"] = summary.at("ledger").at("entries");
  run["shapes"] = summary.at("picture").at("shapes");
  run["panels"] = summary.at("picture").at("panels");
  Columns columns = read_columns(file_of_run(options.run, "trajectory.h5"), options.most_rows);
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

/// The folder, refused where it holds something else than a run; none where there is no such folder.
std::optional<OutputFolder> folder_there(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return std::nullopt;
  return folder_of_run(folder);
}

}  // namespace

fs::path write_view(const ViewOptions& options) {
  const auto held = folder_there(options.run);
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
  const auto held = folder_there(options.run);
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
