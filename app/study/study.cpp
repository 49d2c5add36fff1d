#include "study.hpp"

#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/files/nesting.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/reports/text.hpp>
#include <lagroid/run/study/methods.hpp>
#include <lagroid/run/study/study.hpp>
#include "../command/shell.hpp"
#include "../command/written.hpp"
#include "../reading/scene_reader.hpp"
#include "accuracy.hpp"
#include "scene_experiment.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>

namespace lagroid::app {

namespace {

/// A mistake on the command line.
class BadOption : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::vector<std::string> parts(const std::string& text, char separator) {
  std::vector<std::string> out;
  std::size_t from = 0;
  while (from <= text.size()) {
    const std::size_t to = std::min(text.find(separator, from), text.size());
    out.push_back(text.substr(from, to - from));
    from = to + 1;
  }
  return out;
}

double positive_number(const std::string& text, const char* option) {
  char* end = nullptr;
  const double x = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(x) || !(x > 0))
    throw BadOption(fmt::format("{}: \"{}\" is no positive number", option, text));
  return x;
}

std::vector<Method> chosen_methods(const char* option, const std::string& patterns, const std::vector<Method>& all) {
  try {
    return matching(patterns, all);
  } catch (const UnknownMethod& error) {
    throw BadOption(fmt::format("{}: {}", option, error.what()));
  }
}

std::vector<double> read_steps(const std::string& text, double end) {
  std::vector<double> out;
  if (text.empty()) return out;
  if (const auto range = parts(text, ':'); range.size() == 3) {
    const double first = positive_number(range[0], "--steps");
    const double last = positive_number(range[1], "--steps");
    const double count = positive_number(range[2], "--steps");
    if (count != std::floor(count) || count < 2 || count > 100)
      throw BadOption("--steps first:last:count: the count is a whole number from 2 to 100");
    for (int k = 0; k < int(count); ++k) out.push_back(first * std::pow(last / first, k / (count - 1)));
  } else {
    for (const std::string& part : parts(text, ',')) out.push_back(positive_number(part, "--steps"));
  }
  for (const double h : out)
    if (h > end || end / h > 1e9)
      throw BadOption(fmt::format("--steps: {:g} does not go with a scene that lasts {:g}", h, end));
  std::sort(out.rbegin(), out.rend());
  return out;
}

/// The reference state of an earlier study of the same scene.
std::unique_ptr<Reference> reference_from(const std::string& file, const Experiment& experiment) {
  const auto refuse = [&](const std::string& why) { return BadOption(fmt::format("--reference {}: {}", file, why)); };
  const auto text = contents(file);
  if (!text) throw refuse("no such file, or it cannot be read; give METHOD@STEP or the study.json of an earlier study");
  const auto read = read_json(*text);
  if (!read) throw refuse("is no study.json");
  try {
    const auto& json = *read;
    if (std::abs(json.at("time").get<double>() - experiment.end) > 1e-12 * experiment.end)
      throw refuse(
          fmt::format("is for t = {:g}, this scene lasts {:g}", json.at("time").get<double>(), experiment.end));
    std::vector<NamedVector> state;
    for (const auto& b : json.at("reference").at("state"))
      state.push_back({b.at("name"), b.at("values").get<std::vector<double>>(), b.at("size")});
    const auto own = experiment.begin(experiment.methods.front(), experiment.step)->state();
    if (std::isnan(distance(own, state))) throw refuse("is of another system");
    const std::string method = json.at("reference").at("method");
    if (const std::string problem = text_problem(method); !problem.empty())
      throw refuse("reference.method: " + problem);
    return known_reference(experiment, state, json.at("reference").at("uncertainty").get<double>(),
                           method + ", from " + file);
  } catch (const nlohmann::json::exception&) {
    throw refuse("is no study.json");
  }
}

/// METHOD@STEP, or an earlier study's file.
std::unique_ptr<Reference> reference_of(const std::string& text, const Experiment& experiment) {
  const auto at = text.rfind('@');
  if (at == std::string::npos) return reference_from(text, experiment);
  if (at == 0) throw BadOption("--reference: name a method before the @, as in splitting@0.001");
  const auto method = chosen_methods("--reference", text.substr(0, at), experiment.methods);
  if (!method.front().equal_steps)
    throw BadOption(fmt::format("--reference: steps of {} vary, so that half of one says nothing; name another",
                                method.front().name));
  const double h = positive_number(text.substr(at + 1), "--reference");
  if (h > experiment.end)
    throw BadOption(fmt::format("--reference: a step of {:g} is longer than the scene, {:g}", h, experiment.end));
  return method_reference(experiment, method.front(), h);
}

std::string command_of(const StudyCommandOptions& options) {
  std::string out = "./lagroid study " + quoted(options.scene);
  for (const auto& given : options.overrides) out += " --set " + quoted(given);
  if (!options.methods.empty()) out += " --methods " + quoted(options.methods);
  if (!options.steps.empty()) out += " --steps " + quoted(options.steps);
  if (!options.reference.empty()) out += " --reference " + quoted(options.reference);
  const StudyCommandOptions usual;
  if (options.target != usual.target) out += fmt::format(" --target {:g}", options.target);
  if (options.longest != usual.longest) out += fmt::format(" --longest {:g}", options.longest);
  if (options.budget != usual.budget) out += fmt::format(" --budget {:g}", options.budget);
  if (options.repetitions != usual.repetitions) out += fmt::format(" --repetitions {}", options.repetitions);
  if (!options.out.empty()) out += " --out " + quoted(options.out);
  return out;
}

std::string listing(const Experiment& experiment, bool json) {
  if (json) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const Method& m : experiment.methods)
      out.push_back({{"name", m.name}, {"order", m.order}, {"time", lagroid::time_keys(m, "")}});
    return out.dump(2) + "\n";
  }
  std::string out = fmt::format("{}: methods, and what [time] holds for them\n", experiment.name);
  for (const Method& m : experiment.methods)
    out += fmt::format("  {:<28} order {:<3} {}\n", m.name, m.order, lagroid::time_keys(m, ""));
  return out;
}

}  // namespace

void add_study_options(CLI::App& command, StudyCommandOptions& options) {
  add_scene_options(command, options);
  command.add_option("--methods", options.methods,
                     "those whose names match, as in 'splitting*,runge-kutta'; all by default (see --list)");
  command.add_option("--steps", options.steps, "sizes, as 0.1,0.05 or first:last:count; found by default");
  command.add_option("--reference", options.reference,
                     "METHOD@STEP, or the study.json of an earlier study; by default the method of highest order, "
                     "extrapolated");
  command.add_option("--target", options.target, "the error for which a method is recommended")
      ->check(between(1e-15, 1))
      ->capture_default_str();
  command.add_option("--longest", options.longest, "seconds that a run may take, where steps are found")
      ->check(between(1e-3, 1e5))
      ->capture_default_str();
  command
      .add_option("--budget", options.budget,
                  "seconds of wall clock that all of it may take: spent first on the methods that are the cheapest, "
                  "or near them; what was not measured for want of time is told")
      ->check(between(0.1, 1e7))
      ->capture_default_str();
  command.add_option("--repetitions", options.repetitions, "of every run, interleaved, to be timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_option("--out", options.out, "write study.html, figures, CSV and JSON into this folder");
  command.add_flag("--list", options.list, "say which methods apply to the scene, and run nothing");
}

int study(const StudyCommandOptions& options) {
  Findings findings;
  std::string note;
  std::optional<OutputFolder> folder;
  try {
    const Section scene = read_scene(options.scene, options.overrides);
    if (scene.has("accuracy")) check_accuracy(scene);
    const Experiment experiment = read_experiment(scene);
    if (options.list) {
      print(listing(experiment, options.json));
      return 0;
    }
    const std::vector<Method> methods = chosen_methods("--methods", options.methods, experiment.methods);
    Steps steps{read_steps(options.steps, experiment.end), options.longest};
    if (!options.out.empty())
      folder.emplace(folder_for_study(options.out, scene.whole(), options.methods, steps.sizes, options.reference,
                                      options.repetitions));
    if (!options.json)
      print(
          fmt::format("{}: {} methods, within {:g} s (--budget): {}then rounds of smaller steps, in which methods far "
                      "dearer than others drop out\n",
                      experiment.name, methods.size(), options.budget,
                      options.reference.empty() ? "a third for the reference at most, " : "the reference, "));
    StudyRequest request{.methods = methods,
                         .steps = std::move(steps),
                         .target = options.target,
                         .budget = options.budget,
                         .repetitions = options.repetitions};
    if (!options.reference.empty())
      request.reference = [&](const Experiment& of) { return reference_of(options.reference, of); };
    findings = study_until_interrupted(experiment, request, !options.json);
    findings.scene = options.scene;
    findings.command = command_of(options);
  } catch (const MethodRefused& error) {
    return refuse(options.json, exit_bad_input, "invalid_scene", fmt::format("{}: {}", options.scene, error.what()));
  } catch (const BadOption& error) {
    return refuse(options.json, exit_bad_input, "invalid_command_line", error.what());
  } catch (const std::domain_error& error) {
    return refuse(options.json, exit_failed, "no_reference", error.what());
  }
  std::string report = options.json ? study_json(findings) + "\n" : study_text(findings);
  if (!options.out.empty()) {
    const auto files = write_study(findings, options.out, note);
    if (!options.json) {
      if (!note.empty()) report += fmt::format("  note: no pictures: {}\n", note);
      for (const auto& file : files) report += fmt::format("  wrote {}\n", file.string());
    }
  } else if (!options.json) {
    report += "  (no files written; --out DIR writes page, figures, CSV and JSON)\n";
  }
  print(report);
  if (!findings.interrupted) return code_after_writing(0, options.scene);
  complain(fmt::format("{}: interrupted; what was measured so far is told", options.scene));
  return exit_interrupted;
}

}  // namespace lagroid::app
