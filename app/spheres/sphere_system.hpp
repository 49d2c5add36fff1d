#pragma once
/// Systems on (T*S^2)^k, as scenes name them.

#include "../keys/parameter.hpp"
#include "../reading/scene_reader.hpp"

#include <lagroid/core/quantity.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>
#include <lagroid/systems/spheres/sphere_integrator.hpp>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// What a system keeps, and what its own methods promise of it. Lie group methods promise nothing.
struct SphereQuantity {
  std::string name;
  std::string column;
  std::string unit;
  Promise promise = Promise::bounded;
};

/// The value of one, and the size of the terms that it is made of.
struct Measured {
  double value = 0;
  double size = 0;
};

class SphereSystem {
 public:
  using Points = SphereIntegrator::Points;

  virtual ~SphereSystem() = default;
  virtual std::string_view name() const = 0;
  /// The forms that it has, the usual one first; its momenta are always known.
  virtual std::vector<SphereForm> forms() const = 0;
  /// Points in another form; only for forms that it has.
  virtual Points in_form(const Points& z, SphereForm from, SphereForm to) const = 0;
  virtual std::unique_ptr<SphereIntegrator> begin(const Points& start,
                                                  const SphereIntegratorOptions& options) const = 0;

  /// Numbers that the system has read from files, as the parameters of a learned model. A run is resumed only where
  /// they are the same as when it began.
  virtual std::vector<double> from_files() const { return {}; }
  /// Overrides "key=value" with which its scene can be read from another folder: relative paths of files made absolute.
  virtual std::vector<std::string> pinned() const { return {}; }

  /// The energy first.
  virtual std::vector<SphereQuantity> quantities() const = 0;
  /// In the same order.
  virtual std::vector<Measured> measure(const Points& z, SphereForm form) const = 0;

  /// It is shown as a chain that hangs from the origin: lengths of rods (m), as many as there are points, and the
  /// masses at their ends (of any unit).
  virtual std::vector<double> rods() const = 0;
  virtual std::vector<double> bobs() const = 0;
  int count() const { return int(rods().size()); }
};

struct SphereEntry {
  std::string_view name;
  std::string_view summary;
  std::string_view groupoid;
  std::vector<Key> parameters;
  std::vector<std::string> symmetries;
  std::vector<std::string> conserved;
  /// Those of its systems, the usual one first.
  std::vector<SphereForm> forms;
  /// Methods beside those for Lie groups, made for the system. The first is what scenes get.
  std::vector<DeclaredMethod> own_methods;
  /// The paper that the system itself is from, if there is one.
  Source source;
  /// Reads [parameters] of a scene.
  std::unique_ptr<SphereSystem> (*read)(const Section& scene);
};

/// In the order in which they are listed to users.
const std::vector<SphereEntry>& sphere_systems();
/// The one that the scene names; null where it names none of these.
const SphereEntry* sphere_system_of(const Section& scene);

}  // namespace lagroid::app
