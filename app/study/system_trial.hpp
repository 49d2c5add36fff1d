#pragma once
/// Trials of any system.

#include "trial.hpp"

#include <lagroid/core/quantity.hpp>
#include <lagroid/core/two_sided.hpp>
#include <lagroid/solvers/constrained_momentum.hpp>
#include <lagroid/solvers/march.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace lagroid::app {

template <DiscreteSystem Sys> class SystemTrial final : public Trial {
 public:
  using G = typename Sys::GroupoidType;

  SystemTrial(Sys system, const State<G>& initial, const ArrowOf<G>& configuration, const MarchOptions& options)
      : system_(std::move(system)),
        quantities_(system_.quantities()),
        march_(make_march(system_, initial, configuration, options)),
        stages_(march_->traits().stages) {}

  StepReport advance(Work& work) override {
    const StepReport report = march_->advance();
    if (report.converged()) count(work, report, stages_);
    return report;
  }
  StepReport run(double end, Work& work) override {
    StepReport report;
    report.status = SolveStatus::converged;
    const TrajectoryPoint<Sys>& point = march_->point();
    while (report.converged() && end - point.time > 0.5 * (point.index > 0 ? point.step_size : system_.h))
      report = advance(work);
    return report;
  }
  double time() const override { return march_->point().time; }
  MethodTraits traits() const override { return march_->traits(); }

  Sight see() override {
    const TrajectoryPoint<Sys>& point = march_->point();
    const AlgebroidVector<G> momentum = tangent_momentum(system_, point.state);
    Sight sight;
    sight.state = {block("configuration", system_.groupoid.coordinates_of_arrow(point.configuration)),
                   block("momentum", momentum)};
    TrajectoryPoint<Sys> reported = point;
    reported.state.momentum = momentum;
    for (const auto& quantity : quantities_) {
      if (quantity.needs_step && point.index == 0) continue;
      Block seen{quantity.name, std::vector<double>(quantity.components.size())};
      quantity.evaluate(reported, seen.values.data());
      if (quantity.size) seen.size = quantity.size(reported);
      sight.invariants.push_back(std::move(seen));
    }
    see_constraints(point, sight);
    return sight;
  }

 private:
  template <class V> static Block block(const char* name, const V& v) {
    return {name, std::vector<double>(v.data(), v.data() + v.size())};
  }

  void see_constraints(const TrajectoryPoint<Sys>& point, Sight& sight) {
    const auto see = [&](double residual) {
      sight.constrained = true;
      sight.constraint = std::isnan(residual) ? residual : std::max(sight.constraint, residual);
    };
    const G& groupoid = system_.groupoid;
    if constexpr (G::arrow_coordinate_count() > G::dimension + object_dimension_of<G>())
      see((groupoid.coordinates_of_arrow(groupoid.project(point.configuration)) -
           groupoid.coordinates_of_arrow(point.configuration))
              .cwiseAbs()
              .maxCoeff());
    if constexpr (Sys::object_constraints > 0) see(system_.object_constraint(point.state.object).cwiseAbs().maxCoeff());
    if constexpr (Sys::arrow_constraints > 0)
      if (point.index > 0) {
        if constexpr (HasTimeStep<Sys>) system_.h = point.step_size;
        set_time(system_, point.time - point.step_size);
        see(constraint_values(system_, point.step.arrow).cwiseAbs().maxCoeff());
      }
  }

  Sys system_;
  std::vector<Quantity<Sys>> quantities_;
  std::unique_ptr<March<Sys>> march_;
  int stages_;
};

}  // namespace lagroid::app
