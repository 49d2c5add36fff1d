#pragma once
/// What is to be seen and shown of a motion on (T*S^2)^k.

#include "sphere_system.hpp"

#include <lagroid/run/motion/observables.hpp>

#include <vector>

namespace lagroid::app {

/// Fields xi, yi, zi (bobs), qix, qiy, qiz (directions), wix... or pix... and one for each quantity. Promised are the
/// system's quantities where the method is symplectic, and the spheres where it keeps to them.
class SphereNode final : public Observables {
 public:
  /// Of every n-th node something is seen: over those between rounding walks on. The system must outlive this.
  SphereNode(const SphereSystem& system, SphereForm form, const MethodTraits& method, bool keeps_spheres, long every);

  void see(long index, double time, SphereIntegrator::Points points);

  long index() const override { return index_; }
  double time() const override { return time_; }
  Endpoint endpoint() const override;
  bool finite() const override;
  const std::vector<Field>& fields() const override { return fields_; }
  void read(std::size_t field, double* row) const override;
  const std::vector<Watched>& quantities() const override { return watched_; }
  double measure(std::size_t quantity, double* value) const override {
    *value = measured_[quantity].value;
    return measured_[quantity].size;
  }
  double noise() const override { return rounding_; }
  Constrained constrained() const override { return constrained_; }
  std::optional<double> residual() const override { return residual_; }

 private:
  void add(Columns columns) { fields_.push_back({std::move(columns)}); }

  const SphereSystem& system_;
  SphereForm form_;
  Constrained constrained_;
  double rounding_;  ///< of rounding between nodes that are seen, relative to the terms
  std::vector<double> rods_;
  std::vector<Field> fields_;
  std::vector<Watched> watched_;
  long index_ = 0;
  double time_ = 0;
  SphereIntegrator::Points z_;
  std::vector<Measured> measured_;
  double residual_ = 0;
};

/// Adds shapes, panels and conventions.
void describe_spheres(const SphereSystem& system, SphereForm form, RunResult& result);

}  // namespace lagroid::app
