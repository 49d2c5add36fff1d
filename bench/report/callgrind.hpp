#pragma once
/// Instructions, counted by callgrind: they repeat exactly. Needs valgrind.

#include <string>

namespace bench {

/// What a command prints. Throws std::runtime_error where it fails.
std::string output_of(const std::string& command);

/// The number that follows these words in a text. Throws std::runtime_error where they are not there.
double number_after(const std::string& text, const std::string& words);

/// Of `program STEPS arguments`: what one step takes, without what comes before the first, and what the longer run
/// printed.
struct Counted {
  double instructions = 0;
  std::string printed;
};
Counted counted(const std::string& program, const std::string& arguments);

}  // namespace bench
