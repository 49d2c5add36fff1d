#include "learn_files.hpp"

#include <lagroid/run/files/kept_file.hpp>
#include <lagroid/run/reports/clock.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/text.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using learning::Stage;

constexpr const char* scene_file_name = "learned.toml";
constexpr std::array<const char*, 9> files{model_file_name, scene_file_name, "history.csv",
                                           "errors.csv",    "summary.json",  "summary.txt",
                                           "plot.gp",       "plot.svg",      "plot.png"};

std::string history_csv(const TrainingOutcome& outcome) {
  std::string out = "line,start,iteration,training,validation,damping,seconds\n";
  long line = 0;
  for (const Stage& now : outcome.trained.history)
    fmt::format_to(std::back_inserter(out), "{},{},{},{:.6g},{:.6g},{:.3g},{:.3f}\n", line++, now.start + 1,
                   now.iteration, now.mse, now.validation, now.damping, now.seconds);
  return out;
}

std::string errors_csv(const TrainingOutcome& outcome) {
  std::string out = "t,rms\n";
  for (std::size_t i = 0; i < outcome.measures->times.size(); ++i)
    fmt::format_to(std::back_inserter(out), "{},{:.6g}\n", outcome.measures->times[i], outcome.measures->rms[i]);
  return out;
}

/// What coordinates and momenta are called in learned.toml: q1, ..., qn, p1, ..., pn.
std::vector<std::string> names_of_state(std::size_t n) {
  std::vector<std::string> names;
  for (const char which : {'q', 'p'})
    for (std::size_t i = 1; i <= n; ++i) names.push_back(fmt::format("{}{}", which, i));
  return names;
}

/// The learned H as a formula that a scene takes. Empty where there is none, as on spheres.
std::string scene_formula(const TrainingOutcome& outcome) {
  const auto& [model, parameters] = outcome.learned;
  return model->formula(parameters, names_of_state(std::size_t(outcome.data.width()) / 2), longest_text);
}

/// Why a model in R^n leaves no scene; empty where it leaves one, and on spheres, whose scenes name the model's file.
std::string why_no_scene(const TrainingOutcome& outcome) {
  if (outcome.data.bodies > 0) return "";
  if (outcome.learned.model->damped())
    return fmt::format("no {}: scenes of formulas have no friction of this kind", scene_file_name);
  if (scene_formula(outcome).empty())
    return fmt::format("no {}: H as a formula has more than the {} characters that scenes allow; take a smaller model",
                       scene_file_name, longest_text);
  return "";
}

/// A scene of the learned H as a formula, from where the first trajectory starts.
std::string learned_scene(const TrainingOutcome& outcome) {
  const std::size_t n = std::size_t(outcome.data.width()) / 2;
  const std::vector<std::string> names = names_of_state(n);
  const auto quoted = [&](std::size_t from) {
    return fmt::format("[\"{}\"]", fmt::join(names.begin() + long(from), names.begin() + long(from + n), "\", \""));
  };
  const Eigen::VectorXd start = outcome.data.starts.col(0);
  return fmt::format(
      "# The Hamiltonian that lagroid learn found in {}, {}.\n# Run it with: lagroid run {}\nsystem = "
      "\"hamiltonian\"\n\n"
      "[hamiltonian]\ncoordinates = {}\nmomenta = {}\nH = \"{}\"\n\n"
      "[initial]\nposition = [{}]\nmomentum = [{}]\n\n[time]\nstep = {}\nsteps = 1000\n",
      visible(outcome.options.data), outcome.learned.model->name(), scene_file_name, quoted(0), quoted(n),
      scene_formula(outcome), fmt::join(start.begin(), start.begin() + long(n), ", "),
      fmt::join(start.begin() + long(n), start.end(), ", "), outcome.data.interval / outcome.options.substeps);
}

std::string gnuplot_script(const TrainingOutcome& outcome) {
  std::string out =
      "# Draws history.csv and errors.csv; run by lagroid, or by hand: gnuplot plot.gp\n"
      "set datafile separator ','\nset datafile missing 'nan'\nset grid\nset logscale y\nset format y '%.0e'\n";
  for (const auto& [file, terminal] : {std::pair("plot.svg", "svg size 1040,400 background 'white' noenhanced"),
                                       std::pair("plot.png", "pngcairo size 1040,400 noenhanced")}) {
    out += fmt::format("\nset terminal {}\nset output '{}'\nset multiplot layout 1,{}\n", terminal, file,
                       outcome.measures ? 2 : 1);
    out +=
        "set title 'mean squared error'\nset xlabel 'iteration, of all starts'\nset key\n"
        "plot 'history.csv' using 'line':'training' with lines linewidth 1.5 title 'training'";
    if (std::isfinite(outcome.trained.validation))
      out += ", '' using 'line':'validation' with lines linewidth 1.5 title 'validation'";
    if (outcome.measures)
      out +=
          "\nset title 'held-out trajectories, root of the mean squared error'\nset xlabel 't'\nunset key\n"
          "plot 'errors.csv' using 't':'rms' with linespoints linewidth 1.5 pointtype 7";
    out += "\nunset multiplot\nset output\n";
  }
  return out;
}

/// How much of the motion from first points to later ones the model accounts for: one less its mean squared error over
/// that of a system at rest. NaN where nothing moves.
double share_explained(const TrainingOutcome& outcome) {
  const learning::Trajectories& data = outcome.data;
  double motion = 0;
  for (Eigen::Index j = 0; j < data.count(); ++j)
    for (Eigen::Index i = 0; i < data.weights.rows(); ++i)
      motion += data.weights(i, j) *
                (data.ends.block(i * data.width(), j, data.width(), 1) - data.starts.col(j)).squaredNorm();
  if (motion == 0) return std::numeric_limits<double>::quiet_NaN();
  return 1 - outcome.trained.mse * data.total_weight() / motion;
}

/// What is said where that is little: a training converges on noise too.
std::string little_explained(const TrainingOutcome& outcome) {
  constexpr double enough = 0.9;
  const double share = share_explained(outcome);
  if (!(share < enough)) return "";
  return fmt::format(
      "the model explains {:.3g} % of the motion in the data: they are noise for the most part, or of another kind of "
      "system, or the model is too small",
      100 * std::max(share, 0.0));
}

std::vector<std::string> notes_of(const TrainingOutcome& outcome) {
  std::vector<std::string> out = outcome.notes;
  if (const std::string note = little_explained(outcome); !note.empty()) out.push_back(note);
  if (outcome.options.out)
    if (const std::string note = why_no_scene(outcome); !note.empty()) out.push_back(note);
  return out;
}

/// NaN is no JSON.
nlohmann::ordered_json known(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json();
}

/// What decides what is learned, beside data and model; other test data measure the same.
std::string as_text(const LearnOptions& o) {
  std::string out = fmt::format("{} {} {:.17g} {:.17g} {} {} {} {:.17g}", *o.integrator, o.substeps, o.noise,
                                o.validation.value_or(-1), o.starts, o.iterations, o.seed, o.enough);
  if (o.points > 0) out += fmt::format(" pieces of {}", o.points);
  return out;
}

std::vector<std::vector<double>> rows_of(const Eigen::MatrixXd& matrix) {
  std::vector<std::vector<double>> out;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const Eigen::VectorXd row = matrix.row(i);
    out.emplace_back(row.begin(), row.end());
  }
  return out;
}

/// A line for each row, the first under its name.
std::string matrix_lines(const char* name, const Eigen::MatrixXd& matrix) {
  std::string out;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    out += fmt::format("  {:<12}", i == 0 ? name : "");
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) out += fmt::format(" {:12.8f}", matrix(i, j));
    out += "\n";
  }
  return out;
}

}  // namespace

nlohmann::ordered_json training_json(const TrainingOutcome& outcome) {
  const auto& trained = outcome.trained;
  nlohmann::ordered_json out;
  out["status"] = to_string(trained.outcome);
  if (!trained.message.empty()) out["message"] = trained.message;
  out["model"] = outcome.learned.model->name();
  if (outcome.data.bodies > 0) {
    out["bodies"] = outcome.data.bodies;
  } else {
    out["coordinates"] = outcome.data.width() / 2;
  }
  out["integrator"] = *outcome.options.integrator;
  out["substeps"] = outcome.options.substeps;
  out["data"] = {{"file", outcome.options.data},
                 {"trajectories", outcome.data.count()},
                 {"points", outcome.data.points},
                 {"interval", outcome.data.interval},
                 {"noise", outcome.options.noise}};
  out["parameters"] = trained.parameters.size();
  out["training_mse"] = trained.mse;
  out["explained"] = known(share_explained(outcome));
  out["validation_mse"] = known(trained.validation);
  out["iterations"] = trained.iterations;
  out["best_seed"] = trained.start;
  out["seconds"] = trained.seconds;
  const auto& model = *outcome.learned.model;
  if (const auto mass = rows_of(model.mass(trained.parameters)); !mass.empty()) out["mass_matrix"] = mass;
  if (const auto r = rows_of(model.dissipation(trained.parameters)); !r.empty()) out["dissipation"] = r;
  if (outcome.measures) {
    const auto& found = *outcome.measures;
    out["held_out"] = {{"file", *outcome.options.test},
                       {"trajectories", outcome.test->count()},
                       {"points", outcome.test->points},
                       {"duration", found.times.back()},
                       {"mse", known(found.mse)},
                       {"rms_at_end", known(found.rms.back())},
                       {"energy_variation_rms", known(found.energy_rms)},
                       {"energy_variation_largest", known(found.energy_largest)}};
    if (outcome.data.bodies > 0) {
      out["held_out"]["momentum_change_learned"] = known(found.momentum_learned);
      out["held_out"]["momentum_change_data"] = known(found.momentum_data);
    }
    out["held_out"]["lost"] = found.lost;
  }
  for (const std::string& note : notes_of(outcome)) out["notes"].push_back(note);
  return out;
}

std::string training_text(const TrainingOutcome& outcome) {
  const auto& trained = outcome.trained;
  const auto& options = outcome.options;
  const auto& model = *outcome.learned.model;
  const Eigen::MatrixXd dissipation = model.dissipation(trained.parameters);
  std::string out =
      fmt::format("{} on {}{}, through {} with {} substeps of {:g}: {}\n", model.name(), to_string(model.space()),
                  dissipation.size() > 0 ? ", with dissipation" : "", *options.integrator, options.substeps,
                  outcome.data.interval / options.substeps, to_string(trained.outcome));
  out += fmt::format("  data         {}: {} trajectories of {} points, {:g} apart\n", options.data,
                     outcome.data.count(), outcome.data.points, outcome.data.interval);
  out += fmt::format("  parameters   {}\n", trained.parameters.size());
  out += fmt::format("  training     mean squared error {:.2e}", trained.mse);
  const double share = share_explained(outcome);
  out += std::isfinite(share) ? fmt::format(", {:.6g} % of the motion explained\n", 100 * share) : std::string("\n");
  if (std::isfinite(trained.validation)) out += fmt::format("  validation   {:.2e}\n", trained.validation);
  out += matrix_lines("mass matrix", model.mass(trained.parameters));
  out += matrix_lines("R", dissipation);
  if (outcome.measures) {
    const auto& found = *outcome.measures;
    out += fmt::format("  held out     {}: {} trajectories of {} points, until t = {:g}\n", *options.test,
                       outcome.test->count(), outcome.test->points, found.times.back());
    if (found.lost > 0) out += fmt::format("               {} of them could not be followed\n", found.lost);
    out += fmt::format("               mean squared error {:.2e}, root of it at the end {:.2e}\n", found.mse,
                       found.rms.back());
    out += fmt::format("  learned H    varies along them by {:.1e} (rms), {:.1e} at most{}\n", found.energy_rms,
                       found.energy_largest, dissipation.size() > 0 ? ", what R takes included" : "");
    if (outcome.data.bodies > 0)
      out += fmt::format("  momentum     about the vertical changes by {:.1e} on learned motions, {:.1e} in the data\n",
                         found.momentum_learned, found.momentum_data);
  }
  out += fmt::format("  iterations   {}, {} of the processor", trained.iterations, duration(trained.seconds));
  out += options.model.ends_with(".json") ? fmt::format("; from {}\n", options.model)
                                          : fmt::format("; the best start was that of seed {}\n", trained.start);
  if (!trained.message.empty()) out += fmt::format("  note: {}\n", trained.message);
  for (const std::string& note : notes_of(outcome)) out += fmt::format("  note: {}\n", note);
  return out;
}

OutputFolder folder_for_training(const fs::path& folder, const TrainingOutcome& outcome) {
  const learning::Model& model = *outcome.learned.model;
  const OutputSource source{{"data", contents(outcome.options.data).value_or("")},
                            {"model", model.name() + (model.damped() ? ", with dissipation" : "")},
                            {"options", as_text(outcome.options)}};
  return {folder, OutputKind::model, source, files};
}

std::vector<fs::path> write_training(const TrainingOutcome& outcome, const fs::path& folder, std::string& note) {
  const auto make = [&](const fs::path& staging) {
    std::vector<std::string> names{model_file_name, "history.csv", "summary.json", "summary.txt", "plot.gp"};
    write_text(model_text(outcome.learned), staging / model_file_name);
    if (outcome.data.bodies == 0 && why_no_scene(outcome).empty()) {
      write_text(learned_scene(outcome), staging / scene_file_name);
      names.emplace_back(scene_file_name);
    }
    write_text(history_csv(outcome), staging / "history.csv");
    if (outcome.measures) {
      write_text(errors_csv(outcome), staging / "errors.csv");
      names.emplace_back("errors.csv");
    }
    write_text(json_text(training_json(outcome)) + "\n", staging / "summary.json");
    write_text(visible(training_text(outcome), "\n"), staging / "summary.txt");
    write_text(gnuplot_script(outcome), staging / "plot.gp");
    return names;
  };
  return write_and_draw(folder, files, make, {"plot.gp", {"plot.svg", "plot.png"}}, note);
}

}  // namespace lagroid::app
