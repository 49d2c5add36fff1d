#include "comparison.hpp"

#include <fmt/format.h>

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bench {

namespace {

/// The processor's count of retired instructions in user space; tells nothing on machines without one.
class InstructionCounter {
 public:
  InstructionCounter() {
    perf_event_attr event{};
    event.type = PERF_TYPE_HARDWARE;
    event.size = sizeof event;
    event.config = PERF_COUNT_HW_INSTRUCTIONS;
    event.exclude_kernel = 1;
    file_ = int(syscall(SYS_perf_event_open, &event, 0, -1, -1, 0));
  }
  ~InstructionCounter() {
    if (file_ >= 0) close(file_);
  }
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  /// 0 where there is no counter.
  double read_now() const {
    std::uint64_t count = 0;
    if (file_ < 0 || read(file_, &count, sizeof count) != ssize_t(sizeof count)) return 0;
    return double(count);
  }

 private:
  int file_ = -1;
};

/// Collects every repetition, prints a dot for each.
class Collector final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      if (run.error_occurred) {
        fmt::print(stderr, "\n{}: {}\n", run.run_name.function_name, run.error_message);
        continue;
      }
      times_[run.run_name.function_name].push_back(run.GetAdjustedCPUTime());
      const auto counter = run.counters.find("instructions");
      if (counter != run.counters.end()) instructions_[run.run_name.function_name] = counter->second.value;
      fmt::print(stderr, ".");
    }
    std::fflush(stderr);
  }
  Results results() {
    Results out;
    for (auto& [name, times] : times_) {
      std::sort(times.begin(), times.end());
      const std::size_t count = times.size();
      Measured& m = out[name];
      m.median = times[count / 2];
      m.spread = (times[(3 * count) / 4] - times[count / 4]) / m.median;
      m.instructions = instructions_[name];
    }
    return out;
  }

 private:
  std::map<std::string, std::vector<double>> times_;
  std::map<std::string, double> instructions_;
};

std::string time_of(double ns) {
  if (ns < 1e4) return fmt::format("{:.0f} ns", ns);
  if (ns < 1e7) return fmt::format("{:.3g} us", ns / 1e3);
  return fmt::format("{:.3g} ms", ns / 1e6);
}

}  // namespace

std::string key_of(const std::string& group, const std::string& name) { return group + ": " + name; }

void timed(benchmark::State& state, const std::function<void(long)>& steps, long at_once) {
  static const InstructionCounter counter;
  const double before = counter.read_now();
  while (state.KeepRunningBatch(at_once)) steps(at_once);
  const double counted = counter.read_now() - before;
  if (counted > 0) state.counters["instructions"] = counted / double(state.iterations());
}

std::vector<Subject> matching(std::vector<Subject> subjects, const std::string& part) {
  std::erase_if(subjects, [&](const Subject& s) { return key_of(s.group, s.name).find(part) == std::string::npos; });
  return subjects;
}

Results run(const std::vector<Subject>& subjects, int repetitions, double min_time) {
  if (subjects.empty()) return {};
  std::vector<std::string> flags{"lagroid_bench", "--benchmark_enable_random_interleaving=true",
                                 fmt::format("--benchmark_repetitions={}", repetitions),
                                 fmt::format("--benchmark_min_time={}", min_time)};
  std::vector<char*> arguments;
  for (auto& flag : flags) arguments.push_back(flag.data());
  int count = int(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  benchmark::ClearRegisteredBenchmarks();
  for (const Subject& s : subjects)
    benchmark::RegisterBenchmark(key_of(s.group, s.name).c_str(),
                                 [run = s.run](benchmark::State& state) { run(state); });
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  fmt::print(stderr, "\n");
  return collector.results();
}

std::string table(const std::vector<Subject>& subjects, const Results& results) {
  std::string out;
  std::string group;
  const bool counted =
      std::any_of(results.begin(), results.end(), [](const auto& r) { return r.second.instructions > 0; });
  for (const Subject& s : subjects) {
    const auto at = results.find(key_of(s.group, s.name));
    if (at == results.end()) continue;
    if (s.group != group) {
      group = s.group;
      out += fmt::format("\n**{}**\n\n| | median | ratio | spread |{}\n|---|---|---|---|{}\n", group,
                         counted ? " instructions |" : "", counted ? "---|" : "");
    }
    const auto reference = std::find_if(subjects.begin(), subjects.end(),
                                        [&](const Subject& r) { return r.group == group && r.reference; });
    const auto floor = reference == subjects.end() ? results.end() : results.find(key_of(group, reference->name));
    const Measured& m = at->second;
    out += fmt::format("| {} | {} | {} | {:.0f} % |", s.name, time_of(m.median),
                       floor == results.end() ? "" : fmt::format("{:.3g}", m.median / floor->second.median),
                       100 * m.spread);
    if (counted) out += fmt::format(" {:.0f} |", m.instructions);
    out += "\n";
  }
  return out;
}

std::string goals_table(const std::vector<Goal>& goals, const Results& results, bool every) {
  std::string out = "| | ratio | wanted | |\n|---|---|---|---|\n";
  for (const Goal& g : goals) {
    const auto above = results.find(key_of(g.group, g.numerator));
    const auto below = results.find(key_of(g.group, g.denominator));
    const bool measured = above != results.end() && below != results.end();
    if (!measured && !every) continue;
    std::string ratio_column;
    std::string outcome = "**not measured**";
    if (measured) {
      const double ratio = above->second.median / below->second.median;
      ratio_column = fmt::format("{:.3g}", ratio);
      outcome = (g.at_least ? ratio >= g.bound : ratio <= g.bound) ? "reached" : "**missed**";
    }
    out += fmt::format("| {}: {} / {} | {} | {} {:g} | {} |\n", g.group, g.numerator, g.denominator, ratio_column,
                       g.at_least ? "at least" : "at most", g.bound, outcome);
  }
  return out;
}

}  // namespace bench
