#pragma once
/// The motion of a split system by compositions of its flows, linearised: with g_{k+1} = g_k a(q_k, mu_k; theta), a the
/// arrow that the flows lead along,
///
///     tau(w) = a^{-1} tau(v) a(target of tau(v), mu + dmu; theta + dtheta),    x' = (w, mu').
///
///     LinearisedSplitting<Kepler> motion(kepler, start, unit, splittings::srkn6, {"strength"}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);
///
/// Its steps can be cut (CuttableExplicit) where flows take times over the scalar, too (SplitInLanes).
///
/// Requires flows that are templates on the scalar. Errors: those of CuttableExplicit; std::invalid_argument for a
/// composition that the system does not admit.

#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/solvers/sensitivity/explicit/cuttable_explicit.hpp>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

/// The system along whose flows time passes at a rate.
template <SplitSystem Sys> struct FlowsAtRate : Sys {
  using G = typename Sys::GroupoidType;
  static constexpr bool has_rate = SplitInLanes<Sys, VariedNumber>;

  explicit FlowsAtRate(const Sys& system) : Sys(system) {}
  template <int Part, class S, class T>
  FlowOf<G, S> flow(const T& t, const ObjectOf<G, S>& q, const Vector<S, G::dimension>& mu) const {
    if constexpr (has_rate && std::is_same_v<S, VariedNumber>) {
      return Sys::template flow<Part>(varied<S>(rate) * t, q, mu);
    } else {
      return Sys::template flow<Part>(t, q, mu);
    }
  }

  double rate = 1;
};

template <SplitSystem Sys> class SplittingSteps : public SplittingIntegrator<Sys> {
 public:
  using G = typename Sys::GroupoidType;
  using Chart = GroupoidChart<Sys>;

  SplittingSteps(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration,
                 const Composition& composition)
      : SplittingIntegrator<Sys>(system, start, configuration, composition), composition_(composition) {}

  template <class S> NodeOver<G, S> step(const Sys& system, const NodeOver<G, S>& from) const {
    SplitMotion<Sys, S> motion(system, from.object, from.momentum);
    motion.step(composition_, system.h);
    return {motion.object(), motion.momentum(), system.groupoid.compose(from.configuration, motion.arrow())};
  }

 private:
  Composition composition_;
};

}  // namespace detail

template <SplitSystem Sys>
class LinearisedSplitting final
    : public CuttableExplicit<Sys, detail::FlowsAtRate<Sys>, detail::SplittingSteps<detail::FlowsAtRate<Sys>>> {
 public:
  using G = typename Sys::GroupoidType;
  using System = detail::FlowsAtRate<Sys>;
  using Steps = detail::SplittingSteps<System>;

  LinearisedSplitting(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration,
                      const Composition& composition, const std::vector<std::string>& parameters,
                      ObserveNode<Sys> observe)
      : CuttableExplicit<Sys, System, Steps>(System(system), {System(system), start, configuration, composition},
                                             parameters, std::move(observe)) {}
};

}  // namespace lagroid
