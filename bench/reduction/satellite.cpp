// A satellite with wheels, on pairs of (attitude, wheels' angles) and on their steps.
#include "satellite.hpp"

#include <lagroid/core/reduction/reduced_system.hpp>
#include <lagroid/groupoids/morphisms.hpp>

namespace reduction {

namespace {

struct SatelliteOnPairs : System<SatelliteOnPairs, PairOf<Placement>> {
  Satellite below;
  template <class A> auto lagrangian(const A& g) const {
    const auto& step = groupoid.quotient(g);
    using S = typename std::remove_cvref_t<decltype(std::get<0>(step))>::Scalar;
    return below.lagrangian<S>(step);
  }
};

}  // namespace

int satellite_by_hand(long steps) { return integrate(Satellite{}, satellite_start(), steps); }
int satellite_reduced(long steps) {
  return integrate(ReducedSystem<LeftQuotient<Placement>, SatelliteOnPairs>{}, satellite_start(), steps);
}

}  // namespace reduction
