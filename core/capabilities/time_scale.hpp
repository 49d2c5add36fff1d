#pragma once
/// Systems that know how fast they move.

#include <lagroid/core/system.hpp>

#include <concepts>

namespace lagroid {

/// A system that writes `double time_scale_rate(const State<G>& z) const`: d log sigma / dt along its motion, where
/// sigma(q, mu) is a time in which little changes and to which the step is to be proportional. sigma must be the same,
/// its rate the opposite, when the motion is reversed.
template <class Sys>
concept HasTimeScale = requires(const Sys& system, const State<typename Sys::GroupoidType>& state) {
  { system.time_scale_rate(state) } -> std::convertible_to<double>;
};

namespace detail {
LAGROID_MEMBER_NAME(NamesTimeScale, time_scale_rate);
}  // namespace detail

/// Whether `time_scale_rate`, where there is one, is that.
template <class Sys> inline constexpr bool time_scale_fits = HasTimeScale<Sys> || !detail::NamesTimeScale<Sys>;

}  // namespace lagroid
