#pragma once
/// What tests of `lagroid learn` have in common: data, and what a training says.

#include "../command_line.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <string>

class Learn : public CommandLine {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return path(name);
  }
  std::string drawn(const std::string& name, const std::string& options = "") const {
    const Outcome r =
        run("trajectories " + (options.find("--count") == std::string::npos ? std::string("--count 60 ") : "") +
            options + " --out " + path(name));
    EXPECT_EQ(r.code, 0) << r.err;
    return path(name);
  }
  nlohmann::json summary(const std::string& arguments) const {
    const Outcome r = run(arguments + " --json");
    EXPECT_EQ(r.code, 0) << arguments << r.err << r.out;
    return nlohmann::json::parse(r.out);
  }
  static std::string read(const std::string& name) {
    std::ifstream in(name);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};
