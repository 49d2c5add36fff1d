// `lagroid sweep`: designs, members, threads, ranks, interrupts, killed ranks, files, refusals.
#include "command_line.hpp"

#include <lagroid/app/experiments/sweep_scaling.hpp>
#include <lagroid/app/sweep/work/schedule.hpp>

#include <H5Cpp.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <csignal>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <sstream>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace {

using lagroid::app::Message;
using lagroid::app::Ranks;
using lagroid::app::Schedule;
using lagroid::app::ScheduleOutcome;

// ---- the schedule alone, on ranks that are threads

/// Where ranks that are threads leave their messages.
struct Post {
  std::mutex mutex;
  std::vector<std::deque<Ranks::Received>> boxes;
};

class LocalRanks final : public Ranks {
 public:
  LocalRanks(Post& post, int rank) : post_(post), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return int(post_.boxes.size()); }
  void send(int to, const Message& message) override {
    const std::lock_guard lock(post_.mutex);
    post_.boxes[std::size_t(to)].push_back({rank_, message});
  }
  std::optional<Received> receive() override {
    const std::lock_guard lock(post_.mutex);
    auto& box = post_.boxes[std::size_t(rank_)];
    if (box.empty()) return std::nullopt;
    Received out = box.front();
    box.pop_front();
    return out;
  }
  std::string broadcast(const std::string& text) override { return text; }

 private:
  Post& post_;
  int rank_;
};

/// Has no memory for a message.
class Speechless final : public Ranks {
 public:
  int rank() const override { return 1; }
  int size() const override { return 2; }
  void send(int, const Message&) override { throw std::bad_alloc(); }
  std::optional<Received> receive() override { return std::nullopt; }
  std::string broadcast(const std::string& text) override { return text; }
  void abort(const std::string& why) override { told = why; }

  std::string told;
};

TEST(Schedule, ARankThatCannotGoOnEndsAll) {
  Speechless ranks;
  EXPECT_THROW(for_each_part(ranks, {}, {.threads = 1}, [](long) { return true; }), std::bad_alloc);
  EXPECT_EQ(ranks.told, std::bad_alloc().what());
}

ScheduleOutcome on_ranks(int ranks, int threads, long parts, const std::function<bool(int rank, long part)>& work,
                         const std::function<bool()>& interrupted = nullptr) {
  Post post;
  post.boxes.resize(std::size_t(ranks));
  std::vector<long> all(static_cast<std::size_t>(parts));
  std::iota(all.begin(), all.end(), 0L);
  ScheduleOutcome out;
  std::vector<std::thread> others;
  for (int rank = 0; rank < ranks; ++rank)
    others.emplace_back([&, rank] {
      LocalRanks self(post, rank);
      Schedule schedule{.threads = threads, .interrupted = interrupted};
      const auto outcome = for_each_part(self, all, schedule, [&work, rank](long part) { return work(rank, part); });
      if (rank == 0) out = outcome;
    });
  for (auto& each : others) each.join();
  return out;
}

TEST(Schedule, EveryPartIsDoneOnceOnAnyRanksAndThreads) {
  for (const int ranks : {1, 2, 5})
    for (const int threads : {1, 3})
      for (const long parts : {0L, 1L, 4L, 300L}) {
        std::vector<std::atomic<int>> done(static_cast<std::size_t>(parts));
        const auto outcome = on_ranks(ranks, threads, parts, [&](int, long part) {
          ++done[std::size_t(part)];
          return true;
        });
        EXPECT_TRUE(outcome.finished);
        for (const auto& count : done) EXPECT_EQ(count, 1) << ranks << " ranks, " << threads << " threads";
      }
}

TEST(Schedule, IdleRanksTakeTheWorkOfBusyOnes) {
  std::atomic<int> elsewhere = 0;
  const auto outcome = on_ranks(3, 1, 40, [&](int rank, long) {
    std::this_thread::sleep_for(std::chrono::milliseconds(rank == 0 ? 200 : 2));
    elsewhere += rank != 0;
    return true;
  });
  EXPECT_TRUE(outcome.finished);
  EXPECT_GT(elsewhere, 34);
}

TEST(Schedule, AFailureEndsItAndIsTold) {
  std::atomic<int> done = 0;
  const auto outcome = on_ranks(3, 2, 10000, [&](int rank, long) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    if (++done > 50 && rank == 1) throw std::runtime_error("the disk is full");
    return true;
  });
  EXPECT_FALSE(outcome.finished);
  EXPECT_EQ(outcome.failure, "the disk is full");
  EXPECT_EQ(outcome.failed_rank, 1);
  EXPECT_LT(done, 10000);
}

TEST(Schedule, AnInterruptEndsIt) {
  std::atomic<int> done = 0;
  const auto outcome = on_ranks(
      2, 2, 10000,
      [&](int, long) {
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        ++done;
        return true;
      },
      [&] { return done > 60; });
  EXPECT_FALSE(outcome.finished);
  EXPECT_EQ(outcome.failure, "");
  EXPECT_LT(done, 100);
}

// ---- the command

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
  /// Kills a rank in the middle, `times` times in all, then completes the sweep.
  void kill_ranks(int times);
};

const char* const square = R"(
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

std::string random_design(const std::string& kind, long count, const std::string& vary) {
  return "\n[design]\nkind = \"" + kind + "\"\ncount = " + std::to_string(count) + "\nseed = 7\n" + vary;
}

TEST_F(Sweep, AGridIsInOrderAndItsMembersAreRuns) {
  const std::string file = orbits(square);
  const Outcome r = sweep(file, "grid");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(column("grid", "initial.momentum.1"), (std::vector<double>{1.5, 1.5, 1.75, 1.75, 2.0, 2.0}));
  EXPECT_EQ(column("grid", "parameters.strength"), (std::vector<double>{0.9, 1.1, 0.9, 1.1, 0.9, 1.1}));
  const auto alone = nlohmann::json::parse(
      run("run " + example("kepler") +
          " --set time.steps=50 --set initial.momentum.1=1.75 --set parameters.strength=1.1 --json")
          .out);
  EXPECT_EQ(column("grid", "final/x")[3], alone.at("final").at("position")[0].get<double>());
  EXPECT_EQ(column("grid", "final/py")[3], alone.at("final").at("momentum")[1].get<double>());
  EXPECT_EQ(column("grid", "run/iterations")[3], alone.at("iterations").get<double>());
  EXPECT_EQ(column("grid", "ledger/energy")[3], alone.at("ledger").at("entries")[0].at("drift").get<double>());
  for (const char* name : {"sweep.h5", "summary.json", "summary.txt", "plot.gp", "plot.svg", "plot.png"})
    EXPECT_TRUE(fs::exists(out("grid") + "/" + name)) << name;
  EXPECT_FALSE(fs::exists(out("grid") + "/parts"));
}

TEST_F(Sweep, LogarithmicScalesMeetBothEnds) {
  ASSERT_EQ(sweep(orbits("[design]\nkind = \"grid\"\n[[vary]]\nkey = \"parameters.strength\"\nfrom = 0.1\nto = 10\n"
                         "count = 3\nscale = \"log\"\n"),
                  "log")
                .code,
            0);
  const auto values = column("log", "parameters.strength");
  EXPECT_EQ(values[0], 0.1);
  EXPECT_NEAR(values[1], 1, 1e-15);
  EXPECT_EQ(values[2], 10);
  // Between them whole numbers are met, too: 1000^(1/3) is 10 but for a round-off.
  ASSERT_EQ(sweep(orbits("[design]\nkind = \"grid\"\n[[vary]]\nkey = \"time.steps\"\nfrom = 1\nto = 1000\n"
                         "count = 4\nscale = \"log\"\n"),
                  "steps")
                .code,
            0);
  EXPECT_EQ(column("steps", "run/steps"), (std::vector<double>{1, 10, 100, 1000}));
}

TEST_F(Sweep, WhatElseStandsInTheFolderStays) {
  fs::create_directories(out("mine") + "/parts");
  file("mine/notes.txt", "mine");
  file("mine/parts/notes.txt", "mine");
  ASSERT_EQ(sweep(orbits(square), "mine").code, 0);
  EXPECT_EQ(bytes(out("mine") + "/notes.txt"), "mine");
  EXPECT_EQ(bytes(out("mine") + "/parts/notes.txt"), "mine");
  EXPECT_EQ(parts("mine"), 0U);
  // Results that were taken away are made again.
  fs::remove(out("mine") + "/summary.json");
  ASSERT_EQ(sweep(orbits(square), "mine").code, 0);
  EXPECT_TRUE(fs::exists(out("mine") + "/summary.json"));
}

TEST_F(Sweep, ALatinHypercubeMeetsEveryStratumOnce) {
  const std::string vary = R"(
[[vary]]
key = "initial.momentum.1"
from = 1.0
to = 2.0
[[vary]]
key = "parameters.strength"
mean = 1
deviation = 0.1
[[vary]]
key = "initial.momentum.0"
from = -0.5
to = 0.5
)";
  ASSERT_EQ(sweep(orbits(random_design("latin-hypercube", 40, vary), 2), "lhs").code, 0);
  std::set<int> uniform;
  std::set<int> normal;
  for (const double x : column("lhs", "initial.momentum.1")) uniform.insert(int(40 * (x - 1)));
  for (const double x : column("lhs", "parameters.strength"))
    normal.insert(int(40 * 0.5 * std::erfc(-(x - 1) / 0.1 / std::sqrt(2.0))));
  EXPECT_EQ(uniform.size(), 40U);
  EXPECT_EQ(normal.size(), 40U);
  EXPECT_EQ(*uniform.begin(), 0);
  EXPECT_EQ(*normal.rbegin(), 39);
  // Random members do not, and the keys of a hypercube are paired at random.
  ASSERT_EQ(sweep(orbits(random_design("random", 40, vary), 2), "random").code, 0);
  std::set<int> strata;
  for (const double x : column("random", "initial.momentum.1")) strata.insert(int(40 * (x - 1)));
  EXPECT_LT(strata.size(), 36U);
  const auto a = column("lhs", "initial.momentum.1");
  const auto b = column("lhs", "initial.momentum.0");
  double product = 0;
  for (std::size_t i = 0; i < a.size(); ++i) product += (a[i] - 1.5) * b[i];
  EXPECT_LT(std::abs(product / 40 * 12), 0.5);  // the correlation
}

TEST_F(Sweep, SeedsDecideAndNothingElseDoes) {
  const std::string file =
      orbits(random_design("random", 10, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 1\nto = 2\n"), 2);
  ASSERT_EQ(sweep(file, "a").code, 0);
  ASSERT_EQ(sweep(file, "b").code, 0);
  ASSERT_EQ(sweep(file, "c", "--set design.seed=8").code, 0);
  expect_same("a", "b");
  EXPECT_NE(column("a", "initial.momentum.1"), column("c", "initial.momentum.1"));
}

TEST_F(Sweep, SpheresAndAttitudesAreUniform) {
  const std::string file = this->file("tops.toml", "[scene]\nfile = \"" + example("rigid_body") +
                                                       "\"\ntime.steps = 1\n" + random_design("random", 3000, R"(
[[vary]]
key = "initial.momentum"
distribution = "sphere"
radius = 2
[[vary]]
key = "initial.attitude"
distribution = "attitude"
)"));
  ASSERT_EQ(sweep(file, "tops", "--set keep.ledger=false --set run.part=500").code, 0);
  std::array<std::vector<double>, 3> m;
  std::array<std::vector<double>, 4> q;
  for (int i = 0; i < 3; ++i) m[std::size_t(i)] = column("tops", "initial.momentum." + std::to_string(i));
  for (int i = 0; i < 4; ++i) q[std::size_t(i)] = column("tops", "initial.attitude." + std::to_string(i));
  // Each coordinate of a point of S^2 is uniform, and so are the turns of S^3's points: moments with five sigmas.
  for (int i = 0; i < 3; ++i) {
    double first = 0, second = 0, fourth = 0;
    for (std::size_t k = 0; k < 3000; ++k) {
      const double x = m[std::size_t(i)][k] / 2;
      first += x / 3000;
      second += x * x / 3000;
      fourth += x * x * x * x / 3000;
    }
    EXPECT_NEAR(first, 0, 5 * std::sqrt(1 / 3.0 / 3000));
    EXPECT_NEAR(second, 1 / 3.0, 5 * std::sqrt((1 / 5.0 - 1 / 9.0) / 3000));
    EXPECT_NEAR(fourth, 1 / 5.0, 5 * std::sqrt((1 / 9.0 - 1 / 25.0) / 3000));
  }
  for (int i = 0; i < 4; ++i) {
    double second = 0, fourth = 0;
    for (std::size_t k = 0; k < 3000; ++k) {
      const double x = q[std::size_t(i)][k];
      second += x * x / 3000;
      fourth += x * x * x * x / 3000;
    }
    EXPECT_NEAR(second, 1 / 4.0, 5 * std::sqrt((1 / 8.0 - 1 / 16.0) / 3000));
    EXPECT_NEAR(fourth, 1 / 8.0, 5 * std::sqrt(7 / 128.0 / 3000));
  }
  for (std::size_t k = 0; k < 3000; ++k) {
    double norm = 0;
    for (const auto& each : q) norm += each[k] * each[k];
    EXPECT_NEAR(norm, 1, 1e-14);
    EXPECT_NEAR(std::hypot(m[0][k], m[1][k], m[2][k]), 2, 1e-14);
  }
}

TEST_F(Sweep, ListsComeFromCsvAndHdf5) {
  file("list.csv", "# two orbits\ninitial.momentum.1, parameters.strength\n1.9,1\n\n+2.0,1.05\n");
  const double momentum[2] = {1.9, 2.0};
  const double strength[2] = {1, 1.05};
  const hsize_t size = 2;
  {
    const H5::H5File h5(out("list.h5"), H5F_ACC_TRUNC);
    const H5::DataSpace space(1, &size);
    h5.createDataSet("initial.momentum.1", H5::PredType::NATIVE_DOUBLE, space)
        .write(momentum, H5::PredType::NATIVE_DOUBLE);
    h5.createDataSet("parameters.strength", H5::PredType::NATIVE_DOUBLE, space)
        .write(strength, H5::PredType::NATIVE_DOUBLE);
  }
  const std::string design = "[design]\nkind = \"list\"\nfile = \"list.csv\"\n";
  ASSERT_EQ(sweep(orbits(design), "csv").code, 0);
  ASSERT_EQ(sweep(orbits(design), "h5", "--set design.file=list.h5").code, 0);
  EXPECT_EQ(column("csv", "parameters.strength"), (std::vector<double>{1, 1.05}));
  EXPECT_EQ(column("csv", "final/x"), column("h5", "final/x"));
  // Keys of members.csv are a list for another sweep.
  std::string keys;
  std::istringstream lines(bytes(out("csv") + "/members.csv"));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::vector<std::string> words;
    for (std::string word; std::getline(fields, word, ',');) words.push_back(word);
    keys += words[2] + "," + words[3] + "\n";
  }
  this->file("keys.csv", keys);
  ASSERT_EQ(sweep(orbits(design), "again", "--set design.file=keys.csv").code, 0);
  EXPECT_TRUE(bytes(out("csv") + "/members.csv") == bytes(out("again") + "/members.csv"));
}

TEST_F(Sweep, SeriesHoldTheNodesThatWereAskedFor) {
  const std::string sorted = this->file("series.toml",
                                        "keep = {series = [\"position\", \"px\"], every = 20, initial = "
                                        "[\"py\"], final = [\"px\"], ledger = false}\n" +
                                            bytes(orbits(square)));
  ASSERT_EQ(sweep(sorted, "series").code, 0);
  const H5::H5File h5(out("series") + "/sweep.h5", H5F_ACC_RDONLY);
  const auto read = [&](const std::string& name) {
    const H5::DataSet set = h5.openDataSet(name);
    std::vector<double> values(std::size_t(set.getSpace().getSimpleExtentNpoints()));
    set.read(values.data(), H5::PredType::NATIVE_DOUBLE);
    return values;
  };
  const auto t = read("series/t");
  ASSERT_EQ(t.size(), 6U * 4);
  EXPECT_NEAR(t[1], 0.2, 1e-15);
  EXPECT_NEAR(t[3], 0.5, 1e-15);
  const auto px = read("series/px");
  const auto last = read("final/px");
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(px[4 * i + 3], last[i]);
  EXPECT_EQ(read("initial/py"), read("keys/initial.momentum.1"));
  EXPECT_EQ(members("series").count("final/x"), 0U);
  EXPECT_EQ(members("series").count("ledger/energy"), 0U);
}

TEST_F(Sweep, AMemberThatFailsFailsAlone) {
  const std::string file = orbits(
      "[design]\nkind = \"grid\"\n[[vary]]\nkey = \"initial.position.0\"\n"
      "values = [0.4, 0.0, 0.5]\n");
  const Outcome r = sweep(file, "some");
  EXPECT_EQ(r.code, 3);
  EXPECT_NE(r.err.find("1 of 3 members failed"), std::string::npos) << r.err;
  const auto status = members("some").at("status");
  EXPECT_EQ(status[0], "converged");
  EXPECT_EQ(status[1], "invalid_scene");
  EXPECT_EQ(status[2], "converged");
  EXPECT_TRUE(std::isnan(column("some", "final/x")[1]));
  const auto json = nlohmann::json::parse(bytes(out("some") + "/summary.json"));
  EXPECT_EQ(json.at("status"), "members_failed");
  EXPECT_EQ(json.at("failures")[0].at("member"), 1);
  EXPECT_NE(json.at("failures")[0].at("message").get<std::string>().find("centre of attraction"), std::string::npos);
  // A step that is not solved leaves the state before it.
  const std::string steps = this->file("steps.toml", "[scene]\nfile = \"" + example("rigid_body") +
                                                         "\"\ntime.steps = 50\n[design]\nkind = \"grid\"\n"
                                                         "[[vary]]\nkey = \"initial.momentum.1\"\nvalues = [2, 1e4]\n");
  EXPECT_EQ(sweep(steps, "steps").code, 3);
  EXPECT_EQ(members("steps").at("status"), (std::vector<std::string>{"converged", "stagnated"}));
  EXPECT_EQ(column("steps", "run/steps"), (std::vector<double>{50, 0}));
  EXPECT_EQ(column("steps", "final/t")[1], 0);
  // Told again by the same command, which finds nothing left to do.
  const Outcome again = sweep(file, "some", "--json");
  EXPECT_EQ(again.code, 3);
  EXPECT_EQ(nlohmann::json::parse(again.out).at("failed"), json.at("failed"));
}

TEST_F(Sweep, AnySceneIsAMember) {
  const auto over = [&](const std::string& scene, const std::string& key, const std::string& values,
                        const std::string& more, const std::string& column_of) {
    SCOPED_TRACE(scene);
    const std::string file = this->file("any.toml", "[scene]\nfile = \"" + example(scene) + "\"\n" + more +
                                                        "\n[design]\nkind = \"grid\"\n[[vary]]\nkey = \"" + key +
                                                        "\"\nvalues = " + values + "\n");
    const Outcome r = sweep(file, scene);
    EXPECT_EQ(r.code, 0) << r.err;
    if (r.code != 0) return;
    const auto found = column(scene, column_of);
    EXPECT_TRUE(std::isfinite(found[0]));
    EXPECT_NE(found[0], found[1]);
  };
  over("kepler_boundary", "boundary.end.position.0", "[-0.3, -0.2]", "solver.starts = 4\ntime.steps = 20", "run/cost");
  over("plate_ball", "parameters.spin", "[0.5, 0.6]", "solver.starts = 4\ntime.steps = 10", "run/cost");
  over("pythagorean", "body.1.mass", "[4, 4.1]", "time.steps = 100", "final/t");
  over("pendulum_chain", "time.step", "[0.01, 0.02]", "time.steps = 10", "final/t");
  over("kepler_adaptive", "initial.momentum.1", "[1.9, 2]", "time.steps = 20", "final/t");
}

TEST_F(Sweep, AnAccuracyIsChosenOnceForAllMembers) {
  const std::string file = this->file("accurate.toml", R"(
[scene]
system = "pendulum"
[scene.time]
duration = 5.0
[scene.accuracy]
target = 1e-3
pilot = 0.2
[scene.initial]
position = [1.0]
momentum = [0.0]
[design]
kind = "grid"
[[vary]]
key = "initial.position.0"
from = 0.1
to = 2.5
count = 4
)");
  const Outcome r = sweep(file, "accurate");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("accuracy: for an error of"), std::string::npos) << r.out;
  const auto steps = column("accurate", "run/steps");
  EXPECT_EQ(std::set<double>(steps.begin(), steps.end()).size(), 1U);
}

TEST_F(Sweep, ThreadsAndPartsLeaveTheSameBytes) {
  const std::string file = orbits(square);
  ASSERT_EQ(sweep(file, "one", "--threads 1").code, 0);
  ASSERT_EQ(sweep(file, "two", "--threads 2").code, 0);
  ASSERT_EQ(sweep(file, "seven", "--threads 7").code, 0);
  expect_same("one", "two");
  expect_same("one", "seven");
  ASSERT_EQ(sweep(file, "whole", "--set run.part=4").code, 0);
  EXPECT_TRUE(bytes(out("one") + "/members.csv") == bytes(out("whole") + "/members.csv"));
}

TEST_F(Sweep, LanesAndScenesAgreeToRoundOff) {
  const std::string ranges = R"(
[[vary]]
key = "initial.momentum.0"
from = 0.2
to = 0.6
[[vary]]
key = "initial.momentum.1"
from = 0.2
to = 0.6
)";
  const std::string range = R"(
[[vary]]
key = "initial.position.0"
from = 0.2
to = 2.6
)";
  for (const auto& [scene, vary, series] : {std::tuple("rigid_body", ranges, "M1"), std::tuple("pendulum", range, "q"),
                                            std::tuple("plate_ball_initial_value", ranges, "px")}) {
    SCOPED_TRACE(scene);
    // A number of members that fills no register.
    const std::string file =
        this->file("lanes.toml", "keep = {ledger = false, every = 30, series = [\"" + std::string(series) +
                                     "\"]}\n[scene]\nfile = \"" + example(scene) + "\"\ntime.steps = 100\n" +
                                     random_design("latin-hypercube", 21, vary));
    const std::string lanes = std::string(scene) + "_lanes";
    const std::string scenes = std::string(scene) + "_scenes";
    const Outcome r = sweep(file, lanes);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("engine    lanes"), std::string::npos) << r.out;
    ASSERT_EQ(sweep(file, scenes, "--set run.engine=scenes").code, 0);
    for (const auto& [name, values] : members(lanes)) {
      if (name == "status" || name == "run/steps") {
        EXPECT_EQ(values, members(scenes).at(name));
      }
      if (!name.starts_with("final/")) continue;
      const auto a = column(lanes, name);
      const auto b = column(scenes, name);
      for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-11 * (1 + std::abs(b[i]))) << name;
    }
    // Threads and parts change nothing in lanes either.
    ASSERT_EQ(sweep(file, lanes + "2", "--threads 1 --set run.part=8 --set run.engine=lanes").code, 0);
    EXPECT_TRUE(bytes(out(lanes) + "/members.csv") == bytes(out(lanes + "2") + "/members.csv"));
  }
}

TEST_F(Sweep, AMemberThatFailsInALaneFailsAlone) {
  const std::string file =
      this->file("steps.toml", "[scene]\nfile = \"" + example("rigid_body") +
                                   "\"\ntime.steps = 50\n[keep]\nledger = false\n[design]\nkind = "
                                   "\"grid\"\n[[vary]]\nkey = \"initial.momentum.1\"\nvalues = [2, 1e4, 3]\n");
  EXPECT_EQ(sweep(file, "lanes", "--set run.engine=lanes --set run.part=3").code, 3);
  EXPECT_EQ(sweep(file, "scenes", "--set run.engine=scenes").code, 3);
  EXPECT_EQ(members("lanes").at("status"), members("scenes").at("status"));
  EXPECT_EQ(column("lanes", "run/steps"), (std::vector<double>{50, 0, 50}));
  EXPECT_NEAR(column("lanes", "final/M2")[2], column("scenes", "final/M2")[2], 1e-12);
}

TEST_F(Sweep, AnInterruptKeepsWhatIsFinishedAndTheSameCommandGoesOn) {
  const std::string file =
      orbits(random_design("random", 60, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 1.5\nto = 2\n"), 20000);
  ASSERT_EQ(sweep(file, "whole").code, 0);
  const std::string command = std::string(LAGROID_PROGRAM) + " sweep " + file + " --out " + out("broken");
  const pid_t child = start(command);
  wait_for_parts("broken", 3);
  kill(child, SIGTERM);
  EXPECT_EQ(wait_for(child), 4);
  EXPECT_GE(parts("broken"), 3U);
  EXPECT_LT(parts("broken"), 60U);
  EXPECT_FALSE(fs::exists(out("broken") + "/sweep.h5"));
  // Another sweep has no place there.
  const Outcome other = sweep(file, "broken", "--set design.count=61");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("holds a sweep of another sweep file"), std::string::npos) << other.err;
  // Nor have parts of which nobody knows the sweep.
  fs::rename(out("broken") + "/sweep.cbor", out("aside"));
  const Outcome unknown = sweep(file, "broken");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.err.find("sweep.cbor"), std::string::npos) << unknown.err;
  fs::rename(out("aside"), out("broken") + "/sweep.cbor");
  // A part that was damaged is noticed, and run again.
  const fs::path part = fs::directory_iterator(out("broken") + "/parts")->path();
  std::ofstream(part, std::ios::app) << "x";
  const Outcome damaged = sweep(file, "broken");
  EXPECT_EQ(damaged.code, 2);
  EXPECT_NE(damaged.err.find("run the same command again"), std::string::npos) << damaged.err;
  const Outcome r = sweep(file, "broken");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("kept from before"), std::string::npos) << r.out;
  expect_same("whole", "broken");
}

TEST_F(Sweep, RanksLeaveTheSameBytes) {
  if (const std::string why = without_ranks(); !why.empty()) GTEST_SKIP() << why;
  const std::string file = orbits(
      random_design("latin-hypercube", 100, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 0.5\nto = 2\n"), 300);
  ASSERT_EQ(sweep(file, "alone").code, 0);
  for (const int ranks : {1, 2, 4}) {
    const std::string name = "ranks" + std::to_string(ranks);
    const Outcome r = run("sweep " + file + " --threads 2 --out " + out(name), mpirun(ranks));
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.out.find("latin-hypercube"), r.out.rfind("latin-hypercube"));  // told once
    expect_same("alone", name);
  }
  // One line from one rank, where there is something wrong.
  const Outcome wrong = run("sweep " + file + " --out " + out("no") + " --set design.kind=cube", mpirun(3));
  EXPECT_EQ(wrong.code, 2);
  const auto at = wrong.err.find("lagroid: ");
  EXPECT_EQ(at, wrong.err.rfind("lagroid: ")) << wrong.err;
}

void Sweep::kill_ranks(int times) {
  if (const std::string why = without_ranks(); !why.empty()) GTEST_SKIP() << why;
  const std::string file =
      orbits(random_design("random", 60, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 1.5\nto = 2\n"), 20000);
  ASSERT_EQ(sweep(file, "whole").code, 0);
  std::mt19937 random(20261123);
  for (int i = 0; i < times; ++i) {
    const std::string name = "killed" + std::to_string(i);
    const std::string pid = out("pid");
    const std::string command = mpirun(3) + "sh -c 'echo $$ > " + pid + ".$OMPI_COMM_WORLD_RANK; exec " +
                                LAGROID_PROGRAM + " sweep " + file + " --threads 1 --out " + out(name) + "'";
    const pid_t job = start("env " + command);
    const std::size_t before = 1 + random() % 30;
    wait_for_parts(name, before);
    std::ifstream victim(pid + "." + std::to_string(random() % 3));
    pid_t rank = 0;
    victim >> rank;
    ASSERT_GT(rank, 1);
    kill(rank, SIGKILL);
    EXPECT_NE(wait_for(job), 0);
    EXPECT_GE(parts(name), before);
    const Outcome r = i % 2 == 0 ? sweep(file, name) : run("sweep " + file + " --out " + out(name), mpirun(2));
    EXPECT_EQ(r.code, 0) << r.err;
    expect_same("whole", name);
    fs::remove_all(out(name));
  }
}

#ifdef LAGROID_MANY_KILLS
constexpr int kills = 20;
#else
constexpr int kills = 2;
#endif
TEST_F(Sweep, AKilledRankLosesNothingAfterTheRerun) { kill_ranks(kills); }

TEST_F(Sweep, EveryExampleRuns) {
  const auto small = [&](const std::string& name, const std::string& more, long count) {
    SCOPED_TRACE(name);
    const Outcome r = sweep(example("sweeps/" + name), name, "--json " + more);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(nlohmann::json::parse(r.out).at("members"), count);
  };
  small("basins", "--set vary.0.count=6 --set vary.1.count=5", 30);
  small("rigid_bodies", "--set design.count=50", 50);
  small("kepler", "--set design.count=10 --set scene.time.steps=500", 10);
  small("plate_ball", "--set vary.0.count=2 --set vary.1.count=2", 4);
  small("three_bodies", "--set scene.time.steps=1000", 4);
  EXPECT_EQ(std::count_if(fs::directory_iterator(fs::path(LAGROID_EXAMPLES) / "sweeps"), fs::directory_iterator(),
                          [](const auto& entry) { return entry.path().extension() == ".toml"; }),
            5)
      << "ask the new one, too";
  // Every angle has come to rest near one of the wells.
  for (const double q : column("basins", "final/q")) EXPECT_LT(std::abs(std::remainder(q, 2 * M_PI)), 0.6);
}

TEST_F(Sweep, WhatItCostsIsMeasuredAndModelled) {
  if (const std::string why = without_ranks(); !why.empty()) GTEST_SKIP() << why;
  const Outcome r = run("reproduce sweep-scaling --json --out " + out("scaling"), mpirun(2));
  ASSERT_EQ(r.code, 0) << r.err;
  for (const auto& [name, seconds] : nlohmann::json::parse(r.out).at("seconds").items()) {
    EXPECT_GE(seconds.get<double>(), 0) << name;
    EXPECT_LT(seconds.get<double>(), 10) << name;
  }
  EXPECT_NE(bytes(out("scaling") + "/report.md").find("| 10000 |"), std::string::npos);
  EXPECT_EQ(run("reproduce sweep-scaling --out " + out("alone")).code, 2);
}

TEST(SweepModel, LosesWhatItSays) {
  using lagroid::app::sweep_efficiency;
  using lagroid::app::sweep_seconds;
  lagroid::app::SweepCosts free;
  // The last part alone is lost where nothing costs anything.
  EXPECT_DOUBLE_EQ(sweep_efficiency(free, {.workers = 100, .work = 600, .parts = 9, .member = 1}), 0.9);
  // Rank 0 is the bottleneck where parts are shorter than it takes to hand one to every thread.
  lagroid::app::SweepCosts handing;
  handing.hand = 1e-3;
  EXPECT_DOUBLE_EQ(sweep_seconds(handing, {.workers = 10000, .work = 100, .parts = 100, .member = 1}), 1000 + 1);
  EXPECT_DOUBLE_EQ(sweep_seconds(handing, {.workers = 100, .work = 100, .parts = 100, .member = 1}), 100 + 1);
}

TEST_F(Sweep, TellsOneJsonObject) {
  const Outcome r = sweep(orbits(square), "json", "--json");
  ASSERT_EQ(r.code, 0);
  const auto json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json.at("status"), "converged");
  EXPECT_EQ(json.at("members"), 6);
  EXPECT_EQ(json.at("design").at("keys")[1], "parameters.strength");
  EXPECT_EQ(json.at("columns").at("run/steps").at("mean"), 50);
  EXPECT_EQ(json.at("files").size(), 7U);
}

TEST_F(Sweep, BadInputIsOneLineThatNamesTheRemedy) {
  const std::string good = orbits(square);
  file("nan.csv", "initial.momentum.1\n1\nnan\n");
  file("word.csv", "initial.momentum.1\none\n");
  file("ragged.csv", "initial.momentum.1,parameters.strength\n1,2\n3\n");
  file("twice.csv", "initial.momentum.1,initial.momentum.1\n1,2\n");
  file("stranger.csv", "initial.momentum.7\n1\n");
  file("overlap.csv", "initial.position,initial.position.0\n1,2\n");
  file("empty.csv", "initial.momentum.1\n");
  file("no.h5", "no HDF5");
  file("plain", "");
  const std::string list = orbits("[design]\nkind = \"list\"\n");
  const std::string listed = file("listed.toml", bytes(list));
  orbits(square);
  const std::string pendula = file(
      "pendula.toml", "scene = \"" + example("pendulum") + "\"\n[design]\nkind = \"list\"\nfile = \"overlap.csv\"\n");
  const auto from = [&](const std::string& name) { return listed + " --set design.file=" + name; };
  const std::string there = " --out " + out("bad");
  const std::vector<std::pair<std::string, std::string>> cases{
      {"nowhere.toml" + there, "nowhere.toml"},
      {good + there + " --set design.kind=cube", "latin-hypercube"},
      {good + there + " --set design.kind=random", "missing key \"count\""},
      {good + there + " --set design.count=3", "unknown key"},
      {good + there + " --set vary.0.key=initial.momentum.2", "no number of the scene"},
      {good + there + " --set vary.0.key=initial.momentum", "vary one of them"},
      {good + there + " --set vary.0.key=parameters.strength", "varies already"},
      {good + there + " --set vary.0.key=system", "no number of the scene"},
      {good + there + " --set vary.0.from=inf", "finite"},
      {good + there + " --set vary.0.scale=log --set vary.0.from=0", "positive"},
      {good + there + " --set vary.0.count=0", "from 1 to"},
      {good + there + " --set vary.0.count=99999999 --set vary.1.values=[1,2]", "more than 100000000 members"},
      {good + there + " --set vary.0.cuont=3", "did you mean \"count\""},
      {good + there + " --set vary.1.values=[]", "none"},
      {good + there + " --set vary=[]", "no [[vary]]"},
      {good + there + " --set scene.file=nowhere.toml", "no such scene file"},
      {good + there + " --set scene.time.stpes=3", "orbits.toml: scene.time.stpes"},
      {good + there + " --set keep.final=[\\\"z\\\"]", "these are: position, x, y"},
      {good + there + " --set keep.every=3", "goes with series"},
      {good + there + " --set plot.quantity=z", "no column \"z\""},
      {good + there + " --set run.part=0", "from 1 to"},
      {good + there + " --set run.engine=lanes", "keep.ledger = false"},
      {good + there + " --set run.engine=lanes --set keep.ledger=false", "parameters.strength varies"},
      {good + there + " --set sceen=1", "did you mean \"scene\""},
      {good, "--out"},
      {good + there + " --threads 0", "--threads"},
      {good + " --out /proc/nowhere", "choose another place"},
      {good + " --out " + out("plain"), "is not a folder"},
      {from("nan.csv") + there, "line 3, column initial.momentum.1: nan is not finite"},
      {from("word.csv") + there, "\"one\" is no number"},
      {from("ragged.csv") + there, "line 3 has 1 fields"},
      {from("twice.csv") + there, "two columns"},
      {from("stranger.csv") + there, "design.file: \"initial.momentum.7\" is no number of the scene"},
      {pendula + there, "varies already"},
      {from("empty.csv") + there, "holds no members"},
      {from("no.h5") + there, "HDF5"},
      {from("nowhere.csv") + there, "there is no such file"}};
  for (const auto& [arguments, words] : cases) {
    expect_refused("sweep " + arguments, words);
    EXPECT_FALSE(fs::exists(out("bad"))) << arguments;
  }
}

TEST_F(Sweep, AFullDiskIsOneLineAndThePartsBeforeItStay) {
  const std::string file =
      orbits(random_design("random", 40, "[[vary]]\nkey = \"initial.momentum.1\"\nfrom = 1\nto = 2\n"), 5);
  // Files of at most one block: no sum of parts is written, but each part is.
  const Outcome r = run("sweep " + file + " --out " + out("full"), "trap '' XFSZ; ulimit -f 8; ");
  EXPECT_EQ(r.code, 3) << r.out << r.err;
  EXPECT_NE(r.err.find("is the disk full?"), std::string::npos) << r.err;
  EXPECT_EQ(parts("full"), 40U);
  EXPECT_EQ(sweep(file, "full").code, 0);
  ASSERT_EQ(sweep(file, "whole").code, 0);
  expect_same("whole", "full");
}

}  // namespace
