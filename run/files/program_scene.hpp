#pragma once
/// What stands in the place of a scene where a program of one's own runs its system: name, method, step, start, and
/// numbers that identify the system. A run is resumed only where it is the same.

#include <span>
#include <string>
#include <string_view>

namespace lagroid {

/// What has to be the same for such a run to be resumed. `marks` identify the system (system_marks.hpp).
struct ProgramRun {
  std::string name;
  std::string method;
  double step = 0;
  long every = 1;
  std::span<const double> marks;
  std::span<const double> object;
  std::span<const double> momentum;
  std::span<const double> configuration;
};

/// It as text. Throws std::invalid_argument where the name is not one line of text, or the start no numbers.
std::string scene_of_program(const ProgramRun& run);

/// Whether the text is one of these, and no scene.
bool is_of_a_program(std::string_view text);

}  // namespace lagroid
