#pragma once
/// Sweeps through the program: their scenes, and what they leave.

#include "../command_line.hpp"

#include <chrono>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace lagroid::sweep_tests {

using Table = std::map<std::string, std::vector<std::string>>;

class Sweep : public CommandLine {
 protected:
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  /// A sweep over a short orbit.
  std::string orbits(const std::string& rest, long steps = 50) const {
    return file("orbits.toml",
                "[scene]\nfile = \"" + example("kepler") + "\"\ntime.steps = " + std::to_string(steps) + "\n" + rest);
  }
  std::string out(const std::string& name) const { return (folder_ / name).string(); }
  Outcome sweep(const std::string& file, const std::string& name, const std::string& more = "") const {
    return run("sweep " + file + " --out " + out(name) + " " + more);
  }
  static std::string bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    EXPECT_TRUE(in) << path;
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void expect_same(const std::string& a, const std::string& b) const {
    for (const char* name : {"/sweep.h5", "/members.csv", "/summary.json", "/summary.txt"})
      EXPECT_TRUE(bytes(out(a) + name) == bytes(out(b) + name)) << a << " " << b << name;
  }
  Table members(const std::string& name) const {
    std::ifstream in(out(name) + "/members.csv");
    Table table;
    std::vector<std::string> header;
    for (std::string line; std::getline(in, line);) {
      std::istringstream fields(line);
      std::vector<std::string> words;
      for (std::string word; std::getline(fields, word, ',');) words.push_back(word);
      if (header.empty())
        header = words;
      else
        for (std::size_t i = 0; i < words.size(); ++i) table[header[i]].push_back(words[i]);
    }
    return table;
  }
  std::vector<double> column(const std::string& name, const std::string& key) const {
    const Table table = members(name);
    std::vector<double> numbers;
    for (const std::string& word : table.at(key)) numbers.push_back(std::strtod(word.c_str(), nullptr));
    return numbers;
  }
  std::size_t parts(const std::string& name) const {
    std::error_code ignored;
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(out(name) + "/parts", ignored))
      count += entry.path().extension() == ".cbor";
    return count;
  }
  /// Starts a command of the shell; its process id.
  static pid_t start(const std::string& command) {
    const pid_t child = fork();
    if (child != 0) return child;
    execl("/bin/sh", "sh", "-c", ("exec " + command + " >/dev/null 2>&1").c_str(), nullptr);
    _exit(127);
  }
  static int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  void wait_for_parts(const std::string& name, std::size_t count) const {
    for (int i = 0; i < 3000 && parts(name) < count; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  static std::string mpirun(int ranks) {
    return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n " +
           std::to_string(ranks) + " ";
  }
  /// Why nothing can be run on ranks, if so.
  std::string without_ranks() const {
    if (std::system("mpirun --version >/dev/null 2>&1") != 0) return "no mpirun here (Debian package openmpi-bin)";
    if (run("sweep x --out y", "PMI_SIZE=1 ").err.find("without MPI") != std::string::npos)
      return "this lagroid was built without MPI";
    return "";
  }
};

inline const char* const square = R"(
[design]
kind = "grid"
[[vary]]
key = "initial.momentum.1"
from = 1.5
to = 2.0
count = 3
[[vary]]
key = "parameters.strength"
values = [0.9, 1.1]
)";

inline std::string random_design(const std::string& kind, long count, const std::string& vary) {
  return "\n[design]\nkind = \"" + kind + "\"\ncount = " + std::to_string(count) + "\nseed = 7\n" + vary;
}

}  // namespace lagroid::sweep_tests
