// The pages on methods name those that are declared.
#include "pages.hpp"

#include <lagroid/solvers/extrapolation/extrapolation_table.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/rotations/moser_veselov_method.hpp>

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid::documentation_tests::methods_tests {
namespace {

using Words = std::set<std::string>;

Words words(const std::vector<std::string>& list) { return {list.begin(), list.end()}; }

/// The words that may stand at a key of [time] or [solver] of an initial value, in `backquotes` in the page's table.
Words words_of_key(const std::string& page, const std::string& table, const std::string& key) {
  const auto keys = page.find("<!-- keys of kepler with initial: " + table + " -->");
  const auto start = page.find("\n| `" + key + "` |", keys);
  if (keys == std::string::npos || start > page.find("<!-- end of keys -->", keys))
    throw std::runtime_error("no key " + table + "." + key);
  std::istringstream cells(page.substr(start + 1, page.find('\n', start + 1) - start - 1));
  std::string cell;
  for (int i = 0; i <= 2; ++i) std::getline(cells, cell, '|');
  return words(matches(cell, "`([^`]+)`"));
}

/// What docs/scenes.md offers.
std::map<std::string, Words> methods_of(const std::string& scenes) {
  Words compositions = words_of_key(scenes, "time", "composition");
  compositions.erase("single");  // what is not composed
  Words methods = words_of_key(scenes, "time", "method");
  methods.merge(words(matches(scenes, "a rigid_body has `([^`]+)` besides")));
  return {{"mode", words_of_key(scenes, "time", "mode")},
          {"method", methods},
          {"without_root", words_of_key(scenes, "time", "without_root")},
          {"composition", compositions},
          {"solver", words_of_key(scenes, "solver", "method")}};
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
  wanted.emplace(lagroid::extrapolation_method.name);
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

}  // namespace
}  // namespace lagroid::documentation_tests::methods_tests
