// What callgrind counts: reduction STEPS SUBJECT; `reduction list` prints the subjects, a group and a name each.
#include "reduction.hpp"

#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

int main(int argc, char** argv) {
  constexpr std::pair<const char*, int (*)(long)> subjects[]{
      {"free body: by hand", reduction::body_by_hand},
      {"free body: reduced", reduction::body_reduced},
      {"satellite: by hand", reduction::satellite_by_hand},
      {"satellite: reduced", reduction::satellite_reduced},
      {"body of a satellite, its wheels at fixed momenta: by hand", reduction::satellite_level_by_hand},
      {"body of a satellite, its wheels at fixed momenta: reduced", reduction::satellite_level},
      {"body of a satellite, its Routhian given: by hand", reduction::satellite_level_by_hand},
      {"body of a satellite, its Routhian given: reduced", reduction::solved_satellite_level},
      {"distance of a planet, at fixed angular momentum: by hand", reduction::planet_level_by_hand},
      {"distance of a planet, at fixed angular momentum: reduced", reduction::planet_level},
      {"distance of a planet, its Routhian given: by hand", reduction::planet_level_by_hand},
      {"distance of a planet, its Routhian given: reduced", reduction::solved_planet_level},
  };
  for (const auto& [name, integrate] : subjects) {
    if (argc == 2 && std::string_view(argv[1]) == "list") std::printf("%s\n", name);
    if (argc == 3 && std::string_view(argv[2]) == name) return integrate(std::atol(argv[1]));
  }
  return argc == 2 ? 0 : 2;
}
