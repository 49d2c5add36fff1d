#pragma once
/// The motion of a split system by compositions of its flows, linearised: with g_{k+1} = g_k a(q_k, mu_k; theta), a the
/// arrow that the flows lead along,
///
///     tau(w) = a^{-1} tau(v) a(target of tau(v), mu + dmu; theta + dtheta),    x' = (w, mu').
///
///     LinearisedSplitting<Kepler> motion(kepler, start, unit, splittings::srkn6, {"strength"}, end_state);
///     const Propagated end = propagate_forward(motion, 100, directions);
///
/// Requires flows that are templates on the scalar. Errors: those of LinearisedExplicit; std::invalid_argument for a
/// composition that the system does not admit.

#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/solvers/sensitivity/explicit/linearised_explicit.hpp>

#include <string>
#include <utility>
#include <vector>

namespace lagroid {

namespace detail {

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
class LinearisedSplitting final : public LinearisedExplicit<Sys, detail::SplittingSteps<Sys>> {
 public:
  using G = typename Sys::GroupoidType;

  LinearisedSplitting(const Sys& system, const State<G>& start, const ArrowOf<G>& configuration,
                      const Composition& composition, const std::vector<std::string>& parameters,
                      ObserveNode<Sys> observe)
      : LinearisedExplicit<Sys, detail::SplittingSteps<Sys>>(system, {system, start, configuration, composition},
                                                             parameters, std::move(observe)) {}
};

}  // namespace lagroid
