#include "draw.hpp"

#include "../spheres/numbers.hpp"
#include "trajectory_files.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/reports/markup.hpp>
#include <lagroid/systems/pendulums/chain_trajectories.hpp>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <stdexcept>

namespace lagroid::app {

namespace {

Eigen::VectorXd one_each(const std::vector<double>& numbers, int links, const char* what) {
  if (numbers.empty()) return Eigen::VectorXd::Ones(links);
  if (numbers.size() == 1) return Eigen::VectorXd::Constant(links, numbers.front());
  if (int(numbers.size()) != links)
    throw std::invalid_argument(fmt::format(
        "--{} has {} numbers, the chain {} links; give one for each, or one for all", what, numbers.size(), links));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), links);
}

}  // namespace

void add_draw_options(CLI::App& command, DrawOptions& options) {
  command.add_option("--chain", options.links, "links of the chain (default 1)")->check(CLI::Range(1, 1000));
  command.add_option("--masses", options.masses, "of its bobs, kg: one for each, or one for all (default 1)")
      ->delimiter(',');
  command.add_option("--lengths", options.lengths, "of its rods, m (default 1)")->delimiter(',');
  command.add_option("--gravity", options.gravity, "m/s^2 (default 1)")->check(finite());
  command.add_option("--count", options.count, "trajectories (default 500)")->check(CLI::Range(1, 1'000'000));
  command.add_option("--points", options.points, "of each, the first included (default 5)")
      ->check(CLI::Range(2, 1'000'000));
  command.add_option("--duration", options.duration, "from the first point to the last, s (default 0.1)")
      ->check(finite());
  command.add_option("--noise", options.noise, "uniform errors in [-noise, noise] on all points but the first")
      ->check(finite_and_not_negative());
  command.add_option("--seed", options.seed, "of the draws (default 0)")->check(CLI::Range(0L, largest_seed));
  command.add_option("--out", options.out, "the file, .csv or .h5")->required();
  command.add_flag("--json", options.json, "print one JSON object and nothing else on standard output");
}

int draw(const DrawOptions& options) {
  const std::filesystem::path file = options.out;
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const std::string name = file.filename().string();
  const std::array<const char*, 1> files{name.c_str()};
  const InterruptGuard guard;
  try {
    require_trajectory_file(file);
    const OutputFolder held(folder, OutputKind::data, std::nullopt, files);
    const PendulumChain<Eigen::Dynamic> chain(one_each(options.masses, options.links, "masses"),
                                              one_each(options.lengths, options.links, "lengths"), options.gravity);
    const auto rows = draw_trajectories(chain, {.count = options.count,
                                                .points = options.points,
                                                .duration = options.duration,
                                                .noise = options.noise,
                                                .seed = options.seed,
                                                .stop = InterruptGuard::interrupted});
    write_whole(folder, files, [&](const std::filesystem::path& staging) {
      write_observations(rows, staging / name);
      return std::vector{name};
    });
  } catch (const DataError& error) {
    return refuse(options.json, exit_bad_input, "invalid_command_line", error.what());
  } catch (const OutputError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    return refuse(options.json, exit_bad_input, "invalid_command_line", error.what());
  } catch (const std::runtime_error& error) {
    if (InterruptGuard::interrupted())
      return refuse(options.json, exit_interrupted, "interrupted",
                    fmt::format("{}: interrupted; nothing was written", options.out));
    return refuse(options.json, exit_failed, "not_followed", error.what());
  }
  const nlohmann::ordered_json json{{"status", "drawn"},
                                    {"bodies", options.links},
                                    {"trajectories", options.count},
                                    {"points", options.points},
                                    {"files", {options.out}}};
  print(options.json
            ? json_text(json) + "\n"
            : fmt::format("  wrote {}: {} trajectories of {} points\n", options.out, options.count, options.points));
  return 0;
}

}  // namespace lagroid::app
