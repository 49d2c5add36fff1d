// Systems that do not fit what their base is told of: none of them may compile. tests/CMakeLists.txt compiles the file
// once for each case, and reads what the compiler says.
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/step/newton_step.hpp>
#include <lagroid/systems/galerkin.hpp>

using namespace lagroid;

namespace {

#if defined(DECLARED_NONE) || defined(OBJECT_CONSTRAINT) || defined(FORCE) || defined(FITS) || defined(DERIVED)
constexpr int told = 0;
#else
constexpr int told = 1;
#endif

struct Particle : System<Particle, Pair<2>, told> {
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 2>& g) const {
    return (g.target - g.source).squaredNorm() * (0.5 / h);
  }
#if defined(DECLARED_NONE) || defined(GALERKIN)
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 2>& g) const { return Vector<S, 1>(g.target(0)); }
#elif defined(ANOTHER_COUNT)
  template <class S> Vector<S, 2> constraint(const PairArrow<S, 2>& g) const { return g.target; }
#elif defined(NOT_CONST)
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 2>& g) { return Vector<S, 1>(g.target(0)); }
#elif defined(MISNAMED)
  template <class S> Vector<S, 1> constraints(const PairArrow<S, 2>& g) const { return Vector<S, 1>(g.target(0)); }
#elif defined(OBJECT_CONSTRAINT)
  template <class S> Vector<S, 1> object_constraint(const Vector<S, 2>& q) const { return Vector<S, 1>(q(0)); }
#elif defined(FORCE)
  template <class S> Forces<S, 2> force(const PairArrow<S, 2>& g) const { return {g.source, g.target}; }
#endif

  double mass() const { return 1; }
  template <class S> S potential(const Vector<S, 2>& q) const { return q.squaredNorm() * 0.5; }
};

#if defined(DERIVED)
// The base of the base is told of what a class derived from it adds no more than the base is.
struct Fits : System<Fits, Pair<1>> {
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return (g.target - g.source).squaredNorm(); }
};
struct Constrained : Fits {
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 1>& g) const { return g.target; }
};
using Subject = Constrained;
#elif defined(GALERKIN)
using Subject = GalerkinMechanics<Particle, 2>;
#else
using Subject = Particle;
#endif

}  // namespace

int main() {
#if defined(GALERKIN)
  const Subject system{Particle{}};
#else
  const Subject system;
#endif
  gradients(system, system.groupoid.unit(ObjectOf<Subject::GroupoidType>{}), Subject::Multipliers{});
}
