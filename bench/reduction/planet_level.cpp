// A planet's distance, with its angular momentum fixed.
#include "reduction.hpp"

#include <lagroid/core/reduction/momentum_level.hpp>
#include <lagroid/core/reduction/reduced_system.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/polar.hpp>

#include <cmath>

namespace reduction {

namespace {

constexpr double angular_momentum = 0.9;
const State<Pair<1>> start{Vector<double, 1>(1.1), Vector<double, 1>(0.3)};

struct Planet : System<Planet, Pair<2>> {
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    return (g.target - g.source).squaredNorm() * (0.5 / h) +
           (1.0 / g.source.norm() + 1.0 / g.target.norm()) * (0.5 * h);
  }
};

/// Its Routhian, where r s sin(theta) = h times the momentum.
template <class S, class T> S routhian_of_distance(const PairArrow<S, 1>& b, const T& momentum) {
  using std::atan2;
  using std::sqrt;
  const T sine = momentum * h;  // times r s, as the cosine
  const S r = b.source(0);
  const S s = b.target(0);
  const S cosine = sqrt(r * r * (s * s) - sine * sine);
  return (r * r + s * s - cosine * 2.0) * (0.5 / h) + (1.0 / r + 1.0 / s) * (0.5 * h) -
         atan2(S(sine), cosine) * momentum;
}
struct Distance : System<Distance, Pair<1>> {
  template <class S> S lagrangian(const PairArrow<S, 1>& b) const { return routhian_of_distance(b, angular_momentum); }
};

using ByTheAngle = FactorConnection<Factors<1>, Pair<1>, SO2>;

/// The planet, whose user has the paper at hand.
struct SolvedPlanet : System<SolvedPlanet, Pair<2>> {
  Planet planet;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const { return planet.lagrangian(g); }
  template <class S, class T>
  S routhian(const ByTheAngle&, const PairArrow<S, 1>& b, const Vector<T, 1>& momentum) const {
    return routhian_of_distance(b, momentum(0));
  }
};

template <class Full> int integrate_level(long steps) {
  const MomentumLevel level(ByTheAngle{}, ReducedSystem<PolarQuotient, Full>{}, Vector<double, 1>(angular_momentum));
  return integrate(level, start, steps);
}

}  // namespace

int planet_level_by_hand(long steps) { return integrate(Distance{}, start, steps); }
int planet_level(long steps) { return integrate_level<Planet>(steps); }
int solved_planet_level(long steps) { return integrate_level<SolvedPlanet>(steps); }

}  // namespace reduction
