#pragma once
/// A manifold M with a Lie group G that acts on it from the left, exp(u) z: what an integrator for homogeneous spaces
/// requires.
///
/// Methods that move a point by the group stay on M: a unit vector is turned, not pushed off its sphere.
///
///     const Spheres<1> sphere{};
///     Spheres<1>::Point z(0, 0, 1);
///     sphere.act(Spheres<1>::Algebra(0.1, 0, 0), z);  // turned by 0.1 about the first axis
///
/// Requires the operations listed at `HomogeneousSpace`, without allocation; laws::homogeneous_laws tests them. Results
/// are written into the last argument. Nothing throws.

#include <lagroid/core/types.hpp>

#include <concepts>

namespace lagroid {

/// A manifold M with a Lie group G acting on it from the left.
///
/// Supplied by the user, all without allocation once the arguments have their sizes:
///
///     using Point;    z in M, in coordinates of a vector space: an Eigen matrix
///     using Algebra;  u in the Lie algebra g: an Eigen matrix
///     void act(const Algebra& u, Point& z)                        z <- exp(u) z
///     void generator(const Algebra& u, const Point& z, Point& v)  v <- u_M(z) = d/dt exp(t u) z at t = 0
///     void bracket(const Algebra& u, const Algebra& v, Algebra& w)  w <- [u, v]
///     void project(Point& z)                                      the point of M nearest to z, to first order
///     Point zero_point(), Algebra zero_algebra()                  of the right sizes
///
/// Laws (laws::homogeneous_laws): exp(s u) exp(t u) z = exp((s + t) u) z; u_M is tangent to the orbits; u -> u_M is
/// linear and [u_M, v_M] = -[u, v]_M for the bracket of vector fields; Jacobi's identity.
///
/// A curve in g moves z by z' = F(t, z)_M(z): these z are the targets of the arrows (g, z_0) of the action groupoid of
/// G on M, and a step of an integrator is such an arrow (docs/lie_group_integrators.md).
template <class M>
concept HomogeneousSpace = requires(const M& m, const typename M::Algebra& u, typename M::Point& z,
                                    typename M::Algebra& w) {
  m.act(u, z);
  m.generator(u, z, z);
  m.bracket(u, u, w);
  m.project(z);
  { m.zero_point() } -> std::same_as<typename M::Point>;
  { m.zero_algebra() } -> std::same_as<typename M::Algebra>;
};

/// A map F : R x M -> g, written into its last argument; it may keep a workspace. The vector field on M is
/// z' = F(t, z)_M(z).
template <class F, class M>
concept AlgebraField = HomogeneousSpace<M> &&
    requires(F& f, double t, const typename M::Point& z, typename M::Algebra& u) {
  f(t, z, u);
};

}  // namespace lagroid
