#pragma once
/// What is to be seen and shown of a motion on a Poisson manifold.

#include "poisson_entry.hpp"

#include <lagroid/run/motion/observables.hpp>

#include <optional>
#include <string>
#include <vector>

namespace lagroid::app {

/// Fields: the state by its labels, energy, Casimirs, the Poisson defect of the next step, drifts. Promised are the
/// Casimirs where the method keeps them, the bracket where it keeps that, and then, without noise, the energy.
class PoissonNode final : public Observables {
 public:
  /// Of every n-th node something is seen: over those between rounding walks on. Where noise drives it, no energy is
  /// promised. The system must outlive this.
  PoissonNode(const PoissonEntry& entry, const AnyPoissonSystem& system, const PoissonIntegrator& method, long every,
              bool driven);

  /// `at` must outlive what is asked of the node.
  void see(long index, double time, const PoissonIntegrator& at);

  long index() const override { return index_; }
  double time() const override { return time_; }
  Endpoint endpoint() const override {
    Endpoint end;
    end.time = time_;
    end.position = x_;
    return end;
  }
  bool finite() const override;
  const std::vector<Field>& fields() const override { return fields_; }
  void read(std::size_t field, double* row) const override;
  const std::vector<Watched>& quantities() const override { return watched_; }
  double measure(std::size_t quantity, double* value) const override {
    const MeasuredFunction measured = quantity < measured_.size() ? measured_[quantity] : MeasuredFunction{defect(), 1};
    *value = measured.value;
    return measured.size;
  }
  double noise() const override { return rounding_; }
  Constrained constrained() const override { return Constrained::no; }
  std::optional<double> residual() const override { return {}; }

 private:
  double defect() const;

  const AnyPoissonSystem& system_;
  double rounding_;  ///< of rounding between nodes that are seen, relative to the terms
  bool has_defect_;
  std::vector<Field> fields_;
  std::vector<Watched> watched_;
  long index_ = 0;
  double time_ = 0;
  std::vector<double> x_;
  std::vector<MeasuredFunction> measured_;  ///< energy and Casimirs
  const PoissonIntegrator* at_ = nullptr;
  mutable std::optional<double> defect_;  ///< where it was needed: it costs more than the step
};

/// The column of the i-th Casimir.
std::string casimir_column(std::size_t i);
/// Adds shapes, panels and conventions.
void describe_poisson(const PoissonEntry& entry, RunResult& result);

}  // namespace lagroid::app
