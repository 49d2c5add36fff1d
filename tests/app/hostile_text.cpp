// Names, keys and files by someone who means harm: none is obeyed by gnuplot, a browser or a terminal, and none ends
// the program without a line.

#include "command_line.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace app_hostile_text_tests {
namespace {

using Json = nlohmann::json;
using std::string;
using std::vector;

/// Which no scene may hold.
const vector<string> refused{"x\nsystem(\"touch owned\")\n#",
                             "x'\n!touch owned\n",
                             "x\r\ny",
                             "x\033[31m",
                             "x\033]0;owned\007",
                             "x\xc2\x9b"
                             "31m",               // CSI in one character
                             "x\xe2\x80\xaegnp",  // right to left
                             "x\xe2\x80\xa8y",    // end of line
                             "x\x7fy",
                             string("x\0y", 3),
                             string(100'000, 'x')};

/// Names as good as any.
const vector<string> shown{"x'; system(\"touch owned\"); '",
                           "x'.system('touch owned').'",
                           "`touch owned`",
                           "$(touch owned)",
                           "@x {/Symbol a",
                           "x\\",
                           "%n%s{}{0}",
                           "</title></script><script>alert(1)</script>",
                           "\"a\", b | c",
                           "@RUN@ # $x^2$",
                           "\xc3\xa9\xe6\xad\xa3"};

/// As a string of TOML, and of JSON.
string quoted(const string& text) { return Json(text).dump(-1, ' ', /*ensure_ascii=*/true); }

/// As one word of the shell.
string word(const string& text) { return "'" + std::regex_replace(text, std::regex("'"), "'\\''") + "'"; }

string scene_named(const string& name) {
  return "name = " + quoted(name) +
         "\n[time]\nstep = 0.05\nsteps = 20\n[[body]]\nkind = 'point'\nname = 'a'\nmass = 1\nposition = [1, 0, 0]\n"
         "[[body]]\nkind = 'point'\nname = 'b'\nmass = 1\nposition = [2, 0, 0]\n"
         "[[effect]]\nkind = 'spring'\nbetween = ['a', 'b']\nstiffness = 1.0\nlength = 1.1\n";
}

class HostileText : public CommandLine {
 protected:
  fs::path write(const string& name, const string& text) const {
    const fs::path file = folder_ / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  static string bytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  /// Whatever was written where the commands run, or in a folder of theirs, is not there.
  void expect_not_owned(const string& what) const {
    EXPECT_FALSE(fs::exists(folder_ / "owned")) << what;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      EXPECT_NE(entry.path().filename(), "owned") << what;
  }

  /// Runs in the folder of the test; nothing reaches the terminal that it would obey.
  Outcome tame(const string& arguments) const {
    Outcome r = run(arguments, "cd " + folder_.string() + " && ");
    const auto obeyed = [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; };
    for (const string& text : {r.out, r.err}) {
      EXPECT_TRUE(std::none_of(text.begin(), text.end(), obeyed)) << arguments.substr(0, 200);
      for (const char* sequence : {"\xc2\x9b", "\xe2\x80\xae", "\xe2\x80\xa8"})
        EXPECT_EQ(text.find(sequence), string::npos) << arguments.substr(0, 200);
    }
    EXPECT_LE(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    expect_not_owned(arguments.substr(0, 200));
    return r;
  }

  void expect_refused(const string& arguments, const string& said = "") const {
    const Outcome r = tame(arguments);
    EXPECT_EQ(r.code, 2) << arguments.substr(0, 200) << "\n" << r.out.substr(0, 200) << r.err.substr(0, 200);
    EXPECT_LT(r.err.size(), 1000U) << r.err.substr(0, 200);
    EXPECT_NE(r.err.find(said), string::npos) << r.err;
  }

  /// The exit code by itself: -1 where the program was killed.
  int code_of(const string& arguments) const {
    const string command = "cd " + folder_.string() + " && " + string(LAGROID_PROGRAM) + " " + arguments;
    const int status = std::system(("sh -c " + word(command)).c_str());
    return WIFEXITED(status) && WEXITSTATUS(status) < 128 ? WEXITSTATUS(status) : -1;
  }

  /// With lagroid-check where that is built.
  vector<string> scene_commands() {
    vector<string> out{"run ", "run --out out ", "study ", "study --list ", "study --out out ", "cite "};
    has_check_ = fs::exists(fs::path(LAGROID_PROGRAM).parent_path() / "lagroid-check");
    if (has_check_) out.emplace_back("check ");
    return out;
  }
};

TEST_F(HostileText, IsRefusedByEveryCommandThatReadsAScene) {
  const string plain = write("plain.toml", scene_named("plain")).string();
  for (const string& text : refused) {
    const string scene = write("scene.toml", scene_named(text)).string();
    for (const string& command : scene_commands()) {
      expect_refused(command + scene, "scene.toml:1: name: ");
      if (text.find('\0') == string::npos)
        expect_refused(command + plain + " --set name=" + word(text), "--set name: ");
    }
    expect_refused("run --json " + scene);
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
  expect_refused("run " + plain + " --set name=" + word("x\xff"), "UTF-8");
}

TEST_F(HostileText, IsRefusedWhereverItStandsInAScene) {
  for (const string& text : refused) {
    const string q = quoted(text);
    for (const string& scene :
         {"system = " + q, q + " = 1", "[" + q + "]\nx = 1", "a." + q + " = 1", "a = [[1, " + q + "]]",
          "a = [{ b = " + q + " }]", "[[body]]\nkind = 'point'\nname = " + q, "[continuation]\nparameter = " + q})
      expect_refused("run " + write("scene.toml", scene).string(), "scene.toml:");
    for (const string& sweep :
         {"scene = " + q, "[scene]\nfile = " + q, "[scene]\nname = " + q, "scene = 'a.toml'\n[[vary]]\nkey = " + q,
          "scene = 'a.toml'\n[keep]\nfinal = [" + q + "]", "scene = 'a.toml'\n[plot]\nx = " + q,
          "scene = 'a.toml'\n[design]\nkind = 'list'\nfile = " + q})
      expect_refused("sweep --out out " + write("sweep.toml", sweep).string(), "sweep.toml:");
    for (const string& problem : {"problem = " + q, "problem = 'eigenvalues'\n[data]\nmatrix = " + q,
                                  "problem = 'eigenvalues'\n[start]\nfile = " + q})
      expect_refused("optimize --out out " + write("problem.toml", problem).string(), "problem.toml:");
  }
}

TEST_F(HostileText, KeysAreThoseThatTomlHasWithoutQuotes) {
  // Such a key would look like one that was read.
  expect_refused("run " + example("kepler") + " --set " + word("time={\"steps.x\" = 1}"), "--set time: ");
  const string scene = bytes(example("kepler"));
  expect_refused("run " + write("scene.toml", "\"time.steps\" = 7\n" + scene).string(),
                 "scene.toml:1: \"time.steps\": no key");
  expect_refused("run " + example("kepler") + " --set 'a b=1'", "--set a b: no key");
}

TEST_F(HostileText, IsShownAsItIs) {
  for (const string& name : shown) {
    fs::remove_all(folder_ / "run");
    fs::remove_all(folder_ / "study");
    const string scene = write("scene.toml", scene_named(name)).string();
    const Outcome r = tame("run " + scene + " --out run");
    EXPECT_EQ(r.code, 0) << name << r.err;
    EXPECT_TRUE(r.out.starts_with(name + ": converged")) << r.out;
    EXPECT_EQ(Json::parse(bytes(folder_ / "run/summary.json")).at("system"), name);
    EXPECT_TRUE(fs::exists(folder_ / "run/plot.svg")) << name;
    EXPECT_EQ(tame("resume run").code, 0) << name;
    EXPECT_EQ(tame("plot run").code, 0) << name;
    EXPECT_EQ(tame("cite run").code, 0) << name;
    EXPECT_EQ(tame("view run").code, 0) << name;
    EXPECT_EQ(bytes(folder_ / "run/view.html").find("<script>alert"), string::npos);

    const Outcome s = tame("study " + scene +
                           " --methods variational --steps 0.1,0.05 --repetitions 1 --reference variational@0.02"
                           " --out study");
    EXPECT_EQ(s.code, 0) << name << s.err;
    for (const char* file : {"study.svg", "study.png"}) EXPECT_TRUE(fs::exists(folder_ / "study" / file)) << name;
    EXPECT_EQ(bytes(folder_ / "study/study.html").find("<script>alert"), string::npos);
    EXPECT_EQ(bytes(folder_ / "study/study.md").find("<script>alert"), string::npos);
    EXPECT_EQ(Json::parse(bytes(folder_ / "study/study.json")).at("system"), name);
  }
}

TEST_F(HostileText, InTheNamesOfFilesIsShownAndNotObeyed) {
  const string name = "x\033[31m\n\xc2\x9b\xff";
  const string file = word((folder_ / name).string() + ".toml");
  const string out = word((folder_ / name).string());
  expect_refused("run " + file, "no such scene file");
  write(name + ".toml", scene_named("plain"));
  for (const string& command : scene_commands()) {
    if (command.find("study") != string::npos) continue;
    EXPECT_EQ(tame(command + file + (command == "check " ? " --samples 1" : "")).code, 0) << command;
  }
  const string briefly = " --methods variational --steps 0.1 --repetitions 1 --reference variational@0.05 --out ";
  for (const string json : {"", " --json"}) {
    EXPECT_EQ(tame("study " + file + briefly + word((folder_ / "study").string() + name) + json).code, 0);
    EXPECT_EQ(tame("run " + file + " --out " + out + json).code, 0);
    EXPECT_EQ(tame("resume " + out + json).code, 0);
  }
  EXPECT_EQ(tame("view " + out).code, 0);
  EXPECT_EQ(tame("plot " + out).code, 0);
  expect_refused("sweep --out sweep " + file);
  expect_refused("optimize " + file);
  expect_refused("learn " + file);
  expect_refused("learn " + example("kepler") + " --model " + out);
  expect_refused("trajectories --out " + out + " --chain " + out);
  expect_refused(out);
  const string data = word((folder_ / name).string() + ".csv");
  for (const string json : {"", " --json"}) {
    EXPECT_EQ(tame("trajectories --chain 1 --count 2 --points 3 --out " + data + json).code, 0);
    EXPECT_EQ(tame("learn --model polynomial:1 --starts 1 --iterations 2 --out learned " + data + json).code, 0);
  }
}

TEST_F(HostileText, InTablesOfNumbersIsShownAndNotObeyed) {
  expect_refused("learn " + write("data.csv", "trajectory,t,x\033[31m\xc2\x9b\n1,2,3\n").string());
  write("members.csv", "time.step,x\033[31m\n1,2\n");
  const string design = "[design]\nkind = 'list'\nfile = 'members.csv'\n";
  expect_refused("sweep --out out " +
                 write("sweep.toml", "scene = " + quoted(example("kepler")) + "\n" + design).string());
  write("matrix.csv", "1,x\033[31m\n");
  expect_refused("optimize " +
                 write("problem.toml", "problem = 'eigenvalues'\n[data]\nmatrix = 'matrix.csv'\n").string());
}

TEST_F(HostileText, InASummaryIsRefused) {
  ASSERT_EQ(tame("run --out run " + example("kepler") + " --set time.steps=20").code, 0);
  const Json whole = Json::parse(bytes(folder_ / "run/summary.json"));
  const auto changed = [&](const char* pointer, const Json& value) {
    Json json = whole;
    json[Json::json_pointer(pointer)] = value;
    write("run/summary.json", json.dump());
  };
  for (const char* pointer : {"/system", "/status", "/notes/0", "/ledger/entries/0/name", "/picture/panels/0/title"}) {
    changed(pointer, "x\033[31m\n");
    expect_refused("view run", "control characters");
  }
  changed("/picture/panels/0/title", "x'\nsystem(\"touch owned\")\n'");
  expect_refused("plot run", "control characters");
  changed("/picture/panels/0/title", "another");
  expect_refused("plot run", "--own-script");
  for (const char* pointer : {"/picture", "/picture/panels/0"}) {
    changed(pointer, Json::object());
    expect_refused("plot run", "summary.json");
  }
  for (const char* pointer : {"/ledger", "/picture"}) {
    changed(pointer, Json::object());
    expect_refused("view run", "summary.json");
  }
  changed("/picture/panels", Json::object());
  expect_refused("plot run", "--own-script");
}

TEST_F(HostileText, AScriptThatTheRunDidNotWriteIsNotRunUnasked) {
  ASSERT_EQ(tame("run --out run " + example("kepler") + " --set time.steps=20").code, 0);
  std::ofstream(folder_ / "run/plot.gp", std::ios::app) << "system(\"touch " + (folder_ / "owned").string() + "\")\n";
  expect_refused("plot run", "--own-script");
  EXPECT_EQ(run("plot --own-script " + (folder_ / "run").string()).code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "owned")) << "asked for";
}

TEST_F(HostileText, PicturesAreNotWrittenThroughTheFolder) {
  ASSERT_EQ(tame("run --out run " + example("kepler") + " --set time.steps=20").code, 0);
  const fs::path kept = write("kept", "of someone");
  for (const char* name : {"plot.svg", "plot.png", "plot.log", "view.html"}) {
    fs::remove(folder_ / "run" / name);
    fs::create_symlink(kept, folder_ / "run" / name);
  }
  EXPECT_EQ(tame("plot run").code, 0);
  EXPECT_EQ(tame("view run").code, 0);
  EXPECT_EQ(bytes(kept), "of someone");
}

TEST_F(HostileText, DeepNestingIsRefused) {
  string dotted = "a";
  for (int i = 1; i < 40'000; ++i) dotted += ".a";
  const auto many = [](const string& part, int count) {
    string out;
    for (int i = 0; i < count; ++i) out += part;
    return out;
  };
  for (const string& text : {dotted + " = 1", "[" + dotted + "]", dotted + " = 1\n!", "a = [{ " + dotted + " = 1 }]",
                             "a = [ \"\"\"b\"\"\"\", { " + dotted + " = 1 }]", many("a = {", 300'000),
                             "a = " + many("[", 300'000), many(many("a.", 60) + "a = {", 300)}) {
    const string scene = write("scene.toml", text).string();
    for (const string command : {"run ", "study ", "sweep --out out ", "optimize ", "cite "})
      expect_refused(command + scene, "nested more than 100 deep");
  }
  expect_refused("run " + example("kepler") + " --set " + dotted + "=1", "no key");
  expect_refused("run " + example("kepler") + " --set a=" + many("[", 40'000), "nested");
  expect_refused("run " + example("kepler") + " --set 'a={" + dotted + "=1}'", "nested");
  // Dots that are no parts of keys.
  const string scene = "# " + string(500, '.') + "\nname = \"" + string(500, '.') + "\"\n";
  EXPECT_EQ(tame("run " + write("dots.toml", scene + scene_named("").substr(9)).string()).code, 0);

  ASSERT_EQ(tame("run --out run " + example("kepler") + " --set time.steps=20").code, 0);
  const string deep = many("[", 300'000) + many("]", 300'000);
  write("run/summary.json", deep);
  expect_refused("view run");
  expect_refused("plot run");
  write("run/.lagroid", "{\"kind\": \"run\", \"of\": {\"scene\": " + deep + "}}");
  expect_refused("run --out run " + example("kepler") + " --set time.steps=20", ".lagroid");
  for (const string& json : {deep, "{\"kind\": " + deep + "}"}) {
    write("model.json", json);
    expect_refused("run " + write("learned.toml",
                                  "system = 'learned_hamiltonian'\n[parameters]\nmodel = 'model.json'\n"
                                  "[time]\nstep = 0.1\nsteps = 2\n")
                                .string());
    expect_refused("study --reference model.json " + example("kepler"));
  }
}

TEST_F(HostileText, WhereNobodyListensTheExitCodeTells) {
  EXPECT_EQ(code_of("run nowhere.toml 2>&-"), 2);
  EXPECT_EQ(code_of("run nowhere.toml 2>/dev/full"), 2);
  EXPECT_EQ(code_of("run nowhere.toml >&- 2>&- <&-"), 2);
  EXPECT_EQ(code_of("run --json nowhere.toml >/dev/full 2>/dev/full"), 3);
  EXPECT_EQ(code_of("nonsense 2>/dev/full"), 2);
  const string kepler = example("kepler") + " --set time.steps=20 ";
  EXPECT_EQ(code_of("run " + kepler + "2>&- >/dev/null"), 0);
  EXPECT_EQ(code_of("run " + kepler + ">&- 2>&-"), 3);
  // No file takes the place of what is closed.
  EXPECT_EQ(code_of("run --out run " + kepler + ">&- 2>&-"), 3);
  EXPECT_FALSE(fs::exists(folder_ / "run/.lock"));
  EXPECT_EQ(Json::parse(bytes(folder_ / "run/summary.json")).at("status"), "converged");
}

TEST_F(HostileText, TooManyMembersAreRefusedAtOnce) {
  const string vary = "[[vary]]\nkey = 'initial.momentum.{}'\nfrom = 0.1\nto = 1.0\ncount = 100000000\n";
  const string sweep = "scene = " + quoted(example("kepler")) + "\n[design]\nkind = 'grid'\n" +
                       fmt::format(fmt::runtime(vary), 0) + fmt::format(fmt::runtime(vary), 1);
  const auto start = std::chrono::steady_clock::now();
  expect_refused("sweep --out out " + write("sweep.toml", sweep).string(), "members");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
}

}  // namespace
}  // namespace app_hostile_text_tests
