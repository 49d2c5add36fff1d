#pragma once
/// The motion of a split system by compositions of its flows, linearised: explicit steps have no equations, and the
/// flows themselves are evaluated over numbers with derivatives. With g_{k+1} = g_k a(q_k, mu_k; theta),
///
///     tau(w) = a^{-1} tau(v) a(target of tau(v), mu + dmu; theta + dtheta),    x' = (w, mu').
///
///     LinearisedSplitting<Kepler> motion(kepler, start, unit, splittings::srkn6, {"strength"}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);
///
/// Requires flows that are templates on the scalar. Errors: std::invalid_argument for a name that is no parameter and
/// for a composition that the system does not admit; WithoutDerivative for a parameter that flows read as a plain
/// number, found at the first step.

#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion_of.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lagroid {

template <SplitSystem Sys> class LinearisedSplitting final : public LinearisedMotion {
 public:
  using G = typename Sys::GroupoidType;
  static constexpr int n = Sys::dimension;

  LinearisedSplitting(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration,
                      const Composition& composition, const std::vector<std::string>& parameters,
                      ObserveNode<Sys> observe)
      : system_(system),
        composition_(composition),
        integrator_(system, start, configuration, composition),
        places_(places_of_parameters(system_, parameters)),
        observe_(std::move(observe)),
        stage_(0, 2 * n, int(places_.members.size())) {}
  LinearisedSplitting(const LinearisedSplitting&) = delete;  // derivatives know members by their places
  LinearisedSplitting& operator=(const LinearisedSplitting&) = delete;

  int states() const override { return 2 * n; }
  int parameters() const override { return int(places_.members.size()); }
  double time() const override { return integrator_.point().time; }
  StepReport advance() override {
    before_ = integrator_.point().state;
    return integrator_.advance();
  }

  bool linearise() override {
    const G& groupoid = system_.groupoid;
    const auto back = groupoid.template cast<VariedNumber>(groupoid.inverse(integrator_.point().step.arrow));
    const Vector<double, n> zero = Vector<double, n>::Zero();
    detail::for_directions(2 * n + parameters(), [&](int first) {
      using V = VariedNumber;
      const VariedMembers varying(places_.members, 2 * n - first);
      const auto moved =
          groupoid.tau(groupoid.template cast_object<V>(before_.object), detail::varied_along(zero, -first));
      SplitMotion<Sys, V> motion(system_, groupoid.target(moved), detail::varied_along(before_.momentum, n - first));
      motion.step(composition_, system_.h);
      const Vector<V, n> w = groupoid.tau_inverse(groupoid.compose(back, groupoid.compose(moved, motion.arrow())));
      Vector<V, 2 * n> end;
      end << w, motion.momentum();
      detail::put_tangents(end, first, stage_.end_by_start);
    });
    if (!std::exchange(compared_, true)) compare();
    return stage_.factor();
  }
  int stages() const override { return 1; }
  const LinearStep& stage(int) const override { return stage_; }

  NodeValues observe() const override {
    const TrajectoryPoint<Sys>& point = integrator_.point();
    return detail::values_at(system_, places_, point, 0,
                             [&](int, const auto& object, const auto& momentum, const auto& configuration) {
                               return observe_({system_, point.time, object, momentum, configuration});
                             });
  }

  void serialize(NumberArchive& archive) override { integrator_.serialize(archive); }

 private:
  /// Each parameter, beside differences of the step.
  void compare() {
    const G& groupoid = system_.groupoid;
    const ArrowOf<G> back = groupoid.inverse(integrator_.point().step.arrow);
    for (std::size_t j = 0; j < places_.members.size(); ++j) {
      double& member = const_cast<double&>(*places_.members[j]);  // of system_, no constant
      const double here = member;
      const auto at = [&](double value) {
        member = value;
        SplitMotion<Sys, double> motion(system_, before_.object, before_.momentum);
        motion.step(composition_, system_.h);
        member = here;
        Eigen::VectorXd end(2 * n);
        end << groupoid.tau_inverse(groupoid.compose(back, motion.arrow())), motion.momentum_change();
        return end;
      };
      const double width = 1e-4 * (here == 0 ? 1 : std::abs(here));
      const auto difference = [&](double by) -> Eigen::VectorXd { return (at(here + by) - at(here - by)) / (2 * by); };
      const double rounding = (before_.momentum.norm() + groupoid.coordinates_of_arrow(back).norm()) / width;
      detail::require_derivative(places_.names[j], stage_.end_by_start.col(2 * n + Eigen::Index(j)), difference(width),
                                 difference(width / 2), rounding);
    }
  }

  Sys system_;
  Composition composition_;
  SplittingIntegrator<Sys> integrator_;
  ParameterPlaces places_;
  ObserveNode<Sys> observe_;
  LinearStep stage_;
  State<G> before_ = integrator_.point().state;
  bool compared_ = false;
};

}  // namespace lagroid
