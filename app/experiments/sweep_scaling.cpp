#include "sweep_scaling.hpp"

#include "../sweep/sweep_files.hpp"
#include "../sweep/sweep_folder.hpp"
#include "../sweep/work/schedule.hpp"

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/machine.hpp>
#include <lagroid/run/reports/clock.hpp>

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <limits>
#include <numeric>
#include <thread>

namespace lagroid::app {

const std::vector<const char*> sweep_scaling_files{"report.md", "model.csv", "figures.gp", "efficiency.svg"};

namespace {

namespace fs = std::filesystem;

constexpr double hour = 3600;
constexpr std::array<double, 5> workers{1, 10, 100, 1000, 10000};
constexpr std::array<double, 4> parts_each{4, 16, 64, 256};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The least of several times: what else the machine does only adds.
template <class F> double least_time(const F& f) {
  constexpr int repetitions = 9;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    const double start = now();
    f();
    least = std::min(least, now() - start);
  }
  return least;
}

/// Members with numbers of no meaning.
SweepPart some_members(long first, long count) {
  SweepPart part(first, count);
  for (long i = 0; i < count; ++i) {
    part.end(i, "converged", "");
    for (int c = 0; c < SweepCosts::columns; ++c)
      part.set(i, fmt::format("final/{}", c), "1", "a number", 1 / double(1 + first + i + c));
  }
  return part;
}

/// `parts` parts of `each` members, written and joined.
double time_to_join(const fs::path& folder, long parts, long each) {
  SweepScene sweep;
  sweep.file = "measured";
  sweep.scene = parse_scene("", "measured", {});
  sweep.part = each;
  sweep.design.kind = "random";
  for (const char* key : {"a", "b", "c"}) sweep.design.keys.push_back({key, {key}});
  for (long i = 0; i < 3 * parts * each; ++i) sweep.design.values.push_back(1 / double(1 + i));
  SweepFolder all(folder, sweep);
  all.begin(sweep);
  const PartFiles files(folder);
  for (long p = 0; p < parts; ++p) files.keep(p, some_members(sweep.first_of(p), each));
  const double seconds = least_time([&] {
    std::string note;
    write_sweep(sweep, {"measured", all.joined(sweep)}, folder, note);
  });
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  return seconds;
}

void measure_files(const fs::path& folder, SweepCosts& costs) {
  fs::create_directories(folder / "parts");
  const PartFiles files(folder);
  const auto write = [&](long count) {
    const SweepPart members = some_members(0, count);
    return least_time([&] { files.keep(0, members); });
  };
  constexpr long many = 2000;
  const double one = write(1);
  costs.write_member = std::max(0.0, (write(many) - one) / double(many - 1));
  costs.write_part = one - costs.write_member;
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  // a + b parts + c members, at three sizes.
  const std::array<std::array<long, 2>, 3> sizes{{{16, 4}, {600, 4}, {16, 1000}}};
  Eigen::Matrix3d shape;
  Eigen::Vector3d seconds;
  for (int i = 0; i < 3; ++i) {
    const auto [parts, each] = sizes[std::size_t(i)];
    shape.row(i) << 1, double(parts), double(parts * each);
    seconds(i) = time_to_join(folder, parts, each);
  }
  const Eigen::Vector3d fitted = shape.lu().solve(seconds).cwiseMax(0);
  costs.join = fitted(0);
  costs.join_part = fitted(1);
  costs.join_member = fitted(2);
}

std::string table(const SweepCosts& costs, double member) {
  std::string out = "| threads | ranks of 16 threads |";
  for (const double parts : parts_each) out += fmt::format(" {:g} parts a thread |", parts);
  out += " joining at the end | memory for it |\n|---|---|";
  for (std::size_t i = 0; i < parts_each.size() + 2; ++i) out += "---|";
  out += "\n";
  for (const double w : workers) {
    out += fmt::format("| {:g} | {:g} |", w, std::max(1.0, w / 16));
    for (const double parts : parts_each)
      out += fmt::format(" {:.2f} % |", 100 * sweep_efficiency(costs, {w, hour, parts, member}));
    const double members = w * hour / member;
    out += fmt::format(" {} | {:.2g} GB |\n",
                       duration(costs.join + costs.join_part * 16 * w + costs.join_member * members),
                       3 * 8e-9 * members * SweepCosts::columns);
  }
  return out;
}

std::string report(const SweepCosts& c, const std::string& command, bool pictures) {
  std::string out = fmt::format(
      "# What a sweep costs besides its members\n\nWritten by\n\n    {}\n\non {}, {} ranks. The model and what it "
      "leaves "
      "out: docs/sweeps.md.\n\n"
      "| constant | | measured |\n|---|---|---|\n"
      "| t_start | until all ranks have the sweep (MPI's start included) | {} |\n"
      "| t_wait | of a thread of another rank, from asking for a part to having it | {} |\n"
      "| t_hand | of rank 0's processor, for each part handed out | {} |\n"
      "| t_write | a part of m members of {} numbers into its file | {} + {} m |\n"
      "| t_join | n parts with M members into sweep.h5 and the other files | {} + {} n + {} M |\n\n",
      command, machine(), c.ranks, duration(c.start), duration(c.wait), duration(c.hand), SweepCosts::columns,
      duration(c.write_part), duration(c.write_member), duration(c.join), duration(c.join_part),
      duration(c.join_member));
  out += fmt::format(
      "Rank 0 keeps up as long as the parts of C threads take longer than C t_hand each: {} for 10,000 threads.\n\n",
      duration(1e4 * c.hand));
  out += "## Efficiency by the model\n\nAn hour of members for each thread, members of 10 s:\n\n";
  out += table(c, 10);
  if (pictures) out += "\n![efficiency over the number of threads](efficiency.svg)\n";
  return out;
}

std::string model_csv(const SweepCosts& costs) {
  std::string out = "threads";
  for (const double parts : parts_each) out += fmt::format(",{:g} parts", parts);
  out += "\n";
  for (double w = 1; w < 20000; w *= 2) {
    out += fmt::format("{:g}", w);
    for (const double parts : parts_each) out += fmt::format(",{:.6f}", sweep_efficiency(costs, {w, hour, parts, 10}));
    out += "\n";
  }
  return out;
}

std::string scaling_figures() {
  std::string out =
      "# Draws model.csv; run by lagroid, or by hand: gnuplot figures.gp\nset datafile separator ','\nset grid\n"
      "set terminal svg size 720,480 background 'white' noenhanced\nset output 'efficiency.svg'\nset logscale x\n"
      "set xlabel 'threads'\nset ylabel 'efficiency'\nset yrange [0:1.02]\nset key bottom left\nplot ";
  for (std::size_t i = 0; i < parts_each.size(); ++i)
    out += fmt::format(
        "{}'model.csv' using (column('threads')):(column('{:g} parts')) with lines linewidth 1.5 title "
        "'{:g} parts a thread'",
        i ? ", " : "", parts_each[i], parts_each[i]);
  return out + "\nset output\n";
}

}  // namespace

double sweep_seconds(const SweepCosts& c, const SweepJob& job) {
  const double parts = job.parts * job.workers;
  const double members = job.work * job.workers / job.member;
  const double part = job.work / job.parts + c.write_part + c.write_member * members / parts;
  const double computing = std::max(job.parts * (part + c.wait), parts * c.hand);
  return c.start + computing + part + c.join + c.join_part * parts + c.join_member * members;
}

double sweep_efficiency(const SweepCosts& costs, const SweepJob& job) { return job.work / sweep_seconds(costs, job); }

SweepCosts measure_sweep(Ranks& ranks, double start, const fs::path& folder) {
  SweepCosts costs;
  costs.ranks = ranks.size();
  ranks.broadcast("");
  costs.start = now() - start;
  // Rank 0 only hands out, but for a part now and then.
  std::vector<long> parts(3000);
  std::iota(parts.begin(), parts.end(), 0L);
  std::size_t own = 0;
  const auto outcome = for_each_part(ranks, parts, {.threads = 1}, [&](long) {
    if (ranks.rank() != 0) return true;
    ++own;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return true;
  });
  if (ranks.rank() != 0) return costs;
  costs.wait = outcome.seconds_waiting / double(parts.size() - own);
  costs.hand = outcome.seconds_handing / double(parts.size() - own);
  measure_files(folder / ".measured", costs);
  return costs;
}

std::vector<fs::path> write_sweep_scaling(const SweepCosts& costs, const std::string& command, const fs::path& folder,
                                          std::string& note) {
  const auto data = [&](const fs::path& staging) {
    write_text(model_csv(costs), staging / "model.csv");
    write_text(scaling_figures(), staging / "figures.gp");
    return std::vector<std::string>{"model.csv", "figures.gp"};
  };
  return write_and_draw(folder, sweep_scaling_files, data, {"figures.gp", {"efficiency.svg"}}, note,
                        [&](const fs::path& staging, bool drawn) {
                          write_text(report(costs, command, drawn), staging / "report.md");
                          return std::vector<std::string>{"report.md"};
                        });
}

}  // namespace lagroid::app
