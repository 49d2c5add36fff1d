/// What accuracy costs a scene.

#include "bindings.hpp"
#include "computing.hpp"
#include "scene.hpp"

#include <lagroid/run/files/output_folder.hpp>

#include <lagroid/run/study/methods.hpp>
#include <lagroid/run/study/study.hpp>
#include <study/accuracy.hpp>
#include <study/scene_experiment.hpp>

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
  lagroid::Experiment experiment = app::read_experiment(read);
  for (const double h : steps)
    if (!(h > 0 && h <= experiment.end))
      throw py::value_error("steps: must be positive, and no longer than the scene lasts");
  if (!(seconds > 0)) throw py::value_error("budget: must be positive");
  std::sort(steps.rbegin(), steps.rend());
  std::optional<lagroid::OutputFolder> held;
  if (folder)
    held.emplace(lagroid::folder_for_study(*folder, read.whole(), methods, steps, /*reference=*/"", repetitions));
  const lagroid::StudyRequest request{
      .methods = lagroid::matching(methods, experiment.methods),
      .steps = {steps, longest},
      .target = target,
      .budget = seconds,
      .repetitions = repetitions,
      .reference_seconds = std::min(reference_time, lagroid::share_of_reference * seconds)};
  lagroid::Findings findings;
  computing([&] {
    experiment.interrupted = lagroid::InterruptGuard::interrupted;
    findings = lagroid::study(experiment, request, [](double) { return !lagroid::InterruptGuard::interrupted(); });
    findings.scene = scene.name;
    findings.command = "lagroid.study(...)";
    std::string note;
    if (folder && !lagroid::InterruptGuard::interrupted()) lagroid::write_study(findings, *folder, note);
    return 0;
  });
  return lagroid::study_json(findings);
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
        for (const lagroid::Method& m : app::read_experiment(scene.read()).methods)
          out.emplace_back(m.name, m.order, lagroid::time_keys(m, ""));
        return out;
      },
      py::arg("scene"));
}

}  // namespace lagroid::python
