#include "reproduce.hpp"

#include "command/shell.hpp"
#include "command/written.hpp"
#include "experiments/constrained_maps.hpp"
#include "experiments/newton/newton_report.hpp"
#include "experiments/optimisation/accelerated_report.hpp"
#include "experiments/poisson_study.hpp"
#include "experiments/sweep_scaling.hpp"
#include "experiments/time_steps.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/reports/clock.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/run/reports/progress.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

constexpr const char* newton_name = "newton-on-lie-groups";
constexpr const char* time_name = "time-steps";
constexpr const char* accelerated_name = "accelerated-optimization";
constexpr const char* maps_name = "constrained-maps";
constexpr const char* learning_name = "learning-hamiltonians";
constexpr const char* scaling_name = "sweep-scaling";
constexpr const char* poisson_name = "poisson";

/// Shares of steps solved, by example and method.
nlohmann::ordered_json solved(const NewtonFindings& findings) {
  nlohmann::ordered_json out;
  for (const auto example : newton_examples)
    for (const auto method : newton_methods)
      out[fmt::format("example {}", number_of(example))][name_of(method)] = solved_share(findings, example, method);
  return out;
}

OutputFolder folder_for_report(const std::string& folder, const char* name, std::span<const char* const> files) {
  return {folder, OutputKind::report, OutputSource{{"experiment", name}}, files};
}

/// Prints what was found, with the files that were written; returns the exit code.
int conclude(nlohmann::ordered_json result, std::string text, const std::vector<std::filesystem::path>& files,
             const std::string& note, bool json) {
  tell_written(files, note, text, result);
  print(json ? json_text(result) + "\n" : text);
  return code_after_writing(0, "reproduce");
}

int reproduce_newton(const ReproduceOptions& options) {
  const bool json = options.json;
  const NewtonStudy& study = options.newton;
  if (study.smallest > study.largest)
    return refuse(json, exit_bad_input, "invalid_command_line",
                  fmt::format("--smallest {} is above --largest {}", study.smallest, study.largest));
  const OutputFolder folder = folder_for_report(options.newton_out, newton_name, newton_report_files);
  const auto start = std::chrono::steady_clock::now();
  NewtonFindings findings;
  findings.study = study;
  findings.command =
      fmt::format("./lagroid reproduce {} --smallest {} --largest {} --seeds {} --first-seed {} --out {}", newton_name,
                  study.smallest, study.largest, study.seeds, study.first_seed, quoted(options.newton_out));
  {
    Progress progress(newton_name, 2L * study.seeds * (study.largest - study.smallest + 1), !json);
    findings.cells = run_newton_study(study, [&](long done, long) { progress.update(done); });
  }
  findings.times = time_newton_iterations(study.largest);
  findings.integrators = measure_implicit_integrators();
  std::string note;
  const auto files = write_newton_report(findings, options.newton_out, note);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  nlohmann::ordered_json result;
  result["status"] = "done";
  result["steps"] = findings.cells.size() / newton_methods.size();
  result["seconds"] = seconds;
  result["solved"] = solved(findings);
  std::string text = fmt::format("{}: {} steps by {} methods in {:.3g} s\n", newton_name, result["steps"].get<long>(),
                                 newton_methods.size(), seconds);
  for (const auto& [example, shares] : result["solved"].items()) {
    text += fmt::format("  {}, solved to 1e-13 (1 + h)\n", example);
    for (const auto& [method, share] : shares.items())
      text += fmt::format("    {:<20} {:6.2f} %\n", method, 100 * share.get<double>());
  }
  return conclude(std::move(result), std::move(text), files, note, json);
}

int reproduce_time_steps(const ReproduceOptions& options) {
  const bool json = options.json;
  const OutputFolder folder = folder_for_report(options.time_out, time_name, time_report_files);
  const auto start = std::chrono::steady_clock::now();
  TimeFindings findings;
  {
    Progress progress(time_name, 100, !json);
    findings = run_time_study(options.refinements, [&](long done, long all) { progress.update(100 * done / all); });
  }
  std::string note;
  const auto files = write_time_report(findings,
                                       fmt::format("./lagroid reproduce {} --refinements {} --out {}", time_name,
                                                   options.refinements, quoted(options.time_out)),
                                       options.time_out, note);
  nlohmann::ordered_json result;
  result["status"] = "done";
  result["runs"] = findings.runs.size();
  result["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const auto& run : findings.runs)
    if (run.method != "fixed")
      result["gain_at_equal_cost"][run.problem][run.method] = gain_at_equal_cost(findings, run.problem, run.method);
  std::string text =
      fmt::format("{}: {} runs in {:.3g} s\n", time_name, findings.runs.size(), result["seconds"].get<double>());
  for (const auto& [problem, gains] : result["gain_at_equal_cost"].items()) {
    text += fmt::format("  {}, error of fixed steps of order 2 over theirs at equal cost\n", problem);
    for (const auto& [method, gain] : gains.items())
      text += fmt::format("    {:<20} {:8.3g}\n", method, gain.get<double>());
  }
  return conclude(std::move(result), std::move(text), files, note, json);
}

int reproduce_accelerated(const ReproduceOptions& options) {
  const bool json = options.json;
  const OutputFolder folder = folder_for_report(options.accelerated_out, accelerated_name, accelerated_report_files);
  const AcceleratedStudy& study = options.accelerated;
  const auto start = std::chrono::steady_clock::now();
  AcceleratedFindings findings;
  {
    Progress progress(accelerated_name, 100, !json);
    findings = run_accelerated_study(study, [&](long done, long all) { progress.update(100 * done / all); });
  }
  std::string note;
  const auto files = write_accelerated_report(
      findings,
      fmt::format("./lagroid reproduce {} --instances {} --first-seed {} --iterations {} --out {}", accelerated_name,
                  study.instances, study.first_seed, study.iterations, quoted(options.accelerated_out)),
      options.accelerated_out, note);
  nlohmann::ordered_json result;
  result["status"] = "done";
  result["runs"] = findings.runs.size();
  result["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::string text =
      fmt::format("{}: {} runs in {:.3g} s\n", accelerated_name, findings.runs.size(), result["seconds"].get<double>());
  for (const auto& problem : accelerated_problems()) {
    text += fmt::format("  {}, iterations to 1e-8 and to 1e-12 of the minimum\n", problem);
    for (const auto& method : accelerated_methods()) {
      const double to_8 =
          median_of(findings, problem, method.name, [](const auto& r) { return double(r.to_8.iterations); });
      const double to_12 =
          median_of(findings, problem, method.name, [](const auto& r) { return double(r.to_12.iterations); });
      result["iterations"][problem][method.name] = {{"1e-8", to_8}, {"1e-12", to_12}};
      const auto shown = [](double count) { return count < 0 ? std::string("-") : fmt::format("{:.0f}", count); };
      text += fmt::format("    {:<32} {:>8} {:>8}\n", method.name, shown(to_8), shown(to_12));
    }
  }
  return conclude(std::move(result), std::move(text), files, note, json);
}

int reproduce_maps(const ReproduceOptions& options) {
  const bool json = options.json;
  const OutputFolder folder = folder_for_report(options.maps_out, maps_name, map_report_files);
  std::vector<MapMethod> methods;
  {
    Progress progress(maps_name, 100, !json);
    methods = run_map_study(options.coarsest, options.map_refinements,
                            [&](long done, long all) { progress.update(100 * done / all); });
  }
  std::string note;
  const auto files =
      write_map_report(methods,
                       fmt::format("./lagroid reproduce {} --coarsest {} --refinements {} --out {}", maps_name,
                                   options.coarsest, options.map_refinements, quoted(options.maps_out)),
                       options.maps_out, note);
  nlohmann::ordered_json result;
  result["status"] = "done";
  std::string text = fmt::format("{}: orders in q, p and tangent p\n", maps_name);
  for (const auto& method : methods) {
    const double q = map_order(method, [](const auto& e) { return e.q; });
    const double p = map_order(method, [](const auto& e) { return e.p; });
    const double tangent = map_order(method, [](const auto& e) { return e.tangent; });
    result["orders"][method.problem][method.name] = {{"q", q}, {"p", p}, {"tangent", tangent}};
    text += fmt::format("  {:<20} {:<32} {:6.2f} {:6.2f} {:6.2f}\n", method.problem, method.name, q, p, tangent);
  }
  return conclude(std::move(result), std::move(text), files, note, json);
}

int reproduce_learning(const ReproduceOptions& options) {
  const bool json = options.json;
  const OutputFolder folder = folder_for_report(options.learning_out, learning_name, learning_report_files);
  const LearningStudy& study = options.learning;
  const auto start = std::chrono::steady_clock::now();
  LearningFindings findings;
  {
    Progress progress(learning_name, 100, !json);
    findings = run_learning_study(study, [&](long done, long all) { progress.update(100 * done / all); });
  }
  std::string note;
  const auto files = write_learning_report(
      findings,
      fmt::format("./lagroid reproduce {} --runs {} --first-seed {} --largest {} --units {} --substeps {} --out {}",
                  learning_name, study.runs, study.first_seed, study.largest, study.units, study.substeps,
                  quoted(options.learning_out)),
      options.learning_out, note);
  nlohmann::ordered_json result;
  result["status"] = "done";
  result["fits"] = findings.fits.size();
  result["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::string text =
      fmt::format("{}: {} fits in {:.3g} s\n", learning_name, findings.fits.size(), result["seconds"].get<double>());
  for (const auto& fit : findings.fits) {
    if (fit.part != LearningPart::study || fit.noise != 0 || fit.points != 5 || fit.seed != study.first_seed) continue;
    const double test = median_of(findings, fit, &LearningFit::test);
    result["test_mse"][fmt::format("k = {}", fit.bodies)][fit.integrator][fmt::format("N = {}", fit.count)][fit.model] =
        test;
    text += fmt::format("  k = {}, {:<4} N = {:<5} {:<14} test MSE {:.3g}\n", fit.bodies, fit.integrator, fit.count,
                        fit.model, test);
  }
  return conclude(std::move(result), std::move(text), files, note, json);
}

int reproduce_poisson(const ReproduceOptions& options) {
  const bool json = options.json;
  const OutputFolder folder = folder_for_report(options.poisson_out, poisson_name, poisson_report_files);
  PoissonFindings found;
  {
    // The systems, what work they are, the noise.
    Progress progress(poisson_name, 300, !json);
    const auto part = [&](long which) {
      return [&progress, which](long done, long all) { progress.update(100 * which + 100 * done / all); };
    };
    found.rows = run_poisson_study(options.poisson_steps, part(0));
    found.work = run_poisson_work(part(1));
    found.above = run_poisson_above();
    found.period_count = options.poisson_periods;
    if (found.period_count > 0) found.periods = run_periods(found.period_count);
    if (options.poisson_paths > 0) found.noise = run_noise_study(options.poisson_paths, part(2));
  }
  const std::vector<PoissonRow>& rows = found.rows;
  std::string note;
  const auto files = write_poisson_report(
      found, options.poisson_steps,
      fmt::format("./lagroid reproduce {} --steps {} --paths {} --periods {} --out {}", poisson_name,
                  options.poisson_steps, options.poisson_paths, options.poisson_periods, quoted(options.poisson_out)),
      options.poisson_out, note);
  nlohmann::ordered_json result;
  result["status"] = "done";
  result["runs"] = rows.size();
  std::string text = fmt::format("{}: {} runs of {} steps\n", poisson_name, rows.size(), options.poisson_steps);
  for (const PoissonRow& row : rows) {
    result["systems"][row.system][row.method] = {
        {"order", row.order}, {"poisson_defect", row.defect}, {"casimirs", row.casimir}};
    text += text_of(row);
  }
  for (const NoiseRow& row : found.noise) {
    result["noise"][row.what] = {{"theory", row.promised}, {"found", row.found}, {"error", row.error}};
    text += fmt::format("  {:<48} {:.4g} +- {:.2g}, theory {:.4g}\n", row.what, row.found, row.error, row.promised);
  }
  return conclude(std::move(result), std::move(text), files, note, json);
}

int reproduce_scaling(const ReproduceOptions& options) {
  const bool json = options.json;
  const double start = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  try {
    require_writable(options.scaling_out, sweep_scaling_files);
    const auto ranks = join_ranks();
    if (ranks->size() == 1)
      return refuse(
          json, exit_bad_input, "invalid_command_line",
          fmt::format("one process has nobody to hand parts to: mpirun -n 4 lagroid reproduce {}", scaling_name));
    std::optional<OutputFolder> folder;
    try {
      if (ranks->rank() == 0) folder.emplace(folder_for_report(options.scaling_out, scaling_name, sweep_scaling_files));
    } catch (const OutputError& error) {
      ranks->abort(error.what());
      throw;
    }
    const SweepCosts costs = measure_sweep(*ranks, start, options.scaling_out);
    if (ranks->rank() != 0) return 0;
    std::string note;
    const auto files = write_sweep_scaling(costs,
                                           fmt::format("mpirun --oversubscribe -n {} lagroid reproduce {} --out {}",
                                                       costs.ranks, scaling_name, quoted(options.scaling_out)),
                                           options.scaling_out, note);
    nlohmann::ordered_json result;
    result["status"] = "done";
    result["ranks"] = costs.ranks;
    for (const auto& [name, seconds] :
         {std::pair("start", costs.start), std::pair("wait", costs.wait), std::pair("hand", costs.hand),
          std::pair("write_part", costs.write_part), std::pair("join_part", costs.join_part)})
      result["seconds"][name] = seconds;
    std::string text = fmt::format("{}: {} ranks\n", scaling_name, costs.ranks);
    for (const auto& [name, seconds] : result["seconds"].items())
      text += fmt::format("  {:<12} {}\n", name, duration(seconds.get<double>()));
    return conclude(std::move(result), std::move(text), files, note, json);
  } catch (const RunError& error) {
    return refuse(json, exit_bad_input, "invalid_run", error.what());
  }
}

void newton_options(CLI::App& command, ReproduceOptions& options) {
  command.add_option("--out", options.newton_out, "the folder for report.md, tables, CSV and figures")
      ->capture_default_str();
  command.add_option("--smallest", options.newton.smallest, "the least N")
      ->check(CLI::Range(2, 50))
      ->capture_default_str();
  command.add_option("--largest", options.newton.largest, "the greatest N; large ones take long (N^6)")
      ->check(CLI::Range(2, 50))
      ->capture_default_str();
  command.add_option("--seeds", options.newton.seeds, "how many random starting points for each N")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command.add_option("--first-seed", options.newton.first_seed, "the first of their seeds")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

void time_options(CLI::App& command, ReproduceOptions& options) {
  command.add_option("--out", options.time_out, "the folder for report.md, CSV and figures")->capture_default_str();
  command.add_option("--refinements", options.refinements, "how many step sizes a method runs with")
      ->check(CLI::Range(2, 12))
      ->capture_default_str();
}

void accelerated_options(CLI::App& command, ReproduceOptions& options) {
  command.add_option("--out", options.accelerated_out, "the folder for report.md, CSV and figures")
      ->capture_default_str();
  command.add_option("--instances", options.accelerated.instances, "how many random instances of each problem")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command.add_option("--first-seed", options.accelerated.first_seed, "the first of their seeds, 10 apart")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  command.add_option("--iterations", options.accelerated.iterations, "at most, of every run")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
}

void map_options(CLI::App& command, ReproduceOptions& options) {
  command.add_option("--out", options.maps_out, "the folder for report.md, CSV and the figure")->capture_default_str();
  command.add_option("--coarsest", options.coarsest, "the least number of steps")
      ->check(CLI::Range(10, 10000))
      ->capture_default_str();
  command.add_option("--refinements", options.map_refinements, "how often it is doubled, and one")
      ->check(CLI::Range(2, 12))
      ->capture_default_str();
}

void learning_options(CLI::App& command, ReproduceOptions& options) {
  LearningStudy& study = options.learning;
  command.add_option("--out", options.learning_out, "the folder for report.md, CSV and the figure")
      ->capture_default_str();
  command.add_option("--runs", study.runs, "data sets of each cell")->check(CLI::Range(1, 100))->capture_default_str();
  command.add_option("--first-seed", study.first_seed, "the first of their seeds")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  command.add_option("--largest", study.largest, "leave out cells with more trajectories")
      ->check(CLI::Range(50, 1500))
      ->capture_default_str();
  command.add_option("--units", study.units, "of the network's hidden layer")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command.add_option("--substeps", study.substeps, "of the integrator between two points")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command.add_option("--threads", study.threads, "fits at a time")->check(CLI::Range(1, 256))->capture_default_str();
}

void poisson_options(CLI::App& command, ReproduceOptions& options) {
  command.add_option("--out", options.poisson_out, "the folder for report.md and CSV")->capture_default_str();
  command.add_option("--paths", options.poisson_paths, "of noise, for each of 20 batches; 0 leaves noise out")
      ->capture_default_str()
      ->check(CLI::Range(0, 1'000'000));
  command
      .add_option("--periods", options.poisson_periods,
                  "of predator and prey, beside the methods of odeint; 0 leaves them out")
      ->capture_default_str()
      ->check(CLI::Range(0L, 10'000'000L));
  command.add_option("--steps", options.poisson_steps, "of size 0.1, over which Casimirs and energy are watched")
      ->check(CLI::Range(10L, 100'000'000L))
      ->capture_default_str();
}

void scaling_options(CLI::App& command, ReproduceOptions& options) {
  command.add_option("--out", options.scaling_out, "the folder for report.md, CSV and the figure")
      ->capture_default_str();
}

struct Reproduction {
  const char* name;
  const char* summary;
  void (*options)(CLI::App& command, ReproduceOptions& options);
  int (*run)(const ReproduceOptions& options);
};
constexpr Reproduction reproductions[] = {
    {time_name, "fixed, adaptive and controlled steps, composed and split ones: error against time and evaluations",
     time_options, reproduce_time_steps},
    {newton_name, "Owren and Welfert, section 5: Newton, fixed point, Ceres and the path on O(N), and what they cost",
     newton_options, reproduce_newton},
    {learning_name, "Celledoni and others: Hamiltonians of spherical pendula learned from data, the parameter study",
     learning_options, reproduce_learning},
    {maps_name, "Duruisseaux and Leok, sections 2 to 5.4.1: orders of constrained maps of types I, II and III",
     map_options, reproduce_maps},
    {accelerated_name, "Duruisseaux and Leok, Figure 1: accelerated optimisation on manifolds, and the competition",
     accelerated_options, reproduce_accelerated},
    {poisson_name, "orders of integrators on Poisson manifolds, and what they keep of bracket, Casimirs and energy",
     poisson_options, reproduce_poisson},
    {scaling_name, "what lagroid sweep costs besides its members, and its efficiency on many machines (under mpirun)",
     scaling_options, reproduce_scaling}};

}  // namespace

void add_reproductions(CLI::App& command, ReproduceOptions& options) {
  command.require_subcommand(1);
  for (const Reproduction& each : reproductions) {
    CLI::App* added = command.add_subcommand(each.name, each.summary);
    each.options(*added, options);
    added->add_flag("--json", options.json, "print one JSON object and nothing else on standard output");
    added->callback([&options, &each] { options.name = each.name; });
  }
}

int reproduce(const ReproduceOptions& options) {
  return std::find_if(std::begin(reproductions), std::end(reproductions),
                      [&](const Reproduction& each) { return options.name == each.name; })
      ->run(options);
}

}  // namespace lagroid::app
