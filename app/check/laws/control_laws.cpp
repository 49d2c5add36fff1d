#include "../family_laws.hpp"

#include "../../control/control_problem.hpp"

namespace lagroid::app {

namespace {

class ControlLaws final : public FamilyLaws {
 public:
  const SceneFamily& family() const override { return control_family(); }
  Certificate certify(const Section& scene, const CheckCommandOptions& options) const override {
    return control_problem(scene).certify(scene, options.samples, std::uint64_t(options.seed));
  }
};

}  // namespace

const FamilyLaws& control_laws() {
  static const ControlLaws laws;
  return laws;
}

}  // namespace lagroid::app
