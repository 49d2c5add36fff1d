/// Folders of output: of one kind, of one scene, for one process, whole whatever ends a command (docs/stability.md).
#include "../app/command_line.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <map>
#include <random>
#include <regex>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>

namespace run_output_folders_tests {
namespace {

class Folders : public CommandLine {
 protected:
  struct Command {
    std::string kind;   ///< as refusals call what it leaves
    std::string words;  ///< but for --out
    std::string other;  ///< the same with other input
  };

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return path(name);
  }
  static std::string bytes(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// All files of a folder.
  static std::map<std::string, std::string> everything(const fs::path& folder) {
    std::map<std::string, std::string> out;
    if (!fs::exists(folder)) return out;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file()) out[fs::relative(entry.path(), folder).string()] = bytes(entry.path());
    return out;
  }
  static std::string names(const fs::path& folder) {
    std::string out;
    for (const auto& entry : fs::directory_iterator(folder)) out += entry.path().filename().string() + " ";
    return out;
  }

  /// One of every kind, each over in a moment.
  std::vector<Command> commands() {
    const std::string sweep =
        file("sweep.toml", "[scene]\nfile = \"" + example("kepler") +
                               "\"\ntime.steps = 20\n[design]\nkind = \"grid\"\n[[vary]]\nkey = "
                               "\"initial.momentum.1\"\nfrom = 1.5\nto = 2\ncount = 40\n[run]\npart = 1\n");
    const std::string optimum = file(
        "optimum.toml",
        "problem = \"rayleigh\"\ndata.A = {random = \"symmetric\", rows = 10}\n[method]\nname = \"trust-region\"\n");
    for (const char* seed : {"1", "2"})
      EXPECT_EQ(run("trajectories --count 20 --seed " + std::string(seed) + " --out " +
                    path("data" + std::string(seed) + ".csv"))
                    .code,
                0);
    const std::string learn = " --model polynomial:1 --starts 1 --iterations 3";
    const std::string steps = " --methods splitting --repetitions 1 --steps 0.1,0.05";
    const std::string short_scene = example("kepler") + " --set time.steps=20";
    return {{"a run", "run " + short_scene, "run " + short_scene + " --set time.step=0.02"},
            {"a sweep", "sweep " + sweep, "sweep " + sweep + " --set vary.0.count=41"},
            {"a study", "study " + short_scene + steps, "study " + short_scene + " --set time.step=0.02" + steps},
            {"an optimisation", "optimize " + optimum, "optimize " + optimum + " --set data.A.seed=2"},
            {"a learned model", "learn " + path("data1.csv") + learn, "learn " + path("data2.csv") + learn},
            {"a report", "reproduce constrained-maps --refinements 2", ""}};
  }

  /// A gnuplot that leaves a file `started` and draws for minutes; what the shell does to have it.
  std::string slow_gnuplot() {
    fs::create_directories(folder_ / "bin");
    file("bin/gnuplot", "#!/bin/sh\ntouch " + path("started") + "\nexec sleep 300\n");
    fs::permissions(folder_ / "bin/gnuplot", fs::perms::owner_all);
    return "env PATH=" + path("bin") + ":$PATH ";
  }
  pid_t start(const std::string& command) const {
    const pid_t child = fork();
    if (child != 0) return child;
    execl("/bin/sh", "sh", "-c", ("exec " + command + " >" + path("said") + " 2>&1").c_str(), nullptr);
    _exit(127);
  }
  static bool comes(const std::function<bool()>& what) {
    for (int i = 0; i < 6000 && !what(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return what();
  }
};

TEST_F(Folders, AnotherKindIsRefusedAndNothingIsTouched) {
  const auto all = commands();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string out = path("of" + std::to_string(i));
    ASSERT_EQ(run(all[i].words + " --out " + out).code, 0) << all[i].words;
    const auto before = everything(out);
    // With the mark, and as an earlier version left it.
    for (const bool marked : {true, false}) {
      if (!marked) fs::remove(out + "/.lagroid");
      for (const Command& other : all) {
        if (other.kind == all[i].kind) continue;
        const Outcome r = expect_refused(other.words + " --out " + out, "it holds " + all[i].kind + " (");
        EXPECT_NE(r.err.find("choose another folder"), std::string::npos) << r.err;
      }
      if (marked) {
        const Outcome r = run("trajectories --count 2 --out " + out + "/trajectory.csv");
        EXPECT_EQ(r.code, 2) << r.err;
        EXPECT_TRUE(everything(out) == before) << all[i].kind << ": " << names(out);
      }
    }
    if (all[i].kind != "a run") {
      EXPECT_EQ(run("resume " + out).code, 2);
      EXPECT_EQ(run("view " + out).code, 2);
    }
  }
}

TEST_F(Folders, AnotherSceneIsRefusedAndTheSameIsWrittenAgain) {
  const auto all = commands();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string out = path("of" + std::to_string(i));
    ASSERT_EQ(run(all[i].words + " --out " + out).code, 0) << all[i].words;
    const auto before = everything(out);
    if (!all[i].other.empty()) {
      expect_refused(all[i].other + " --out " + out, "it holds " + all[i].kind + " of ");
      EXPECT_TRUE(everything(out) == before) << all[i].kind;
    }
    EXPECT_EQ(run(all[i].words + " --out " + out).code, 0) << all[i].words;
  }
}

TEST_F(Folders, ABadSceneLeavesNoFolder) {
  for (const std::string& words :
       {"run " + example("kepler") + " --set time.stpes=3", "run " + example("kepler") + " --set time.step=-1"}) {
    EXPECT_EQ(run(words + " --out " + path("a/b/c")).code, 2);
    EXPECT_FALSE(fs::exists(path("a")));
    fs::create_directories(path("own"));
    EXPECT_EQ(run(words + " --out " + path("own")).code, 2);
    EXPECT_EQ(names(path("own")), "");
  }
}

/// Whoever is at work in a folder has it for itself.
TEST_F(Folders, AFolderAtWorkIsRefused) {
  const auto all = commands();
  const std::string out = path("held");
  fs::create_directories(out);
  const int lock = ::open((out + "/.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  for (const Command& each : all) expect_refused(each.words + " --out " + out, "another run is at work there");
  EXPECT_EQ(run("trajectories --count 2 --out " + out + "/data.csv").code, 2);
  EXPECT_EQ(names(out), ".lock ");
  ::close(lock);
  EXPECT_EQ(run(all.front().words + " --out " + out).code, 0);
  EXPECT_FALSE(fs::exists(out + "/.lock"));
}

TEST_F(Folders, TwoProcessesAtATimeAndOneOfThemWorks) {
  const std::string out = path("out");
  const std::string words =
      std::string(LAGROID_PROGRAM) + " run " + example("kepler") + " --set time.steps=20 --out " + out;
  for (int i = 0; i < 20; ++i) {
    const pid_t first = start(words);
    const pid_t second = start(words);
    int codes[2];
    waitpid(first, &codes[0], 0);
    waitpid(second, &codes[1], 0);
    for (const int code : codes) EXPECT_TRUE(WEXITSTATUS(code) == 0 || WEXITSTATUS(code) == 2) << code;
    EXPECT_TRUE(WEXITSTATUS(codes[0]) == 0 || WEXITSTATUS(codes[1]) == 0);
    EXPECT_FALSE(fs::exists(out + "/.lock"));
  }
}

/// What is computed is in place before anything is drawn, and the first signal ends the drawing.
TEST_F(Folders, TheFirstSignalEndsTheDrawing) {
  const std::string program = slow_gnuplot() + LAGROID_PROGRAM + " ";
  const std::map<std::string, std::vector<std::string>> data{
      {"a run", {"trajectory.h5", "trajectory.csv", "summary.json", "summary.txt", "plot.gp", "checkpoint/state.cbor"}},
      {"a sweep", {"sweep.h5", "members.csv", "summary.json", "plot.gp"}},
      {"a study", {"study.csv", "study.json", "study.md", "study.html", "study.gp"}},
      {"an optimisation", {"result.h5", "history.csv", "summary.json", "plot.gp"}},
      {"a learned model", {"model.json", "history.csv", "summary.json", "plot.gp"}},
      {"a report", {"report.md", "errors.csv", "figures.gp"}}};
  for (const Command& each : commands())
    for (const int signal : {SIGINT, SIGTERM}) {
      SCOPED_TRACE(each.words);
      fs::remove(folder_ / "started");
      const fs::path out = folder_ / ("drawn by " + each.kind + std::to_string(signal));
      const pid_t child = start(program + each.words + " --out '" + out.string() + "'");
      ASSERT_TRUE(comes([&] { return fs::exists(folder_ / "started"); }));
      for (const std::string& name : data.at(each.kind)) EXPECT_TRUE(fs::exists(out / name)) << name;
      const auto sent = std::chrono::steady_clock::now();
      kill(child, signal);
      int status = 0;
      waitpid(child, &status, 0);
      EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(10));
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 4) << status << bytes(folder_ / "said");
      for (const std::string& name : data.at(each.kind)) EXPECT_TRUE(fs::exists(out / name)) << name;
      for (const auto& entry : fs::directory_iterator(out)) {
        const std::string name = entry.path().filename().string();
        EXPECT_FALSE(name.starts_with(".partial") || name == ".lock" || name == "parts") << name;
        EXPECT_NE(entry.path().extension(), ".svg");
      }
      EXPECT_NE(bytes(folder_ / "said").find("no pictures: interrupted"), std::string::npos) << bytes(folder_ / "said");
      EXPECT_EQ(run(each.words + " --out '" + out.string() + "'").code, 0);
    }
}

/// The descriptors of closed ones are not given to files, into which what is printed would go.
TEST_F(Folders, ClosedDescriptorsTouchNoFile) {
  for (const Command& each : commands())
    for (const std::string closed : {">&-", "<&- >&-", "<&- >&- 2>&-"}) {
      SCOPED_TRACE(each.words + closed);
      const fs::path out = folder_ / "out";
      fs::remove_all(out);
      const int code = std::system(
          (std::string(LAGROID_PROGRAM) + " " + each.words + " --out " + out.string() + " " + closed).c_str());
      EXPECT_EQ(WEXITSTATUS(code), 3) << "standard output could not be written";
      const auto closed_files = everything(out);
      fs::remove_all(out);
      ASSERT_EQ(run(each.words + " --out " + out.string()).code, 0);
      const auto usual = everything(out);
      for (const auto& [name, text] : closed_files) {
        ASSERT_TRUE(usual.contains(name)) << name;
        EXPECT_EQ(text.find("\n  wrote "), std::string::npos) << name;
        if (!name.ends_with(".csv")) continue;
        const std::string& other = usual.at(name);
        EXPECT_EQ(text.substr(0, text.find('\n')), other.substr(0, other.find('\n'))) << name;
      }
      // A study says what it will do, and where it cannot it does nothing.
      const bool study = each.words.starts_with("study");
      EXPECT_EQ(closed_files.size(), study ? 0 : usual.size());
    }
}

TEST_F(Folders, PartsThatAKillLeftGoWithTheNextCommand) {
  const auto all = commands();
  const std::string out = path("out");
  ASSERT_EQ(run(all[1].words + " --out " + out).code, 0);
  // Killed between the last mark and the end.
  fs::create_directories(out + "/parts");
  std::ofstream(out + "/parts/00000000.cbor") << "x";
  fs::create_directories(out + "/.partial-999999999");
  const Outcome r = run(all[1].words + " --out " + out);
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("finished before"), std::string::npos);
  EXPECT_FALSE(fs::exists(out + "/parts"));
  EXPECT_FALSE(fs::exists(out + "/.partial-999999999"));
}

/// Writes a file as `replace_by_cbor` does.
void keep_cbor(const fs::path& file, const std::string& body) {
  const std::size_t sum = std::hash<std::string_view>{}(body);
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(&sum), sizeof sum) << body;
}

TEST_F(Folders, ASweepWithoutItsMarkIsNobodysHoweverOftenOneAsks) {
  const auto sweep = commands()[1];
  const std::string out = path("out");
  ASSERT_EQ(run(sweep.words + " --out " + out).code, 0);
  fs::remove(out + "/.lagroid");
  for (int again = 0; again < 2; ++again) {
    const Outcome r = run(sweep.other + " --out " + out);
    EXPECT_EQ(r.code, 2) << r.out;
    EXPECT_FALSE(fs::exists(out + "/.lagroid"));
  }
}

TEST_F(Folders, ASweepIsFinishedWhereItsResultsAreThereAsTheyWere) {
  const auto sweep = commands()[1];
  const std::string out = path("out");
  ASSERT_EQ(run(sweep.words + " --out " + out).code, 0);
  fs::remove(out + "/members.csv");
  EXPECT_EQ(run(sweep.words + " --out " + out).code, 0);
  EXPECT_TRUE(fs::exists(out + "/members.csv"));
  fs::resize_file(out + "/sweep.h5", 100);
  EXPECT_EQ(run(sweep.words + " --out " + out).code, 0);
  EXPECT_GT(fs::file_size(out + "/sweep.h5"), 100u);
}

TEST_F(Folders, AMarkThatIsDamagedIsNobodysPermission) {
  const std::string out = path("out");
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=5 --out " + out).code, 0);
  std::ofstream(out + "/.lagroid") << "{";
  const auto before = everything(out);
  const Outcome r = run("run " + example("pendulum") + " --out " + out);
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find(".lagroid"), std::string::npos) << r.err;
  EXPECT_EQ(everything(out), before);
}

TEST_F(Folders, WhatLinksLeadToIsLeftAlone) {
  const std::string precious = path("precious");
  std::ofstream(precious) << "mine";
  const std::string out = path("out");
  fs::create_directories(out);
  fs::create_symlink(precious, out + "/.lagroid.partial");
  EXPECT_EQ(run("run " + example("kepler") + " --set time.steps=5 --out " + out).code, 0);
  std::ifstream in(precious);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "mine");

  const std::string other = path("other");
  const std::string elsewhere = path("elsewhere");
  fs::create_directories(other);
  fs::create_directories(elsewhere);
  std::ofstream(elsewhere + "/scene.toml") << "mine";
  fs::create_symlink(elsewhere, other + "/checkpoint");
  EXPECT_EQ(run("run " + example("kepler") + " --set time.steps=5 --out " + other).code, 2);
  std::ifstream kept(elsewhere + "/scene.toml");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(kept), {}), "mine");
}

TEST_F(Folders, FilesOfAUsersBesideACheckpointStay) {
  const std::string out = path("out");
  fs::create_directories(out + "/checkpoint");
  std::ofstream(out + "/checkpoint/rows-of-mine.csv") << "mine";
  EXPECT_EQ(run("run " + example("kepler") + " --set time.steps=5 --out " + out).code, 0);
  EXPECT_TRUE(fs::exists(out + "/checkpoint/rows-of-mine.csv"));
}

TEST_F(Folders, ListsOfOtherLengthsInACheckpointAreRefused) {
  const std::string out = path("out");
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=40 --out " + out).code, 0);
  const std::string file = out + "/checkpoint/state.cbor";
  std::ifstream in(file, std::ios::binary);
  const std::string kept{std::istreambuf_iterator<char>(in), {}};
  in.close();
  auto json = nlohmann::json::from_cbor(kept.substr(sizeof(std::size_t)));
  ASSERT_TRUE(json.at("state").at("run").at("judge").at("quantity 0").contains("first"));
  json["state"]["run"]["judge"]["quantity 0"]["first"] = std::vector<double>();
  const auto cbor = nlohmann::json::to_cbor(json);
  keep_cbor(file, {cbor.begin(), cbor.end()});
  const Outcome r = run("resume " + out + " --set time.steps=100");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("checkpoint"), std::string::npos) << r.err;
}

/// Whoever is said to have made the file, `change` names another.
template <class Change> void make_of_another(const fs::path& file, const Change& change) {
  std::ifstream in(file, std::ios::binary);
  std::string kept{std::istreambuf_iterator<char>(in), {}};
  in.close();
  auto json = nlohmann::json::from_cbor(kept.substr(sizeof(std::size_t)));
  std::string program = json.at("program");
  EXPECT_NE(program.find("build "), std::string::npos) << program;
  json["program"] = change(program);
  const auto cbor = nlohmann::json::to_cbor(json);
  keep_cbor(file, {cbor.begin(), cbor.end()});
}
void make_of_another_build(const fs::path& file) {
  make_of_another(file, [](const std::string& program) { return program + "x"; });
}

TEST_F(Folders, ACheckpointNestedBeyondAllMeaningIsRefused) {
  const std::string out = path("out");
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=40 --out " + out).code, 0);
  // Arrays of one element inside each other.
  keep_cbor(out + "/checkpoint/state.cbor", std::string(300000, '\x81') + '\x01');
  const Outcome r = run("resume " + out + " --set time.steps=100");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("checkpoint"), std::string::npos) << r.err;
}

TEST_F(Folders, TheRunOfAnotherMinorVersionIsRefusedWhateverIsAskedFor) {
  const std::string out = path("out");
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=40 --out " + out).code, 0);
  make_of_another(out + "/checkpoint/state.cbor", [](const std::string& program) {
    return std::regex_replace(program, std::regex(R"(lagroid [0-9.]+)"), "lagroid 0.2.0");
  });
  for (const std::string also : {"", " --other-build"}) {
    const Outcome r = run("resume " + out + also + " --set time.steps=100");
    EXPECT_EQ(r.code, 2);
    EXPECT_NE(r.err.find("was made by lagroid 0.2.0"), std::string::npos) << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  }
  EXPECT_EQ(run("view " + out).code, 0);
}

TEST_F(Folders, TheRunOfAnotherBuildIsRefused) {
  const std::string out = path("out");
  const std::string whole = path("whole");
  const std::string scene = "run " + example("kepler") + " --set time.steps=";
  ASSERT_EQ(run(scene + "100 --out " + whole).code, 0);
  ASSERT_EQ(run(scene + "40 --out " + out).code, 0);
  make_of_another_build(out + "/checkpoint/state.cbor");
  const auto before = everything(out);
  const Outcome r = run("resume " + out + " --set time.steps=100");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("another build of lagroid"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("--other-build"), std::string::npos) << r.err;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  EXPECT_TRUE(everything(out) == before);
  const Outcome on = run("resume " + out + " --other-build --set time.steps=70");
  EXPECT_EQ(on.code, 0) << on.err;
  EXPECT_NE(on.out.find("without the promise of the same bits"), std::string::npos) << on.out;
  // That stays said, now that it is ours.
  const Outcome later = run("resume " + out + " --set time.steps=100");
  EXPECT_EQ(later.code, 0) << later.err;
  EXPECT_NE(bytes(out + "/summary.txt").find("without the promise of the same bits"), std::string::npos);
  EXPECT_TRUE(bytes(out + "/trajectory.csv") == bytes(whole + "/trajectory.csv"));
}

TEST_F(Folders, TheSweepOfAnotherBuildIsRefused) {
  const std::string sweep = commands()[1].words;
  const std::string out = path("out");
  ASSERT_EQ(run(sweep + " --out " + path("whole")).code, 0);
  // Broken off by a full disk when all parts are there.
  ASSERT_EQ(run(sweep + " --out " + out, "trap '' XFSZ; ulimit -f 8; ").code, 3);
  make_of_another_build(out + "/sweep.cbor");
  const Outcome r = run(sweep + " --out " + out);
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("by another build of lagroid"), std::string::npos) << r.err;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  const Outcome on = run(sweep + " --other-build --out " + out);
  EXPECT_EQ(on.code, 0) << on.err;
  EXPECT_NE(bytes(out + "/summary.txt").find("without the promise of the same bits"), std::string::npos);
  EXPECT_TRUE(bytes(out + "/members.csv") == bytes(path("whole") + "/members.csv"));
}

TEST_F(Folders, AFullDiskIsTheSameForAll) {
  for (const std::string& words :
       {"trajectories --count 200 --out " + path("data.csv"), "trajectories --count 200 --out " + path("data.h5"),
        "run " + example("kepler") + " --out " + path("out")}) {
    const Outcome r = run(words, "trap '' XFSZ; ulimit -f 8; ");
    EXPECT_EQ(r.code, 3) << words << r.err;
    EXPECT_NE(r.err.find("is the disk full?"), std::string::npos) << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  }
  EXPECT_FALSE(fs::exists(path("data.csv")));
}

/// A file that the disk does not give back to its end: this process's own memory, which begins with a hole.
TEST_F(Folders, AFileThatCannotBeReadIsNamed) {
  for (const char* name : {"memory.toml", "memory.csv"}) fs::create_symlink("/proc/self/mem", path(name));
  for (const std::string& words : {"run " + path("memory.toml"), "sweep " + path("memory.toml") + " --out " + path("x"),
                                   "optimize " + path("memory.toml"), "learn " + path("memory.csv")}) {
    const Outcome r = expect_refused(words, "cannot be read");
    EXPECT_NE(r.err.find("memory."), std::string::npos) << r.err;
  }
}

TEST_F(Folders, ADamagedTrajectoryIsNamed) {
  const std::string out = path("out");
  ASSERT_EQ(run("run " + example("kepler") + " --set time.steps=50 --out " + out).code, 0);
  const std::string good = bytes(out + "/trajectory.h5");
  std::mt19937 random(3);
  for (int k = 0; k < 60; ++k) {
    std::string bad = good;
    // Where the file says what is in it.
    for (int i = 0; i < 1 + k % 20; ++i) bad[random() % std::min<std::size_t>(bad.size(), 6000)] = char(random() % 256);
    if (k % 10 == 0) bad.resize(random() % bad.size());
    std::ofstream(out + "/trajectory.h5", std::ios::binary) << bad;
    const Outcome r = run("view " + out);
    EXPECT_TRUE(r.code == 0 || r.code == 2) << k << ": " << r.code << r.err;
    EXPECT_EQ(r.code == 2, r.err.find("trajectory.h5") != std::string::npos) << r.err;
  }
}

TEST_F(Folders, NoThreadsIsOneLine) {
  const auto all = commands();
  const Outcome r = run(all[1].words + " --threads 3 --out " + path("out"), "ulimit -v 3000000; ulimit -s 8000000; ");
  EXPECT_EQ(r.code, 3) << r.err;
  EXPECT_NE(r.err.find("no thread could be started"), std::string::npos) << r.err;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  EXPECT_EQ(run(all[1].words + " --out " + path("out")).code, 0);
}

}  // namespace
}  // namespace run_output_folders_tests
