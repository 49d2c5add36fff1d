#pragma once
/// What stands in the place of a scene where a program of one's own runs its system: name, method, step, start, and
/// numbers that identify the system. A run is resumed only where it is the same.

#include <lagroid/run/motion/motion.hpp>

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

/// Refuses a name (that of `option`) which is not one line of text, and a start (of `what`, as "a run") of which a
/// number is not finite: throws std::invalid_argument.
void require_name_and_start(std::string_view option, std::string_view name, std::string_view what,
                            std::span<const NamedVector> start);

/// It as text. Throws std::invalid_argument where the name is not one line of text, or the start no numbers.
std::string scene_of_program(const ProgramRun& run);

/// Whether the text is one of these, and no scene.
bool is_of_a_program(std::string_view text);

}  // namespace lagroid
