#include "callgrind.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <stdexcept>

namespace bench {

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

Counted counted(const std::string& program, const std::string& arguments) {
  const auto run = [&](int steps) {
    return output_of(fmt::format("valgrind --tool=callgrind --callgrind-out-file=/dev/null {} {} {} 2>&1", program,
                                 steps, arguments));
  };
  constexpr int few = 100;
  constexpr int many = 1100;
  const std::string long_run = run(many);
  const double difference = number_after(long_run, "Collected :") - number_after(run(few), "Collected :");
  return {difference / (many - few), long_run};
}

}  // namespace bench
