// The documentation keeps up with the code: its C++ is that of the examples, what it quotes is printed, what it names
// exists.
#include <lagroid/core/version.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/rotations/moser_veselov_method.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

const std::filesystem::path root = LAGROID_ROOT;

std::string read(const std::filesystem::path& path) {
  std::ifstream file(root / path);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The text without the indentation of its lines.
std::string flush_left(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find_first_not_of(' ');
    out += (first == std::string::npos ? "" : line.substr(first)) + '\n';
  }
  return out;
}

/// The page's blocks in that language which are no part of `source`, indentation aside; one "no block" if it has none.
std::vector<std::string> foreign_blocks(const std::string& page, const std::string& language,
                                        const std::string& source) {
  const std::string fence = "```" + language + "\n";
  std::vector<std::string> out;
  if (page.find(fence) == std::string::npos) out.push_back("no block");
  for (auto at = page.find(fence); at != std::string::npos; at = page.find(fence, at)) {
    at += fence.size();
    const std::string block = page.substr(at, page.find("```", at) - at);
    if (flush_left(source).find(flush_left(block)) == std::string::npos) out.push_back(block);
    at += block.size() + 3;
  }
  return out;
}

/// The page's section of that heading.
std::string section(const std::string& page, const std::string& heading) {
  const auto start = page.find("\n" + heading + "\n");
  if (start == std::string::npos) throw std::runtime_error("no section " + heading);
  return page.substr(start, page.find("\n## ", start + 1) - start);
}

/// The text of all files of that ending in those folders.
std::string text_of(const std::vector<std::string>& folders, const std::string& ending) {
  std::string out;
  for (const auto& folder : folders)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ending) out += read(entry.path());
  return out;
}

/// What matches the pattern's group, lines joined.
std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::string joined = std::regex_replace(text, std::regex("\\s+"), " ");
  const std::regex expression(pattern);
  std::vector<std::string> out;
  for (std::sregex_iterator at(joined.begin(), joined.end(), expression); at != std::sregex_iterator(); ++at)
    out.push_back((*at)[1]);
  return out;
}

/// The folders of the sources, each of which may include those before it (docs/architecture.md).
const std::vector<std::string> layers{"core", "groupoids", "solvers", "systems", "run", "app"};

/// Which of the includes in a layer's text name a later one.
std::vector<std::string> upward_includes(const std::string& layer, const std::string& text) {
  std::vector<std::string> out;
  const auto place = [](const std::string& name) { return std::find(layers.begin(), layers.end(), name); };
  for (const auto& included : matches(text, "#include <lagroid/(\\w+)/"))
    if (place(included) != layers.end() && place(included) > place(layer)) out.push_back(layer + " -> " + included);
  return out;
}

/// Which folders of the app, each with its rooms, the files in each of them include. What lies in app/ itself makes the
/// programs of them.
using FolderIncludes = std::map<std::string, std::set<std::string>>;
FolderIncludes app_includes() {
  FolderIncludes out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "app")) {
    const auto& file = entry.path();
    if (file.extension() != ".hpp" && file.extension() != ".cpp") continue;
    const auto folder_of = [](const std::filesystem::path& of) {
      const auto inside = of.lexically_normal().lexically_relative(root / "app");
      return "app" + (inside.has_parent_path() ? "/" + inside.begin()->string() : std::string());
    };
    const std::string folder = folder_of(file);
    if (folder == "app") continue;
    for (const auto& included : matches(read(file), "#include \"([^\"]+)\""))
      if (const std::string other = folder_of(file.parent_path() / included); other != folder)
        out[folder].insert(other);
  }
  return out;
}

/// The folders that lie on a cycle of includes, or lead to one.
std::vector<std::string> in_cycles(FolderIncludes includes) {
  for (bool changed = true; changed;) {
    changed = false;
    for (auto& [folder, others] : includes)
      changed |= std::erase_if(others, [&](const std::string& other) {
                   return !includes.contains(other) || includes.at(other).empty();
                 }) > 0;
  }
  std::vector<std::string> out;
  for (const auto& [folder, others] : includes)
    if (!others.empty()) out.push_back(folder);
  return out;
}

/// The page without its fenced blocks.
std::string prose_of(std::string page) {
  for (auto at = page.find("```"); at != std::string::npos; at = page.find("```", at))
    page.erase(at, page.find("```", at + 3) + 3 - at);
  return page;
}

/// The files, tests and identifiers in `backquotes` and the laws in "quotes" that do not exist.
std::vector<std::string> unknown_names(const std::string& page) {
  const std::string headers = text_of({"core", "groupoids", "solvers", "systems"}, ".hpp");
  const std::string tests = text_of({"tests"}, ".cpp");
  std::vector<std::string> out;
  const auto require = [&](const std::string& name, bool exists) {
    if (!exists) out.push_back(name);
  };
  for (const auto& name : matches(page, "`([^`]+)`")) {
    const auto dot = name.find('.');
    if (name.find('/') != std::string::npos) {
      require(name, exists(root / name));
    } else if (dot != std::string::npos) {
      require(name, tests.find("TEST(" + name.substr(0, dot) + ", " + name.substr(dot + 1) + ")") != std::string::npos);
    } else {
      require(name, std::regex_search(headers, std::regex("\\b" + name + "\\b")));
    }
  }
  for (const auto& law : matches(page, "\"([^\"]+)\"")) require(law, headers.find(law + "\"") != std::string::npos);
  return out;
}

/// The text of a test, from its name to the next one at most; empty if there is none.
std::string body_of(const std::string& test, const std::string& tests) {
  const auto dot = test.find('.');
  const auto start = tests.find("TEST(" + test.substr(0, dot) + ", " + test.substr(dot + 1) + ")");
  if (start == std::string::npos) return {};
  return tests.substr(start, std::min(tests.find("\nTEST", start), tests.find("\n}\n", start)) - start);
}

/// For every statement, the laws that none of the tests said to fail them mentions, and those of these tests that
/// mention none of the laws. What fails is named in the sentence "Fails: ...", or anywhere in a statement without.
std::vector<std::string> unfounded_failures(const std::string& page) {
  const std::string tests = text_of({"tests"}, ".cpp");
  std::vector<std::string> out;
  for (std::size_t start = 0; start < page.size();) {
    const auto end = std::min(page.find("\n\n", start), page.size());
    const std::string statement = page.substr(start, end - start);
    start = end + 2;
    const auto laws = matches(statement, "\"([^\"]+)\"");
    if (laws.empty()) continue;
    const auto fails = matches(statement, "Fails:((?:[^.]|\\.\\w)*)");
    const auto failing = matches(fails.empty() ? statement : fails.front(), "`(\\w+\\.\\w+)`");
    const auto mentions = [&](const std::string& test, const std::string& law) {
      return body_of(test, tests).find(law + "\"") != std::string::npos;
    };
    for (const auto& law : laws)
      if (std::none_of(failing.begin(), failing.end(), [&](const auto& test) { return mentions(test, law); }))
        out.push_back(law);
    for (const auto& test : failing)
      if (std::none_of(laws.begin(), laws.end(), [&](const auto& law) { return mentions(test, law); }))
        out.push_back(test);
  }
  return out;
}

const std::vector<std::string> none;

TEST(Readme, ItsOwnSystemIsThatOfTheExample) {
  EXPECT_EQ(
      foreign_blocks(section(read("README.md"), "## A system of your own"), "cpp", read("examples/my_system.cpp")),
      none);
}

TEST(Tutorial, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/tutorial.md"), "cpp", read("examples/my_system.cpp")), none);
}

#ifdef LAGROID_EXAMPLE
TEST(Tutorial, WhatItQuotesIsPrinted) {
  std::FILE* pipe = ::popen(LAGROID_EXAMPLE " 2>/dev/null", "r");
  ASSERT_NE(pipe, nullptr);
  std::string printed;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) printed += char(c);
  EXPECT_EQ(::pclose(pipe), 0);
  EXPECT_EQ(foreign_blocks(read("docs/tutorial.md"), "text", printed), none);
}
#endif

TEST(BrokenPage, AnAlteredBlockIsFoundOut) {
  std::string page = read("docs/tutorial.md");
  const std::string half = "(0.5 / h)";
  page.replace(page.find(half), half.size(), "(0.6 / h)");
  EXPECT_EQ(foreign_blocks(page, "cpp", read("examples/my_system.cpp")).size(), 1U);
  EXPECT_EQ(foreign_blocks("no code", "cpp", "any").size(), 1U);
}

TEST(Architecture, LayersIncludeThoseBeforeThem) {
  for (const auto& layer : layers)
    for (const char* ending : {".hpp", ".cpp"}) EXPECT_EQ(upward_includes(layer, text_of({layer}, ending)), none);
}
TEST(Architecture, FoldersOfTheAppIncludeEachOtherOneWay) { EXPECT_EQ(in_cycles(app_includes()), none); }
TEST(BrokenArchitecture, ACycleIsFoundOut) {
  FolderIncludes includes = app_includes();
  ASSERT_TRUE(includes["app/study"].contains("app/families"));
  includes["app/families"].insert("app/study");
  EXPECT_FALSE(in_cycles(includes).empty());
}

/// Of source text, the names that have another one now (CHANGELOG.md has the table); they live in compat/ alone.
std::vector<std::string> retired_names(const std::string& text) {
  return matches(text,
                 "\\b(March|MarchOptions|MarchOf|make_march|Walk|Tape|Stepper|Lanes|Mixed|MixedOf|AlphaFibre|EitherWay|"
                 "Abilities|Seek|Sight|Pace|PlainMarch|Lesson|SphereMarch|BatchMarch|persist|deflect)"
                 "\\b(?! of | that | from )");
}
TEST(Names, RetiredOnesDoNotComeBack) {
  for (const auto& layer : layers)
    for (const char* ending : {".hpp", ".cpp"}) EXPECT_EQ(retired_names(text_of({layer}, ending)), none);
  EXPECT_EQ(retired_names("std::unique_ptr<March<Sys>> m;"), std::vector<std::string>{"March"});
}

/// Folders of sources with more files of their own than a reader takes in at a glance.
std::vector<std::string> crowded_folders(const std::vector<std::string>& tops) {
  std::map<std::string, int> count;
  for (const auto& top : tops)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
      const std::string ending = entry.path().extension().string();
      if (ending == ".hpp" || ending == ".cpp" || ending == ".py" || ending == ".in")
        ++count[entry.path().parent_path().lexically_relative(root).string()];
    }
  std::vector<std::string> out;
  for (const auto& [folder, files] : count)
    if (files > 15) out.push_back(folder);
  return out;
}
TEST(Rooms, AreNotCrowded) {
  EXPECT_EQ(crowded_folders({"core", "groupoids", "solvers", "systems", "run", "app", "tests", "bench", "python"}),
            none);
}

/// Everything that runs is one of these; a second way would be another class here.
TEST(Architecture, OneClassForEveryKindOfMotion) {
  const std::string sources = text_of({"core", "groupoids", "solvers", "systems", "run", "app", "python"}, ".hpp") +
                              text_of({"core", "groupoids", "solvers", "systems", "run", "app", "python"}, ".cpp");
  const auto sorted = [](std::vector<std::string> names) {
    std::sort(names.begin(), names.end());
    return names;
  };
  EXPECT_EQ(sorted(matches(sources, "class (\\w+) (?:final )?: public Motion\\b")),
            (std::vector<std::string>{"BodiesMotion", "SphereMotion", "SystemMotion"}));
  EXPECT_EQ(sorted(matches(sources, "class (\\w+) (?:final )?: public Observables\\b")),
            (std::vector<std::string>{"SceneNode", "SphereNode", "SystemNode"}));
}
TEST(BrokenArchitecture, AnUpwardIncludeIsFoundOut) {
  EXPECT_EQ(upward_includes("core", "#include <lagroid/run/run.hpp>\n"), std::vector<std::string>{"core -> run"});
}

TEST(Mathematics, WhatItNamesExists) { EXPECT_EQ(unknown_names(read("docs/mathematics.md")), none); }

TEST(HigherOrder, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/higher_order.md"))), none); }
TEST(HigherOrder, WhatFailsALawSaysWhich) { EXPECT_EQ(unfounded_failures(read("docs/higher_order.md")), none); }

TEST(HamiltonianMapsPage, WhatItNamesExists) {
  EXPECT_EQ(unknown_names(prose_of(read("docs/hamiltonian_maps.md"))), none);
}
TEST(HamiltonianMapsPage, ItsCodeIsThatOfTheTest) {
  EXPECT_EQ(foreign_blocks(read("docs/hamiltonian_maps.md"), "cpp", read("tests/solvers/hamiltonian_maps/maps.cpp")),
            none);
}

TEST(OptimisationPage, WhatItNamesExists) {
  const std::string page = read("docs/optimisation.md");
  for (const char* heading : {"## A function of your own", "## Algorithm 1, and what its multipliers are",
                              "## What is promised", "## The setting that we recommend"})
    EXPECT_EQ(unknown_names(prose_of(section(page, heading))), none) << heading;
}
TEST(OptimisationPage, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/optimisation.md"), "cpp", read("examples/my_objective.cpp")), none);
}

TEST(LieGroupPage, WhatItNamesExists) {
  EXPECT_EQ(unknown_names(prose_of(read("docs/lie_group_integrators.md"))), none);
}
TEST(LieGroupPage, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/lie_group_integrators.md"), "cpp", read("examples/my_hamiltonian.cpp")), none);
}

TEST(LearningPage, WhatItNamesExists) {
  for (const char* heading : {"## How well", "## A potential of your own"})
    EXPECT_EQ(unknown_names(prose_of(section(read("docs/learning.md"), heading))), none) << heading;
}
TEST(LearningPage, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/learning.md"), "cpp", read("examples/my_potential.cpp")), none);
}

TEST(Newton, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/newton.md"))), none); }
TEST(Newton, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/newton.md"), "cpp", read("examples/implicit_step.cpp")), none);
}

TEST(Nonholonomic, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/nonholonomic.md"))), none); }
TEST(Nonholonomic, WhatFailsALawSaysWhich) { EXPECT_EQ(unfounded_failures(read("docs/nonholonomic.md")), none); }

TEST(MultibodyPage, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/multibody.md"))), none); }
TEST(MultibodyPage, WhatFailsALawSaysWhich) {
  EXPECT_EQ(unfounded_failures(prose_of(read("docs/multibody.md"))), none);
}
TEST(Ensembles, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/ensembles.md"), "cpp", read("examples/my_ensemble.cpp")), none);
  EXPECT_EQ(unknown_names(prose_of(read("docs/ensembles.md"))), none);
}

TEST(MultibodyPage, ItsCodeIsThatOfTheExample) {
  EXPECT_EQ(foreign_blocks(read("docs/multibody.md"), "cpp", read("examples/my_effect.cpp")), none);
}

TEST(Sweeps, WhatItNamesExists) {
  const std::string page = read("docs/sweeps.md");
  const auto laws = matches(page, "`((?:Sweep|Schedule)\\.[A-Za-z]+)`");
  EXPECT_FALSE(laws.empty());
  const std::string tests = text_of({"tests/app/sweep_command"}, ".cpp");
  for (const std::string& law : laws) {
    const auto dot = law.find('.');
    EXPECT_NE(tests.find("(" + law.substr(0, dot) + ", " + law.substr(dot + 1) + ")"), std::string::npos) << law;
  }
}
TEST(Time, WhatItNamesExists) { EXPECT_EQ(unknown_names(prose_of(read("docs/time.md"))), none); }
TEST(Time, WhatFailsALawSaysWhich) { EXPECT_EQ(unfounded_failures(prose_of(read("docs/time.md"))), none); }

TEST(TheoryPages, WhatTheyNameExists) {
  for (const char* paper : {"G", "N", "V", "H"})
    EXPECT_EQ(unknown_names(prose_of(read(std::string("docs/theory/") + paper + ".md"))), none) << paper;
}

/// What looks like the name of a test, Suite.Name, in `backquotes`.
std::vector<std::string> unknown_tests(const std::string& page) {
  const std::string tests = text_of({"tests"}, ".cpp");
  std::vector<std::string> out;
  for (const auto& name : matches(prose_of(page), "`([A-Z]\\w+\\.[A-Z]\\w+)`"))
    if (body_of(name, tests).empty()) out.push_back(name);
  return out;
}

TEST(Questions, AreAnsweredByTestsThatExist) {
  const std::string page = read("docs/faq.md");
  EXPECT_EQ(unknown_tests(page), none);
  for (auto at = page.find("\n## "); at != std::string::npos; at = page.find("\n## ", at + 1)) {
    const std::string answer = page.substr(at, page.find("\n## ", at + 1) - at);
    EXPECT_FALSE(matches(answer, "`([A-Z]\\w+\\.[A-Z]\\w+)`").empty()) << answer.substr(0, 80);
  }
}

TEST(BrokenPage, ATestOfNothingIsFoundOut) {
  EXPECT_EQ(unknown_tests("`Nothing.IsTested`, `NewtonStep.ReportsNotFinite`"),
            std::vector<std::string>{"Nothing.IsTested"});
}

TEST(Mathematics, ItNamesEveryLaw) {
  // It and the pages of what is not [G]'s.
  const auto named =
      matches(read("docs/mathematics.md") + read("docs/nonholonomic.md") + read("docs/time.md") +
                  read("docs/higher_order.md") + read("docs/multibody.md") + read("docs/lie_group_integrators.md") +
                  read("docs/ensembles.md") + prose_of(read("docs/optimisation.md")),
              "\"([^\"]+)\"");
  const auto laws = matches(text_of({"core/testing", "solvers/testing", "solvers/optimisation/testing",
                                     "systems/multibody/testing", "systems/testing"},
                                    ".hpp"),
                            "law\\( ?\"([^\"]+)\",");
  EXPECT_GT(laws.size(), 50U);
  for (const auto& law : laws) EXPECT_NE(std::find(named.begin(), named.end(), law), named.end()) << law;
}

TEST(Mathematics, WhatFailsALawSaysWhich) { EXPECT_EQ(unfounded_failures(read("docs/mathematics.md")), none); }

/// The files in tests/ that only the nightly tests build.
std::vector<std::string> nightly_files() {
  const std::string list =
      matches(read("tests/CMakeLists.txt"), "foreach\\(name (groupoids/laws_algebroid [^)]*)\\)").at(0);
  std::vector<std::string> out{"certificates", "nightly_runs"};
  for (const auto& name : matches(list, "(\\w+)(?: |$)")) out.push_back(name);
  return out;
}

/// What the page names and nightly tests alone bear, but for what its section on them says, and the other way round:
/// suites of tests, and law suites that no other test calls.
std::vector<std::string> misplaced_on(const std::string& page) {
  const std::string told = section(page, "## What is asked when");
  std::string daily;
  const auto files = nightly_files();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "tests")) {
    const bool at_night = std::find(files.begin(), files.end(), entry.path().stem()) != files.end();
    if (entry.path().extension() == ".cpp" && !at_night) daily += read(entry.path());
  }
  std::vector<std::string> out;
  const auto compare = [&](const std::string& name, bool at_night) {
    if (std::regex_search(told, std::regex("\\b" + name + "\\b")) != at_night) out.push_back(name);
  };
  for (const auto& test : matches(page, "`([A-Z]\\w+\\.[A-Z]\\w+)`"))
    compare(test.substr(0, test.find('.')), body_of(test, daily).empty());
  for (const auto& suite : matches(page, "`(\\w+_laws?)`"))
    compare(suite, daily.find("laws::" + suite) == std::string::npos);
  return out;
}

TEST(Mathematics, SaysWhatTheNightlyTestsAloneBear) { EXPECT_EQ(misplaced_on(read("docs/mathematics.md")), none); }
TEST(BrokenPage, AClaimThatNightlyTestsAloneBearIsFoundOut) {
  std::string page = read("docs/mathematics.md");
  const std::string named = "PoissonDefect, ";
  page.erase(page.find(named), named.size());
  page.replace(page.find("`cotangent_laws`,"), 17, "`variational_laws`,");
  const auto found = misplaced_on(page);
  for (const char* name : {"PoissonDefect", "cotangent_laws", "variational_laws"})
    EXPECT_NE(std::find(found.begin(), found.end(), name), found.end()) << name;
}

using Words = std::set<std::string>;

Words words(const std::vector<std::string>& list) { return {list.begin(), list.end()}; }

/// The words in `backquotes` of a column of the row that begins with `key`, of a table of the page.
Words words_in_row(const std::string& page, const std::string& key, int column) {
  const auto start = page.find("\n| " + key + " |");
  if (start == std::string::npos) throw std::runtime_error("no row " + key);
  std::istringstream cells(page.substr(start + 1, page.find('\n', start + 1) - start - 1));
  std::string cell;
  for (int i = 0; i <= column; ++i) std::getline(cells, cell, '|');
  return words(matches(cell, "`([^`]+)`"));
}

/// What the rows of docs/scenes.md on methods offer.
std::map<std::string, Words> methods_of(const std::string& scenes) {
  Words compositions = words_in_row(scenes, "`[time] composition`", 3);
  compositions.erase("splitting");  // whose compositions they are
  return {{"mode", words_in_row(scenes, "`[time] mode`", 2)},
          {"method", words_in_row(scenes, "`[time] method`", 2)},
          {"without_root", words_in_row(scenes, "`[time] without_root`", 2)},
          {"composition", compositions},
          {"solver", words_in_row(scenes, "`[solver] method`", 2)}};
}

std::map<std::string, Words> declared() {
  Words methods = words(lagroid::method_words());
  methods.emplace(lagroid::moser_veselov_method.name);
  Words compositions;
  for (const auto& each : lagroid::compositions_of(lagroid::OtherOrders::composed_flows))
    if (each.stages() > 1) compositions.emplace(each.name);
  return {{"mode", words(lagroid::mode_words())},
          {"method", methods},
          {"without_root", words(lagroid::words_of(lagroid::without_root_words))},
          {"composition", compositions},
          {"solver", words(lagroid::words_of(lagroid::solver_words))}};
}

/// What docs/which_method.md recommends and is no declared name, and the declared methods that it passes over.
std::vector<std::string> misjudged_methods(const std::string& page) {
  Words known{"tolerance", "[boundary]", "pendulum_chain"}, wanted;
  for (const lagroid::IntegrationMethod& method : lagroid::declared_methods) wanted.emplace(method.name);
  wanted.emplace(lagroid::moser_veselov_method.name);
  wanted.emplace(lagroid::rattle_method.name);
  known.insert(wanted.begin(), wanted.end());
  for (const auto& each : lagroid::compositions_of(lagroid::OtherOrders::composed_flows)) known.emplace(each.name);
  for (const auto& each : lagroid::lie_group_methods::all) known.emplace(each.name);
  Words named = words(matches(page, "`mode = \"([^\"`]+)\"`"));
  std::vector<std::string> out;
  for (const std::string& word : matches(page, "\\| [^|]+ \\| ([^|]+) \\|"))
    for (const std::string& each : matches(word, "`([^`]+)`")) {
      if (each.find('=') != std::string::npos) continue;
      named.insert(each);
      if (!known.contains(each)) out.push_back(each);
    }
  for (const std::string& each : matches(page, "\\*\\*What `([^`]+)` is there for")) named.insert(each);
  for (const std::string& each : wanted)
    if (!named.contains(each)) out.push_back(each);
  return out;
}

TEST(Methods, ScenesPageNamesExactlyTheDeclaredOnes) { EXPECT_EQ(methods_of(read("docs/scenes.md")), declared()); }
TEST(Methods, TheAdvisedOnesAreDeclaredAndNoneIsPassedOver) {
  EXPECT_EQ(misjudged_methods(read("docs/which_method.md")), none);
}
TEST(BrokenPage, AMethodOfNothingIsFoundOut) {
  std::string page = read("docs/scenes.md");
  page.replace(page.find("`adaptive`, "), 12, "");
  EXPECT_NE(methods_of(page), declared());
  page = read("docs/which_method.md");
  page.replace(page.find("`rattle`"), 8, "`rattel`");
  EXPECT_EQ(misjudged_methods(page), (std::vector<std::string>{"rattel", "rattle"}));
}

/// The names of methods that are written out in sources which should look them up.
std::vector<std::string> spelt_methods(const std::string& sources) {
  std::vector<std::string> out;
  const auto ask = [&](std::string_view name) {
    if (sources.find('"' + std::string(name) + '"') != std::string::npos) out.emplace_back(name);
  };
  for (const lagroid::IntegrationMethod& method : lagroid::declared_methods) ask(method.name);
  ask(lagroid::moser_veselov_method.name);
  ask(lagroid::rattle_method.name);
  return out;
}

TEST(Architecture, MethodsAreNamedWhereTheyAreDeclared) {
  std::string sources;
  for (const char* ending : {".hpp", ".cpp"})
    sources += text_of({"app/reading", "app/scenes", "app/families", "app/bodies", "app/spheres", "app/systems",
                        "app/study", "app/sweep", "app/cite", "run", "python"},
                       ending);
  EXPECT_GT(sources.size(), 100'000U);
  EXPECT_EQ(spelt_methods(sources), none);
}
TEST(BrokenArchitecture, AMethodThatIsSpeltAgainIsFoundOut) {
  EXPECT_EQ(spelt_methods("if (mode == \"adaptive\")"), std::vector<std::string>{"adaptive"});
}

TEST(StabilityPage, WhatItNamesExists) {
  const std::string page = read("docs/stability.md");
  for (const char* heading : {"## Stable", "## Experimental"})
    EXPECT_EQ(unknown_names(section(page, heading)), none) << heading;
}

TEST(InstallPage, TheVersionIsThatOfTheLibrary) {
  EXPECT_NE(read("pyproject.toml").find("\ndynamic = [\"version\"]\n"), std::string::npos);
  EXPECT_NE(read("CHANGELOG.md").find("\n## " LAGROID_VERSION), std::string::npos);
}

TEST(InstallPage, TheFilesItNamesExist) {
  const auto names = matches(prose_of(read("docs/install.md")), "`((?:app|bench|core|docs|tests)/[^` ]+)`");
  EXPECT_GT(names.size(), 3U);
  for (const auto& name : names) EXPECT_TRUE(exists(root / name)) << name;
}

TEST(BrokenPage, AFailureOfAnotherLawIsFoundOut) {
  const std::vector<std::string> unfounded{"units", "BrokenGroupoid.WrongInverse"};
  EXPECT_EQ(unfounded_failures("\"units\"\n- Fails: `BrokenGroupoid.WrongInverse`.\n\n"
                               "\"units\", fails: `BrokenGroupoid.WrongUnit`"),
            unfounded);
}

TEST(BrokenPage, ANameOfNothingIsFoundOut) {
  const std::vector<std::string> names{"core/nothing.hpp", "Nothing.IsTested", "nothing_at_all", "no law"};
  EXPECT_EQ(unknown_names("`core/nothing.hpp` `Nothing.IsTested` `nothing_at_all` \"no law\""), names);
}

}  // namespace
