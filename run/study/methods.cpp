#include <lagroid/run/study/methods.hpp>

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <sstream>

namespace lagroid {

std::string time_keys(const Method& method, const std::string& grid) {
  std::string out = grid;
  for (const std::string& setting : method.settings) {
    const auto equals = setting.find('=');
    const std::string key = setting.substr(setting.find('.') + 1, equals - setting.find('.') - 1);
    const std::string value = setting.substr(equals + 1);
    const bool number = value.find_first_of("0123456789") == 0;
    out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", key, number ? value : '"' + value + '"');
  }
  return out;
}

std::vector<Method> matching(const std::string& patterns, const std::vector<Method>& all) {
  if (patterns.empty()) return all;
  std::vector<Method> out;
  std::istringstream list(patterns);
  for (std::string pattern; std::getline(list, pattern, ',');) {
    bool known = false;
    for (const Method& method : all) {
      if (fnmatch(pattern.c_str(), method.name.c_str(), 0) != 0) continue;
      known = true;
      if (std::none_of(out.begin(), out.end(), [&](const Method& m) { return m.name == method.name; }))
        out.push_back(method);
    }
    if (known) continue;
    std::string names;
    for (const Method& m : all) names += (names.empty() ? "" : ", ") + m.name;
    throw UnknownMethod(fmt::format("no method \"{}\" for this scene; there are: {}", pattern, names));
  }
  return out;
}

}  // namespace lagroid
