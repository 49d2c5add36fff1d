#pragma once
/// The trivial groupoid R^n x R^n x H => R^n with a Lie group H: arrows (q0, q1, h), with (q0, q1, h)(q1, q2, k) = (q0,
/// q2, h k).
///
/// A ball on a plate has a position that its motion depends on, and an attitude that enters by its changes alone: so do
/// all systems with a symmetry group H, after reduction.
///
///     const Trivial<2, SO3> groupoid;
///     const auto g = groupoid.unit(std::tuple(Vector<double, 2>(0, 0), Vector<double, 0>()));
///     const auto& [position, turn] = g;
///
/// Errors are those of Product.

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/product.hpp>

namespace lagroid {

/// Arrows (q0, q1, h): from q0 to q1 with an element of H, (q0, q1, h)(q1, q2, k) = (q0, q2, h k). Algebroid: TR^n x h,
/// that of Atiyah for the bundle below.
///
/// It is the product of Pair<n> and H as it stands: objects of H are a single point, so that composing factor by factor
/// requires equal ends in R^n alone. And it is the gauge groupoid Pair(P)/H of the bundle P = R^n x H, H acting from
/// the left on the second factor: the class of ((q0, a), (q1, b)) is (q0, q1, a^{-1} b), by
/// ProductMorphism<IdentityMorphism<Pair<n>>, LeftQuotient<H>>.
///
/// The gauge groupoid of a bundle G -> H\G of a group over a homogeneous space, H the elements that leave a point m
/// where it is, is the action groupoid of G on that space: the class of (a, b) is (a^{-1} b, m a), by
/// StabiliserQuotient. So Action<SO3, RotatedDirections> is that of SO(3) -> S^2.
template <int N, class H> using Trivial = Product<Pair<N>, H>;

}  // namespace lagroid
