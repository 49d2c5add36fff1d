// What a run costs beside its steps: nodes recorded, quantities judged.
#include "../report/comparison.hpp"

#include <families/family.hpp>
#include <reading/scene_reader.hpp>
#include <systems/library_systems.hpp>

#include <lagroid/run/motion/drive.hpp>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace bench {

using namespace lagroid;

namespace {

constexpr const char* steps_alone = "steps alone";
constexpr const char* in_a_run = "in a run, judged";
constexpr const char* recorded = "in a run, recorded and judged";
constexpr long steps_of_a_run = 8192;  // what reading the scene takes is lost among them

app::MotionScene motion_of(const std::string& file) {
  const app::Section scene = app::read_scene(LAGROID_SOURCE "/examples/" + file, {});
  return app::motions_of(scene).read(scene, {});
}

void add(std::vector<Subject>& out, const char* group, const std::string& file) {
  struct Late {  // read when it is first measured
    std::unique_ptr<Motion> motion;
  };
  const auto late = std::make_shared<Late>();
  out.push_back({group, steps_alone,
                 [=](benchmark::State& state) {
                   if (!late->motion) late->motion = motion_of(file).motion;
                   bool good = true;
                   timed(state, [&](long steps) {
                     for (long k = 0; k < steps && good; ++k) good = late->motion->advance().converged();
                   });
                   if (!good) state.SkipWithError("a step failed");
                 },
                 /*reference=*/true});
  for (const bool record : {false, true})
    out.push_back({group, record ? recorded : in_a_run, [=](benchmark::State& state) {
                     bool good = true;
                     const auto run = [&](long steps) {
                       const app::MotionScene scene = motion_of(file);
                       RunContext context;
                       context.record = record;
                       RunResult result;
                       drive(*scene.motion, {steps, 1, 0, {}}, context, result);
                       good = good && result.converged();
                     };
                     timed(state, run, steps_of_a_run);
                     if (!good) state.SkipWithError("a run failed");
                   }});
}

}  // namespace

std::vector<Subject> recorded_subjects() {
  app::use_families({&app::systems_family(), &app::spheres_family(), &app::bodies_family()});
  app::use_systems(app::library_systems());
  std::vector<Subject> out;
  add(out, "pendulum, a step of a run", "pendulum.toml");
  add(out, "rigid body, a step of a run", "rigid_body.toml");
  add(out, "chain of 20 links, a step of a run", "chain_drop.toml");
  return out;
}

}  // namespace bench
