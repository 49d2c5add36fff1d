/// Optimal control problems of scenes.

#include "arrays.hpp"
#include "bindings.hpp"
#include "computing.hpp"
#include "scene.hpp"

#include <control/control_files.hpp>
#include <families/family.hpp>

#include <fmt/format.h>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

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

/// (rows, columns), a copy.
py::array table(const std::vector<std::vector<double>>& rows) {
  const auto columns = rows.empty() ? 0 : Eigen::Index(rows.front().size());
  Eigen::MatrixXd out(Eigen::Index(rows.size()), columns);
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    for (Eigen::Index j = 0; j < columns; ++j) out(i, j) = rows[std::size_t(i)][std::size_t(j)];
  return owned(std::move(out));
}

}  // namespace

void bind_control(py::module_& module) {
  using R = ControlResult;
  py::class_<R, std::shared_ptr<R>>(module, "ControlResult",
                                    "What lagroid.control returns: the cheapest solution found, or the best failure.")
      .def_readonly("problem", &R::problem, "Its name.")
      .def_readonly("groupoid", &R::groupoid, "The groupoid of its arrows.")
      .def_readonly("state_names", &R::states, "Of the columns of `states`.")
      .def_readonly("control_names", &R::controls, "Of the columns of `controls`.")
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
          "is_strict_minimum", [](const R& r) { return r.report.is_strict_minimum; },
          "Whether second derivatives say so.")
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
          "Of the arrows: the multipliers of their equations, (N, equations).")
      .def_property_readonly(
          "summary", [](const R& r) { return app::control_json(r).dump(2); },
          "JSON, as lagroid control --json prints it.")
      .def("__repr__", [](const R& r) {
        return fmt::format("<{}: {}, cost {:.10g}>", r.problem, to_string(r.report.status), r.report.cost);
      });
  module.def("control", solve_scene, py::arg("scene"), py::arg("folder"));
}

}  // namespace lagroid::python
