#pragma once
/// The motion of a split system by extrapolated splitting steps, linearised: between two nodes the same inner steps are
/// made over numbers with derivatives, of the sizes and of the orders that the tolerance asked for,
///
///     g = project(e + sum_j w_j (g_j - e)),    mu' - mu = sum_j w_j (mu_j - mu),
///
/// which derivatives hold: how these change with the start is not smooth, and what it does to the end is of the size of
/// the run's own error.
///
///     LinearisedExtrapolation<Kepler> motion(kepler, start, unit, 1e-10, {"strength"}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);
///
/// Requires flows that are templates on the scalar. Errors: those of LinearisedExplicit and of ExtrapolatedSplitting.
/// (Internal differentiation: Bock 1981.)

#include <lagroid/solvers/extrapolation/extrapolated_splitting.hpp>
#include <lagroid/solvers/sensitivity/explicit/linearised_explicit.hpp>

#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// As an inner step leaves it.
template <DiscreteSystem Sys, class S>
AlgebroidVector<typename Sys::GroupoidType, S> reported_momentum(const Sys& system,
                                                                 const NodeOver<typename Sys::GroupoidType, S>& node) {
  if constexpr (std::is_same_v<S, double>) {
    return tangent_momentum(system, {node.object, node.momentum});
  } else {
    return varied_tangent_momentum(system, node.object, node.momentum);
  }
}

}  // namespace detail

/// Where inner steps of extrapolation lead to, over any scalar that the flows take.
template <SplitSystem Sys, class S>
NodeOver<typename Sys::GroupoidType, S> follow_inner_steps(const Sys& system,
                                                           NodeOver<typename Sys::GroupoidType, S> node,
                                                           std::span<const InnerStep> steps) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = system.groupoid;
  for (const InnerStep& inner : steps) {
    const NodeOver<G, S> from = node;
    const Eigen::VectorXd weights = ExtrapolationTable::of(inner.rows, 1, 1).weights.col(0);
    const auto begun = groupoid.coordinates_of_arrow(groupoid.unit(from.object));
    auto place = begun;
    for (int j = 1; j <= inner.rows; ++j) {
      SplitMotion<Sys, S> row(system, from.object, from.momentum);
      const double size = inner.size / j;
      row.template follow<0>(0.5 * size);
      for (int i = 1; i <= j; ++i) {
        row.follow_others(size);
        row.template follow<0>(i < j ? size : 0.5 * size);
      }
      place += (groupoid.coordinates_of_arrow(row.arrow()) - begun) * weights(j - 1);
      node.momentum += row.momentum_change() * weights(j - 1);
    }
    ArrowOf<G, S> arrow = groupoid.project(groupoid.template arrow_at<S>(place));
    if constexpr (Sys::object_constraints > 0) onto_object_constraints<S>(system, arrow);
    node.object = groupoid.target(arrow);
    node.configuration = groupoid.compose(from.configuration, arrow);
    node.momentum = detail::reported_momentum(system, node);
  }
  return node;
}

namespace detail {

template <SplitSystem Sys> class ExtrapolationSteps : public ExtrapolatedSplitting<Sys> {
 public:
  using G = typename Sys::GroupoidType;
  using Chart = GroupoidChart<Sys>;
  using ExtrapolatedSplitting<Sys>::ExtrapolatedSplitting;

  StepReport advance() {
    made_.clear();
    return ExtrapolatedSplitting<Sys>::advance([this](const InnerStep& inner) { made_.push_back(inner); });
  }
  template <class S> NodeOver<G, S> step(const Sys& system, const NodeOver<G, S>& from) const {
    return follow_inner_steps(system, from, made_);
  }

 private:
  std::vector<InnerStep> made_;  ///< on the way to the present node
};

}  // namespace detail

template <SplitSystem Sys>
class LinearisedExtrapolation final : public LinearisedExplicit<Sys, detail::ExtrapolationSteps<Sys>> {
 public:
  using G = typename Sys::GroupoidType;

  LinearisedExtrapolation(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration, double tolerance,
                          const std::vector<std::string>& parameters, ObserveNode<Sys> observe)
      : LinearisedExplicit<Sys, detail::ExtrapolationSteps<Sys>>(system, {system, start, configuration, tolerance},
                                                                 parameters, std::move(observe)) {}
};

}  // namespace lagroid
