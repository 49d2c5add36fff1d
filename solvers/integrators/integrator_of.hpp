#pragma once
/// Puts an integrator of a known type behind the interface `Integrator`, at the cost of one virtual call a step.
///
/// Its steps can be made in part where it has `cut(from, share, to)` or, if it can be copied, `begin_cut(from, share)`,
/// after which its next step is that part. After a change it goes on by `go_on_from(point)`, where nodes stay in time
/// but for integrators whose steps are equal in one of their own (`has_own_time`), with `follow_energy_of(state)`.

#include <lagroid/solvers/integrators/integrator.hpp>

#include <utility>

namespace lagroid {

namespace detail {

/// Any integrator, behind the interface.
template <DiscreteSystem Sys, class Integrating> class IntegratorOf final : public Integrator<Sys> {
 public:
  template <class... As> explicit IntegratorOf(As&&... arguments) : integrator_(std::forward<As>(arguments)...) {}

  StepReport advance() override { return integrator_.advance(); }
  const TrajectoryPoint<Sys>& point() const override { return integrator_.point(); }
  MethodTraits traits() const override { return integrator_.traits(); }
  using Visit = typename Integrator<Sys>::Visit;
  void for_each_inner_stage(const Visit& visit) const override {
    if constexpr (requires { integrator_.for_each_inner_stage(visit); }) integrator_.for_each_inner_stage(visit);
  }
  long without_root() const override {
    if constexpr (requires { integrator_.without_root(); }) {
      return integrator_.without_root();
    } else {
      return 0;
    }
  }

  void serialize(NumberArchive& archive) override { integrator_.serialize(archive); }

  bool cuts() const override {
    if constexpr (requires { integrator_.cuts(); }) {
      return integrator_.cuts();
    } else {
      return solves_cuts || begins_cuts;
    }
  }
  void keep_node() override {
    kept_ = integrator_.point();
    rest_ = 1;
  }
  [[gnu::cold]] StepReport cut(double share, TrajectoryPoint<Sys>& to, const Visit& inner = {}) override {
    StepReport report;
    share *= rest_;
    if (share == 0) {
      to = kept_;
      report.status = SolveStatus::converged;
    } else if constexpr (visits_cuts) {
      report = integrator_.cut(kept_, share, to, inner);
    } else if constexpr (solves_cuts) {
      report = integrator_.cut(kept_, share, to);
    } else if constexpr (begins_cuts) {
      const Integrating whole = integrator_;
      integrator_.begin_cut(kept_, share);
      report = advance();
      to = point();
      integrator_ = whole;
      to.index = kept_.index + 1;
      to.time = kept_.time + to.step_size;
    }
    return report;
  }

  using ChangeSystem = typename Integrator<Sys>::ChangeSystem;
  bool kicks() const override {
    return cuts() && requires(Integrating & all, const TrajectoryPoint<Sys>& point) { all.go_on_from(point); };
  }
  StepReport kick(double share, const AlgebroidVector<typename Sys::GroupoidType>& by) override {
    return go_on_after(share, [&](TrajectoryPoint<Sys>& inside) { inside.state.momentum += by; });
  }

  bool changes_system() const override { return kicks() && has_systems; }
  StepReport change(double share, const ChangeSystem& how) override {
    return go_on_after(share, [&](TrajectoryPoint<Sys>&) { change_here(how); });
  }
  void change_here(const ChangeSystem& how) override {
    if constexpr (has_systems) integrator_.for_each_system(how);
  }

 private:
  static constexpr bool solves_cuts = requires(Integrating & all, TrajectoryPoint<Sys>& point) {
    all.cut(point, 0.5, point);
  };
  static constexpr bool visits_cuts = requires(Integrating & all, TrajectoryPoint<Sys>& point, const Visit& inner) {
    all.cut(point, 0.5, point, inner);
  };
  static constexpr bool begins_cuts = requires(Integrating & all, const TrajectoryPoint<Sys>& point) {
    all.begin_cut(point, 0.5);
  };

  static constexpr bool has_systems = requires(Integrating & all, const ChangeSystem& how) {
    all.for_each_system(how);
  };
  static constexpr bool has_own_time = requires { Integrating::has_own_time; };
  /// Makes the rest of the last step from the point that a share of it leads to, after a change.
  template <class Change> [[gnu::cold]] StepReport go_on_after(double share, const Change& change) {
    StepReport report;
    if constexpr (requires { integrator_.go_on_from(kept_); }) {
      TrajectoryPoint<Sys> inside;
      report = cut(share, inside);
      if (!report.converged()) return report;
      inside.index = kept_.index;
      change(inside);
      if constexpr (has_own_time) integrator_.follow_energy_of(inside.state);
      kept_ = inside;
      rest_ *= 1 - share;
      TrajectoryPoint<Sys> reached;
      report = cut(1, reached);
      if (!report.converged()) return report;
      reached.index = point().index;
      if (!has_own_time) reached.time = point().time;
      integrator_.go_on_from(reached);
    }
    return report;
  }

  Integrating integrator_;
  TrajectoryPoint<Sys> kept_;
  double rest_ = 1;  ///< of a step, that begins at the point that is kept
};

}  // namespace detail

}  // namespace lagroid
