#pragma once
/// The laws of each kind of scenes. (They are apart from the families themselves because they take long to compile:
/// every program has families, lagroid-check alone has laws.)
///
///     const Certificate found = laws_of(scene).certify(scene, options);
///
/// Errors: SceneError for a scene of which there are no laws.

#include "../families/family.hpp"
#include "check_options.hpp"

#include <lagroid/run/ledger/certificate.hpp>

#include <functional>
#include <utility>
#include <vector>

namespace lagroid::app {

/// Tests the laws of the system of a module, along the run of a scene.
using AskLaws =
    std::function<Certificate(const SystemModule& module, const Section& scene, const CheckCommandOptions& options)>;

class FamilyLaws {
 public:
  virtual ~FamilyLaws() = default;
  virtual const SceneFamily& family() const = 0;
  virtual Certificate certify(const Section& scene, const CheckCommandOptions& options) const = 0;
};

/// Those of systems, along the runs of their scenes, given a function that tests the system of a module.
class LawsOfSystems final : public FamilyLaws {
 public:
  explicit LawsOfSystems(AskLaws ask) : ask_(std::move(ask)) {}
  const SceneFamily& family() const override { return systems_family(); }
  Certificate certify(const Section& scene, const CheckCommandOptions& options) const override {
    return ask_(module_of_scene(scene), scene, options);
  }

 private:
  AskLaws ask_;
};

/// Sets which laws this program has, at its start.
void use_laws(std::vector<const FamilyLaws*> laws);
/// Those of the family that the scene is of. Throws SceneError where there are none.
const FamilyLaws& laws_of(const Section& scene);

/// Of the systems of the library.
const FamilyLaws& systems_laws();
/// Of the method of a scene on (T*S^2)^k, beside where it starts.
const FamilyLaws& spheres_laws();
/// Of the bracket and the step of a scene of a Poisson system, beside where it starts.
const FamilyLaws& poisson_laws();
/// Of the step of a scene that holds its formulas, beside where it starts.
const FamilyLaws& formula_laws();
/// Of the step of a scene of bodies, where it starts.
const FamilyLaws& bodies_laws();
/// Of an optimal control problem and of its solution.
const FamilyLaws& control_laws();

}  // namespace lagroid::app
