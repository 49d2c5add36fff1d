#pragma once
/// Scenes of Poisson systems: those of the library, or of a program of one's own.
///
///     const PoissonFamily family({poisson_entry<EulerTop>("euler_top", "free rigid body", "so(3)*", {"|M|^2 / 2"})});
///
/// Requires names that no other system of the program has. Errors: as SceneFamily.

#include "../families/family.hpp"
#include "poisson_entry.hpp"

#include <vector>

namespace lagroid::app {

class PoissonFamily final : public SceneFamily {
 public:
  /// In the order in which they are listed to users.
  explicit PoissonFamily(std::vector<PoissonEntry> entries);
  explicit PoissonFamily(const std::vector<const PoissonEntry*>& entries);

  const std::vector<PoissonEntry>& entries() const { return entries_; }
  /// The one that the scene names; null where it names none of these.
  const PoissonEntry* entry_of(const Section& scene) const;

  std::string_view key() const override;
  bool recognises(const Section& scene) const override { return entry_of(scene) != nullptr; }
  MotionScene read(const Section& scene, const RunContext& context) const override;
  std::vector<Use> uses(const Section& scene) const override;
  std::vector<ListedSystem> systems() const override;
  std::vector<SceneKeys> keys_of_scenes() const override;
  std::vector<std::string> names() const override;

 private:
  std::vector<PoissonEntry> entries_;
};

/// Of the library's systems.
const PoissonFamily& library_brackets();

}  // namespace lagroid::app
