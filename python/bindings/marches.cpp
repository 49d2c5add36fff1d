/// Marches of systems that were made in Python, step by step or many steps at once.

#include "arrays.hpp"
#include "bindings.hpp"
#include "computing.hpp"

#include <simulation.hpp>

#include <lagroid/core/version.hpp>
#include <lagroid/python/any_march.hpp>
#include <lagroid/run/archive.hpp>
#include <lagroid/run/ledger.hpp>

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

/// The rows of a field; matrices are columns first in memory.
py::array rows_of(const Rows& rows, py::handle owner) {
  std::vector<py::ssize_t> shape{py::ssize_t(rows.count)};
  std::vector<py::ssize_t> strides{py::ssize_t(rows.field.width())};
  py::ssize_t stride = 1;
  for (const std::size_t n : rows.field.shape) {
    shape.push_back(py::ssize_t(n));
    strides.push_back(stride);
    stride *= py::ssize_t(n);
  }
  return view(rows.values.data(), std::move(shape), std::move(strides), owner);
}

/// What many steps left.
struct Marched {
  std::string status = "converged";
  std::string message;
  long steps = 0;
  double seconds = 0;
  std::vector<double> time;
  std::vector<Rows> rows;
  std::vector<Rows> quantities;
};

/// A step that was not made.
[[noreturn]] void refuse(const std::string& status, const std::string& message) {
  const auto error = py::module_::import("lagroid.errors").attr("SolveError")(message, status);
  PyErr_SetObject(error.get_type().ptr(), error.ptr());
  throw py::error_already_set();
}

class Integrator {
 public:
  /// `origin`: the system and the arguments of its `integrator`, from which a pickle begins the march anew; or None.
  Integrator(std::shared_ptr<AnyMarch> march, bool ledger, py::object origin)
      : march_(std::move(march)), ledger_(ledger), origin_(std::move(origin)) {
    for (const Watched& each : march_->watched()) {
      scratch_.emplace_back(each.components.size());
      if (ledger)
        watches_.emplace_back(each.name, each.promise, each.components.size(),
                              each.sized ? lagroid::SizeOf::terms : lagroid::SizeOf::value);
    }
    observe();
  }

  /// One step, in the calling thread, with the interpreter's lock: it takes microseconds.
  void advance() {
    const Busy busy(busy_);
    const StepReport report = step();
    if (!report.converged()) refuse(std::string(to_string(report.status)), failure(report));
  }

  std::shared_ptr<Marched> steps(long count, long every) {
    if (count < 0) throw py::value_error("steps: must not be negative");
    if (every < 1) throw py::value_error("every: must be at least 1");
    const Busy busy(busy_);
    return computing([&] {
      auto out = std::make_shared<Marched>();
      for (const Field& field : march_->fields()) out->rows.emplace_back(field);
      for (const Watched& each : march_->watched())
        out->quantities.emplace_back(Field{each.name, {each.components.size()}, each.on_arrows});
      const auto start = std::chrono::steady_clock::now();
      record(*out);
      for (long k = 1; k <= count; ++k) {
        const StepReport report = step();
        if (!report.converged()) {
          out->status = std::string(to_string(report.status));
          out->message = failure(report);
          break;
        }
        out->steps = k;
        if (k % every == 0 || k == count) record(*out);
        if (lagroid::InterruptGuard::interrupted()) break;
      }
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
    persist(archive);
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
    auto out = std::make_unique<Integrator>(begun.march_, begun.ledger_, origin);
    const auto refuse = [] { return py::value_error("an integrator pickled by another lagroid; begin it anew"); };
    try {
      lagroid::Archive archive(nlohmann::json::from_cbor(kept[2].cast<std::string>()));
      out->persist(archive);
    } catch (const nlohmann::json::exception&) {
      throw refuse();
    } catch (const std::out_of_range&) {
      throw refuse();
    }
    return out;
  }

  long index() const {
    const Busy busy(busy_);
    return march_->index();
  }
  double time() const {
    const Busy busy(busy_);
    return march_->time();
  }
  MethodTraits traits() const { return march_->traits(); }
  std::vector<lagroid::LedgerEntry> ledger() const {
    const Busy busy(busy_);
    std::vector<lagroid::LedgerEntry> out;
    if (ledger_ && march_->constrained()) out.push_back(lagroid::constraint_entry(largest_residual_, residual_size_));
    for (const auto& watch : watches_) out.push_back(watch.entry());
    return out;
  }

  /// A field at the node that was reached, in an array of its own.
  py::array now(const std::string& name) const {
    const auto& fields = march_->fields();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i].name != name) continue;
      auto* rows = new Rows(fields[i]);
      const py::capsule owner(rows, [](void* p) { delete static_cast<Rows*>(p); });
      look(name, fields[i].on_arrows, [&] { march_->read(i, rows->add()); });
      return rows_of(*rows, owner)[py::int_(0)].cast<py::array>();
    }
    throw py::key_error(name);
  }
  py::array quantity(const std::string& name) const {
    const auto& all = march_->watched();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].name != name) continue;
      std::vector<double> out(all[i].components.size());
      look(name, all[i].on_arrows, [&] { march_->watch(i, out.data()); });
      return owned(std::move(out));
    }
    throw py::key_error(name);
  }

 private:
  /// Held while the march is made or looked at.
  class Busy {
   public:
    explicit Busy(std::atomic<bool>& busy) : busy_(busy) {
      if (busy_.exchange(true)) throw std::runtime_error("the integrator is marched by another thread");
    }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;
    ~Busy() { busy_ = false; }

   private:
    std::atomic<bool>& busy_;
  };

  /// Reads numbers at this node.
  template <class F> void look(const std::string& name, bool on_arrows, const F& read) const {
    const Busy busy(busy_);
    if (on_arrows && march_->index() == 0) throw py::value_error(name + ": no step was made yet");
    read();
  }
  /// Visits all that a pickle holds beside the origin.
  void persist(lagroid::Archive& archive) {
    archive.tape("march", [&](Tape& tape) { march_->persist(tape); });
    archive("largest residual", largest_residual_);
    archive("residual size", residual_size_);
    for (std::size_t i = 0; i < watches_.size(); ++i) archive(fmt::format("watch {}", i), watches_[i]);
  }
  StepReport step() {
    const StepReport report = march_->advance();
    if (report.converged()) observe();
    return report;
  }
  std::string failure(const StepReport& report) const {
    return lagroid::step_failure(report, march_->index() + 1, march_->time(), march_->mode());
  }
  void observe() {
    if (ledger_ && march_->constrained() && march_->index() > 0) {
      const double residual = march_->residual();
      // The size of the constraints' terms changes slowly: looked at where a residual stands out.
      if (!(residual <= largest_residual_) || residual_size_ == 0) {
        residual_size_ = std::max(residual_size_, march_->residual_size());
        largest_residual_ = lagroid::worse(largest_residual_, residual);
      }
    }
    for (std::size_t i = 0; i < watches_.size(); ++i) {
      if (march_->watched()[i].on_arrows && march_->index() == 0) continue;
      const double size = march_->watch(i, scratch_[i].data());
      watches_[i].observe(scratch_[i].data(), march_->watched()[i].sized ? size : lagroid::norm_of(scratch_[i]));
    }
  }
  void record(Marched& out) const {
    const bool has_step = march_->index() > 0;
    out.time.push_back(march_->time());
    const auto put = [&](Rows& rows, const auto& read) {
      if (rows.field.on_arrows && (!has_step || out.time.size() == 1)) return;
      read(rows.add());
    };
    for (std::size_t i = 0; i < out.rows.size(); ++i) put(out.rows[i], [&](double* to) { march_->read(i, to); });
    for (std::size_t i = 0; i < out.quantities.size(); ++i)
      put(out.quantities[i], [&](double* to) { march_->watch(i, to); });
  }

  static constexpr const char* version = LAGROID_VERSION;

  std::shared_ptr<AnyMarch> march_;
  bool ledger_;
  py::object origin_;
  double largest_residual_ = 0;
  double residual_size_ = 0;
  std::vector<lagroid::QuantityWatch> watches_;
  std::vector<std::vector<double>> scratch_;
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
            for (const Rows& each : self.cast<const typename Class::type&>().rows)
              if (each.field.name == key) return rows_of(each, self);
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

void bind_marches(py::module_& module) {
  py::class_<AnyMarch, std::shared_ptr<AnyMarch>>(module, "AnyMarch", "What an Integrator marches.");

  py::class_<Marched, std::shared_ptr<Marched>> marched(
      module, "March", "The nodes of many steps: arrays over the march's own numbers, read-only and not copied.");
  marched.def_readonly("status", &Marched::status, "converged, or why the last step was not made.")
      .def_readonly("message", &Marched::message, "Which step, and what to do.")
      .def_readonly("steps", &Marched::steps, "Steps made.")
      .def_readonly("seconds", &Marched::seconds, "Of the steps.")
      .def_property_readonly(
          "converged", [](const Marched& m) { return m.status == "converged"; }, "Whether every step was made.")
      .def_property_readonly(
          "time", [](const py::object& self) { return view(self.cast<const Marched&>().time, self); },
          "(nodes,), s; the first is where the march began.")
      .def_property_readonly(
          "quantities",
          [](const py::object& self) {
            py::dict out;
            for (const Rows& each : self.cast<const Marched&>().quantities)
              out[py::str(each.field.name)] = rows_of(each, self);
            return out;
          },
          "What the system keeps, by name: (nodes, width) each.")
      .def("__repr__", [](const Marched& m) {
        return fmt::format("<march: {}, {} steps in {:.3g} s>", m.status, m.steps, m.seconds);
      });
  bind_fields(marched, true);

  py::class_<BoundaryPath> path(module, "BoundaryPath", "A stationary path between two ends.");
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
      .def(py::init<std::shared_ptr<AnyMarch>, bool, py::object>(), py::arg("march").none(false),
           py::arg("ledger") = true, py::arg("origin") = py::none())
      .def(py::pickle([](Integrator& self) { return self.pickled(); },
                      [](const py::tuple& kept) { return Integrator::resumed(kept); }))
      .def("advance", &Integrator::advance, "One step. Raises SolveError, with its status.")
      .def("march", &Integrator::steps, py::arg("steps"), py::arg("every") = 1,
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
