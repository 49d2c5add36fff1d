#pragma once
/// Systems that declare a time scale sigma(q, mu), to which steps are to be proportional, by its rate d log sigma / dt.
///
/// Adaptive steps that follow a smooth, reversible function of the state keep the long-time behaviour of symplectic
/// methods.
///
///     double time_scale_rate(const State<Pair<2>>& z) const {
///       return 1.5 * z.object.dot(z.momentum) / z.object.squaredNorm();
///     }
///
/// is that of sigma = |q|^{3/2}, the time scale of a fall towards a centre. Requires that sigma is the same, and its
/// rate the opposite, for the reversed motion. `time_scale_fits` is false for a member of this name and another form.

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
