#include "own_parts.hpp"

#include "../program.hpp"
#include "../sweep/sweep.hpp"

#include <boost/core/demangle.hpp>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace lagroid::app {

int own_program(int argc, char** argv, std::vector<const SystemModule*> systems) {
  return program(argc, argv, {{&systems_family(), &sweeps_family()}, std::move(systems), {sweep_command()}});
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
