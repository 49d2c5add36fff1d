#pragma once
/// Systems whose runs start by velocities: which numbers these are, and the momentum that they come to.
///
/// What a scene gives is kept where parameters change: the momentum follows them, and has derivatives by them.
///
///     static constexpr std::array<std::string_view, 2> velocity_names{"w", "v1"};
///     template <class S> Vector<S, 3> momentum_of(const ObjectOf<SE2, S>& q, const Vector<S, 2>& v) const;
///     Vector<double, 2> velocities(const State<SE2>& z) const;  // of a state with such a momentum
///
/// Requires of `momentum_of` that it reads parameters by `varied` (core/scalars/varied.hpp), and that `velocities`
/// finds what it is given. `velocity_start_fits` is false for names of velocities without the other two. Nothing
/// throws.

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/core/system.hpp>

#include <concepts>

namespace lagroid {

template <class Sys> using VelocitiesOf = Vector<double, int(Sys::velocity_names.size())>;

template <class Sys>
concept StartsByVelocity = DiscreteSystem<Sys> &&
    requires(const Sys& system, const State<typename Sys::GroupoidType>& z,
             const ObjectOf<typename Sys::GroupoidType, VariedNumber>& q,
             const Vector<VariedNumber, int(Sys::velocity_names.size())>& v) {
  { system.velocities(z) } -> std::convertible_to<VelocitiesOf<Sys>>;
  { system.momentum_of(q, v) } -> std::convertible_to<AlgebroidVector<typename Sys::GroupoidType, VariedNumber>>;
};

namespace detail {
LAGROID_MEMBER_NAME(NamesVelocityStart, velocity_names);
}  // namespace detail

/// Whether `velocity_names`, where there are any, are those of such a system.
template <class Sys>
inline constexpr bool velocity_start_fits = StartsByVelocity<Sys> || !detail::NamesVelocityStart<Sys>;

}  // namespace lagroid
