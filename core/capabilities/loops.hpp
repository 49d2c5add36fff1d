#pragma once
/// Loops of a groupoid's source fibres: paths from one arrow to another that differ by whole turns.
///
/// A boundary value has a solution for each number of turns; a search that multiplies its first guesses by loops finds
/// them.
///
///     const auto g = loop_of(system, q, axis, Eigen::VectorXd::Constant(1, 0.5));  // half of a turn about the axis
///
/// Requires `loop_count(system)` numbers of turns. Returns the unit at q where they are integers. Nothing throws.

#include <lagroid/core/groupoid.hpp>
#include <lagroid/core/member_name.hpp>

#include <concepts>

namespace lagroid {

/// The number of loops that X, a groupoid or a system, declares; zero where it declares none.
template <class X> constexpr int loops_of() {
  if constexpr (requires { X::loops; }) {
    return X::loops;
  } else {
    return 0;
  }
}

/// A groupoid, or a system on one, whose paths from one arrow to another can wind: it writes
///
///     static constexpr int loops                                        how many numbers of turns there are
///     Arrow<double> loop(q, axis, turns) const                          in the source fibre over q
///         const Object<double>& q, const Vector<double, dimension>& axis, const Vector<double, loops>& turns
///
/// unit(q) where all turns are integers, and smooth in them, so that t -> loop(q, axis, t k) is a closed curve for
/// integers k. `axis` is any vector of A_qG: it distinguishes loops of the same number of turns, as rotations about
/// different axes. On a group they are one-parameter subgroups through the kernel of exp. A system writes its own
/// where the obstacle that paths go around belongs to it and not to the groupoid, as a centre of attraction in the
/// plane.
template <class X>
concept Winding = loops_of<X>()
> 0;

namespace detail {

LAGROID_MEMBER_NAME(NamesLoop, loop);
template <class Sys>
concept HasLoop = requires(const Sys& system, const ObjectOf<typename Sys::GroupoidType>& q,
                           const AlgebroidVector<typename Sys::GroupoidType>& axis,
                           const Vector<double, loops_of<Sys>()>& turns) {
  { system.loop(q, axis, turns) } -> std::convertible_to<ArrowOf<typename Sys::GroupoidType>>;
};

/// The object that has the loops of a system: the system itself, or else its groupoid.
template <class Sys> const auto& winder(const Sys& system) {
  if constexpr (Winding<Sys>) {
    return system;
  } else {
    return system.groupoid;
  }
}
template <class Sys>
inline constexpr int windings = Winding<Sys> ? loops_of<Sys>() : loops_of<typename Sys::GroupoidType>();

}  // namespace detail

/// The number of loops in which the paths of a system can wind, for a SizedSystem a number of its run time.
template <class Sys> int loop_count(const Sys& system) {
  if constexpr (requires { system.loop_count(); }) {
    return system.loop_count();
  } else {
    return detail::windings<Sys>;
  }
}

/// The loop over q about `axis` with so many turns, of a system or its groupoid. Requires `loop_count` turns, and that
/// there are any.
template <class Sys>
auto loop_of(const Sys& system, const ObjectOf<typename Sys::GroupoidType>& q,
             const AlgebroidVector<typename Sys::GroupoidType>& axis, const Eigen::VectorXd& turns) {
  if constexpr (requires { system.loop_count(); }) {
    return system.loop(q, axis, turns);
  } else if constexpr (detail::windings<Sys> > 0) {
    return detail::winder(system).loop(q, axis, Vector<double, detail::windings<Sys>>(turns));
  } else {
    return system.groupoid.unit(q);
  }
}

/// Whether a system that has one of `loops` and `loop` has both.
template <class Sys> constexpr bool loops_and_loop_fit() {
  if constexpr (Winding<Sys>) {
    return detail::HasLoop<Sys>;
  } else {
    return !detail::NamesLoop<Sys> || requires(const Sys& system) { system.loop_count(); };
  }
}
template <class Sys> inline constexpr bool loops_fit = loops_and_loop_fit<Sys>();

}  // namespace lagroid
