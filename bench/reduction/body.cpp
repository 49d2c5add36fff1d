// A free body, on pairs of attitudes and on SO(3).
#include "reduction.hpp"

#include <lagroid/core/reduction/reduced_system.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/morphisms.hpp>

namespace reduction {

namespace {

struct Body : System<Body, SO3> {
  Vector<double, 3> inertia{1, 2, 3};
  template <class S> S lagrangian(const Matrix<S, 3, 3>& g) const {
    const Vector<S, 3> turn = SO3::log(g);
    return (turn(0) * turn(0) * inertia(0) + turn(1) * turn(1) * inertia(1) + turn(2) * turn(2) * inertia(2)) *
           (0.5 / h);
  }
};

struct BodyOnPairs : System<BodyOnPairs, PairOf<SO3>> {
  Body below;
  template <class A> auto lagrangian(const A& g) const { return below.lagrangian(groupoid.quotient(g)); }
};

const State<SO3> start{{}, {0.3, 2, 0.1}};

}  // namespace

int body_by_hand(long steps) { return integrate(Body{}, start, steps); }
int body_reduced(long steps) { return integrate(ReducedSystem<LeftQuotient<SO3>, BodyOnPairs>{}, start, steps); }

}  // namespace reduction
