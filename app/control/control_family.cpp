#include "../families/family.hpp"
#include "../reading/kinds.hpp"
#include "control_problem.hpp"

namespace lagroid::app {

namespace {

class OptimalControl final : public SceneFamily {
 public:
  std::string_view key() const override { return keys::control; }
  std::string_view command() const override { return "control"; }
  std::vector<Use> uses(const Section&) const override {
    return {{&reference("marrero2015"), "optimal control as discrete mechanics on Lie groupoids"}};
  }
  std::vector<SceneKeys> keys_of_scenes() const override { return {{"optimal control", control_table()}}; }
};

}  // namespace

const SceneFamily& control_family() {
  static const OptimalControl family;
  return family;
}

}  // namespace lagroid::app
