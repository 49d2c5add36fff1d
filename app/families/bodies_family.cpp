#include "../reading/kinds.hpp"
#include "family.hpp"

#include "../bodies/scene_bodies.hpp"
#include "../bodies/scene_run.hpp"
#include "../scenes/simulation.hpp"

namespace lagroid::app {

namespace {

class Bodies final : public SceneFamily {
 public:
  std::string_view key() const override { return keys::bodies; }
  MotionScene read(const Section& scene, const RunContext& context) const override {
    return read_bodies(scene, context);
  }
  std::vector<Use> uses(const Section& scene) const override {
    std::vector<Use> uses{{&reference("marrero2015"), "discrete constrained mechanics on Lie groupoids"}};
    const Section time = scene.section_or_empty("time");
    const IntegrationMethod& method = read_bodies_method(time);
    add_use(method.source, uses);
    if (method.composed()) add_use(source_of(read_composition(time, compositions::all)), uses);
    if (read_scene_bodies(scene).nonholonomic)
      uses.push_back({&reference("iglesias2008"), "nonholonomic constraints on Lie groupoids"});
    return uses;
  }
  std::vector<SceneKeys> keys_of_scenes() const override { return {{"bodies", scene_of_bodies_table()}}; }
};

}  // namespace

const SceneFamily& bodies_family() {
  static const Bodies family;
  return family;
}

}  // namespace lagroid::app
