#pragma once
/// The motion of a system by explicit steps, linearised: they have no equations, so that the step itself is evaluated
/// over numbers with derivatives, x -> x' in displacements of its two nodes (charts_of_nodes.hpp).
///
/// A kind of steps says by `Chart` which displacements it has, and writes its step over any scalar:
///
///     template <class S> NodeOver<G, S> step(const Sys& system, const NodeOver<G, S>& from) const;
///
/// beside the integrator's own `advance`, `point` and `serialize`. LinearisedExtrapolation is such a motion; those
/// whose steps are made in part, too, are of cuttable_explicit.hpp.
///
/// Requires formulas that are templates on the scalar. Errors: std::invalid_argument for a name that is no parameter;
/// WithoutDerivative for a parameter that they read as a plain number, found at the first step.

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/solvers/sensitivity/explicit/charts_of_nodes.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion_of.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// Kind: of LinearisedMotion, that it is.
template <DiscreteSystem Sys, class Steps, class Kind = LinearisedMotion> class LinearisedExplicit : public Kind {
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
    differentiate(before_, steps_.point(), places_.members, stage_.end_by_start);
    if (!std::exchange(compared_, true)) compare({system_, before_}, {system_, steps_.point()});
    return stage_.factor();
  }
  int stages() const override { return 1; }
  const LinearStep& stage(int) const override { return stage_; }

  NodeValues observe() const override { return observe_at(steps_.point()); }

  void serialize(NumberArchive& archive) override { steps_.serialize(archive); }

 protected:
  using Members = std::vector<const double*>;

  /// What the step from one point to another is by the states and these members of `system()`, a column for each.
  void differentiate(const TrajectoryPoint<Sys>& from, const TrajectoryPoint<Sys>& to, const Members& members,
                     Eigen::MatrixXd& by) const {
    const Chart before(system_, from), after(system_, to);
    by.resize(Chart::states, Chart::states + Eigen::Index(members.size()));
    for_varied(members, [&](int first, const auto& x) {
      detail::put_tangents(after.displacement(steps_.step(system_, before.displaced(x))), first, by);
    });
  }
  NodeValues observe_at(const TrajectoryPoint<Sys>& point) const {
    const Chart here(system_, point);
    NodeValues out;
    for_varied(places_.members, [&](int first, const auto& x) {
      const VariedVector seen = seen_at(here, point.time, x);
      out.values.resize(seen.size());
      out.derivatives.conservativeResize(seen.size(), states() + parameters());
      for (Eigen::Index i = 0; i < seen.size(); ++i) out.values(i) = seen(i).value;
      detail::put_tangents(seen, first, out.derivatives);
    });
    return out;
  }
  /// The numbers alone.
  Eigen::VectorXd values_at(const TrajectoryPoint<Sys>& point) const {
    const VariedVector seen =
        seen_at({system_, point}, point.time,
                detail::varied_along(Vector<double, Chart::states>(Vector<double, Chart::states>::Zero()), none));
    Eigen::VectorXd out(seen.size());
    for (Eigen::Index i = 0; i < seen.size(); ++i) out(i) = seen(i).value;
    return out;
  }

  Sys& system() { return system_; }
  const Members& members() const { return places_.members; }
  Steps& steps() { return steps_; }
  const Steps& steps() const { return steps_; }

 private:
  static constexpr int none = -Chart::states;  ///< of the directions along which displacements vary

  VariedVector seen_at(const Chart& here, double time, const Vector<VariedNumber, Chart::states>& x) const {
    const NodeOver<G, VariedNumber> node = here.displaced(x);
    return observe_(
        {system_, time, node.object, varied_tangent_momentum(system_, node.object, node.momentum), node.configuration});
  }
  /// Visits the directions of states and members: visit(first, x) with displacements along those from `first` on.
  template <class Visit> static void for_varied(const Members& members, const Visit& visit) {
    const Vector<double, Chart::states> zero = Vector<double, Chart::states>::Zero();
    detail::for_directions(Chart::states + int(members.size()), [&](int first) {
      const VariedMembers varying(members, Chart::states - first);
      visit(first, detail::varied_along(zero, -first));
    });
  }

  void compare(const Chart& before, const Chart& after) {
    const Vector<double, Chart::states> still = Vector<double, Chart::states>::Zero();
    detail::compare_with_differences(
        places_, stage_.end_by_start.rightCols(parameters()), detail::size_of(system_, before_),
        [&] { return Eigen::VectorXd(after.displacement(steps_.step(system_, before.displaced(still)))); });
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
