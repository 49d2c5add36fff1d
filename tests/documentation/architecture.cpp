// The folders of the sources: which include which, how many files and lines they have, what is named in them.
#include "pages.hpp"

#include <lagroid/solvers/extrapolation/extrapolation_table.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/rotations/moser_veselov_method.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace lagroid::documentation_tests::architecture_tests {
namespace {

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

/// Types and concepts at namespace scope in the headers of these folders, and the namespaces that have each. What is
/// in a namespace `detail` is not public.
std::map<std::string, std::set<std::string>> public_types(const std::vector<std::string>& tops) {
  const std::regex opens("(?:inline )?namespace ?([\\w:]*) ?\\{");
  const std::regex declares(
      "(?:template <.*> )?(?:struct|class|enum class|enum|using|concept) (?:alignas\\(.*?\\) )?(\\w+)"
      "(?: final)?(?: :.*| =.*| \\{.*)?");
  std::map<std::string, std::set<std::string>> out;
  for (const auto& top : tops)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
      if (entry.path().extension() != ".hpp") continue;
      std::vector<std::string> namespaces;
      std::istringstream lines(read(entry.path()));
      for (std::string line; std::getline(lines, line);) {
        std::smatch found;
        if (line.starts_with("}  // namespace")) {
          namespaces.pop_back();
        } else if (line.empty() || line.front() == ' ' || line.front() == '/') {
          continue;
        } else if (std::regex_match(line, found, opens)) {
          namespaces.push_back(found[1]);
        } else if (std::regex_match(line, found, declares)) {
          std::string path;
          for (const auto& each : namespaces) path += "::" + each;
          if (path.find("detail") == std::string::npos && !path.ends_with("::")) out[found[1]].insert(path);
        }
      }
    }
  return out;
}

TEST(Names, OfPublicTypesAreNotTwo) {
  const std::map<std::string, std::string> allowed{
      {"Model", "the field's word for bodies that move together, and for what is learned"},
      {"Vector", "a vector in both: of a size that its type has, and of one known at run time"}};
  const auto types = public_types(layers);
  EXPECT_GT(types.size(), 400U);
  std::vector<std::string> twice;
  for (const auto& [name, namespaces] : types)
    if (namespaces.size() > 1) twice.push_back(name);
  std::vector<std::string> excused;
  for (const auto& [name, reason] : allowed) excused.push_back(name);
  EXPECT_EQ(twice, excused);
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

/// Sources of more lines than a reader follows in one go.
std::vector<std::string> long_files(const std::vector<std::string>& tops, long most) {
  std::vector<std::string> out;
  for (const auto& top : tops)
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".hpp" && ending != ".cpp" && ending != ".py" && ending != ".js") continue;
      const std::string text = read(entry.path());
      if (std::count(text.begin(), text.end(), '\n') > most)
        out.push_back(entry.path().lexically_relative(root).string());
    }
  return out;
}

TEST(Rooms, AreNotCrowded) {
  EXPECT_EQ(
      crowded_folders({"core", "groupoids", "solvers", "systems", "run", "app", "web", "tests", "bench", "python"}),
      none);
}

TEST(Rooms, FilesAreNotLong) {
  const std::vector<std::string> tops{"core",  "groupoids", "solvers", "systems",  "run",  "app", "tests",
                                      "bench", "python",    "compat",  "examples", "docs", "web"};
  EXPECT_EQ(long_files(tops, 500), none);
  EXPECT_FALSE(long_files({"systems/multibody/solver"}, 400).empty());
}

/// Everything that runs is one of these; a second way would be another class here.
TEST(Architecture, OneClassForEveryKindOfMotion) {
  const std::string sources = text_of({"core", "groupoids", "solvers", "systems", "run", "app", "python"}, ".hpp") +
                              text_of({"core", "groupoids", "solvers", "systems", "run", "app", "python"}, ".cpp");
  const auto sorted = [](std::vector<std::string> names) {
    std::sort(names.begin(), names.end());
    return names;
  };
  EXPECT_EQ(
      sorted(matches(sources, "class (\\w+) (?:final )?: public Motion\\b")),
      (std::vector<std::string>{"BodiesMotion", "FormulaMotion", "PoissonMotion", "SphereMotion", "SystemMotion"}));
  EXPECT_EQ(sorted(matches(sources, "class (\\w+) (?:final )?: public Observables\\b")),
            (std::vector<std::string>{"FormulaNode", "PoissonNode", "SceneNode", "SphereNode", "SystemNode"}));
}

TEST(BrokenArchitecture, AnUpwardIncludeIsFoundOut) {
  EXPECT_EQ(upward_includes("core", "#include <lagroid/run/run.hpp>\n"), std::vector<std::string>{"core -> run"});
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
  ask(lagroid::extrapolation_method.name);
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

}  // namespace
}  // namespace lagroid::documentation_tests::architecture_tests
