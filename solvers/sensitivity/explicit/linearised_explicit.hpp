#pragma once
/// The motion of a system by explicit steps, linearised: they have no equations, so that the step itself is evaluated
/// over numbers with derivatives, x -> x' in displacements of its two nodes (charts_of_nodes.hpp).
///
/// A kind of steps says by `Chart` which displacements it has, and writes its step over any scalar:
///
///     template <class S> NodeOver<G, S> step(const Sys& system, const NodeOver<G, S>& from) const;
///
/// beside the integrator's own `advance`, `point` and `serialize`. LinearisedSplitting and LinearisedRungeKutta are
/// such.
///
/// Requires formulas that are templates on the scalar. Errors: std::invalid_argument for a name that is no parameter;
/// WithoutDerivative for a parameter that they read as a plain number, found at the first step.

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/solvers/sensitivity/explicit/charts_of_nodes.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion_of.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

template <DiscreteSystem Sys, class Steps> class LinearisedExplicit : public LinearisedMotion {
 public:
  using G = typename Sys::GroupoidType;
  using Chart = typename Steps::Chart;

  LinearisedExplicit(const Sys& system, Steps steps, const std::vector<std::string>& parameters,
                     ObserveNode<Sys> observe)
      : system_(system),
        steps_(std::move(steps)),
        places_(places_of_parameters(system_, parameters)),
        observe_(std::move(observe)),
        stage_(0, Chart::states, int(places_.members.size())) {}
  LinearisedExplicit(const LinearisedExplicit&) = delete;  // derivatives know members by their places
  LinearisedExplicit& operator=(const LinearisedExplicit&) = delete;

  int states() const override { return Chart::states; }
  int parameters() const override { return int(places_.members.size()); }
  double time() const override { return steps_.point().time; }
  StepReport advance() override {
    before_ = steps_.point();
    return steps_.advance();
  }

  bool linearise() override {
    const Chart before(system_, before_), after(system_, steps_.point());
    for_varied([&](int first, const auto& x) {
      const auto end = after.displacement(steps_.step(system_, before.displaced(x)));
      detail::put_tangents(end, first, stage_.end_by_start);
    });
    if (!std::exchange(compared_, true)) compare(before, after);
    return stage_.factor();
  }
  int stages() const override { return 1; }
  const LinearStep& stage(int) const override { return stage_; }

  NodeValues observe() const override {
    const Chart here(system_, steps_.point());
    NodeValues out;
    for_varied([&](int first, const auto& x) {
      const NodeOver<G, VariedNumber> node = here.displaced(x);
      const VariedVector seen =
          observe_({system_, time(), node.object, varied_tangent_momentum(system_, node.object, node.momentum),
                    node.configuration});
      out.values.resize(seen.size());
      out.derivatives.conservativeResize(seen.size(), states() + parameters());
      for (Eigen::Index i = 0; i < seen.size(); ++i) out.values(i) = seen(i).value;
      detail::put_tangents(seen, first, out.derivatives);
    });
    return out;
  }

  void serialize(NumberArchive& archive) override { steps_.serialize(archive); }

 private:
  /// Visits the directions of states and parameters: visit(first, x) with displacements along those from `first` on.
  template <class Visit> void for_varied(const Visit& visit) const {
    const Vector<double, Chart::states> zero = Vector<double, Chart::states>::Zero();
    detail::for_directions(states() + parameters(), [&](int first) {
      const VariedMembers varying(places_.members, Chart::states - first);
      visit(first, detail::varied_along(zero, -first));
    });
  }

  /// Each parameter, beside differences of the step.
  void compare(const Chart& before, const Chart& after) {
    const Vector<double, Chart::states> still = Vector<double, Chart::states>::Zero();
    const double size =
        before_.state.momentum.norm() + system_.groupoid.coordinates_of_arrow(before_.configuration).norm();
    for (std::size_t j = 0; j < places_.members.size(); ++j) {
      double& member = const_cast<double&>(*places_.members[j]);  // of system_, no constant
      const double here = member;
      const auto at = [&](double value) -> Eigen::VectorXd {
        member = value;
        const Eigen::VectorXd end = after.displacement(steps_.step(system_, before.displaced(still)));
        member = here;
        return end;
      };
      const double width = 1e-4 * (here == 0 ? 1 : std::abs(here));
      const auto difference = [&](double by) -> Eigen::VectorXd { return (at(here + by) - at(here - by)) / (2 * by); };
      detail::require_derivative(places_.names[j], stage_.end_by_start.col(Chart::states + Eigen::Index(j)),
                                 difference(width), difference(width / 2), size / width);
    }
  }

  Sys system_;
  Steps steps_;
  ParameterPlaces places_;
  ObserveNode<Sys> observe_;
  LinearStep stage_;
  TrajectoryPoint<Sys> before_ = steps_.point();
  bool compared_ = false;
};

}  // namespace lagroid
