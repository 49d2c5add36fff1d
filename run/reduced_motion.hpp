#pragma once
/// A reduced run as a Motion: what is recorded and judged is the full motion, beside it the reduced run's own momentum,
/// what the reduced run keeps and, at a fixed momentum, how much of the motion along the fibres is geometry.
///
///     ReducedMotion<Kepler, Reduction<PolarQuotient>> motion(declared, kepler, down, presentation, arrows, options);
///
/// Requires arrows of the full system about the start, by which is known which of its symmetries descend. Errors are
/// those of ReducedIntegrator.

#include <lagroid/run/motion/system_motion.hpp>
#include <lagroid/solvers/integrators/reduced_integrator.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

template <DiscreteSystem Sys, class Declared> class ReducedMotion final : public SystemMotion<Sys> {
 public:
  using G = typename Sys::GroupoidType;
  using Reduced = ReducedIntegrator<Sys, Declared>;
  using Below = typename Reduced::Below;
  using H = typename Below::GroupoidType;

  /// `system` is that of `down`; `options` are those of the reduced run.
  ReducedMotion(const Declared& declared, const Sys& system, const typename Reduced::Down& down,
                const Presentation<Sys>& presentation, std::span<const ArrowOf<G>> arrows,
                const IntegratorOptions& options, Observer<Sys> observer = nullptr)
      : ReducedMotion(declared, system, presentation, down.quantities(arrows), std::make_unique<Reduced>(down, options),
                      options, std::move(observer)) {}

  std::string failure(const StepReport& report, long step) const override {
    if (has_phases && report.status == SolveStatus::not_finite)
      return fmt::format(
          "step {} (from t = {:.6g}): no arrow near has the fixed momentum, or a number overflowed; use a smaller step",
          step, this->time());
    return SystemMotion<Sys>::failure(report, step);
  }

  void describe(RunResult& result) const override {
    SystemMotion<Sys>::describe(result);
    result.notes.push_back(fmt::format("reduced by \"{}\" ({}) to {}; recorded is the full motion over it",
                                       declared_.name, declared_.meaning, H::name()));
    if constexpr (has_phases) {
      const auto& phases = reduced_.down().phases();
      const auto numbers = [](const auto& v) { return std::vector<double>(v.data(), v.data() + v.size()); };
      const std::vector<double> dynamic = numbers(phases.dynamic());
      const std::vector<double> geometric = numbers(phases.geometric());
      result.ledger.entries.push_back(phase_entry("dynamic phase", dynamic));
      result.ledger.entries.push_back(phase_entry("geometric phase", geometric));
      result.notes.push_back(fmt::format(
          "along the fibres, dynamic phase {:.9g}, geometric phase {:.9g}: what the path of the base moves without "
          "momentum",
          fmt::join(dynamic, ", "), fmt::join(geometric, ", ")));
    }
  }

 private:
  static constexpr bool has_phases = requires(const Reduced& reduced) { reduced.down().phases(); };

  ReducedMotion(const Declared& declared, const Sys& system, const Presentation<Sys>& presentation,
                const std::vector<Quantity<Below>>& own, std::unique_ptr<Reduced>&& integrator,
                const IntegratorOptions& options, Observer<Sys> observer)
      : ReducedMotion(declared, system, presentation, own, *integrator, std::move(integrator), options,
                      std::move(observer)) {}
  /// `reduced` is what `integrator` points to, which is moved on.
  ReducedMotion(const Declared& declared, const Sys& system, const Presentation<Sys>& presentation,
                const std::vector<Quantity<Below>>& own, const Reduced& reduced, std::unique_ptr<Reduced>&& integrator,
                const IntegratorOptions& options, Observer<Sys> observer)
      : SystemMotion<Sys>(system, with_reduced_columns(with_step_sizes(presentation, options), reduced),
                          all_quantities(watched(system, options), own, reduced), std::move(integrator), options,
                          std::move(observer)),
        declared_(declared),
        reduced_(reduced) {}

  /// Of the node where the run is.
  static Presentation<Sys> with_reduced_columns(Presentation<Sys> p, const Reduced& reduced) {
    const std::vector<std::string> labels = numbered("reduced mu", H::dimension);
    p.extras.push_back({{"reduced_momentum",
                         labels,
                         "action / unit of the retraction's coordinates of " + H::name(),
                         "momentum of the reduced run",
                         false,
                         {}},
                        [&reduced](const TrajectoryPoint<Sys>&, double* out) {
                          const auto& mu = reduced.point_below().state.momentum;
                          std::copy(mu.data(), mu.data() + mu.size(), out);
                        }});
    p.panels.push_back({"reduced momentum", "t", "mu", "t", labels});
    if constexpr (has_phases) {
      std::vector<std::string> phases = numbered("dynamic phase", Below::angles);
      for (const std::string& each : numbered("geometric phase", Below::angles)) phases.push_back(each);
      p.extras.push_back({{"phases",
                           phases,
                           "of the angles",
                           "how far the motion along the fibres went by its momentum, and by the path of the base",
                           false,
                           {}},
                          [&reduced](const TrajectoryPoint<Sys>&, double* out) {
                            const auto& tally = reduced.down().phases();
                            Eigen::Map<Vector<double, Below::angles>> dynamic(out);
                            Eigen::Map<Vector<double, Below::angles>> geometric(out + Below::angles);
                            dynamic = tally.dynamic();
                            geometric = tally.geometric();
                          }});
      p.panels.push_back({"phases along the fibres", "t", "phase", "t", phases});
    }
    return p;
  }
  /// Those of the full system, and the reduced run's own at the node where it is.
  static std::vector<Quantity<Sys>> all_quantities(std::vector<Quantity<Sys>> all,
                                                   const std::vector<Quantity<Below>>& own, const Reduced& reduced) {
    for (const Quantity<Below>& each : own)
      all.push_back(
          {each.name, each.components, each.promise, each.needs_step,
           [evaluate = each.evaluate, &reduced](const TrajectoryPoint<Sys>&, double* out) {
             evaluate(reduced.point_below(), out);
           },
           [size = each.size, &reduced](const TrajectoryPoint<Sys>&) { return size(reduced.point_below()); }});
    return all;
  }
  static std::vector<std::string> numbered(const std::string& head, int count) {
    std::vector<std::string> out;
    for (int i = 1; i <= count; ++i) out.push_back(count > 1 ? head + std::to_string(i) : head);
    return out;
  }
  static LedgerEntry phase_entry(std::string name, const std::vector<double>& phase) {
    LedgerEntry entry;
    entry.name = std::move(name);
    entry.promise = "none";
    entry.initial.assign(phase.size(), 0);
    entry.final = phase;
    entry.drift = norm_of(phase);
    entry.relative_drift = entry.drift;
    entry.verdict = "watched";
    return entry;
  }

  Declared declared_;
  const Reduced& reduced_;  ///< the integrator of the motion
};

}  // namespace lagroid
