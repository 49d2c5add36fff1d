#pragma once
/// A satellite with three wheels, on its steps.

#include "reduction.hpp"

#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/groupoids/product.hpp>

namespace reduction {

using Placement = Product<SO3, SO2, SO2, SO2>;

template <class S> S kinetic(const Vector<S, 3>& turn, const Vector<double, 3>& inertia) {
  return (turn(0) * turn(0) * inertia(0) + turn(1) * turn(1) * inertia(1) + turn(2) * turn(2) * inertia(2)) * (0.5 / h);
}

struct Satellite : System<Satellite, Placement> {
  Vector<double, 3> inertia{3, 2, 1};
  Vector<double, 3> wheels{0.4, 0.3, 0.2};
  template <class S> S lagrangian(const ArrowOf<Placement, S>& g) const {
    const Vector<S, 3> turn = SO3::log(std::get<0>(g));
    const Vector<S, 3> angles(SO2::log(std::get<1>(g))(0), SO2::log(std::get<2>(g))(0), SO2::log(std::get<3>(g))(0));
    return kinetic(turn, inertia) + kinetic(Vector<S, 3>(turn + angles), wheels);
  }
};

inline State<Placement> satellite_start() {
  State<Placement> z;
  z.momentum << 1.2, 0.3, -0.5, 0.2, -0.1, 0.3;
  return z;
}

}  // namespace reduction
