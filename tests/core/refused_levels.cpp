// Systems that have no momentum level: none of these may compile. tests/CMakeLists.txt compiles the file once for each
// case, and reads what the compiler says.
#include <lagroid/core/reduction/momentum_level.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/pair.hpp>

using namespace lagroid;

namespace {

using Bundle = Product<Pair<1>, SO2>;

#if defined(ARROW_CONSTRAINT)
constexpr int told = 1;
#else
constexpr int told = 0;
#endif

struct Particle : System<Particle, Bundle, told> {
  double h = 0.1;
  template <class S> S lagrangian(const ArrowOf<Bundle, S>& g) const {
    const auto& [b, turn] = g;
    return (b.target - b.source).squaredNorm() * (0.5 / h) - turn.trace() * (0.5 / h);
  }
#if defined(ARROW_CONSTRAINT)
  template <class S> Vector<S, 1> constraint(const ArrowOf<Bundle, S>& g) const {
    return std::get<0>(g).target - std::get<0>(g).source;
  }
#elif defined(FORCED)
  template <class S> Forces<S, 2> forces(const ArrowOf<Bundle, S>&) const {
    return {Vector<S, 2>::Zero(), Vector<S, 2>::Zero()};
  }
#endif
};

using Connection = FactorConnection<Factors<1>, Pair<1>, SO2>;
[[maybe_unused]] double routhian() {
  const MomentumLevel<Connection, Particle> level({}, {}, Vector<double, 1>(0.2));
  return level.lagrangian(PairArrow<double, 1>{Vector<double, 1>(1), Vector<double, 1>(1)});
}

}  // namespace
