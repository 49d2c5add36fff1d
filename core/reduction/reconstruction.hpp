#pragma once
/// A declared reduction (core/capabilities/reductions.hpp) of a system from an initial value: the reduced system with
/// where it starts, and the full motion over its run, node after node.
///
///     Reconstruction<Kepler, Reduction<PolarQuotient>> down(declared, kepler, state, configuration);
///     const auto run = make_integrator(down.system(), down.initial(), down.configuration(), {});
///     while (run->advance().converged()) {
///       down.join(run->point().step, run->point().step_size);
///       const TrajectoryPoint<Kepler> full = down.full(run->point());
///     }
///
/// The full motion begins with the given configuration, whichever object it ends at. Where a morphism reduces, each
/// node lifts by itself (reconstruct.hpp); where a momentum is fixed, the full arrows are multiplied, with compensation
/// for what rounding takes.
///
/// Required: every step is joined, with each of the arrows that it is composed of, in their order. Errors: NotFree
/// where the symmetry leaves the initial object where it is.

#include <lagroid/core/capabilities/reductions.hpp>
#include <lagroid/core/reduction/descent.hpp>
#include <lagroid/core/reduction/examine_routhian.hpp>
#include <lagroid/core/reduction/phase.hpp>
#include <lagroid/core/reduction/reconstruct.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace lagroid {

template <DiscreteSystem Sys, class Declared> class Reconstruction;

/// What a system is before any reduction.
template <DiscreteSystem Sys> class Reconstruction<Sys, Unreduced> {
 public:
  using Below = Sys;
  using G = typename Sys::GroupoidType;

  Reconstruction(const Unreduced&, const Sys& system, const State<G>& initial, const ArrowOf<G>& configuration)
      : system_(system), initial_(initial), configuration_(configuration) {}

  const Below& system() const { return system_; }
  const State<G>& initial() const { return initial_; }
  const ArrowOf<G>& configuration() const { return configuration_; }
  const State<G>& state_below(const State<G>& z) const { return z; }
  ArrowOf<G> arrow_below(const ArrowOf<G>& g) const { return g; }
  DescentReport examine(std::span<const ArrowOf<G>>) const { return {}; }
  TrajectoryPoint<Sys> full(const TrajectoryPoint<Below>& point) const { return point; }

 private:
  Sys system_;
  State<G> initial_;
  ArrowOf<G> configuration_;
};

/// The symmetries of a system that its reduction keeps: sections X for which A Phi X depends on Phi(q) alone, and
/// boundary terms that do, at the sources of the given arrows.
template <class Phi, class Sys>
std::vector<Symmetry<ReducedSystem<Phi, Sys>>> descending_symmetries(
    const ReducedSystem<Phi, Sys>& reduced, std::span<const ArrowOf<typename Phi::Domain>> arrows,
    double tolerance = 1e-10) {
  using Below = ReducedSystem<Phi, Sys>;
  using H = typename Phi::Codomain;
  std::vector<Symmetry<Below>> out;
  if constexpr (HasSymmetries<Sys>) {
    for (const Symmetry<Sys>& symmetry : reduced.full.symmetries()) {
      const auto section = [reduced, symmetry](const ObjectOf<H>& m) {
        const auto q = object_over(reduced.morphism, m);
        return AlgebroidVector<H>(reduced.morphism.algebroid(q) * symmetry.section(q));
      };
      const auto term = [reduced, symmetry](const ObjectOf<H>& m) {
        return symmetry.f(object_over(reduced.morphism, m));
      };
      const bool descends = std::all_of(arrows.begin(), arrows.end(), [&](const auto& g) {
        const auto q = reduced.full.groupoid.source(g);
        const auto m = reduced.morphism.object(q);
        const AlgebroidVector<H> here = reduced.morphism.algebroid(q) * symmetry.section(q);
        return (section(m) - here).norm() <= tolerance * here.norm() &&
               std::abs(term(m) - symmetry.f(q)) <= tolerance * std::abs(symmetry.f(q));
      });
      if (!descends) continue;
      if (symmetry.boundary_term) {
        out.push_back({"reduced " + symmetry.name, section, term});
      } else {
        out.push_back({"reduced " + symmetry.name, section});
      }
    }
  }
  return out;
}

template <DiscreteSystem Sys, class Phi> class Reconstruction<Sys, Reduction<Phi>> {
 public:
  using Below = ReducedSystem<Phi, Sys>;
  using G = typename Sys::GroupoidType;
  using H = typename Below::GroupoidType;

  Reconstruction(const Reduction<Phi>& declared, const Sys& system, const State<G>& initial,
                 const ArrowOf<G>& configuration)
      : system_(system, declared.along),
        start_(system.groupoid.source(configuration)),
        initial_(system_.state_below(initial)),
        configuration_(system_.morphism(configuration)) {}

  const Below& system() const { return system_; }
  const State<H>& initial() const { return initial_; }
  const ArrowOf<H>& configuration() const { return configuration_; }
  /// Throws NotFree.
  State<H> state_below(const State<G>& z) const { return system_.state_below(z); }
  ArrowOf<H> arrow_below(const ArrowOf<G>& g) const { return system_.morphism(g); }
  /// Whether the system descends, at these arrows.
  DescentReport examine(std::span<const ArrowOf<G>> arrows) const { return examine_descent(system_, arrows); }
  /// What the reduced run keeps, beside what the full one does.
  std::vector<Quantity<Below>> quantities(std::span<const ArrowOf<G>> arrows) const {
    std::vector<Quantity<Below>> out;
    for (const auto& symmetry : descending_symmetries(system_, arrows)) out.push_back(symmetry.quantity());
    return out;
  }

  void join(const Step<Below>&, double) {}
  TrajectoryPoint<Sys> full(const TrajectoryPoint<Below>& point) const { return full_point(system_, point, start_); }
  void serialize(NumberArchive&) {}

 private:
  Below system_;
  ObjectOf<G> start_;
  State<H> initial_;
  ArrowOf<H> configuration_;
};

template <DiscreteSystem Sys, class Connection, class First>
class Reconstruction<Sys, FixedMomentum<Connection, First>> {
 public:
  using Upper = Reconstruction<Sys, First>;
  using Middle = typename Upper::Below;
  using Below = MomentumLevel<Connection, Middle>;
  using G = typename Sys::GroupoidType;
  using M = typename Middle::GroupoidType;
  using H = typename Below::GroupoidType;
  using Phases = PhaseTally<Below>;

  Reconstruction(const FixedMomentum<Connection, First>& declared, const Sys& system, const State<G>& initial,
                 const ArrowOf<G>& configuration)
      : upper_(declared.first, system, initial, configuration),
        system_(through(declared.connection, upper_)),
        name_(declared.name),
        initial_(system_.state_below(upper_.initial())),
        configuration_(system_.connection(upper_.configuration())),
        last_(system_),
        lifted_(upper_.configuration()),
        step_(upper_.system().groupoid.unit(upper_.initial().object)),
        phases_(system_, HorizontalArrows::zero_momentum) {}

  const Below& system() const { return system_; }
  const State<H>& initial() const { return initial_; }
  const ArrowOf<H>& configuration() const { return configuration_; }
  DescentReport examine(std::span<const ArrowOf<G>> arrows) const {
    DescentReport report = upper_.examine(arrows);
    if constexpr (Below::closed) {
      std::vector<ArrowOf<H>> below;
      for (const auto& g : arrows) below.push_back(system_.connection(upper_.arrow_below(g)));
      for (auto& finding : examine_routhian(system_, std::span<const ArrowOf<H>>(below)))
        report.findings.push_back(std::move(finding));
    }
    return report;
  }
  /// The momentum of the full arrows, which is solved for anew at each.
  std::vector<Quantity<Below>> quantities(std::span<const ArrowOf<G>>) const {
    using Point = TrajectoryPoint<Below>;
    const auto on = [level = system_](const Point& point) {
      Below there = level;
      set_time_step(there, point.step_size);
      return there;
    };
    std::vector<std::string> labels;
    for (int i = 1; i <= Below::angles; ++i) labels.push_back("level" + (Below::angles > 1 ? std::to_string(i) : ""));
    return {{"fixed " + std::string(name_), std::move(labels), Promise::conserved, true,
             [on](const Point& point, double* out) {
               Eigen::Map<Vector<double, Below::angles>> values(out);
               values = momentum_of(on(point), point.step);
             },
             [on](const Point& point) { return size_of_terms(on(point), point.step); }}};
  }

  void join(const Step<Below>& step, double size) {
    set_time_step(last_, size);
    step_ = last_.full_arrow(step.arrow);
    const M& groupoid = upper_.system().groupoid;
    ArrowOf<M> reached = groupoid.compose(lifted_, step_);
    lost_ = groupoid.correct(reached, lost_);
    lifted_ = groupoid.project(reached);
    phases_.add(step.arrow, size);
  }
  TrajectoryPoint<Sys> full(const TrajectoryPoint<Below>& point) const {
    TrajectoryPoint<Middle> out;
    out.index = point.index;
    out.time = point.time;
    out.step_size = point.step_size;
    out.state = system_.state_over(point.state);
    out.configuration = lifted_;
    out.step = {step_, point.step.multipliers};
    return upper_.full(out);
  }
  const Phases& phases() const { return phases_; }
  void serialize(NumberArchive& archive) {
    const M& groupoid = upper_.system().groupoid;
    archive.arrow(groupoid, lifted_);
    archive.arrow(groupoid, step_);
    archive(lost_, phases_);
  }

 private:
  /// The level of the initial state.
  static Below through(const Connection& connection, const Upper& upper) {
    const Below zero(connection, upper.system(), Vector<double, Below::angles>::Zero());
    return Below(connection, upper.system(), zero.momentum_of(upper.initial()));
  }
  static Step<Middle> above(const Below& level, const Step<Below>& step) {
    return {level.full_arrow(step.arrow), step.multipliers};
  }
  static Vector<double, Below::angles> momentum_of(const Below& level, const Step<Below>& step) {
    return level.momentum_of(legendre_minus(level.full, above(level, step)));
  }
  /// Of the coordinates of the full arrow, each with the digits that it has, in its momentum.
  static double size_of_terms(const Below& level, const Step<Below>& step) {
    const Step<Middle> g = above(level, step);
    const auto d = two_sided(level.full, g.arrow, g.multipliers);
    return (d.mixed.cwiseAbs() * level.full.groupoid.coordinate_scale(g.arrow)).norm() + d.source_gradient.norm();
  }

  Upper upper_;
  Below system_;
  std::string_view name_;
  State<H> initial_;
  ArrowOf<H> configuration_;
  Below last_;  ///< with the step of the last arrow
  ArrowOf<M> lifted_;
  ArrowOf<M> step_;
  AlgebroidVector<M> lost_ = AlgebroidVector<M>::Zero();
  Phases phases_;
};

/// Whether the system descends, at these arrows. (It is compiled once for each reduction of the library's systems.)
template <DiscreteSystem Sys, class Declared>
DescentReport examine_reduction(const Reconstruction<Sys, Declared>& down,
                                const std::vector<ArrowOf<typename Sys::GroupoidType>>& arrows) {
  return down.examine(arrows);
}

/// The reduction that a system declares in that place, and what the system is after it.
template <DiscreteSystem Sys, std::size_t Place>
using ReductionAt = std::tuple_element_t<Place, decltype(Sys::reductions())>;
template <DiscreteSystem Sys, std::size_t Place>
using ReducedBy = typename Reconstruction<Sys, ReductionAt<Sys, Place>>::Below;

}  // namespace lagroid
