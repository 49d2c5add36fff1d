#pragma once
/// What is recorded, promised and shown of a motion on (T*S^2)^k.

#include "sphere_system.hpp"

#include <lagroid/run/archive.hpp>
#include <lagroid/run/ledger.hpp>
#include <lagroid/run/run_result.hpp>

#include <vector>

namespace lagroid::app {

/// A node, with what is computed of it once for all who want it.
struct SphereNode {
  SphereNode(const SphereSystem& system, SphereForm of, double at, SphereMarch::Points points)
      : time(at), form(of), z(std::move(points)), measured(system.measure(z, form)), residual(off_spheres(z)) {}

  bool finite() const;

  double time;
  SphereForm form;
  SphereMarch::Points z;
  std::vector<Measured> measured;
  double residual;
};

/// Columns xi, yi, zi (bobs), qix, qiy, qiz (directions), wix... or pix... and one for each quantity.
class SphereRecord {
 public:
  SphereRecord(const SphereSystem& system, SphereForm form);

  void declare(Trajectory& trajectory) const;
  void observe(const SphereNode& node, Trajectory& trajectory);
  void describe(RunResult& result) const;  ///< its shapes, panels and conventions

 private:
  std::vector<SphereQuantity> quantities_;
  SphereForm form_;
  std::vector<double> rods_, bobs_;
  std::vector<double> first_;  ///< of the quantities
};

/// Watches what the method promises: of the system's quantities where it is symplectic, of the spheres where it keeps
/// to them. Sees every n-th node, over which rounding walks on.
class SpherePromises {
 public:
  SpherePromises(const SphereSystem& system, const MethodTraits& method, bool keeps_spheres, long every);

  void observe(const SphereNode& node);
  void report(Ledger& ledger) const;
  void persist(Archive& archive);

 private:
  bool promises_;
  bool keeps_spheres_;
  double walk_;  ///< of rounding between nodes that are seen, relative to the terms
  double residual_ = 0;
  std::vector<QuantityWatch> quantities_;
};

}  // namespace lagroid::app
