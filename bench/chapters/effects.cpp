// What an effect costs where it is, and where it is not: instructions, counted by callgrind.
#include "../report/callgrind.hpp"
#include "../report/comparison.hpp"

#include <fmt/format.h>

#include <sstream>
#include <string>

namespace bench {

std::string effects_table() {
  const std::string folder = LAGROID_BUILD "/bench/";
  const Counted bare = counted(folder + "lagroid_effects_bare", "");
  std::string out =
      "| effect in the scene | instructions a step | over a program that knows no effect | memory, B | over its |\n"
      "|---|---|---|---|---|\n";
  const auto memory = [](const Counted& c) { return number_after(c.printed, "memory "); };
  const auto row = [&](const std::string& name, const Counted& c) {
    out += fmt::format("| {} | {:.0f} | {:.3f} | {:.0f} | {:.3f} |\n", name, c.instructions,
                       c.instructions / bare.instructions, memory(c), memory(c) / memory(bare));
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
