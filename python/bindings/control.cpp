/// Optimal control problems of scenes.

#include "arrays.hpp"
#include "bindings.hpp"
#include "computing.hpp"
#include "scene.hpp"

#include <control/control_files.hpp>
#include <control/results/row_words.hpp>
#include <control/scene_loop.hpp>
#include <families/family.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::python {

namespace {

using app::ControlResult;

std::shared_ptr<ControlResult> solve_scene(const Scene& scene, const std::optional<std::filesystem::path>& folder) {
  const app::Section file = scene.read();
  app::require_command(file, "control");
  const app::ControlProblem& problem = app::control_problem(file);
  std::optional<lagroid::OutputFolder> held;
  if (folder) held.emplace(app::folder_for_control(*folder, file));
  return std::make_shared<ControlResult>(computing([&] {
    ControlResult found = problem.solve(file, [](int) { return !lagroid::InterruptGuard::interrupted(); });
    std::string note;
    if (folder) app::write_control(found, *folder, note);
    return found;
  }));
}

/// A control loop with the words of its scene.
class BoundLoop {
 public:
  explicit BoundLoop(const Scene& scene) {
    const app::Section file = scene.read();
    app::require_command(file, "control");
    problem_ = &app::control_problem(file);
    loop_ =
        computing([&] { return problem_->loop(file, [](int) { return !lagroid::InterruptGuard::interrupted(); }); });
  }
  const app::ControlProblem& problem() const { return *problem_; }
  const app::SceneLoop& loop() const { return *loop_; }
  py::array advance(const std::vector<double>& state) {
    if (state.size() != problem_->states().size())
      throw py::value_error(fmt::format("the state has {} numbers ({}), here are {}", problem_->states().size(),
                                        fmt::join(problem_->states(), ", "), state.size()));
    for (const double x : state)
      if (!std::isfinite(x)) throw py::value_error("a state is of finite numbers");
    return owned(computing([&] {
      loop_->advance(state);
      return loop_->control();
    }));
  }

 private:
  const app::ControlProblem* problem_;
  std::unique_ptr<app::SceneLoop> loop_;
};

/// (rows, columns), a copy.
py::array table(const std::vector<std::vector<double>>& rows) {
  const auto columns = rows.empty() ? 0 : Eigen::Index(rows.front().size());
  Eigen::MatrixXd out(Eigen::Index(rows.size()), columns);
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    for (Eigen::Index j = 0; j < columns; ++j) out(i, j) = rows[std::size_t(i)][std::size_t(j)];
  return owned(std::move(out));
}

std::vector<std::string> of_costates(const ControlResult& found, std::string app::CostateColumn::*what) {
  std::vector<std::string> out;
  for (const app::CostateColumn& each : app::costate_columns(found)) out.push_back(each.*what);
  return out;
}

}  // namespace

void bind_control(py::module_& module) {
  using R = ControlResult;
  py::class_<R, std::shared_ptr<R>>(module, "ControlResult",
                                    "What lagroid.control returns: the cheapest solution found, or the best failure.")
      .def_readonly("problem", &R::problem, "Its name.")
      .def_readonly("groupoid", &R::groupoid, "The groupoid of its arrows.")
      .def_readonly("state_names", &R::states, "Of the columns of `states`.")
      .def_readonly("state_units", &R::state_units, "Of the same.")
      .def_readonly("control_names", &R::controls, "Of the columns of `controls`.")
      .def_readonly("control_units", &R::control_units, "Of the same.")
      .def_property_readonly(
          "costate_names", [](const R& r) { return of_costates(r, &app::CostateColumn::name); },
          "Of the columns of `costates`, as in trajectory.csv.")
      .def_property_readonly(
          "costate_units", [](const R& r) { return of_costates(r, &app::CostateColumn::unit); },
          "Of the same: that of the cost per unit of the coordinate.")
      .def_property_readonly(
          "status", [](const R& r) { return std::string(to_string(r.report.status)); }, "converged, or why not.")
      .def_property_readonly(
          "message", [](const R& r) { return r.report.message; }, "Where it did not converge: why, and what to do.")
      .def_property_readonly(
          "converged", [](const R& r) { return r.report.converged(); }, "Whether a solution was found.")
      .def_property_readonly(
          "cost", [](const R& r) { return r.report.cost; }, "Of the cheapest.")
      .def_property_readonly(
          "duration", [](const R& r) { return r.times.back(); }, "T, in the units of the problem.")
      .def_property_readonly(
          "phases",
          [](const R& r) {
            py::dict out;
            for (const auto& each : r.phases) out[py::str(each.name)] = each.duration;
            return out;
          },
          "The durations of the phases by their names, in order; empty where the scene has none.")
      .def_property_readonly(
          "is_strict_minimum", [](const R& r) { return r.report.is_strict_minimum(); },
          "Whether second derivatives say so.")
      .def_property_readonly(
          "is_saddle", [](const R& r) { return r.report.is_saddle(); },
          "Whether second derivatives say that the cost falls along some direction, and nothing below was found.")
      .def_property_readonly(
          "iterations", [](const R& r) { return r.iterations; }, "Of all starts.")
      .def_property_readonly(
          "costs", [](const R& r) { return owned(std::vector<double>(r.costs)); },
          "Of all distinct solutions, cheapest first.")
      .def_property_readonly(
          "times", [](const R& r) { return owned(std::vector<double>(r.times)); }, "Of the nodes, (N + 1,).")
      .def_property_readonly(
          "states", [](const R& r) { return table(r.state_rows); }, "At the nodes, (N + 1, states).")
      .def_property_readonly(
          "controls", [](const R& r) { return table(r.control_rows); }, "Of the arrows, (N, controls).")
      .def_property_readonly(
          "costates", [](const R& r) { return table(r.costate_rows); },
          "Of the arrows: the multipliers of their equations and, behind them, of conditions on nodes, (N, columns).")
      .def_property_readonly(
          "summary", [](const R& r) { return app::control_json(r).dump(2); },
          "JSON, as lagroid control --json prints it.")
      .def("__repr__", [](const R& r) {
        return fmt::format("<{}: {}, cost {:.10g}>", r.problem, to_string(r.report.status), r.report.cost);
      });
  using L = BoundLoop;
  py::class_<L>(
      module, "ControlLoop",
      "Model predictive control: a scene's problem, solved anew at every sample from where the motion is found "
      "to be (docs/optimal_control.md).")
      .def(py::init<const Scene&>(), py::arg("scene"))
      .def_property_readonly(
          "state_names", [](const L& l) { return l.problem().states(); }, "Of the numbers of a state.")
      .def_property_readonly(
          "control_names", [](const L& l) { return l.problem().controls(); }, "Of the numbers of a control.")
      .def("advance", &L::advance, py::arg("state"), "A sample later, at this state: the control until the next one.")
      .def_property_readonly(
          "control", [](const L& l) { return owned(l.loop().control()); }, "To be applied until the next sample.")
      .def_property_readonly(
          "predicted", [](const L& l) { return owned(l.loop().predicted()); },
          "The state at the next sample, by the plan.")
      .def_property_readonly(
          "step", [](const L& l) { return l.loop().step(); }, "From a sample to the next.")
      .def_property_readonly(
          "status", [](const L& l) { return std::string(to_string(l.loop().report().status)); },
          "Of the last solve: converged, or why not.")
      .def_property_readonly(
          "iterations", [](const L& l) { return l.loop().report().iterations; }, "Of the last solve.")
      .def_property_readonly(
          "violation", [](const L& l) { return l.loop().report().violation; },
          "Of the last plan's constraints, the largest.")
      .def(
          "latency", [](const L& l, double percent) { return l.loop().latency().percentile(percent); },
          py::arg("percent"), "Seconds in which so many percent of the samples were solved, to five percent.")
      .def("__repr__", [](const L& l) {
        return fmt::format("<loop of {}: {} samples>", l.problem().name(), l.loop().latency().count());
      });
  module.def("control", solve_scene, py::arg("scene"), py::arg("folder"));
}

}  // namespace lagroid::python
