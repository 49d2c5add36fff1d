#include "../families/family.hpp"
#include "../reading/its_scene.hpp"
#include "../reading/kinds.hpp"
#include "sweep_scene.hpp"

namespace lagroid::app {

namespace {

class Sweeps final : public SceneFamily {
 public:
  std::string_view key() const override { return keys::sweep; }
  std::string_view command() const override { return "sweep"; }
  /// What each of its members rests on.
  std::vector<Use> uses(const Section& sweep) const override {
    const Section scene = read_its_scene(sweep);
    return family_of(scene).uses(scene);
  }
  std::vector<SceneKeys> keys_of_scenes() const override { return {{"sweep", sweep_table()}}; }
};

}  // namespace

const SceneFamily& sweeps_family() {
  static const Sweeps family;
  return family;
}

}  // namespace lagroid::app
