/// What accuracy costs a scene.

#include "bindings.hpp"
#include "computing.hpp"
#include "scene.hpp"

#include <lagroid/run/machine.hpp>
#include <lagroid/run/output_folder.hpp>

#include <study/accuracy.hpp>
#include <study/methods.hpp>
#include <study/study_files.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace lagroid::python {

namespace {

/// How to study; see app/study/study.hpp.
std::string study(const Scene& scene, const std::string& methods, std::vector<double> steps, double target,
                  double longest, double reference_time, double seconds, int repetitions,
                  const std::optional<std::filesystem::path>& folder) {
  const app::Section read = scene.read();
  if (read.has("accuracy")) app::check_accuracy(read);
  app::Experiment experiment = app::read_experiment(read);
  for (const double h : steps)
    if (!(h > 0 && h <= experiment.end))
      throw py::value_error("steps: must be positive, and no longer than the scene lasts");
  if (!(seconds > 0)) throw py::value_error("budget: must be positive");
  std::sort(steps.rbegin(), steps.rend());
  std::optional<lagroid::OutputFolder> held;
  if (folder) held.emplace(app::folder_for_study(*folder, read, methods, steps, /*reference=*/"", repetitions));
  app::Findings findings;
  findings.scene = scene.name;
  findings.name = experiment.name;
  findings.command = "lagroid.study(...)";
  findings.machine = lagroid::machine();
  findings.end = experiment.end;
  findings.target = target;
  findings.methods = app::matching(methods, experiment.methods);
  computing([&] {
    experiment.interrupted = lagroid::InterruptGuard::interrupted;
    const app::Budget budget(seconds);
    experiment = app::within(std::move(experiment), budget);
    const auto reference =
        app::extrapolated_reference(experiment, std::min(reference_time, app::share_of_reference * seconds));
    findings.reference = reference->description;
    findings.uncertainty = reference->uncertainty;
    findings.reference_state = reference->at(experiment.end);
    findings.budget = seconds;
    findings.repetitions = repetitions;
    app::Survey found = app::survey(experiment, findings.methods, {steps, longest}, *reference, repetitions, budget,
                                    [](double) { return !lagroid::InterruptGuard::interrupted(); });
    findings.runs = std::move(found.runs);
    findings.left_out = std::move(found.left_out);
    findings.interrupted = lagroid::InterruptGuard::interrupted();
    std::string note;
    if (folder && !lagroid::InterruptGuard::interrupted()) app::write_study(findings, *folder, note);
    return 0;
  });
  return app::study_json(findings);
}

}  // namespace

void bind_studies(py::module_& module) {
  module.def("study", study, py::arg("scene"), py::arg("methods"), py::arg("steps"), py::arg("target"),
             py::arg("longest"), py::arg("reference_time"), py::arg("budget"), py::arg("repetitions"),
             py::arg("folder"));
  module.def(
      "methods",
      [](const Scene& scene) {
        std::vector<std::tuple<std::string, int, std::string>> out;
        for (const app::Method& m : app::read_experiment(scene.read()).methods)
          out.emplace_back(m.name, m.order, app::time_keys(m, ""));
        return out;
      },
      py::arg("scene"));
}

}  // namespace lagroid::python
