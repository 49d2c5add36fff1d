#pragma once
/// `study`: what accuracy costs a system of one's own, error against processor time of every method that it has.
///
/// It answers which method and which step to take for an error that is acceptable.
///
///     const State<Pair<1>> start{Vector<double, 1>(1.0), Vector<double, 1>(0.0)};
///     const Findings findings = study(Pendulum{}, start, {.steps = 1000, .budget = 10, .folder = "out/study"});
///     std::cout << study_text(findings);
///
/// Requires a system with a step `h`; it compiles all methods that the system has, which takes a minute. Returns
/// Findings, of what was measured until the budget was over or Ctrl-C came.
///
/// Errors: std::invalid_argument, UnknownMethod, std::domain_error and FolderRefused, as listed at `study`.

#include <lagroid/run/motion/system_marks.hpp>
#include <lagroid/run/motion/system_motion.hpp>
#include <lagroid/run/study/methods.hpp>
#include <lagroid/run/study/study.hpp>
#include <lagroid/solvers/integrators/integrator_methods.hpp>
#include <lagroid/solvers/methods/methods.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// Options of `study`.
template <DiscreteSystem Sys> struct StudyOptions {
  using G = typename Sys::GroupoidType;

  long steps = 1000;                          ///< of size system.h, which the motion lasts
  std::string name = "system";                ///< in reports: one line of text
  std::optional<ArrowOf<G>> configuration{};  ///< an arrow that ends at the start's object; its unit
  std::string methods{};                      ///< patterns of names, separated by commas: "splitting*"; empty: all
  std::vector<double> step_sizes{};           ///< empty: halved until errors are those of round-off
  double longest = 0.25;                      ///< s that a run may take, where step sizes are found
  double target = 1e-6;                       ///< the error for which a method is recommended
  double budget = 60;                         ///< s of wall clock, all of it
  int repetitions = 5;                        ///< of every run, to be timed
  std::filesystem::path folder{};             ///< for page, figures, CSV and JSON; empty: no files
  bool progress = false;                      ///< a bar on the terminal
};

/// The system from a state as an experiment. Names of methods are those of `named_methods`. The system must have a step
/// `h`.
template <DiscreteSystem Sys>
requires HasTimeStep<Sys> Experiment experiment_of(const Sys& system, const State<typename Sys::GroupoidType>& start,
                                                   const StudyOptions<Sys>& options) {
  const std::vector<NamedMethod> named = named_methods(capabilities_of(system));
  const auto configuration = options.configuration.value_or(system.groupoid.unit(start.object));
  Experiment out;
  out.name = options.name;
  out.step = system.h;
  out.end = double(options.steps) * system.h;
  for (const NamedMethod& m : named)
    out.methods.push_back({m.name, m.order, m.stages, m.equal_steps, {}, m.to_compare});
  out.motion = [=](const Method& method, double h, double) -> std::unique_ptr<Motion> {
    const auto found = std::find_if(named.begin(), named.end(), [&](const auto& m) { return m.name == method.name; });
    Sys stepped = system;
    stepped.h = h;
    try {
      return std::make_unique<SystemMotion<Sys>>(
          stepped, options.name, std::vector<FieldOf<Sys>>{}, quantities_of(stepped),
          make_integrator(stepped, start, configuration, found->options), found->options);
    } catch (const std::exception& error) {
      throw MethodRefused(error.what());
    }
  };
  return out;
}

namespace detail {

/// A study with its page in `folder`, where there is one; `of` identifies the motion that is studied.
Findings study_with_files(Experiment experiment, StudyRequest request, const std::string& methods,
                          const std::filesystem::path& folder, const std::string& of, bool progress);

/// Throws std::invalid_argument unless these are numbers of a study.
void require_study(const StudyRequest& request, double step, long steps);

/// What has to be the same for two studies to be of the same motion. Throws std::invalid_argument where the name is not
/// one line of text, or the start no numbers.
std::string studied(const std::string& name, double step, long steps, const std::vector<NamedVector>& start);

}  // namespace detail

/// Errors against processor time of every method that the system has, with a recommendation: as `lagroid study` does of
/// a scene. `study_text(findings)` is the result in words.
///
/// Ctrl-C ends it with what was measured so far. Throws std::invalid_argument for a name that is not one line of text,
/// or numbers of which there is no study; UnknownMethod for a pattern that is no method's name; std::domain_error where
/// no two runs agree, so that there is nothing to compare with; FolderRefused where the folder holds something else.
template <DiscreteSystem Sys>
requires HasTimeStep<Sys> Findings study(const Sys& system, const State<typename Sys::GroupoidType>& start,
                                         const StudyOptions<Sys>& options = {}) {
  Experiment experiment = experiment_of(system, start, options);
  StudyRequest request{.steps = {options.step_sizes, options.longest},
                       .target = options.target,
                       .budget = options.budget,
                       .repetitions = options.repetitions};
  detail::require_study(request, system.h, options.steps);
  auto from = experiment.begin(experiment.methods.front(), system.h)->state();
  from.push_back({"system", marks_of(system, start.object)});
  const std::string of = detail::studied(options.name, system.h, options.steps, from);
  return detail::study_with_files(std::move(experiment), std::move(request), options.methods, options.folder, of,
                                  options.progress);
}

}  // namespace lagroid
