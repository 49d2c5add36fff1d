#pragma once
/// Events of scenes through the program: an example with tables after its own, and what its summary tells.

#include "scenes.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <string>

namespace lagroid::scene_tests {

using Json = nlohmann::json;

class Events : public Scenes {
 protected:
  /// The example, with tables after its own.
  std::string with(const std::string& name, const std::string& tables) const {
    return write(contents(example(name)) + "\n" + tables).string();
  }
  static Json summary(const fs::path& run) { return Json::parse(contents(run / "summary.json")); }
  /// What a column of the state was where something happened, for the row-th time in the run.
  static double at_event(const fs::path& run, std::size_t row, const std::string& column) {
    const Json events = summary(run).at("events");
    const Json& columns = events.at("columns");
    const auto place = std::find(columns.begin(), columns.end(), column) - columns.begin();
    return events.at("rows").at(row).at("values").at(std::size_t(place)).get<double>();
  }
  /// The run of these arguments has the same bits as one that is broken off after `some` of its steps and taken up.
  void expect_resumable(const std::string& arguments, long some, long all) const {
    const fs::path whole = folder_ / "in one go", parts = folder_ / "in parts";
    const auto quoted = [](const fs::path& path) { return " --out '" + path.string() + "'"; };
    ASSERT_EQ(run(fmt::format("{} --set time.steps={}{}", arguments, all, quoted(whole))).code, 0);
    ASSERT_EQ(run(fmt::format("{} --set time.steps={}{}", arguments, some, quoted(parts))).code, 0);
    const Outcome on = run(fmt::format("resume '{}' --set time.steps={} --json", parts.string(), all));
    ASSERT_EQ(on.code, 0) << on.err;
    expect_the_same_bits(whole, parts, on.out);
    EXPECT_EQ(contents(whole / "events.csv"), contents(parts / "events.csv"));
  }
};

}  // namespace lagroid::scene_tests
