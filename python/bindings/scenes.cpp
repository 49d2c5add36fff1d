/// Scenes and their runs.

#include "arrays.hpp"
#include "bindings.hpp"
#include "computing.hpp"
#include "scene.hpp"

#include <lagroid/run/events/event_function.hpp>
#include <lagroid/run/files/checkpoint.hpp>
#include <lagroid/run/files/output.hpp>
#include <lagroid/run/reports/report.hpp>

#include <study/run_scene.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::python {

namespace {

namespace fs = std::filesystem;
using lagroid::Endpoint, lagroid::LedgerEntry, lagroid::StationaryPath, lagroid::RunResult, lagroid::Columns;

/// What a function of an event sees, while it is called.
class EventNode {
 public:
  explicit EventNode(const lagroid::Observables& node) : node_(&node) {}
  void close() { node_ = nullptr; }

  double number(const std::string& label) const {
    if (node_ == nullptr) throw std::runtime_error("the node of an event is known only while its function is called");
    if (label == "t") return node_->time();
    std::vector<double> numbers;
    const auto found = [&](const std::vector<std::string>& labels, const auto& read) -> std::optional<double> {
      const auto at = std::find(labels.begin(), labels.end(), label);
      if (at == labels.end()) return std::nullopt;
      numbers.resize(labels.size());
      read(numbers.data());
      return numbers[std::size_t(at - labels.begin())];
    };
    for (const std::size_t i : lagroid::fields_within(*node_))
      if (const auto x = found(node_->fields()[i].columns.components, [&](double* to) { node_->read(i, to); }))
        return *x;
    for (std::size_t i = 0; i < node_->quantities().size(); ++i) {
      const lagroid::Watched& quantity = node_->quantities()[i];
      if (quantity.on_arrows || quantity.adds_up) continue;
      const bool is_one = quantity.components.size() == 1;
      if (const auto x = found(is_one ? std::vector{quantity.name} : quantity.components,
                               [&](double* to) { node_->measure(i, to); }))
        return *x;
    }
    throw py::key_error(fmt::format("{}; there are t, {}", label, fmt::join(lagroid::columns_within(*node_), ", ")));
  }

 private:
  const lagroid::Observables* node_;
};

/// A function of Python's that the loop of a run calls, which is without the interpreter and copies it freely.
class CalledAtNodes {
 public:
  explicit CalledAtNodes(py::function f)
      : function_(new py::function(std::move(f)), [](py::function* held) {
          const py::gil_scoped_acquire acquired;
          delete held;
        }) {}
  /// use(what it returns), with the interpreter.
  template <class Use> auto operator()(const lagroid::Observables& node, const Use& use) const {
    const py::gil_scoped_acquire acquired;
    struct Seen {
      std::shared_ptr<EventNode> node;
      ~Seen() { node->close(); }
    };
    const Seen seen{std::make_shared<EventNode>(node)};
    return use((*function_)(seen.node));
  }

 private:
  std::shared_ptr<py::function> function_;
};

/// An event whose function is one of Python's, or that calls one back: keys as those of [[event]].
lagroid::Event event_of(const py::dict& table) {
  using lagroid::Event;
  Event event;
  const auto chosen = [](const std::string& key, const std::string& word, const std::vector<std::string>& words) {
    const auto at = std::find(words.begin(), words.end(), word);
    if (at == words.end())
      throw py::value_error(fmt::format("event: {} is one of {}, not \"{}\"", key, fmt::join(words, ", "), word));
    return int(at - words.begin());
  };
  for (const auto& [name, value] : table) {
    const auto key = name.cast<std::string>();
    if (key == "name") {
      event.name = value.cast<std::string>();
    } else if (key == "when" && py::isinstance<py::str>(value)) {
      event.when = value.cast<std::string>();
    } else if (key == "when") {
      event.when = "a function of Python's";
      event.function = [f = CalledAtNodes(value.cast<py::function>())](const lagroid::Observables& node) {
        return f(node, [](const py::object& result) { return result.cast<double>(); });
      };
    } else if (key == "call") {
      event.call = [f = CalledAtNodes(value.cast<py::function>())](const lagroid::Happening&,
                                                                   const lagroid::Observables& node) {
        return f(node, [](const py::object& result) { return !result.is(py::bool_(false)); });
      };
    } else if (key == "at") {
      event.at = Event::At(chosen(key, value.cast<std::string>(), {"zero", "minimum", "maximum"}));
    } else if (key == "direction") {
      event.direction = Event::Direction(chosen(key, value.cast<std::string>(), {"both", "rising", "falling"}));
    } else if (key == "then") {
      event.then = Event::Then(chosen(key, value.cast<std::string>(), {"record", "stop"}));
    } else if (key == "count") {
      event.count = value.cast<long>();
    } else if (key == "tolerance") {
      event.tolerance = value.cast<double>();
    } else if (key == "body") {
      event.body = value.cast<std::string>();
    } else if (key == "switch_on") {
      event.switch_on = value.cast<std::vector<std::string>>();
    } else if (key == "switch_off") {
      event.switch_off = value.cast<std::vector<std::string>>();
    } else if (key == "kick") {
      event.kick = value.cast<std::vector<std::string>>();
    } else if (key == "set") {
      for (const auto& text : value.cast<std::vector<std::string>>()) {
        const auto setting = lagroid::event_setting(text);
        if (!setting)
          throw py::value_error(fmt::format("event: \"{}\" is not of the form \"name = expression\"", text));
        event.set.push_back(*setting);
      }
    } else if (key == "plot") {
      event.plot = value.cast<std::vector<std::string>>();
    } else {
      throw py::value_error(
          fmt::format("event: there is no \"{}\"; there are name, when, call, at, direction, then, count, tolerance, "
                      "kick, body, set, switch_on, switch_off, plot",
                      key));
    }
  }
  return event;
}

/// Runs the scene; with a folder, keeps checkpoints there and leaves the files of a run.
std::shared_ptr<RunResult> run(const app::Section& scene, bool record, const std::optional<fs::path>& folder,
                               bool resume, std::vector<lagroid::Event> events = {}) {
  std::optional<lagroid::OutputFolder> held;
  if (folder) held.emplace(resume ? lagroid::folder_of_run(*folder) : lagroid::folder_for_run(*folder, scene.whole()));
  bool interrupted = false;
  auto result = computing(
      [&] {
        auto made = std::make_shared<RunResult>(app::run_scene(scene, {.record = record || folder,
                                                                       .progress = false,
                                                                       .folder = folder.value_or(""),
                                                                       .resume = resume,
                                                                       .events = std::move(events)}));
        if (folder) lagroid::write_outputs(*made, *folder);
        return made;
      },
      interrupted);
  if (interrupted && !result->interrupted()) PyErr_SetInterrupt();  // it came too late for the run: to Python, then
  return result;
}

std::shared_ptr<RunResult> resume(const fs::path& folder, std::optional<long> steps, bool other_build) {
  std::vector<std::string> overrides;
  if (steps) overrides.push_back(fmt::format("time.steps={}", *steps));
  const std::string text = lagroid::Checkpoint::scene_of(folder);
  lagroid::Checkpoint::require_this_build(folder, other_build);
  return run(app::parse_scene(text, folder.string() + "/checkpoint/scene.toml", overrides), true, folder, true);
}

py::array values(const Columns& series, py::handle owner) {
  const auto width = py::ssize_t(series.width());
  const auto rows = width > 0 ? py::ssize_t(series.values.size()) / width : 0;
  if (width == 1) return view(series.values, owner);
  return view(series.values.data(), {rows, width}, {width, 1}, owner);
}

/// A column by its label, or a series by its name.
py::array column(const py::object& self, const std::string& label) {
  const auto& trajectory = self.cast<const RunResult&>().trajectory;
  if (label == "t") return view(trajectory.time, self);
  for (const Columns& series : trajectory.series)
    for (std::size_t i = 0; i < series.width(); ++i)
      if (series.components[i] == label) {
        const auto width = py::ssize_t(series.width());
        return view(series.values.data() + i, {py::ssize_t(series.values.size()) / width}, {width}, self);
      }
  for (const Columns& series : trajectory.series)
    if (series.name == label) return values(series, self);
  throw py::key_error(trajectory.series.empty() ? label + ": nothing was recorded" : label);
}

/// What happened: a dict each, with the columns of the state there.
py::list events(const RunResult& result) {
  const lagroid::EventTable& table = result.events;
  py::list out;
  for (const lagroid::Happening& row : table.rows) {
    py::dict each;
    each["event"] = table.watched[row.event].name;
    each["t"] = row.time;
    each["t_error"] = row.time_error;
    each["step"] = row.step;
    each["passing"] = std::string(to_string(row.passing));
    each["together"] = row.together;
    for (std::size_t i = 0; i < table.columns.size(); ++i) each[py::str(table.columns[i])] = row.values[i];
    out.append(std::move(each));
  }
  return out;
}

std::vector<std::string> columns(const RunResult& result) {
  std::vector<std::string> out;
  if (result.trajectory.series.empty()) return out;
  out.emplace_back("t");
  for (const Columns& series : result.trajectory.series)
    out.insert(out.end(), series.components.begin(), series.components.end());
  return out;
}

}  // namespace

void bind_scenes(py::module_& module) {
  py::class_<Scene>(module, "Scene", "A scene (docs/scenes.md), read anew whenever it is used.")
      .def_static(
          "file",
          [](const fs::path& file, const std::vector<std::string>& overrides) {
            return Scene{file, {}, file.string(), overrides};
          },
          py::arg("file"), py::arg("overrides"), "That of a file, with overrides key=value.")
      .def_static(
          "text",
          [](const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
            return Scene{std::nullopt, text, name, overrides};
          },
          py::arg("text"), py::arg("name"), py::arg("overrides"), "That of a TOML text.")
      .def_readonly("name", &Scene::name, "The file, or what messages call the text.")
      .def(
          "toml", [](const Scene& self) { return self.read().whole(); }, "The whole scene with its overrides.");

  py::class_<EventNode, std::shared_ptr<EventNode>>(
      module, "EventNode", "A node, or a point within a step, at which a function of an event is called.")
      .def("__getitem__", &EventNode::number, py::arg("label"),
           "A column or a quantity of the ledger by its label; \"t\" is the time.");

  py::class_<Endpoint>(module, "Endpoint", "A state as users see it.")
      .def_readonly("time", &Endpoint::time, "s")
      .def_property_readonly(
          "position", [](const py::object& self) { return view(self.cast<const Endpoint&>().position, self); },
          "The object, as its columns; empty on a group.")
      .def_readonly("attitude", &Endpoint::attitude, "Unit quaternion w, x, y, z, or None.")
      .def_readonly("body_attitude", &Endpoint::body_attitude,
                    "The same of the body one sees, where that is the transpose.")
      .def_property_readonly(
          "momentum", [](const py::object& self) { return view(self.cast<const Endpoint&>().momentum, self); },
          "In A*G, as its columns.");

  py::class_<LedgerEntry>(module, "LedgerEntry", "What was promised, and what was found.")
      .def_readonly("name", &LedgerEntry::name, "Of the quantity.")
      .def_readonly("promise", &LedgerEntry::promise, "round-off, conserved, bounded, none or counted")
      .def_property_readonly(
          "initial", [](const py::object& self) { return view(self.cast<const LedgerEntry&>().initial, self); },
          "Its first value.")
      .def_property_readonly(
          "final", [](const py::object& self) { return view(self.cast<const LedgerEntry&>().final, self); },
          "Its last value.")
      .def_readonly("drift", &LedgerEntry::drift, "Largest deviation from the initial value.")
      .def_readonly("relative_drift", &LedgerEntry::relative_drift, "The same over the size of the initial value.")
      .def_readonly("bound", &LedgerEntry::bound, "On the drift; zero where none is promised.")
      .def_readonly("verdict", &LedgerEntry::verdict, "kept, BROKEN, bounded, growing, unjudged, watched or counted")
      .def_readonly("reason", &LedgerEntry::reason, "Of a verdict that drift and bound do not explain; else empty.")
      .def_property_readonly("broken", &LedgerEntry::broken, "Whether the promise was.")
      .def("__repr__", [](const LedgerEntry& e) {
        return fmt::format("<{}: {}, drift {:.2e}: {}>", e.name, e.promise, e.drift, e.verdict);
      });

  py::class_<StationaryPath>(module, "StationaryPath", "A stationary path of a boundary value.")
      .def_readonly("cost", &StationaryPath::cost, "The sum of the Lagrangian over its arrows.")
      .def_readonly("starts", &StationaryPath::starts,
                    "How many starts led to it; none where a way down from a saddle did.")
      .def_property_readonly(
          "momentum", [](const py::object& self) { return view(self.cast<const StationaryPath&>().momentum, self); },
          "At its start.")
      .def_readonly("is_minimum", &StationaryPath::is_minimum, "Whether its second variation is positive.")
      .def_readonly("isolated", &StationaryPath::isolated, "False: one of a continuous family.")
      .def_readonly("normal", &StationaryPath::normal, "False: abnormal, its multipliers are not unique.")
      .def_readonly("negative_directions", &StationaryPath::negative_directions, "Directions that lower the action.");

  py::class_<Columns>(module, "Columns", "A recorded quantity: a row for each node, or for each arrow.")
      .def_readonly("name", &Columns::name, "Of the data set in files.")
      .def_readonly("components", &Columns::components, "The labels of its columns.")
      .def_readonly("unit", &Columns::unit, "Of its numbers.")
      .def_readonly("meaning", &Columns::meaning, "In words.")
      .def_readonly("on_arrows", &Columns::on_arrows, "A row for each arrow: one fewer than there are nodes.")
      .def_property_readonly(
          "values", [](const py::object& self) { return values(self.cast<const Columns&>(), self); },
          "(rows,) or (rows, width); the run's own numbers.");

  py::class_<lagroid::Panel>(module, "Panel", "Curves that belong in one picture.")
      .def_readonly("title", &lagroid::Panel::title, "Above it.")
      .def_readonly("x_label", &lagroid::Panel::x_label, "Below the x axis.")
      .def_readonly("y_label", &lagroid::Panel::y_label, "Beside the y axis.")
      .def_readonly("x", &lagroid::Panel::x, "The column on the x axis.")
      .def_readonly("curves", &lagroid::Panel::curves, "Columns.")
      .def_readonly("equal_axes", &lagroid::Panel::equal_axes, "Whether both have one scale.");

  // With attributes of Python's: which scene it is of (lagroid/scenes.py).
  py::class_<RunResult, std::shared_ptr<RunResult>>(
      module, "RunResult", py::dynamic_attr(),
      "A run: run[column] is an array over the run's own numbers, read-only and not copied.")
      .def_readonly("system", &RunResult::system, "Its name.")
      .def_readonly("method", &RunResult::method, "Of an initial value, and what it declares of itself.")
      .def_readonly("status", &RunResult::status, "converged, interrupted or why not.")
      .def_readonly("message", &RunResult::message, "Why, at which step, what to do.")
      .def_readonly("steps", &RunResult::steps, "Arrows computed.")
      .def_readonly("steps_asked", &RunResult::steps_asked, "Arrows asked for.")
      .def_readonly("seconds", &RunResult::seconds, "Of the computation alone.")
      .def_readonly("iterations", &RunResult::iterations, "Of all solves.")
      .def_readonly("cost", &RunResult::cost, "Of a boundary value.")
      .def_readonly("residual", &RunResult::residual, "Of a solve that failed.")
      .def_property_readonly(
          "initial", [](const RunResult& r) -> const Endpoint& { return r.initial; }, "The first state.",
          py::return_value_policy::reference_internal)
      .def_property_readonly(
          "final", [](const RunResult& r) -> const Endpoint& { return r.final; }, "The last state.",
          py::return_value_policy::reference_internal)
      .def_property_readonly(
          "first_multipliers",
          [](const py::object& self) { return view(self.cast<const RunResult&>().first_multipliers, self); },
          "Of the first arrow.")
      .def_property_readonly(
          "last_multipliers",
          [](const py::object& self) { return view(self.cast<const RunResult&>().last_multipliers, self); },
          "Of the last arrow.")
      .def_readonly("starts", &RunResult::starts, "Of a boundary value: how many there were; else 0.")
      .def_readonly("stationary_paths", &RunResult::stationary_paths,
                    "Of a boundary value: those found, cheapest first.")
      .def_property_readonly(
          "minima",
          [](const RunResult& r) {
            if (PyErr_WarnEx(PyExc_DeprecationWarning, "RunResult.minima is RunResult.stationary_paths", 1) != 0)
              throw py::error_already_set();
            return r.stationary_paths;
          },
          "What stationary_paths were called in version 0.2.")
      .def_readonly("notes", &RunResult::notes, "What else there is to say.")
      .def_property_readonly(
          "ledger", [](const RunResult& r) { return r.ledger.entries; }, "What was promised and found.")
      .def_property_readonly(
          "mean_iterations", [](const RunResult& r) { return r.ledger.mean_iterations; }, "Of a solve.")
      .def_property_readonly(
          "most_iterations", [](const RunResult& r) { return r.ledger.most_iterations; }, "Of one solve.")
      .def_property_readonly(
          "time", [](const py::object& self) { return view(self.cast<const RunResult&>().trajectory.time, self); },
          "(nodes,), s.")
      .def_property_readonly(
          "series",
          [](const py::object& self) {
            py::list out;
            for (const Columns& series : self.cast<const RunResult&>().trajectory.series)
              out.append(py::cast(&series, py::return_value_policy::reference_internal, self));
            return out;
          },
          "All that was recorded, in the order of the files.")
      .def_property_readonly(
          "events", events,
          "What happened of what the scene watches for, in the order of time: a dict each, of event, "
          "t, t_error, step, passing, together and the columns of the state there.")
      .def_property_readonly(
          "conventions", [](const RunResult& r) { return r.trajectory.conventions; }, "What the numbers mean.")
      .def_property_readonly(
          "panels", [](const RunResult& r) { return r.panels; }, "The pictures of such a run.")
      .def_property_readonly("columns", columns, "The labels of all columns; \"t\" is the time.")
      .def("__getitem__", column, py::arg("label"),
           "A column by its label, (rows,), or a series by its name, (rows, width).")
      .def(
          "__contains__",
          [](const RunResult& r, const std::string& label) {
            const auto all = columns(r);
            const auto& series = r.trajectory.series;
            return std::find(all.begin(), all.end(), label) != all.end() ||
                   std::any_of(series.begin(), series.end(), [&](const Columns& s) { return s.name == label; });
          },
          "Whether there is such a column or series.")
      .def_property_readonly("converged", &RunResult::converged, "Whether all was solved.")
      .def_property_readonly("interrupted", &RunResult::interrupted, "Whether Ctrl-C or SIGTERM ended it.")
      .def(
          "gradient",
          [](const py::object& self, const py::object& of, const py::object& wrt, const py::object& columns,
             const py::object& check, const py::object& states) {
            py::dict asked;
            for (const auto& [name, value] : {std::pair("of", of), std::pair("wrt", wrt), std::pair("columns", columns),
                                              std::pair("check", check), std::pair("states", states)})
              if (!value.is_none()) asked[name] = value;
            return py::module_::import("lagroid.studies").attr("gradient_of_run")(self, **asked);
          },
          py::kw_only(), py::arg("of") = py::none(), py::arg("wrt") = py::none(), py::arg("columns") = py::none(),
          py::arg("check") = py::none(), py::arg("states") = py::none(),
          "Exact derivatives of the run, as lagroid.gradient has them: of, wrt, columns, check and states are its.")
      .def("text", lagroid::text_report, "The report, as lagroid run prints it.")
      .def("json", lagroid::json_report, "The summary, as lagroid run --json prints it.")
      .def(
          "write",
          [](RunResult& self, const fs::path& folder) {
            return computing([&] {
              const lagroid::OutputFolder held = lagroid::folder_for_result(folder, self);
              return lagroid::write_outputs(self, folder);
            });
          },
          py::arg("folder"), "Writes trajectory, summary and plots into the folder. Raises OutputError.")
      .def("__repr__", [](const RunResult& r) {
        return fmt::format("<run of {}: {}, {} of {} steps in {:.3g} s>", r.system, r.status, r.steps, r.steps_asked,
                           r.seconds);
      });

  module.def(
      "run",
      [](const Scene& scene, bool record, const std::optional<fs::path>& folder, const std::vector<py::dict>& events) {
        std::vector<lagroid::Event> watched;
        std::transform(events.begin(), events.end(), std::back_inserter(watched), event_of);
        return run(scene.read(), record, folder, false, std::move(watched));
      },
      py::arg("scene"), py::arg("record"), py::arg("folder"), py::arg("events"));
  module.def("resume", resume, py::arg("folder"), py::arg("steps"), py::arg("other_build"));
}

}  // namespace lagroid::python
