// Every mistake in a scene is one line with file, line, key and remedy.
#include <reading/scene_reader.hpp>
#include <study/run_scene.hpp>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include <unistd.h>

using namespace lagroid;
using namespace lagroid::app;

namespace app_scene_reader_tests {
namespace {

class Scene : public ::testing::Test {
 protected:
  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("lagroid_scene_" + std::to_string(::getpid()) + ".toml");
  void TearDown() override { std::filesystem::remove(file_); }

  std::string error(const std::string& text, const std::vector<std::string>& overrides = {}) {
    std::ofstream(file_) << text;
    try {
      run_scene(read_scene(file_, overrides), {});
    } catch (const SceneError& e) {
      std::string message = e.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message;
    }
    return "";
  }
  void expect(const std::string& text, const std::vector<std::string>& parts,
              const std::vector<std::string>& overrides = {}) {
    const std::string message = error(text, overrides);
    for (const auto& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << "\n  in: " << message;
  }
};

const std::string valid = R"(system = "plate_ball"
[parameters]
radius = 1.0
plate_rate = 0.0
spin = 0.4
rotation = "trace"
[time]
step = 0.05
steps = 10
[initial]
position = [0.3, -0.2]
attitude = [1, 0, 0, 0]
momentum = [0.9, 0.2, 0.6, -0.4, 0.8]
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = valid;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST_F(Scene, TheValidOneIsValid) { EXPECT_EQ(error(valid), ""); }

TEST_F(Scene, Mistakes) {
  expect(with("radius", "raduis"), {".toml:3", "parameters.raduis", "unknown key", "\"radius\""});
  expect(with("plate_ball", "plate_bal"), {".toml:1", "system", "plate_bal", "did you mean \"plate_ball\""});
  expect(with("system = \"plate_ball\"", "# none"), {"missing key \"system\""});
  expect(with("system =", "sytem ="), {".toml:1", "sytem", "unknown key; did you mean \"system\""});
  expect(with("momentum =", "momenta ="), {".toml:13", "initial.momenta", "did you mean \"momentum\""});
  expect(with("radius = 1.0", "radius = 1.0\n\"a\\nb\" = 3"), {"control character"});
  expect(with("step = 0.05", "step = -0.05"), {".toml:8", "time.step", "positive", "-0.05"});
  expect(with("step = 0.05", "step = 0"), {"time.step", "positive"});
  expect(with("step = 0.05", "step = nan"), {"time.step", "finite"});
  expect(with("step = 0.05", "step = \"small\""), {"time.step", "expected a number", "a string"});
  expect(with("steps = 10", "steps = 0"), {"time.steps", "from 1"});
  expect(with("steps = 10", "steps = 10.5"), {"time.steps", "whole number"});
  expect(with("steps = 10", ""), {"time", "missing key \"steps\""});
  expect(with("steps = 10", "steps = 10\nduration = 1"), {"time.duration", "not both"});
  expect(with("[0.3, -0.2]", "[0.3]"), {".toml:11", "initial.position", "expected 2 numbers", "got 1"});
  expect(with("[0.3, -0.2]", "[0.3, inf]"), {"initial.position", "finite"});
  expect(with("[0.3, -0.2]", "0.3"), {"initial.position", "array of 2 numbers"});
  expect(with("[1, 0, 0, 0]", "[1, 1, 0, 0]"), {"initial.attitude", "not a unit quaternion", "0.7071067812"});
  expect(with("[1, 0, 0, 0]", "[0, 0, 0, 0]"), {"initial.attitude", "norm 0"});
  expect(with("[1, 0, 0, 0]", "[1, 0]"), {"initial.attitude", "four or three numbers"});
  expect(with("-0.4, 0.8]", "-0.4]"), {"initial.momentum", "px, py, M1, M2, M3"});
  expect(with("radius = 1.0", "radius = 0"), {"parameters.radius", "positive"});
  expect(with("rotation = \"trace\"", "rotation = \"cayly\""), {"parameters.rotation", "did you mean \"cayley\""});
  expect(with("spin = 0.4", "spin = 25"), {"time", "|spin * step| < 1", "1.25"});
  expect(with("[initial]", "[boundary]"), {"boundary"});
  expect(valid + "[boundary]\n", {"boundary", "not both"});
  expect(with("[initial]", "[elsewhere]"), {"missing table [initial]"});
  expect(valid + "[solver]\nmethod = \"newtn\"\n", {"solver.method", "did you mean \"newton\""});
  expect(valid + "[solver]\nstart = 3\n", {"solver.start", "unknown key", "\"starts\""});
  expect(valid + "[solver]\nstarts = 0\n", {"solver.starts", "from 1"});
  EXPECT_EQ(error(valid + "[solver]\nstarts = 3\nseed = 4\ntolerance = 1e-12\n"), "");
  expect(valid + "[outputs]\nevery = 3\n", {"outputs", "unknown key", "\"output\""});
  expect("system = ", {".toml:1", "not valid TOML"});
  expect("", {"missing key \"system\""});
}

TEST_F(Scene, MissingFile) {
  try {
    read_scene("/nonexistent/scene.toml", {});
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("/nonexistent/scene.toml: no such scene file"), std::string::npos);
  }
}

TEST_F(Scene, Overrides) {
  EXPECT_EQ(error(valid, {"time.steps=3", "parameters.rotation=exp", "initial.position=[1, 2]"}), "");
  expect(valid, {"--set time.step", "positive"}, {"time.step=-1"});
  expect(valid, {"--set initial", "initial.position", "expected 2 numbers"},
         {"initial={position=[1],momentum=[0,0,0,0,0]}"});
  expect(valid, {"--set parameters.raduis", "\"radius\""}, {"parameters.raduis=1"});
  expect(valid, {"--set steps", "key=value"}, {"steps"});
  expect(valid, {"--set system.x", "not a table"}, {"system.x=1"});
  for (const char* key : {"a.", ".a", "time..steps", "."})
    expect(valid, {std::string("--set ") + key + ": no key"}, {std::string(key) + "=1"});
  expect("[[body]]\nkind = 'point'\n", {"--set body.00.mass: \"00\" is no place"}, {"body.00.mass=1"});
}

TEST_F(Scene, OtherSystems) {
  expect("system = \"rigid_body\"\n[parameters]\ninertia = [1, 2, -3]\n", {":3", "parameters.inertia", "positive"});
  expect("system = \"kepler\"\n[initial]\nposition = [0, 0]\nmomentum = [0, 1]\n",
         {":3", "initial.position", "centre"});
  expect("system = \"spherical_pendulum\"\n[initial]\nposition = [1, 1, 0]\nmomentum = [0, 0, 1]\n",
         {":3", "initial.position", "0.7071067812"});
  expect("system = \"spherical_pendulum\"\n[initial]\nposition = [1, 0, 0]\nmomentum = [1, 0, 1]\n",
         {":4", "initial.momentum", "tangent"});
  expect("system = \"attitude_control\"\n[parameters]\nforbidden = [0, 0, 0]\n",
         {":3", "parameters.forbidden", "no direction"});
  expect("system = \"attitude_control\"\n[parameters]\nweights = [1, 0, 1]\n",
         {":3", "parameters.weights", "positive"});
  expect("system = \"pendulum\"\n[initial]\nposition = [1]\nmomentum = [0]\n", {"missing key \"time\"", "[time]"});
}

TEST_F(Scene, BoundaryMistakes) {
  const std::string boundary = R"(system = "plate_ball"
[time]
duration = 1.0
steps = 2
[boundary]
start = { position = [0, 0] }
end = { position = [1, 0.5], attitude = [0.6, -0.3, 0.9] }
)";
  expect(boundary, {":4", "time.steps", "at least 3 steps"});
  expect(boundary, {"--set time.steps", "at least 3 steps"}, {"time.steps=1"});
  std::string no_end = boundary;
  no_end.erase(no_end.find("end ="));
  const std::string far = R"(system = "unicycle"
[time]
duration = 1.0
steps = 20
[boundary]
start = { position = [0, 0, 0] }
end = { position = [1, 0.5, 0] }
)";
  expect(far, {":7", "boundary.end.position", "lies 1.11803 m from the start", "rolls 1 m"});
  expect(no_end, {"boundary", "missing key \"end\"", "[boundary.end]"});
}

}  // namespace
}  // namespace app_scene_reader_tests
