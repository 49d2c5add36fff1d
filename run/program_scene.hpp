#pragma once
/// What stands in the place of a scene where a program of one's own runs its system.

#include <span>
#include <string>
#include <string_view>

namespace lagroid {

/// What has to be the same for such a run to be taken up, as text. Throws std::invalid_argument where the name is not
/// one line of text.
std::string scene_of_program(const std::string& name, const std::string& method, double step,
                             std::span<const double> object, std::span<const double> momentum,
                             std::span<const double> configuration);

/// Whether the text is one of these, and no scene.
bool is_of_a_program(std::string_view text);

}  // namespace lagroid
