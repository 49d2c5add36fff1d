/// Integrators of systems that were made in Python, step by step or many steps at once.

#include "arrays.hpp"
#include "bindings.hpp"
#include "computing.hpp"

#include <scenes/simulation.hpp>

#include <lagroid/core/version.hpp>
#include <lagroid/python/rows.hpp>
#include <lagroid/run/files/archive.hpp>
#include <lagroid/run/motion/integrate_nodes.hpp>

#include <fmt/format.h>

#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::python {

namespace {

/// `count` rows of a field; matrices are columns first in memory.
py::array rows_of(const double* values, std::size_t count, const std::vector<std::size_t>& shape_of_one,
                  py::handle owner) {
  std::vector<py::ssize_t> shape{py::ssize_t(count)};
  std::vector<py::ssize_t> strides{py::ssize_t(width_of(shape_of_one))};
  py::ssize_t stride = 1;
  for (const std::size_t n : shape_of_one) {
    shape.push_back(py::ssize_t(n));
    strides.push_back(stride);
    stride *= py::ssize_t(n);
  }
  return view(values, std::move(shape), std::move(strides), owner);
}
py::array rows_of(const Rows& rows, py::handle owner) {
  return rows_of(rows.values.data(), rows.count, rows.field.shape, owner);
}

/// What many steps left.
struct PythonTrajectory {
  std::string status = "converged";
  std::string message;
  long steps = 0;
  double seconds = 0;
  std::vector<Field> fields;
  Trajectory trajectory;

  py::array rows(std::size_t field, py::handle owner) const {
    const std::size_t count = trajectory.time.size() - (fields[field].columns.on_arrows ? 1 : 0);
    return rows_of(trajectory.series[field].values.data(), count, fields[field].shape, owner);
  }
};

/// A step that was not made.
[[noreturn]] void refuse(const std::string& status, const std::string& message) {
  const auto error = py::module_::import("lagroid.errors").attr("SolveError")(message, status);
  PyErr_SetObject(error.get_type().ptr(), error.ptr());
  throw py::error_already_set();
}

class Integrator {
 public:
  /// `origin`: the system and the arguments of its `integrator`, from which a pickle begins anew; or None.
  Integrator(std::shared_ptr<Motion> motion, bool ledger, py::object origin)
      : motion_(std::move(motion)), origin_(std::move(origin)) {
    if (!ledger) return;
    judge_.emplace(motion_->look());
    judge_->observe(motion_->look());
  }

  /// One step, in the calling thread, with the interpreter's lock: it takes microseconds.
  void advance() {
    const Busy busy(busy_);
    const StepReport report = motion_->advance();
    if (!report.converged()) refuse(std::string(to_string(report.status)), failure(report));
    if (judge_) judge_->observe(motion_->look());
  }

  std::shared_ptr<PythonTrajectory> steps(long count, long every) {
    if (count < 0) throw py::value_error("steps: must not be negative");
    if (every < 1) throw py::value_error("every: must be at least 1");
    const Busy busy(busy_);
    return computing([&] {
      auto out = std::make_shared<PythonTrajectory>();
      const auto start = std::chrono::steady_clock::now();
      const Observables& node = motion_->look();
      out->fields = node.fields();
      Recorder recorder(node);
      WatchedMotion watched(*motion_, judge_ ? &*judge_ : nullptr, &recorder, every, true);
      watched.observe();
      const long first = motion_->index();
      const IntegrationEnd end =
          integrate_nodes(watched, count, [](const StepReport&) { return !InterruptGuard::interrupted(); });
      watched.observe_last();
      out->steps = motion_->index() - first;
      if (end.why == IntegrationEnd::Why::failed) {
        out->status = std::string(to_string(end.report.status));
        out->message = failure(end.report);
      } else if (end.why == IntegrationEnd::Why::not_finite) {
        out->status = std::string(to_string(SolveStatus::not_finite));
        out->message = fmt::format("step {}: the time is no finite number any more", motion_->index());
      }
      out->trajectory = std::move(recorder.trajectory());
      out->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      return out;
    });
  }

  /// What `resumed` goes on from: the version, the origin, and the state.
  py::tuple pickled() {
    const Busy busy(busy_);
    if (origin_.is_none())
      throw py::type_error("only an integrator that a system's integrator(...) has made can be pickled or copied");
    lagroid::Archive archive;
    serialize(archive);
    const std::vector<std::uint8_t> state = nlohmann::json::to_cbor(archive.fields());
    const py::bytes bytes(std::string(state.begin(), state.end()));
    return py::make_tuple(version, origin_, bytes);
  }
  static std::unique_ptr<Integrator> resumed(const py::tuple& kept) {
    if (const auto by = kept[0].cast<std::string>(); by != version)
      throw py::value_error(fmt::format("an integrator pickled by lagroid {}, this is {}; begin it anew", by, version));
    const py::tuple origin = kept[1];
    const py::object anew = origin[0].attr("integrator")(**py::dict(origin[1]));
    const auto& begun = anew.cast<const Integrator&>();
    auto out = std::make_unique<Integrator>(begun.motion_, begun.judge_.has_value(), origin);
    const auto refuse = [] { return py::value_error("an integrator pickled by another lagroid; begin it anew"); };
    try {
      lagroid::Archive archive(nlohmann::json::from_cbor(kept[2].cast<std::string>()));
      out->serialize(archive);
    } catch (const nlohmann::json::exception&) {
      throw refuse();
    } catch (const std::out_of_range&) {
      throw refuse();
    }
    return out;
  }

  long index() const {
    const Busy busy(busy_);
    return motion_->index();
  }
  double time() const {
    const Busy busy(busy_);
    return motion_->time();
  }
  MethodTraits traits() const { return motion_->traits(); }
  std::vector<lagroid::LedgerEntry> ledger() const {
    const Busy busy(busy_);
    lagroid::Ledger out;
    if (judge_) judge_->report(out);
    return out.entries;
  }

  /// A field at the node that was reached, in an array of its own.
  py::array now(const std::string& name) const { return now(name, 0, count_of_fields); }
  py::array quantity(const std::string& name) const { return now(name, count_of_fields, std::size_t(-1)); }

 private:
  /// Held while steps are made or looked at.
  class Busy {
   public:
    explicit Busy(std::atomic<bool>& busy) : busy_(busy) {
      if (busy_.exchange(true)) throw std::runtime_error("the integrator is used by another thread");
    }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;
    ~Busy() { busy_ = false; }

   private:
    std::atomic<bool>& busy_;
  };

  /// Of the fields from `first` to `last`.
  py::array now(const std::string& name, std::size_t first, std::size_t last) const {
    const Busy busy(busy_);
    const Observables& node = motion_->look();
    for (std::size_t i = first; i < std::min(last, node.fields().size()); ++i) {
      const Field& field = node.fields()[i];
      if (field.columns.name != name) continue;
      if (field.columns.on_arrows && node.index() == 0) throw py::value_error(name + ": no step was made yet");
      auto* rows = new Rows(field);
      const py::capsule owner(rows, [](void* p) { delete static_cast<Rows*>(p); });
      node.read(i, rows->add());
      return rows_of(*rows, owner)[py::int_(0)].cast<py::array>();
    }
    throw py::key_error(name);
  }
  /// Visits all that a pickle holds beside the origin.
  void serialize(lagroid::Archive& archive) {
    archive.numbers("motion", [&](NumberArchive& numbers) { motion_->serialize(numbers); });
    if (judge_) archive("judge", *judge_);
  }
  std::string failure(const StepReport& report) const { return motion_->failure(report, motion_->index() + 1); }

  static constexpr const char* version = LAGROID_VERSION;

  std::shared_ptr<Motion> motion_;
  std::optional<lagroid::Judge> judge_;
  py::object origin_;
  mutable std::atomic<bool> busy_ = false;
};

/// A property of the class for a field.
template <class Class> void bind_fields(Class& made, bool rows) {
  const auto add = [&](const char* name, const char* doc) {
    const std::string key = name;
    if constexpr (std::is_same_v<typename Class::type, Integrator>) {
      made.def_property_readonly(
          name, [key](const Integrator& self) { return self.now(key); }, doc);
    } else {
      made.def_property_readonly(
          name,
          [key](const py::object& self) {
            const auto& held = self.cast<const typename Class::type&>();
            if constexpr (std::is_same_v<typename Class::type, PythonTrajectory>) {
              for (std::size_t i = 0; i < count_of_fields; ++i)
                if (held.fields[i].columns.name == key) return held.rows(i, self);
            } else {
              for (const Rows& each : held.rows)
                if (each.field.columns.name == key) return rows_of(each, self);
            }
            throw py::key_error(key);
          },
          doc);
    }
  };
  add("object", "The object q.");
  add("momentum", "The momentum mu in the dual of A_qG, in the basis of the retraction.");
  if (!rows) return;
  add("configuration", "The arrow carried along, whose target is the object: a matrix, or coordinates.");
  add("arrow", "The arrow of the last step.");
  add("multipliers", "Its multipliers.");
  add("step_size", "Its size, s.");
}

}  // namespace

void bind_integrators(py::module_& module) {
  py::class_<Motion, std::shared_ptr<Motion>>(module, "Motion", "What an Integrator integrates.");

  py::class_<PythonTrajectory, std::shared_ptr<PythonTrajectory>> integrated(
      module, "Trajectory",
      "The nodes of many steps: arrays over the trajectory's own numbers, read-only and not copied.");
  integrated.def_readonly("status", &PythonTrajectory::status, "converged, or why the last step was not made.")
      .def_readonly("message", &PythonTrajectory::message, "Which step, and what to do.")
      .def_readonly("steps", &PythonTrajectory::steps, "Steps made.")
      .def_readonly("seconds", &PythonTrajectory::seconds, "Of the steps.")
      .def_property_readonly(
          "converged", [](const PythonTrajectory& m) { return m.status == "converged"; },
          "Whether every step was made.")
      .def_property_readonly(
          "time",
          [](const py::object& self) { return view(self.cast<const PythonTrajectory&>().trajectory.time, self); },
          "(nodes,), s; the first is where the steps began.")
      .def_property_readonly(
          "quantities",
          [](const py::object& self) {
            py::dict out;
            const auto& held = self.cast<const PythonTrajectory&>();
            for (std::size_t i = count_of_fields; i < held.fields.size(); ++i)
              out[py::str(held.fields[i].columns.name)] = held.rows(i, self);
            return out;
          },
          "What the system keeps, by name: (nodes, width) each.")
      .def("__repr__", [](const PythonTrajectory& m) {
        return fmt::format("<trajectory: {}, {} steps in {:.3g} s>", m.status, m.steps, m.seconds);
      });
  bind_fields(integrated, true);

  py::class_<BoundaryPath> path(module, "BoundarySolution", "A stationary path between two ends.");
  path.def_readonly("cost", &BoundaryPath::cost, "The sum of the Lagrangian over its arrows.")
      .def_readonly("starts", &BoundaryPath::starts,
                    "How many starts led to it; none where a way down from a saddle did.")
      .def_readonly("is_minimum", &BoundaryPath::is_minimum, "Whether its second variation is positive.")
      .def_readonly("isolated", &BoundaryPath::isolated, "False: one of a continuous family.")
      .def_readonly("normal", &BoundaryPath::normal, "False: abnormal, its multipliers are not unique.")
      .def_readonly("negative_directions", &BoundaryPath::negative_directions, "Directions that lower the action.")
      .def("__repr__", [](const BoundaryPath& p) {
        return fmt::format("<path of cost {:.10g}, {}>", p.cost, p.is_minimum ? "a minimum" : "no minimum");
      });
  bind_fields(path, false);
  path.def_property_readonly(
          "arrow", [](const py::object& self) { return rows_of(self.cast<const BoundaryPath&>().rows[2], self); },
          "The arrows, (steps, ...).")
      .def_property_readonly(
          "multipliers", [](const py::object& self) { return rows_of(self.cast<const BoundaryPath&>().rows[3], self); },
          "Their multipliers, (steps, m).");

  py::class_<Integrator> integrator(module, "Integrator",
                                    "A trajectory in the making. A step that fails leaves everything as it was.");
  integrator
      .def(py::init<std::shared_ptr<Motion>, bool, py::object>(), py::arg("motion").none(false),
           py::arg("ledger") = true, py::arg("origin") = py::none())
      .def(py::pickle([](Integrator& self) { return self.pickled(); },
                      [](const py::tuple& kept) { return Integrator::resumed(kept); }))
      .def("advance", &Integrator::advance, "One step. Raises SolveError, with its status.")
      .def("integrate", &Integrator::steps, py::arg("steps"), py::arg("every") = 1,
           "So many steps; every n-th node is recorded, and the last. A step that fails ends it: see the status.")
      .def_property_readonly("index", &Integrator::index, "Steps made.")
      .def_property_readonly("time", &Integrator::time, "s")
      .def_property_readonly(
          "state", [](const Integrator& self) { return py::make_tuple(self.now("object"), self.now("momentum")); },
          "(object, momentum).")
      .def_property_readonly(
          "method", [](const Integrator& self) { return lagroid::description(self.traits()); },
          "What the steps declare of themselves.")
      .def_property_readonly("ledger", &Integrator::ledger, "What was promised and found, over all steps so far.")
      .def("quantity", &Integrator::quantity, py::arg("name"), "One of the system's quantities at this node.");
  bind_fields(integrator, true);
}

}  // namespace lagroid::python
