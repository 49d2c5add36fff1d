#pragma once
/// The laws of scenes of Poisson systems: of the bracket, and of the step beside where the scene starts.
///
///     const PoissonFamilyLaws laws(library_brackets());
///
/// Requires a family that outlives it. Errors: as FamilyLaws.

#include "../../poisson/poisson_family.hpp"
#include "../family_laws.hpp"

namespace lagroid::app {

class PoissonFamilyLaws final : public FamilyLaws {
 public:
  explicit PoissonFamilyLaws(const PoissonFamily& family) : family_(family) {}
  const SceneFamily& family() const override { return family_; }
  Certificate certify(const Section& scene, const CheckCommandOptions& options) const override;

 private:
  const PoissonFamily& family_;
};

}  // namespace lagroid::app
