#pragma once
/// An integrator of a system on a groupoid as a Motion.
///
///     SystemMotion<Sys> motion(system, presentation, watched(system, options), std::move(integrator), options);
///     const StepReport report = motion.advance();
///
/// Requires the options with which the integrator was made. Steps fail as those of the integrator do; nothing throws
/// but what the system's own functions throw.

#include <lagroid/core/capabilities/discrete_energy.hpp>
#include <lagroid/run/ledger/ledger.hpp>
#include <lagroid/run/motion/motion.hpp>
#include <lagroid/run/motion/parameter_values.hpp>
#include <lagroid/run/motion/system_node.hpp>
#include <lagroid/solvers/extrapolation/extrapolation_table.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_messages.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// What the ledger watches: `quantities_of` the system, and E_d where the steps keep it or vary, or where they are
/// equal and the system names no energy of its own.
template <DiscreteSystem Sys> std::vector<Quantity<Sys>> watched(const Sys& system, const IntegratorOptions& options) {
  auto all = quantities_of(system);
  if constexpr (Timed<Sys> && !TimeDependent<Sys>) {
    const auto energy = [](const auto& q) { return q.name.find("energy") != std::string::npos; };
    // The last arrow of a composed step does not last as long as the step.
    const bool equal =
        options.mode == TimeMode::fixed && options.fixed == StepKind::variational && options.composition.stages() == 1;
    if (options.mode == TimeMode::adaptive) {
      const bool kept = options.without_root == WithoutRoot::stop;
      all.push_back(discrete_energy_quantity(system, kept ? Promise::conserved : Promise::bounded));
    } else if (options.mode == TimeMode::prescribed) {
      all.push_back(discrete_energy_quantity(system, Promise::bounded));  // its drift is the steps' multiplier
    } else if (equal && std::none_of(all.begin(), all.end(), energy)) {
      all.push_back(discrete_energy_quantity(system, Promise::bounded));
    }
  }
  return all;
}

/// The presentation with the step sizes, where they vary: a series and a panel.
template <DiscreteSystem Sys> Presentation<Sys> with_step_sizes(Presentation<Sys> p, const IntegratorOptions& options) {
  if (options.mode == TimeMode::fixed) return p;
  p.extras.push_back({{"step_size", {"h"}, "s", "step size of the arrow", true, {}},
                      [](const TrajectoryPoint<Sys>& point, double* out) { *out = point.step_size; }});
  p.panels.push_back({"step size", "t", "h", "t", {"h"}});
  if ((options.mode == TimeMode::adaptive || options.mode == TimeMode::prescribed) && !TimeDependent<Sys>)
    p.panels.push_back({"discrete energy error", "t", "|E_d - first|", "t", {"drift discrete energy E_d"}});
  return p;
}

/// An integrator of a system as a motion.
template <DiscreteSystem Sys> class SystemMotion : public Motion {
 public:
  using G = typename Sys::GroupoidType;

  /// `options` are those that the integrator was made with.
  SystemMotion(const Sys& system, Presentation<Sys> presentation, std::vector<Quantity<Sys>> quantities,
               std::unique_ptr<Integrator<Sys>> integrator, const IntegratorOptions& options,
               Observer<Sys> observer = nullptr)
      : system_(system),
        options_(options),
        presentation_(std::move(presentation)),
        integrator_(std::move(integrator)),
        stages_(integrator_->traits().stages),
        node_(system, presentation_, std::move(quantities)),
        observer_(std::move(observer)) {}
  /// With fields of one's own in place of a presentation.
  SystemMotion(const Sys& system, std::string name, std::vector<FieldOf<Sys>> fields,
               std::vector<Quantity<Sys>> quantities, std::unique_ptr<Integrator<Sys>> integrator,
               const IntegratorOptions& options)
      : system_(system),
        options_(options),
        integrator_(std::move(integrator)),
        stages_(integrator_->traits().stages),
        node_(system, std::move(fields), std::move(quantities)) {
    presentation_.name = std::move(name);
  }
  SystemMotion(const SystemMotion&) = delete;
  SystemMotion& operator=(const SystemMotion&) = delete;

  std::string name() const override { return presentation_.name; }
  MethodTraits traits() const override { return integrator_->traits(); }

  StepReport advance() override { return integrator_->advance(); }
  std::string failure(const StepReport& report, long step) const override {
    const double time = integrator_->point().time;
    if (options_.tolerance > 0) return tolerance_failure(report, step, time, options_.tolerance, most_inner_steps);
    return step_failure(report, step, time, options_.mode);
  }

  long evaluations(const StepReport& report) const override { return stages_ > 0 ? stages_ : report.iterations; }

  long index() const override { return integrator_->point().index; }
  double time() const override { return integrator_->point().time; }
  double step_size() const override {
    const TrajectoryPoint<Sys>& point = integrator_->point();
    if constexpr (HasTimeStep<Sys>)
      if (point.index == 0) return system_.h;
    return point.step_size;
  }
  const Observables& look() override {
    const TrajectoryPoint<Sys>& point = integrator_->point();
    node_.see(point);
    if (point.index > 0) {
      if constexpr (Sys::constraints > 0)
        integrator_->for_each_inner_stage(
            [&](const Step<Sys>& step, double start, double size) { node_.see_inner(step, start, size); });
      if (point.index == 1) first_multipliers_ = point.step.multipliers;
    }
    if (observer_ && point.index > observed_) observer_(node_.point());
    observed_ = point.index;
    return node_;
  }
  std::string why_not_cut() const override {
    return integrator_->cuts() ? "" : "steps of this method cannot be made in part: " + traits().name;
  }
  void keep_node() override { integrator_->keep_node(); }
  const Observables* look_within(double share) override {
    TrajectoryPoint<Sys> inside;
    if (!integrator_->cut(share, inside).converged()) return nullptr;
    node_.see(inside);
    return &node_;
  }
  Changeable changeable() const override {
    Changeable out;
    if (integrator_->kicks()) out.momenta = {{"", G::dimension}};
    if (integrator_->changes_system())
      for (const ParameterValue& each : parameter_values(system_)) out.parameters.push_back(each.name);
    return out;
  }
  std::string refused(double, const MotionChange& change) override {
    Sys changed = system_;
    return set_parameters(changed, change.parameters);
  }
  StepReport change_within(double share, const MotionChange& change) override {
    StepReport report;
    if (!change.kick.empty()) {
      report = integrator_->kick(share, Eigen::Map<const AlgebroidVector<G>>(change.kick.data()));
      if (!report.converged() || change.parameters.empty()) return report;
      share = 0;
    }
    const auto set = [&change](Sys& system) { set_parameters(system, change.parameters); };
    report = integrator_->change(share, set);
    if (report.converged()) change_what_is_seen(set);
    return report;
  }
  std::vector<NamedVector> state() const override {
    const TrajectoryPoint<Sys>& point = integrator_->point();
    return {named("configuration", system_.groupoid.coordinates_of_arrow(point.configuration)),
            named("momentum", tangent_momentum(system_, point.state))};
  }
  std::optional<double> defect() const override;

  void describe(RunResult& result) const override {
    const TrajectoryPoint<Sys>& point = integrator_->point();
    if (point.index > 0) {
      result.first_multipliers.assign(first_multipliers_.begin(), first_multipliers_.end());
      result.last_multipliers.assign(point.step.multipliers.begin(), point.step.multipliers.end());
    }
    present(presentation_, result);
    if (parameter_values(system_) != first_parameters_ && !presentation_.extras.empty()) {
      std::vector<std::string> labels;
      for (const auto& extra : presentation_.extras)
        labels.insert(labels.end(), extra.series.components.begin(), extra.series.components.end());
      result.notes.push_back(fmt::format(
          "parameters were changed on the way; the columns {} and the pictures are made with the first ones",
          fmt::join(labels, ", ")));
    }
    if (const long count = integrator_->without_root(); count > 0) {
      result.notes.push_back(without_root_note(count, result.steps, options_.without_root));
      result.ledger.entries.push_back(counted_entry("steps off the energy", count, result.steps));
    }
  }
  void serialize(NumberArchive& archive) override {
    const std::vector<ParameterValue> first = parameter_values(system_);
    std::vector<ParameterValue> now = first;
    for (ParameterValue& each : now) archive(each.value);
    if (now != first) {
      const auto change = [&now](Sys& system) { set_parameters(system, now); };
      integrator_->change_here(change);
      change_what_is_seen(change);
    }
    integrator_->serialize(archive);
    archive(first_multipliers_, observed_);
    node_.serialize(archive);
  }

 private:
  template <class How> void change_what_is_seen(const How& how) {
    how(system_);
    node_.change(how, watched(system_, options_));
  }
  template <class V> static NamedVector named(const char* name, const V& v) {
    return {name, std::vector<double>(v.data(), v.data() + v.size())};
  }

  Sys system_;
  IntegratorOptions options_;
  Presentation<Sys> presentation_;
  std::unique_ptr<Integrator<Sys>> integrator_;
  int stages_;
  SystemNode<Sys> node_;
  Observer<Sys> observer_;
  long observed_ = -1;
  std::vector<ParameterValue> first_parameters_ = parameter_values(system_);
  Vector<double, Sys::constraints> first_multipliers_ = Vector<double, Sys::constraints>::Zero();
};

template <DiscreteSystem Sys> std::optional<double> SystemMotion<Sys>::defect() const {
  const TrajectoryPoint<Sys>& point = integrator_->point();
  std::optional<double> largest;
  const auto see = [&](double residual) { largest = worse(largest.value_or(0), residual); };
  const G& groupoid = system_.groupoid;
  if constexpr (G::arrow_coordinate_count() > G::dimension + object_dimension_of<G>())
    see((groupoid.coordinates_of_arrow(groupoid.project(point.configuration)) -
         groupoid.coordinates_of_arrow(point.configuration))
            .cwiseAbs()
            .maxCoeff());
  if constexpr (Sys::object_constraints > 0) see(system_.object_constraint(point.state.object).cwiseAbs().maxCoeff());
  if constexpr (Sys::arrow_constraints > 0) {
    largest = largest.value_or(0);
    if (point.index > 0) {
      Sys system = system_;
      set_arrow(system, point.time - point.step_size, point.step_size);
      see(constraint_residual(system, point.step));
    }
  }
  return largest;
}

}  // namespace lagroid
