// What a step of a reduced system takes beside one of the system as a person reduces it: instructions.
#include "../report/callgrind.hpp"
#include "../report/comparison.hpp"

#include <fmt/format.h>

#include <sstream>
#include <string>

namespace bench {

namespace {

constexpr const char* by_hand = "by hand";
constexpr const char* reduced = "reduced";

}  // namespace

std::vector<std::string> reduction_groups() {
  std::vector<std::string> out;
  std::istringstream subjects(output_of(LAGROID_BUILD "/bench/lagroid_reduction list"));
  for (std::string subject; std::getline(subjects, subject);)
    if (subject.ends_with(key_of("", by_hand))) out.push_back(subject.substr(0, subject.rfind(": ")));
  return out;
}

Results reduction_counts(const std::vector<std::string>& groups) {
  Results out;
  for (const auto& group : groups)
    for (const auto& name : {by_hand, reduced}) {
      const std::string key = key_of(group, name);
      const double count = counted(LAGROID_BUILD "/bench/lagroid_reduction", fmt::format("'{}'", key)).instructions;
      out[key] = {.median = count, .instructions = count};
    }
  return out;
}

std::vector<Goal> reduction_goals(const std::vector<std::string>& groups) {
  std::vector<Goal> out;
  for (const auto& group : groups) out.push_back({group, reduced, by_hand, 1.1});
  return out;
}

std::string reduction_table(const std::vector<std::string>& groups, const Results& counts) {
  std::string out = "| instructions a step | by hand | reduced | ratio |\n|---|---|---|---|\n";
  for (const auto& group : groups) {
    const double theirs = counts.at(key_of(group, by_hand)).instructions;
    const double ours = counts.at(key_of(group, reduced)).instructions;
    out += fmt::format("| {} | {:.0f} | {:.0f} | {:.3f} |\n", group, theirs, ours, ours / theirs);
  }
  return out;
}

}  // namespace bench
