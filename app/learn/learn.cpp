#include "learn.hpp"

#include "../command/written.hpp"
#include "../spheres/numbers.hpp"
#include "learn_files.hpp"
#include "trajectory_files.hpp"

#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/progress.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <new>
#include <utility>

namespace lagroid::app {

namespace {

using learning::TrainingStatus;

constexpr double usual_validation = 0.2;

std::string integrator_names() {
  std::string out;
  for (const LieGroupMethod& method : lie_group_methods::all) {
    if (!out.empty()) out += ", ";
    out += method.name;
  }
  return out;
}

int exit_code(TrainingStatus outcome) {
  switch (outcome) {
    case TrainingStatus::interrupted:
      return exit_interrupted;
    case TrainingStatus::too_little_data:
      return exit_bad_input;
    case TrainingStatus::not_finite:
      return exit_failed;
    default:
      return 0;
  }
}

/// Reads what the options name. Throws DataError and ModelError.
TrainingOutcome prepare(const LearnOptions& options) {
  TrainingOutcome outcome;
  outcome.options = options;
  ReadTrajectories given = read_trajectories(options.data, options.noise, options.points);
  outcome.data = std::move(given.trajectories);
  if (given.left_out > 0)
    outcome.notes.push_back(
        fmt::format("{} points at the ends of trajectories are left out: they make no whole piece", given.left_out));
  const std::string space = to_string(space_of(outcome.data));
  if (options.model.ends_with(".json")) {
    outcome.learned = read_model(options.model);
    if (const std::string its = to_string(outcome.learned.model->space()); its != space)
      throw DataError(
          fmt::format("{} is on {}, {} on {}; give data of its system", options.model, its, options.data, space));
    if (options.dissipation && !outcome.learned.model->damped())
      throw ModelError(
          fmt::format("{} declares no dissipation; leave --dissipation out, or begin anew with it", options.model));
  } else {
    outcome.learned.model =
        named_model(options.model, space_of(outcome.data),
                    options.dissipation ? learning::Dissipation::rayleigh : learning::Dissipation::none);
  }
  if (!options.integrator) outcome.options.integrator = outcome.data.bodies > 0 ? "commutator-free-4" : "runge-kutta-4";
  if (options.test) {
    outcome.test = read_trajectories(*options.test, options.test_noise).trajectories;
    if (const std::string its = to_string(space_of(*outcome.test)); its != space)
      throw DataError(
          fmt::format("{} is on {}, {} on {}; give data of one system", *options.test, its, options.data, space));
  }
  return outcome;
}

learning::Trained train(const TrainingOutcome& outcome) {
  const LearnOptions& options = outcome.options;
  learning::Training training;
  training.method = *lie_group_methods::named(*options.integrator);
  training.substeps = options.substeps;
  training.seed = options.seed;
  training.begin = outcome.learned.parameters;
  training.starts = training.begin.size() > 0 ? 1 : options.starts;
  training.iterations = options.iterations;
  training.validation = options.validation.value_or(options.noise > 0 ? usual_validation : 0);
  training.enough = options.enough;
  training.seconds = options.seconds;
  const long trials = training.starts > 1 ? long(training.starts) * training.trial : 0;
  Progress progress(options.model, trials + options.iterations, !options.json);
  long tried = 0;
  training.callback = [&](const learning::Stage& now) {
    progress.update(now.start < training.starts && trials > 0 ? ++tried : trials + now.iteration);
    return true;
  };
  training.stop = InterruptGuard::interrupted;
  return learning::train(*outcome.learned.model, outcome.data, training);
}

/// On held-out data, unless Ctrl-C comes, or came.
void measure(TrainingOutcome& outcome) {
  const auto& [model, parameters] = outcome.learned;
  outcome.measures = learning::measure(*model, parameters, *outcome.test, 1e-12, InterruptGuard::interrupted);
  if (outcome.measures->complete) return;
  outcome.measures.reset();
  outcome.notes.push_back("interrupted, so that nothing was measured on " + *outcome.options.test);
}

/// Ends a training that left no model.
int refuse_untrained(const TrainingOutcome& outcome) {
  const auto& trained = outcome.trained;
  const int code = exit_code(trained.outcome);
  const bool goes_on = outcome.learned.parameters.size() > 0 && trained.outcome == TrainingStatus::not_finite;
  return refuse(outcome.options.json, code != 0 ? code : exit_failed, std::string(to_string(trained.outcome)),
                fmt::format("{}: {}", goes_on ? outcome.options.model : outcome.options.data, trained.message));
}

int serve(const LearnOptions& options) {
  if (options.integrator && lie_group_methods::named(*options.integrator) == nullptr)
    return refuse(
        options.json, exit_bad_input, "invalid_command_line",
        fmt::format("--integrator {}: there is none; take one of {}", *options.integrator, integrator_names()));
  TrainingOutcome outcome;
  std::optional<OutputFolder> folder;
  try {
    outcome = prepare(options);
    if (options.out) folder.emplace(folder_for_training(*options.out, outcome));
  } catch (const DataError& error) {
    return refuse(options.json, exit_bad_input, "invalid_data", error.what());
  } catch (const ModelError& error) {
    return refuse(options.json, exit_bad_input, "invalid_command_line", error.what());
  }
  const InterruptGuard guard;
  outcome.trained = train(outcome);
  if (!outcome.trained.usable()) return refuse_untrained(outcome);
  outcome.learned.parameters = outcome.trained.parameters;
  if (!outcome.trained.mass_determined)
    outcome.notes.emplace_back(
        "the data do not determine the mass matrix; give motions that differ more, or go on longer");
  if (!outcome.trained.dissipation_determined)
    outcome.notes.emplace_back("the data do not determine the friction; give more and different motions");
  if (outcome.test) measure(outcome);
  const bool unmeasured = outcome.test && !outcome.measures;
  const int code = unmeasured ? exit_interrupted : exit_code(outcome.trained.outcome);
  std::string text = training_text(outcome);
  auto json = training_json(outcome);
  if (options.out) {
    std::string note;
    const auto files = write_training(outcome, *options.out, note);
    tell_written(files, note, text, json);
  } else {
    text += "  (no files written; --out DIR writes model, history, plot and summary)\n";
  }
  print(options.json ? json_text(json) + "\n" : text);
  if (code != 0)
    complain(fmt::format("{}: {}", options.data, unmeasured ? outcome.notes.back() : outcome.trained.message));
  return code_after_writing(code, options.data);
}

}  // namespace

void add_learn_options(CLI::App& command, LearnOptions& options) {
  const auto share = number_that_is("a share from 0 to 0.9", [](double x) { return x >= 0 && x <= 0.9; });
  command
      .add_option(
          "data", options.data,
          "trajectories, a .csv or .h5 file (several in R^n by .csv alone), or the trajectory.h5 of a run in R^n "
          "(see docs/learning.md)")
      ->required();
  command.add_option(
      "--model", options.model,
      "of the potential on spheres, of H(q, p) in R^n: polynomial:DEGREE, or network:UNITS[,UNITS...] (default "
      "network:8); or a model.json to go on from");
  command.add_flag("--dissipation", options.dissipation, "learn a friction -R q' too, R constant and semidefinite");
  command
      .add_option("--points", options.points,
                  "cut trajectories into pieces of so many, and leave out what is left at their ends (default: as they "
                  "are); --test is not cut")
      ->check(CLI::Range(2, 1'000'000));
  command.add_option("--integrator", options.integrator,
                     fmt::format("trained through: {} (default commutator-free-4 on spheres, runge-kutta-4 in R^n)",
                                 integrator_names()));
  command.add_option("--substeps", options.substeps, "of the integrator between points (default 2)")
      ->check(CLI::Range(1, 10000));
  command.add_option("--noise", options.noise, "size of the errors in the data (default 0)")
      ->check(finite_and_not_negative());
  command.add_option("--test", options.test, "held-out trajectories to measure the result on");
  command.add_option("--test-noise", options.test_noise, "size of the errors in these (default 0)")
      ->check(finite_and_not_negative());
  command
      .add_option("--validation", options.validation,
                  "share of the data kept back to stop early by (default 0.2 with noise, else 0)")
      ->check(share);
  command.add_option("--starts", options.starts, "tried, of which the best goes on (default 4)")
      ->check(CLI::Range(1, 10000));
  command.add_option("--iterations", options.iterations, "of the best, at most (default 100)")
      ->check(CLI::Range(0, 1'000'000));
  command.add_option("--seed", options.seed, "of the first start, and of the parts of the data (default 1)")
      ->check(CLI::Range(0L, largest_seed));
  command.add_option("--enough", options.enough, "mean squared error in training at which it stops (default 0)")
      ->check(finite_and_not_negative());
  command.add_option("--seconds", options.seconds, "of the processor, at most")->check(positive());
  command.add_option("--out", options.out, "write model, history, errors, plot and summary files into this folder");
  command.add_flag("--json", options.json, "print one JSON object and nothing else on standard output");
}

int learn(const LearnOptions& options) {
  try {
    return serve(options);
  } catch (const std::bad_alloc&) {
    return refuse(options.json, exit_failed, "out_of_memory",
                  fmt::format("{}: out of memory; give fewer trajectories, or a smaller model", options.data));
  }
}

}  // namespace lagroid::app
