#include "own_parts.hpp"

#include "../command/command.hpp"
#include "../poisson/poisson_family.hpp"
#include "../poisson/poisson_node.hpp"
#include "../program.hpp"
#include "../sweep/sweep.hpp"

#include <fmt/format.h>
#include <boost/core/demangle.hpp>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <utility>

namespace lagroid::app {

std::string refusal_of(const OwnSystems& systems) {
  std::set<std::string> names;
  const auto add = [&](const std::string& name) { return names.insert(name).second; };
  for (const SystemModule* each : systems.systems)
    if (!add(each->name()))
      return fmt::format("two systems of this program are called {}; give one another name", each->name());
  for (const PoissonEntry* each : systems.brackets) {
    if (!add(each->name))
      return fmt::format("two systems of this program are called {}; give one another name", each->name);
    std::set<std::string> columns{"t", "energy", "defect"};
    for (std::size_t i = 0; i < each->casimirs.size(); ++i) columns.insert(casimir_column(i));
    for (const std::string& label : each->labels)
      if (!columns.insert(label).second)
        return fmt::format("{}: two columns would be called {}; change its labels()", each->name, label);
  }
  return {};
}

int own_program(int argc, char** argv, OwnSystems systems) {
  if (const std::string why = refusal_of(systems); !why.empty())
    return refuse(asks_for_json(argc, argv), exit_internal_error, "invalid_program", why);
  const PoissonFamily brackets(systems.brackets);
  return program(argc, argv,
                 {{&systems_family(), &brackets, &sweeps_family()}, std::move(systems.systems), {sweep_command()}});
}

int ask_for_all_methods() {
  if (const char* file = std::getenv(where_to_ask)) std::ofstream(file) << "all methods\n";
  return exit_internal_error;
}

std::string snake_case(const std::type_info& type) {
  std::string name = boost::core::demangle(type.name());
  name.resize(std::min(name.find('<'), name.size()));
  if (const auto colons = name.rfind("::"); colons != std::string::npos) name.erase(0, colons + 2);
  const auto letter = [&](std::size_t i, int (*is)(int)) {
    return i < name.size() && is(static_cast<unsigned char>(name[i])) != 0;
  };
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    // A capital begins a word, but within a row of them only the last that a small letter follows: SE2Body, se2_body.
    const bool begins =
        i > 0 && letter(i, std::isupper) && (!letter(i - 1, std::isupper) || letter(i + 1, std::islower));
    if (begins && out.back() != '_') out += '_';
    out += char(std::tolower(static_cast<unsigned char>(name[i])));
  }
  return out;
}

}  // namespace lagroid::app
