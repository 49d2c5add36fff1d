#pragma once
/// Other programs: started, waited for, ended.
///
///     Process gnuplot({"gnuplot", "plot.gp"}, {.folder = "out", .error = "plot.log"});
///     const int code = gnuplot.wait();
///     const int other = run_process({"cmake", "--version"}, {.out = "version.txt"});
///
/// Errors: std::system_error where the program cannot be started, with the reason as its code (std::errc).

#include <filesystem>
#include <string>
#include <vector>

namespace lagroid {

/// Where a program runs and where what it prints goes, each empty for ours. Files are named from its folder.
struct ProcessOptions {
  std::filesystem::path folder{};
  std::filesystem::path out{};
  std::filesystem::path error{};
};

/// A program that was started, found by PATH where its name has no slash. It is terminated when the thread that started
/// it ends; signals that ours ignores have their usual effect on it.
class Process {
 public:
  /// `words` are the program and its arguments.
  explicit Process(const std::vector<std::string>& words, const ProcessOptions& options = {});
  /// Waits for its end.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Whether it has not ended yet.
  bool running();
  /// Ends it at once.
  void kill();
  /// Its exit code, or 128 and the number of the signal that ended it.
  int wait();

 private:
  void collect(int flags);

  int child_ = -1;
  int status_ = 0;
  bool ended_ = false;
};

/// Runs a program to its end. Returns its exit code as `Process::wait` does.
int run_process(const std::vector<std::string>& words, const ProcessOptions& options = {});

}  // namespace lagroid
