// What an effect costs where it is, and where it is not: instructions, counted by callgrind.
#include "../report/comparison.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <sstream>
#include <stdexcept>

namespace bench {

namespace {

std::string output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start: " + command);
  std::string out;
  std::array<char, 4096> buffer{};
  while (const auto n = std::fread(buffer.data(), 1, buffer.size(), pipe)) out.append(buffer.data(), n);
  if (pclose(pipe) != 0) throw std::runtime_error("failed: " + command);
  return out;
}

double number_after(const std::string& text, const std::string& words) {
  const auto at = text.find(words);
  if (at == std::string::npos) throw std::runtime_error("no \"" + words + "\" in: " + text);
  return std::stod(text.substr(at + words.size()));
}

struct Counted {
  double instructions = 0;  ///< a step
  double memory = 0;        ///< B
};

/// Of `program STEPS arguments`: the steps themselves, without building the scene.
Counted counted(const std::string& program, const std::string& arguments) {
  const auto run = [&](int steps) {
    return output_of(fmt::format("valgrind --tool=callgrind --callgrind-out-file=/dev/null {} {} {} 2>&1", program,
                                 steps, arguments));
  };
  constexpr int few = 100;
  constexpr int many = 1100;
  const std::string long_run = run(many);
  const double difference = number_after(long_run, "Collected :") - number_after(run(few), "Collected :");
  return {difference / (many - few), number_after(long_run, "memory ")};
}

}  // namespace

std::string effects_table() {
  const std::string folder = LAGROID_BUILD "/bench/";
  const Counted bare = counted(folder + "lagroid_effects_bare", "");
  std::string out =
      "| effect in the scene | instructions a step | over a program that knows no effect | memory, B | over its |\n"
      "|---|---|---|---|---|\n";
  const auto row = [&](const std::string& name, const Counted& c) {
    out += fmt::format("| {} | {:.0f} | {:.3f} | {:.0f} | {:.3f} |\n", name, c.instructions,
                       c.instructions / bare.instructions, c.memory, c.memory / bare.memory);
  };
  row("(a program that knows none)", bare);
  std::istringstream names(output_of(folder + "lagroid_effects_full list"));
  const Counted none = counted(folder + "lagroid_effects_full", "none");
  row("none, of all that it knows", none);
  for (std::string name; std::getline(names, name);)
    if (name != "none") row(name, counted(folder + "lagroid_effects_full", fmt::format("'{}'", name)));
  return out;
}

}  // namespace bench
