#include "family.hpp"

#include "../reading/simulation.hpp"
#include "registry.hpp"

#include <lagroid/solvers/boundary_words.hpp>

namespace lagroid::app {

namespace {

class Systems final : public SceneFamily {
 public:
  bool recognises(const Section& scene) const override { return scene.has("system"); }
  /// A boundary value too, and a first step that is found for an accuracy.
  RunResult run(const Section& scene, const RunContext& context) const override {
    return with_system_of(scene, [&](const auto& entry) { return entry.read(scene, context).run(nullptr); });
  }
  MotionScene read(const Section& scene, const RunContext& context) const override {
    return with_system_of(scene, [&](const auto& entry) {
      const auto task = entry.read(scene, context);
      if (!task.begin)
        scene.fail("boundary", "a study compares how initial values are marched: give a scene with [initial]");
      return MotionScene{task.begin(), read_pace(scene, context), task.methods};
    });
  }
  std::vector<Use> uses(const Section& scene) const override {
    return with_system_of(scene, [&]<class Sys>(const Entry<Sys>& entry) {
      std::vector<Use> uses{{&reference("marrero2015"), "discrete constrained mechanics on Lie groupoids"}};
      const Section time = scene.section_or_empty("time");
      const DeclaredMethod& method = read_declared_method(time, entry.own_methods);
      add_use(method.source, uses);
      if (const auto compositions = compositions_of(method.other_orders); !compositions.empty())
        add_use(source_of(read_composition(time, compositions)), uses);
      if (Sys::principle == Principle::nonholonomic)
        uses.push_back({&reference("iglesias2008"), "nonholonomic constraints on Lie groupoids"});
      const auto solvers = words_of(boundary_words);
      const std::string solver = scene.section_or_empty("solver").choice_or("method", solvers.front(), solvers);
      if (method.implicit && choice_of(boundary_words, solver) == BoundaryMethod::newton)
        uses.push_back({&reference("owren2000"), "Newton's iteration, carried from Lie groups to groupoids"});
      return uses;
    });
  }
  std::vector<ListedSystem> systems() const override {
    std::vector<ListedSystem> all;
    for_each_system([&]<class Sys>(const Entry<Sys>& entry) {
      ListedSystem one{
          std::string(entry.name), std::string(entry.summary), Sys::GroupoidType::name(), entry.parameters, {}, {}};
      const Sys system;
      if constexpr (requires { system.symmetries(); })
        for (const auto& symmetry : system.symmetries()) one.symmetries.push_back(symmetry.name);
      for (const auto& quantity : system.quantities())
        if (quantity.promise == Promise::conserved) one.conserved.push_back(quantity.name);
      all.push_back(std::move(one));
    });
    return all;
  }
};

}  // namespace

const SceneFamily& systems_family() {
  static const Systems family;
  return family;
}

}  // namespace lagroid::app
