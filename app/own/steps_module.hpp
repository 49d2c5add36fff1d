#pragma once
/// Systems of a program that is compiled in seconds: equal steps of the discrete Lagrangian, F-(g, lambda) = mu, by
/// Newton's iteration.
///
/// A first run of a new system need not wait a minute for methods that it does not use.
///
///     const StepsModule<Dido> module("dido", "Dido's problem", nullptr);  // without words of its own
///     const RunResult result = module.run(scene, context);
///
/// Errors: NeedsAllMethods where the scene names another method or a boundary value; SceneError where it has a mistake.

#include "../scenes/system_scene.hpp"
#include "own_parts.hpp"

#include <lagroid/run/run.hpp>

#include <memory>
#include <string>
#include <utility>

namespace lagroid::app {

/// Where a program with all methods runs the scene too, both give the same bits.
template <DiscreteSystem Sys> class StepsModule final : public SystemModule {
 public:
  StepsModule(std::string name, std::string summary, Dress<Sys> dress)
      : SystemModule(std::move(name), std::move(summary)), dress_(dress) {}

  bool nonholonomic() const override { return Nonholonomic<Sys>; }
  std::span<const DeclaredMethod> own_methods() const override { return {}; }
  ListedSystem listed() const override { return listed_system<Sys>(name(), summary()); }
  SystemKeys keys() const override { return with_declarations<Sys>(keys_of<Sys>(name(), dress_)); }
  MotionScene read(const Section&, const RunContext&) const override { throw NeedsAllMethods{}; }
  RunResult run(const Section& scene, const RunContext& context) const override {
    if (scene.has("boundary") || scene.has(reduce_word)) throw NeedsAllMethods{};
    const Sys system = read_system<Sys>(scene);
    const Presentation<Sys> presentation = dressed(system, name(), dress_);
    const InitialValue<Sys> initial = read_initial(system, scene, presentation.momentum);
    const IntegratorChoice choice = read_integrator(scene, capabilities_of(system));
    const RunExtent extent = read_extent(scene, context);
    if (!by_newton_steps(choice) || choice.options.composition.stages() > 1) throw NeedsAllMethods{};
    scene.finish();
    auto integrator = std::make_unique<lagroid::detail::IntegratorOf<Sys, FixedStepIntegrator<Sys>>>(
        system, initial.state, initial.configuration, std::make_unique<NewtonStep<Sys>>());
    SystemMotion<Sys> motion(system, presentation, watched(system, choice.options), std::move(integrator),
                             choice.options);
    RunResult result;
    drive(motion, extent, context, result);
    return result;
  }

 private:
  Dress<Sys> dress_;
};

}  // namespace lagroid::app
